// How much of the ground a real OS1-128 sees at grazing incidence, beside the two laws of matt reflection.
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/lidar/beam/texture/value_noise.h"
#include "canyon/lidar/ouster/recording.h"
#include "canyon/scene/surfaces/material.h"
#include "canyon/tests/lidar/ground_under.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::lidar::ouster {
namespace {

using lidar::testing::ground_under;
using lidar::testing::GroundPlane;

constexpr double kBin_m = 2.5;
constexpr std::size_t kBins = 24;

/// Shots that would meet the ground so far off, and how many came back from it.
struct Counts {
  std::array<double, kBins> shots{}, returned{};
  double height_m = 0.0;
};

/// A shot counts where nothing but ground, or nothing at all, was met by those below it in its direction.
void count_ground(const Frame& frame, const Metadata& metadata, const std::vector<int>& shift, Counts& out) {
  std::vector<Eigen::Vector3d> points;
  for (const Return& r : frame.returns) points.push_back(r.p_m);
  const GroundPlane ground = ground_under(points);
  const double height_m = ground.below_m + metadata.lidar_to_sensor(2, 3);  // of where beams begin
  out.height_m += height_m / 3.0;
  const auto pixels = metadata.elevation_deg.size();
  const int columns = metadata.columns_per_frame;
  std::vector<const Return*> met(pixels * static_cast<std::size_t>(columns), nullptr);
  for (const Return& r : frame.returns)
    met[static_cast<std::size_t>(r.pixel) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(r.column)] =
        &r;
  for (int direction = 0; direction < columns; ++direction) {
    for (std::size_t pixel = pixels; pixel-- > 0;) {  // from the lowest up
      const int column = (direction - shift[pixel] + columns) % columns;
      const double up = metadata.elevation_deg[pixel] * kDegree;
      const double across =
          2.0 * kPi * (0.5 - static_cast<double>(column) / columns) - metadata.azimuth_deg[pixel] * kDegree;
      const Eigen::Vector3d along(std::cos(across) * std::cos(up), std::sin(across) * std::cos(up), std::sin(up));
      const double falls = -along.dot(ground.normal);
      const double there_m = falls > 1e-3 ? height_m / falls : 1e9;
      if (there_m >= kBin_m * kBins) break;
      const Return* r = met[pixel * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
      const bool is_ground = r != nullptr && std::abs(ground.height_m(r->p_m)) < 0.15 + 0.01 * r->range_m;
      if (r != nullptr && !is_ground) break;
      const auto bin = static_cast<std::size_t>(there_m / kBin_m);
      out.shots[bin] += 1.0;
      out.returned[bin] += is_ground ? 1.0 : 0.0;
    }
  }
}

/// Share of level asphalt, brighter and darker from place to place, that gives back enough from so far off: the radar
/// equation of `radiometric`, by hand.
double returned_by(bool rough, double height_m, double range_m, double range_at_10_percent_m) {
  const auto& all = scene::builtin_materials();
  const auto asphalt =
      std::find_if(all.begin(), all.end(), [](const scene::Material& m) { return m.name == "asphalt"; });
  const double cosine = height_m / range_m, s2 = std::pow(asphalt->lidar_slope_deg * kDegree, 2);
  const double A = 1.0 - 0.5 * s2 / (s2 + 0.33), B = 0.45 * s2 / (s2 + 0.09);
  const double light = asphalt->reflectance(850.0) * (rough ? A * cosine + B * (1.0 - cosine * cosine) : cosine);
  const double needed = 0.1 * std::pow(range_m / range_at_10_percent_m, 2);
  const RandomStream draws(2, "test.places");
  constexpr int kPlaces = 4000;
  int enough = 0;
  for (std::uint64_t k = 0; k < kPlaces; ++k) {
    const Eigen::Vector3d place = 50.0 * Eigen::Vector3d(draws.uniform(0, k), draws.uniform(1, k), draws.uniform(2, k));
    const float factor =
        vary(place, static_cast<float>(asphalt->widest()), 1.0F / static_cast<float>(asphalt->lidar_grain_m), 7);
    enough += static_cast<double>(factor) * light >= needed ? 1 : 0;
  }
  return static_cast<double>(enough) / kPlaces;
}

// At 20 m the incidence is 84 degrees. Lambertian asphalt would be lost there altogether, and 90 % come back. Oren and
// Nayar's law is within a factor of 1.5 up to 27.5 m; beyond 30 m what comes back is by the sensor's own reflectivity
// no asphalt any more. 40 m for a Lambertian target of 10 % is what an early data sheet of the OS1, its 128 beams
// included, says; 45 m, printed beside it, is as remembered of a later one.
TEST(OusterScans, GroundComesBackFromWhereALambertianOneWouldNot) {
  CANYON_REAL_DATA(capture_path, "lidar/ouster/OS-1-128_v2.3.0_1024x10_lb_n3.pcap");
  CANYON_REAL_DATA(metadata_path, "lidar/ouster/OS-1-128_v2.3.0_1024x10.json");
  const auto metadata = read_metadata(metadata_path);
  ASSERT_TRUE(metadata.ok());
  const auto frames = read_frames(capture_path, *metadata);
  ASSERT_TRUE(frames.ok());
  std::vector<int> shift;  // columns that bring a pixel to the direction of the others
  for (const double azimuth_deg : metadata->azimuth_deg)
    shift.push_back(static_cast<int>(std::lround(azimuth_deg / 360.0 * metadata->columns_per_frame)) + 12);
  Counts counts;
  for (const Frame& frame : *frames) count_ground(frame, *metadata, shift, counts);
  EXPECT_NEAR(counts.height_m, 1.97, 0.05);
  std::printf(
      "sensor %.2f m above the ground\n     range      shots  returned   lambertian (40, 45 m)   rough (40, 45 m)\n",
      counts.height_m);
  for (std::size_t bin = 2; bin < kBins; ++bin) {
    if (counts.shots[bin] < 200.0) continue;
    const double there_m = kBin_m * (static_cast<double>(bin) + 0.5), share = counts.returned[bin] / counts.shots[bin];
    const double lambertian[2] = {returned_by(false, counts.height_m, there_m, 40.0),
                                  returned_by(false, counts.height_m, there_m, 45.0)};
    const double rough[2] = {returned_by(true, counts.height_m, there_m, 40.0),
                             returned_by(true, counts.height_m, there_m, 45.0)};
    std::printf("%4.1f-%4.1f m  %7.0f  %8.2f   %10.2f %10.2f   %10.2f %10.2f\n", there_m - 0.5 * kBin_m,
                there_m + 0.5 * kBin_m, counts.shots[bin], share, lambertian[0], lambertian[1], rough[0], rough[1]);
    if (there_m > 20.0) {
      EXPECT_LT(1.5 * lambertian[1], share) << there_m;
    }
    if (there_m > 10.0 && there_m < 27.5) {
      EXPECT_LT(std::max(rough[0] / share, share / rough[0]), 1.5) << there_m;
    }
  }
}

}  // namespace
}  // namespace canyon::lidar::ouster
