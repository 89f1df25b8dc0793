// How much of the ground a real OS1-128 sees at grazing incidence, beside a simulated one with the beam of `high`.
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/lidar/ouster/recording.h"
#include "canyon/tests/lidar/grazed_ground.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::lidar::ouster {
namespace {

using lidar::testing::AimedShot;
using lidar::testing::beam_of_high;
using lidar::testing::compare_ground;
using lidar::testing::GroundComparison;
using lidar::testing::GroundRecording;
using lidar::testing::RecordedTurn;

/// In the frame of our beam table: x ahead, the origin on the axis, as high as the beams begin.
RecordedTurn turn_of(const Frame& frame, const Metadata& metadata) {
  const auto pixels = metadata.elevation_deg.size();
  const int columns = metadata.columns_per_frame;
  const Eigen::Vector3d beams_in_sensor(0.0, 0.0, metadata.lidar_to_sensor(2, 3));
  std::vector<Eigen::Vector3d> points;
  std::vector<const Return*> met(pixels * static_cast<std::size_t>(columns), nullptr);
  for (const Return& r : frame.returns) {
    points.push_back(r.p_m - beams_in_sensor);
    met[static_cast<std::size_t>(r.pixel) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(r.column)] =
        &r;
  }
  RecordedTurn out{{}, lidar::testing::ground_under(points)};
  for (int direction = 0; direction < columns; ++direction) {
    const double step_rad = 2.0 * kPi / columns;
    out.columns.push_back({kPi - direction * step_rad, {}});
    for (std::size_t pixel = pixels; pixel-- > 0;) {  // from the lowest up
      // The column that brings this pixel to the direction of the others.
      const int ahead = static_cast<int>(std::lround(metadata.azimuth_deg[pixel] * kDegree / step_rad));
      const int column = (direction - ahead + columns) % columns;
      const double head = kPi - column * step_rad, across = head - metadata.azimuth_deg[pixel] * kDegree;
      const double up = metadata.elevation_deg[pixel] * kDegree;
      AimedShot shot;
      shot.from_L = metadata.origin_out_m * Eigen::Vector3d(std::cos(head), std::sin(head), 0.0);
      shot.along_L = {std::cos(across) * std::cos(up), std::sin(across) * std::cos(up), std::sin(up)};
      if (const Return* r = met[pixel * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)]) {
        shot.returned = true;
        shot.p_L = r->p_m - beams_in_sensor;
        shot.intensity = r->reflectivity;
      }
      out.columns.back().shots.push_back(shot);
    }
  }
  return out;
}

/// Ranges from which bins begin, m.
std::vector<double> bins(double first_m, double last_m) {
  std::vector<double> out;
  for (double from_m = first_m; from_m <= last_m; from_m += lidar::testing::GroundBin::kWidth_m) out.push_back(from_m);
  return out;
}

// 40 m for a Lambertian target of 10 % is what an early data sheet of the OS1, its 128 beams included, says; 45 m is as
// remembered of a later one. 35.4 m is what `high` has, a VLP-16's.
TEST(OusterScans, GroundComesBackFromWhereALambertianOneWouldNot) {
  CANYON_REAL_DATA(capture_path, "lidar/ouster/OS-1-128_v2.3.0_1024x10_lb_n3.pcap");
  CANYON_REAL_DATA(metadata_path, "lidar/ouster/OS-1-128_v2.3.0_1024x10.json");
  const auto metadata = read_metadata(metadata_path);
  ASSERT_TRUE(metadata.ok());
  const auto frames = read_frames(capture_path, *metadata);
  ASSERT_TRUE(frames.ok());
  GroundRecording recording{"os1_128",
                            std::vector<std::size_t>(metadata->elevation_deg.size()),
                            static_cast<std::size_t>(metadata->columns_per_frame),
                            0,
                            {}};
  std::iota(recording.lasers.begin(), recording.lasers.end(), std::size_t{0});
  for (const Frame& frame : *frames) {
    recording.turns.push_back(turn_of(frame, *metadata));
    EXPECT_NEAR(recording.turns.back().ground.below_m, 1.97, 0.05);
  }
  const std::string infrared = "wavelength_nm = 850.0\n";
  const GroundComparison both = compare_ground(recording, {{"high, 40 m", beam_of_high(40.0) + infrared},
                                                           {"lambertian", beam_of_high(40.0, "lambertian") + infrared},
                                                           {"35.4 m", beam_of_high(35.4) + infrared},
                                                           {"45 m", beam_of_high(45.0) + infrared}});
  both.expect_as_much_ground();
  EXPECT_EQ(both.judged_m(), bins(10.0, 42.5));
  // Known misses of the beam of `high`: from 27.5 m on more comes back than of asphalt. With a VLP-16's 35.4 m in place
  // of this sensor's 40 m they begin at 22.5 m, with 45 m at 32.5 m.
  EXPECT_EQ(both.misses_m(0), bins(27.5, 42.5));
  EXPECT_EQ(both.misses_m(2), bins(22.5, 42.5));
  EXPECT_EQ(both.misses_m(3), bins(32.5, 42.5));
  // A Lambertian street is lost from 15 m on.
  EXPECT_EQ(both.misses_m(1), bins(15.0, 42.5));
  // The sensor's reflectivity is of the linear part of its scale: per cent. From 32.5 m on hardly anything of ours
  // comes back.
  EXPECT_EQ(both.intensities_judged_m(0), bins(10.0, 30.0));
  EXPECT_EQ(both.intensity_misses_m(0), std::vector<double>{});
}

}  // namespace
}  // namespace canyon::lidar::ouster
