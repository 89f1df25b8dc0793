#include "canyon/gnss/paths/scatter/scatter.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "canyon/core/units.h"
#include "canyon/gnss/paths/bounce.h"
#include "canyon/gnss/paths/propagation.h"
#include "canyon/gnss/paths/scatter/directive_lobe.h"
#include "canyon/gnss/paths/scatter/facade_tiles.h"
#include "canyon/scene/scene_at.h"
#include "canyon/tests/gnss/paths/wall_scene.h"

namespace canyon::gnss {
namespace {

using testing::direction;
using testing::WallScene;
const double kWavenumber = 2.0 * kPi / kL1WavelengthM;

/// By the midpoint rule over the hemisphere before the wall, of cells equal in azimuth and in elevation.
double integral_by_sum(const DirectiveLobe& lobe, double cos_incidence) {
  const double sine = std::sqrt(1.0 - cos_incidence * cos_incidence);
  const int n = 600;
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    const double theta = (i + 0.5) * 0.5 * kPi / n;
    for (int j = 0; j < n; ++j) {
      const double phi = (j + 0.5) * 2.0 * kPi / n;
      // Mirror's direction (sine, 0, cosine).
      sum += lobe.at(std::sin(theta) * std::cos(phi) * sine + std::cos(theta) * cos_incidence) * std::sin(theta);
    }
  }
  return sum * 0.5 * kPi / n * 2.0 * kPi / n;
}

// Of what falls on a wall, G^2 (1 - S^2) goes on as from a mirror, G^2 S^2 into the lobe and 1 - G^2 into or through
// the wall: all of it. The midpoint rule errs by (pi / 2 / 600)^2 / 24 times the second derivative, at most about the
// exponent: below 1e-6 of the whole.
TEST(Scatter, EnergyIsKept) {
  const auto& materials = scene::builtin_materials();
  for (const char* name : {"concrete", "brick", "glass", "metal"}) {
    const auto material =
        std::find_if(materials.begin(), materials.end(), [&](const scene::Material& m) { return m.name == name; });
    const ScatteredShare own{.scatters = true, .coefficient = std::nullopt};
    for (const int exponent : {1, 2, 3, 4, 8, material->scatter_lobe}) {
      for (const double incidence_rad : {0.0, 0.5, 1.1, 1.5}) {
        const double cosine = std::cos(incidence_rad), share = own.of(*material);
        const DirectiveLobe lobe{exponent};
        const Bounce b =
            bounce_off(*material, {std::sin(incidence_rad), 0.0, -cosine}, Eigen::Vector3d::UnitZ(), 0.0, kL1Hz);
        const CircularField mirror = reflected_field(std::span(&b, 1));
        const double given_back = std::norm(mirror.copolar) + std::norm(mirror.crosspolar);
        const double factor = mirror_factor(Eigen::Vector3d::UnitX(), share);
        const double reflected = factor * factor * given_back;
        const double scattered = share * given_back * integral_by_sum(lobe, cosine) / lobe.integral_sr(cosine);
        EXPECT_NEAR(reflected + scattered + (1.0 - given_back), 1.0, 1e-6) << name << exponent << " " << incidence_rad;
      }
    }
  }
  EXPECT_EQ(ScatteredShare{}.of(materials.front()), 0.0);
  EXPECT_EQ((ScatteredShare{.scatters = true, .coefficient = 0.5}.of(materials.front())), 0.25);
  EXPECT_EQ(mirror_factor(Eigen::Vector3d::UnitZ(), 0.16), 1.0);  // roofs and the ground stay mirrors
}

// At normal incidence the integral is 2 pi (2 - 2^-n) / (n + 1); of a Lambert-like exponent 1 it is pi (1 + cos / 2).
TEST(Scatter, LobesIntegralInClosedForm) {
  for (const int n : {1, 2, 4, 9, 20})
    EXPECT_NEAR(DirectiveLobe{n}.integral_sr(1.0), 2.0 * kPi * (2.0 - std::pow(2.0, -n)) / (n + 1), 1e-12);
  for (const double cosine : {0.0, 0.3, 0.9})
    EXPECT_NEAR(DirectiveLobe{1}.integral_sr(cosine), kPi * (1.0 + 0.5 * cosine), 1e-12);
}

std::vector<SignalPaths> trace(const scene::Scene& scene, const Eigen::Vector3d& p_W,
                               const std::vector<Eigen::Vector3d>& s, const char* paths, bool scatter,
                               const char* keys = "") {
  PropagationConfig config;
  config.paths.name = paths;
  config.scatter.name = scatter ? "directive" : "none";
  const auto node = ConfigNode::parse(keys, "keys");
  CANYON_CHECK(node && read_fields(&*node, "gnss", [&config](FieldVisitor& f) { visit(f, config); }).ok(), keys);
  PathParameters limits;
  limits.weakest_db = limits.weakest_nlos_db = -40.0;
  const auto model = *make_propagation(config, limits);
  std::vector<SignalPaths> out(s.size());
  GnssCounters counters;
  model->trace(p_W, s, scene::SceneAt(scene), out, counters);
  return out;
}

std::complex<double> scattered(const SignalPaths& paths) {
  std::complex<double> sum = 0.0;
  for (const SignalPath& e : paths.echoes)
    if (e.facets[0] == SignalPath::kScattered) sum += e.copolar * std::polar(1.0, -kWavenumber * e.excess_m);
  return sum;
}

/// Both hands; bins add up as fields, of which each tile has its part in two.
double scattered_power(const SignalPaths& paths) {
  std::complex<double> cross = 0.0;
  for (const SignalPath& e : paths.echoes)
    if (e.facets[0] == SignalPath::kScattered) cross += e.crosspolar * std::polar(1.0, -kWavenumber * e.excess_m);
  return std::norm(scattered(paths)) + std::norm(cross);
}

// A long metal wall 12 m to the west, normal incidence in azimuth. Mean power over 1500 places 1 m apart along it
// against the closed form, S^2 times the integral over the wall of cos lobe / (F r^2), within 4 sigma of the mean of 2
// x 1500 exponential values of which those within a lobe's width are alike (12 m: a twelfth counts), and the tiles' own
// grain.
TEST(Scatter, MeanPowerIsTheIntegralOverTheWall) {
  const auto scene = WallScene().wall({-12, -1200, 0}, {0, 2400, 0}, {0, 0, 24}, "metal").build();
  const Eigen::Vector3d s = direction(90, 40.0);
  double mean = 0.0;
  int places = 0;
  for (double y = -750.0; y < 750.0; y += 1.0, ++places)
    mean += scattered_power(
        trace(*scene, {0.0, y, 2.0}, {s}, "visibility", true, "scatter_coefficient = 0.4\nscatter_lobe = 4")[0]);
  mean /= places;
  const DirectiveLobe lobe{4};
  const double cosine = s.x(), step = 0.5;
  double expected = 0.0;
  for (double y = -149.75; y < 150.0; y += step) {
    for (double z = -1.75; z < 22.0; z += step) {
      const Eigen::Vector3d to(-12.0, y, z);
      const double r = to.norm();
      if (r >= 150.0) continue;
      const Eigen::Vector3d mirror(s.x(), -s.y(), -s.z());
      expected += 0.16 * step * step * cosine * lobe.at(mirror.dot(-to / r)) * std::min(5.0 * (1.0 - r / 150.0), 1.0) /
                  (lobe.integral_sr(cosine) * (r * r + 64.0 / (2.0 * kPi)));
    }
  }
  EXPECT_NEAR(mean / expected, 1.0, 4.0 / std::sqrt(3000.0 / 12.0));
}

// The mirror loses what the wall scatters, and nothing changes where it is off.
TEST(Scatter, MirrorIsWeakerByWhatIsScattered) {
  const auto scene = WallScene().wall({-12, -100, 0}, {0, 200, 0}, {0, 0, 24}).build();
  const Eigen::Vector3d s = direction(90, 20.0), p(0.0, 0.0, 2.0);
  const auto off = trace(*scene, p, {s}, "specular1", false)[0], on = trace(*scene, p, {s}, "specular1", true)[0];
  ASSERT_EQ(off.echoes.size(), 1u);
  const auto mirror =
      std::find_if(on.echoes.begin(), on.echoes.end(), [](const SignalPath& e) { return e.reflections == 1; });
  ASSERT_NE(mirror, on.echoes.end());
  EXPECT_NEAR(std::abs(mirror->crosspolar / off.echoes[0].crosspolar), std::sqrt(1.0 - 0.16), 1e-15);
  EXPECT_GT(on.echoes.size(), 1u);
}

// A satellite is hidden behind the wall to the west; another wall sends it on. A centimetre turns the phase of a tile
// by at most 2 x 2 pi 0.01 m / wavelength, and no tile comes or goes by more than its own field: no step between places
// 1 cm apart is larger than that of the turning, times what all tiles together can have, plus one tile.
TEST(Scatter, ACentimetreChangesTheFieldLittle) {
  const auto scene =
      WallScene().wall({-12, -150, 0}, {0, 300, 0}, {0, 0, 24}).wall({12, -150, 0}, {0, 0, 24}, {0, 300, 0}).build();
  const Eigen::Vector3d s = direction(270, 30.0);
  std::complex<double> before = scattered(trace(*scene, {0, -5, 2}, {s}, "visibility", true)[0]);
  double largest = 0.0, size = 0.0;
  int count = 0;
  for (double y = -4.99; y < 5.0; y += 0.01, ++count) {
    const auto paths = trace(*scene, {0, y, 2}, {s}, "visibility", true)[0];
    EXPECT_FALSE(paths.line_of_sight);
    const std::complex<double> now = scattered(paths);
    largest = std::max(largest, std::abs(now - before));
    size += std::norm(now) / 1000.0;
    before = now;
  }
  EXPECT_GT(size, 1e-4);
  const double turn = 2.0 * kWavenumber * 0.01, tile = 0.4 * std::sqrt(64.0 / (2.0 * kPi)) / 22.0;
  EXPECT_LT(largest, turn * 3.0 * std::sqrt(size) + tile);  // a Rayleigh field is beyond 3 RMS once in 8000
}

TEST(Scatter, TilesArePlacesNotRuns) {
  const auto scene = WallScene().box({-40, -20, 0}, {-20, 20, 18}).build();
  const FacadeTiles one(*scene, 8.0), two(*scene, 8.0);
  double area_m2 = 0.0;
  ASSERT_EQ(one.tiles().size(), two.tiles().size());
  for (std::size_t i = 0; i < one.tiles().size(); ++i) {
    area_m2 += one.tiles()[i].area_m2;
    EXPECT_EQ(one.tiles()[i].phase, two.tiles()[i].phase);
    EXPECT_LE(std::abs(one.tiles()[i].normal_W.z()), 0.5);
  }
  EXPECT_NEAR(area_m2, 2.0 * 18.0 * (20.0 + 40.0), 1e-6);  // the four walls, no roof
}

}  // namespace
}  // namespace canyon::gnss
