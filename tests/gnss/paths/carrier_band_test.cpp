#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/gnss/paths/bounce.h"
#include "canyon/gnss/paths/diffraction/knife_edge.h"
#include "canyon/gnss/paths/propagation.h"
#include "canyon/gnss/receiver/link_budget.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/sensor/satellite_source.h"
#include "canyon/gnss/signal.h"
#include "canyon/scene/scene_at.h"
#include "canyon/tests/gnss/sensor/pseudorange_sensor_fixture.h"

// 2026-11-22: Fresnel coefficients, slabs, facet sizes and diffraction were those of L1 for every band.
namespace canyon::gnss {
namespace {

using testing::direction;
using testing::PseudorangeSensorTest;
using testing::WallScene;

struct Band {
  const char* name;
  double hz;
};

std::vector<Band> bands() {
  return {{"L1", carrier_hz(GnssSystem::kGps, 1)},
          {"L2", carrier_hz(GnssSystem::kGps, 2)},
          {"L5", carrier_hz(GnssSystem::kGps, 5)},
          {"G1 of channel -7", carrier_hz(GnssSystem::kGlonass, 1, -7)},
          {"G1 of channel 6", carrier_hz(GnssSystem::kGlonass, 1, 6)},
          {"B1I", carrier_hz(GnssSystem::kBeidou, 2)}};
}

const Eigen::Vector3d kAntenna(0.0, 0.0, 2.0);

/// The ways of one direction at every band at once.
std::vector<SignalPaths> trace(const PathModel& model, const scene::Scene& scene, const Eigen::Vector3d& s) {
  const std::vector<Band> all = bands();
  const std::vector<Eigen::Vector3d> directions_W(all.size(), s);
  std::vector<double> carriers_hz;
  for (const Band& b : all) carriers_hz.push_back(b.hz);
  std::vector<SignalPaths> out(all.size());
  GnssCounters counters;
  model.trace(kAntenna, {directions_W, carriers_hz}, scene::SceneAt(scene), out, counters);
  return out;
}

/// Direct wave and the one echo, as they add up at an antenna that takes both polarizations alike.
std::complex<double> two_rays(const SignalPath& echo, double wavelength_m) {
  return 1.0 + (echo.copolar + echo.crosspolar) * std::polar(1.0, -2.0 * kPi * echo.excess_m / wavelength_m);
}

// A small rough pane of glass, 20 m to the west: slab, roughness and physical optics all depend on the wavelength.
TEST(CarrierBand, TwoRaysOffAPaneHaveTheClosedFormOfTheirBand) {
  // 2 x 2 m around the reflection point of a satellite in the east: (-20, 0, 2 + 20 tan 30).
  const double middle_m = 2.0 + 20.0 * std::tan(30.0 * kDegree);
  const auto scene = WallScene().wall({-20, -1, middle_m - 1.0}, {0, 2, 0}, {0, 0, 2}, "glass").build();
  const scene::Material& glass = scene->materials()[WallScene().material("glass")];
  ASSERT_GT(glass.thickness_m, 0.0);
  PathParameters p;
  p.roughness_m = 0.01;
  const double cosine = std::cos(30.0 * kDegree), excess_m = 40.0 * cosine, distance_m = 20.0 / cosine;
  for (const char* name : {"specular1", "specular2", "launching"}) {
    p.launched_rays = 200000;  // 100 of them meet the pane
    const bool exact = std::string(name) != "launching";
    const auto model = exact ? find_model(path_models(), name)->make({}, p) : make_launching(p);
    const auto paths = trace(*model, *scene, direction(90, 30));
    for (std::size_t i = 0; i < paths.size(); ++i) {
      const Band band = bands()[i];
      const double wavelength_m = kSpeedOfLight / band.hz;
      ASSERT_EQ(paths[i].echoes.size(), 1u) << name << ", " << band.name;
      const SignalPath& echo = paths[i].echoes[0];
      const Fresnel pane = fresnel_slab(glass.permittivity(band.hz), glass.thickness_m, wavelength_m, 30.0 * kDegree);
      const double roughness_m = std::hypot(0.01, glass.roughness_m);
      const double left = roughness_factor(roughness_m, cosine, wavelength_m) *
                          std::min(1.0, 4.0 * cosine / (wavelength_m * distance_m));
      if (!exact) {
        // The best ray misses the satellite by up to half their spacing, 4 mrad: 0.1 m of the 23 m that the factor of
        // a small pane goes with, 0.5 %.
        EXPECT_NEAR(std::abs(echo.crosspolar - left * pane.cross), 0.0, 5e-3 * std::abs(left * pane.cross))
            << name << ", " << band.name;
        continue;
      }
      EXPECT_NEAR(echo.excess_m, excess_m, 1e-9);
      const std::complex<double> expected =
          1.0 + left * (pane.co + pane.cross) * std::polar(1.0, -2.0 * kPi * excess_m / wavelength_m);
      // Corners in single precision (2e-6 m at 20 m): 1e-4 rad of phase at most, of an echo below 1.
      EXPECT_NEAR(std::abs(two_rays(echo, wavelength_m) - expected), 0.0, 1e-4) << name << ", " << band.name;
    }
  }
}

// Off level ground: the same, and the plane is fitted over each band's own Fresnel zone.
TEST(CarrierBand, TwoRaysOffTheGroundHaveTheClosedFormOfTheirBand) {
  scene::SceneParts parts;
  parts.frame = LocalFrame(Geodetic{testing::kVicksburgLat, testing::kVicksburgLon, 60.0});
  parts.materials = scene::builtin_materials();
  parts.objects.push_back({"ground", scene::ObjectKind::kTerrain});
  std::uint16_t grass = 0;
  while (parts.materials[grass].name != "grass") ++grass;
  for (const auto& [x, y] : {std::pair{-200.0F, -200.0F}, {200.0F, -200.0F}, {200.0F, 200.0F}, {-200.0F, 200.0F}})
    parts.mesh.vertices.emplace_back(x, y, 0.0F);
  parts.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  parts.mesh.material = {grass, grass};
  parts.mesh.object = {0, 0};
  const scene::Scene scene(parts);
  const scene::Material& material = parts.materials[grass];
  const auto model =
      make_propagation(make_visibility({}), find_model(diffraction_models(), "none")->make({}, {}), true, {});
  const double elevation_rad = 20.0 * kDegree, cosine = std::sin(elevation_rad), excess_m = 4.0 * cosine;
  const auto paths = trace(*model, scene, direction(130, 20));
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const Band band = bands()[i];
    const double wavelength_m = kSpeedOfLight / band.hz;
    ASSERT_EQ(paths[i].echoes.size(), 1u) << band.name;
    const Fresnel f = fresnel(material.permittivity(band.hz), std::acos(cosine));
    const double rough = roughness_factor(material.roughness_m, cosine, wavelength_m);
    const std::complex<double> expected =
        1.0 + rough * (f.co + f.cross) * std::polar(1.0, -2.0 * kPi * excess_m / wavelength_m);
    // The way is found to 1e-6 m (GroundReflection.LevelGroundHasTheClosedForm): 4e-5 rad.
    EXPECT_NEAR(std::abs(two_rays(paths[i].echoes[0], wavelength_m) - expected), 0.0, 5e-5) << band.name;
  }
}

// Bent over a roof, and beside it: the field has ITU-R P.526's size and phase at each band. The phase is the test of
// the echo's convention: what is taken off it when it is stored must be what the receiver puts back.
TEST(CarrierBand, AnEdgeBendsEachBandByItsOwnWavelength) {
  const auto scene = WallScene().box({-30, -500, 0}, {-20, 500, 22}).build();
  const auto model = [](const char* name) {
    return make_propagation(make_visibility({}), find_model(diffraction_models(), name)->make({}, {}), false, {});
  };
  // The roof's edge stands 20 m above the antenna at 20 m: 45 deg.
  const auto detour_m = [](double elevation_deg) {
    return std::sqrt(800.0) * (1.0 - std::cos((45.0 - elevation_deg) * kDegree));
  };
  for (const double elevation_deg : {43.0, 44.0, 44.6}) {
    const auto paths = trace(*model("knife_edge"), *scene, direction(270, elevation_deg));
    for (std::size_t i = 0; i < paths.size(); ++i) {
      const double wavelength_m = kSpeedOfLight / bands()[i].hz;
      ASSERT_EQ(paths[i].echoes.size(), 1u) << bands()[i].name << " at " << elevation_deg;
      const SignalPath& echo = paths[i].echoes[0];
      const auto arrived = echo.copolar * std::polar(1.0, -2.0 * kPi * echo.excess_m / wavelength_m);
      const auto expected = knife_edge_field(knife_edge_nu(detour_m(elevation_deg), wavelength_m));
      // Corners in single precision, 2e-6 m at 28 m: 2e-5 rad of the field's argument.
      EXPECT_NEAR(std::abs(arrived - expected), 0.0, 2e-5) << bands()[i].name << " at " << elevation_deg;
    }
  }
  for (const double elevation_deg : {45.2, 45.6}) {
    const auto paths = trace(*model("knife_edge"), *scene, direction(270, elevation_deg));
    for (std::size_t i = 0; i < paths.size(); ++i) {
      const double wavelength_m = kSpeedOfLight / bands()[i].hz;
      const auto expected = knife_edge_field(-knife_edge_nu(detour_m(elevation_deg), wavelength_m));
      EXPECT_NEAR(std::abs(paths[i].direct - expected), 0.0, 2e-5) << bands()[i].name << " at " << elevation_deg;
      EXPECT_GT(std::abs(paths[i].direct - 1.0), 1e-3);
    }
  }
}

// What only one band can follow is found for that band alone, wherever the others stand in the list: deep in a shadow
// the field falls as the root of the wavelength.
TEST(CarrierBand, EachBandHasItsOwnLimit) {
  const auto scene = WallScene().box({-30, -500, 0}, {-20, 500, 22}).build();
  PathParameters p;
  p.weakest_nlos_db = -20.0;
  const auto model =
      make_propagation(make_visibility(p), find_model(diffraction_models(), "knife_edge")->make({}, p), false, p);
  int some = 0;
  for (double elevation_deg = 35.0; elevation_deg < 40.0; elevation_deg += 0.05) {
    const auto paths = trace(*model, *scene, direction(270, elevation_deg));
    int found = 0;
    for (std::size_t i = 0; i < paths.size(); ++i) {
      const double wavelength_m = kSpeedOfLight / bands()[i].hz;
      const double detour_m = std::sqrt(800.0) * (1.0 - std::cos((45.0 - elevation_deg) * kDegree));
      const double field = std::abs(knife_edge_field(knife_edge_nu(detour_m, wavelength_m)));
      if (std::abs(field - 0.1) < 1e-4) continue;  // on the limit, to the rounding of the corners
      EXPECT_EQ(paths[i].echoes.size(), field > 0.1 ? 1u : 0u) << bands()[i].name << " at " << elevation_deg;
      found += static_cast<int>(paths[i].echoes.size());
    }
    some += found > 0 && found < static_cast<int>(paths.size()) ? 1 : 0;
  }
  EXPECT_GT(some, 5);
}

// Through the receiver: both signals of satellites behind a roof come as strong as their own wavelength bends them.
TEST_F(PseudorangeSensorTest, BothBandsAreAsStrongAsTheirOwnWavelengthBendsThem) {
  scene = WallScene().box({-60, -3000, 0}, {-12, 3000, 60}, "absorber").build();
  GnssConfig c = testing::errors_off();
  c.mode.name = "dual";
  c.satellites.systems = "GREC";
  c.propagation.paths.name = "visibility";
  c.propagation.diffraction.name = "knife_edge";
  c.reception.multipath_rule.name = "correlator";
  c.locks.tracking_threshold_dbhz = 25.0;
  const auto sensor = make(c);
  auto source = make_satellite_source(c.satellites, testing::kStart, testing::kStart + 480.0);
  ASSERT_TRUE(source.ok());
  const auto model =
      make_propagation(make_visibility({}), find_model(diffraction_models(), "knife_edge")->make({}, {}), false, {});
  const LocalFrame& frame = scene->frame();
  int compared = 0;
  std::set<GnssSystem> systems;
  for (int k = 0; k < 400; ++k) {
    const GpsTime t = testing::kStart + 60.0 * k;
    const auto output = sensor->measure(1000 * k, t, antenna_W, still, scene::SceneAt(*scene));
    for (const GnssObservation& o : output.epoch.observations) {
      const auto signal = transmission_to(*source->constellation, o.sv, t, truth_E());
      ASSERT_TRUE(signal);
      const Eigen::Vector3d s = frame.R_EW().transpose() * (signal->p_E() - truth_E()).normalized();
      std::vector<SignalPaths> paths(1);
      GnssCounters counters;
      model->trace(antenna_W, std::vector{s}, scene::SceneAt(*scene), paths, counters);
      if (paths[0].line_of_sight || paths[0].echoes.size() != 1) continue;
      const auto expected = [&](int band) {
        const double wavelength_m = kSpeedOfLight / carrier_hz(o.sv.system, band, signal->state.frequency_channel);
        SignalPath echo = paths[0].echoes[0];
        echo.copolar = knife_edge_field(knife_edge_nu(echo.excess_m, wavelength_m));
        return receive(echo, LinkBudget{}, Eigen::Vector3d::UnitZ(), s).cn0_dbhz;
      };
      // The antenna's up is that of the ellipsoid, the scene's a plane: the same at its origin.
      EXPECT_NEAR(o.cn0_dbhz, expected(o.band), 1e-6) << o.sv.str();
      if (o.second.band != 0) {
        EXPECT_NEAR(o.second.cn0_dbhz, expected(o.second.band), 1e-6) << o.sv.str();
        EXPECT_GT(o.second.cn0_dbhz, o.cn0_dbhz) << "the longer wave bends more";
        ++compared;
        systems.insert(o.sv.system);
      }
    }
  }
  EXPECT_GT(compared, 20);
  EXPECT_EQ(systems.size(), 4u);
}

// The ionosphere delays each first signal by its own carrier's square: B1I's 1.8 % more than L1's, G1's 3 % less.
TEST_F(PseudorangeSensorTest, FirstBandsHaveTheirOwnIonosphere) {
  GnssConfig c = testing::open_sky("single_uncorrected");
  c.satellites.systems = "GRC";
  const auto sensor = make(c);
  const auto source = make_satellite_source(c.satellites, testing::kStart, testing::kStart + 480.0);
  ASSERT_TRUE(source.ok());
  const auto ionosphere = c.ionosphere.make("gnss.ionosphere", IonosphereSetup{});
  ASSERT_TRUE(ionosphere.ok());
  const auto output = measure(*sensor, 0);
  const Horizon horizon(truth_E());
  std::set<GnssSystem> systems;
  for (const GnssObservationTruth& s : output.truth.satellites) {
    if (!s.tracked) continue;
    const auto signal = transmission_to(*source->constellation, s.sv, testing::kStart, truth_E());
    const double hz = carrier_hz(s.sv.system, first_band(s.sv.system), signal->state.frequency_channel);
    const double at_l1_m = (*ionosphere)->delay_m(horizon.view(testing::kStart, signal->p_E()));
    EXPECT_NEAR(s.ionosphere_delay_m, at_l1_m * std::pow(kL1Hz / hz, 2), 1e-9) << s.sv.str();
    if (s.sv.system == GnssSystem::kGps) {
      EXPECT_EQ(s.ionosphere_delay_m, at_l1_m);
    }
    systems.insert(s.sv.system);
  }
  EXPECT_EQ(systems.size(), 3u);
}

}  // namespace
}  // namespace canyon::gnss
