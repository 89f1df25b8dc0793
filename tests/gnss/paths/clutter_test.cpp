#include "canyon/gnss/paths/clutter/clutter.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/process/parallel.h"
#include "canyon/core/units.h"
#include "canyon/gnss/paths/clutter/clutter_scatterers.h"
#include "canyon/gnss/paths/clutter/lattice_noise.h"
#include "canyon/gnss/paths/clutter/street_shading.h"
#include "canyon/gnss/paths/propagation.h"
#include "canyon/scene/scene_at.h"
#include "canyon/tests/gnss/paths/normal_law.h"
#include "canyon/tests/gnss/paths/wall_scene.h"
#include "canyon/tests/gnss/sensor/gnss_keys.h"

namespace canyon::gnss {
namespace {

using testing::below;
using testing::direction;
using testing::four_sigma;
using testing::share_below;
using testing::WallScene;

// The variance is 1 wherever a place is within its cell; places 3 cells apart are independent. Mean square of 40,000
// within 4 sqrt(2 / n).
TEST(LatticeNoise, IsStandardNormalEverywhere) {
  const LatticeNoise noise(3, "test.lattice");
  constexpr int kPlaces = 40000;
  for (const double f : {0.0, 0.2, 0.5, 0.93}) {
    double sum = 0.0, sum2 = 0.0, beyond = 0.0;
    for (int i = 0; i < kPlaces; ++i) {
      const double v = noise.at<3>({3.0 * (i % 200) + f, 3.0 * (i / 200) + f, 0.4 * f - 7.0}, 1);
      sum += v;
      sum2 += v * v;
      beyond += v > 1.0 ? 1.0 : 0.0;
    }
    EXPECT_NEAR(sum / kPlaces, 0.0, 4.0 / std::sqrt(kPlaces)) << f;
    EXPECT_NEAR(sum2 / kPlaces, 1.0, 4.0 * std::sqrt(2.0 / kPlaces)) << f;
    EXPECT_NEAR(beyond / kPlaces, below(-1.0), four_sigma(below(-1.0), kPlaces)) << f;
  }
}

// cos and sin of pi/2 (3 f^2 - 2 f^3) turn by at most 3 pi / 4 a cell: in 4 coordinates, 16 corners of at most 5.
TEST(LatticeNoise, TurnsEvenly) {
  const LatticeNoise noise(3, "test.lattice");
  double before = noise.at<2>({0.0, 0.37}, 0);
  for (int i = 1; i < 20000; ++i) {
    const double now = noise.at<2>({1e-3 * i, 0.37}, 0);
    EXPECT_LT(std::abs(now - before), 1e-3 * 0.75 * kPi * 4.0 * 5.0);
    before = now;
  }
}

// Share of the bad state: mean durations of lognormals without those below the shortest, here by the midpoint rule.
TEST(TwoStateLaw, ShareOfTheBadState) {
  const TwoStateLaw law("suburban", 1.0);
  ASSERT_EQ(law.table().size(), 5u);
  const auto mean = [](double mu, double sigma, double least) {
    double weight = 0.0, sum = 0.0;
    const double step = 1e-4;
    for (double z = (std::log(least) - mu) / sigma + 0.5 * step; z < 12.0; z += step) {
      const double density = std::exp(-0.5 * z * z);
      weight += density;
      sum += density * std::exp(mu + sigma * z);
    }
    return sum / weight;
  };
  const double good = mean(3.0138, 1.4161, 8.3214), bad = mean(2.4521, 0.7637, 5.9087);
  EXPECT_NEAR(law.table()[1].shaded_share, bad / (good + bad), 1e-4);  // the rule's beginning is within a step
  EXPECT_NEAR(TwoStateLaw("suburban", 0.5).table()[1].shaded_share, 0.5 * law.table()[1].shaded_share, 1e-15);
}

/// Clutter as the keys say, and nothing weak left out.
std::unique_ptr<PathModel> model_of(const std::string& keys, std::uint64_t seed = 1, double weakest_db = -80.0) {
  GnssConfig config;
  testing::set_keys(config, "paths = \"visibility\"\nclutter = \"street\"\n" + keys);
  PathParameters limits;
  limits.weakest_db = limits.weakest_nlos_db = weakest_db;
  limits.seed = seed;
  return *make_propagation(config.propagation, limits);
}

SignalPaths trace(const PathModel& model, const scene::Scene& scene, const Eigen::Vector3d& p_W,
                  const Eigen::Vector3d& s_W, double t_s = 0.0, double carrier_hz = kL1Hz) {
  std::vector<SignalPaths> out(1);
  GnssCounters counters;
  const std::vector directions{s_W};
  const std::vector carriers{carrier_hz};
  model.trace(p_W, PlaneWaves(directions, carriers).at(GpsTime{} + t_s), scene::SceneAt(scene), out, counters);
  return out[0];
}

/// Sum of the scatterers at the carrier.
std::complex<double> scattered(const SignalPaths& paths, bool cross = false, double carrier_hz = kL1Hz) {
  std::complex<double> sum = 0.0;
  for (const SignalPath& e : paths.echoes)
    if (e.facets[0] == SignalPath::kClutter)
      sum += (cross ? e.crosspolar : e.copolar) * std::polar(1.0, -2.0 * kPi * e.excess_m * carrier_hz / kSpeedOfLight);
  return sum;
}

/// A wall so far away that it hides nothing.
std::unique_ptr<scene::Scene> open_place() {
  return WallScene().wall({-9e4, -5, 0}, {0, 10, 0}, {0, 0, 3}).build();
}

// At rest an echo of many has the power of its field, on the move that of its parts; between, as the loop's first-order
// response says: at f = f0 half of each. Of one scatterer both are the same.
TEST(StreetClutter, MovingAveragesOverFading) {
  const auto scene = open_place();
  const auto model = model_of("clutter_moving_share = 0.0");
  const Eigen::Vector3d s = direction(100.0, 30.0);
  const SignalPaths paths = trace(*model, *scene, {3.0, 4.0, 1.5}, s);
  ASSERT_GT(paths.echoes.size(), 2u);
  LinkBudget link;
  for (const SignalPath& e : paths.echoes) {
    ASSERT_GT(e.spread, 0.0);
    const auto power = [&](double v_m_s) {
      return std::pow(10.0, 0.1 * receive(e, link, Eigen::Vector3d::UnitZ(), s, {v_m_s, 0.0, 0.0}).cn0_dbhz);
    };
    const double f0_m_s = 0.5 / kPi * kL1WavelengthM / e.spread;
    EXPECT_NEAR(power(f0_m_s) / (0.5 * (power(0.0) + power(1e9))), 1.0, 1e-9);
  }
}

// Without obstacles the sum of scatterers is complex normal with the table's multipath as its power, half to each hand:
// places farther apart than twice the reach are independent. With a direct signal of 1 the amplitude is Rician of
// K = 2 / power: its distribution by the midpoint rule over I0, at 2000 places, shares within 4 sigma; the fading-in of
// weak bins is below 1e-3 of the field.
TEST(StreetClutter, FadingIsRician) {
  const auto scene = open_place();
  for (const char* moving : {"clutter_moving_share = 0.0", "clutter_moving_share = 0.5"}) {
    const auto model = model_of(std::string("clutter_reach_m = 40.0\nclutter_shaded_scale = 0.0\n") + moving);
    const Eigen::Vector3d s = direction(100.0, 30.0);
    const double power = TwoStateLaw("suburban", 1.0).multipath_power(false, 30.0 * kDegree);
    std::vector<double> amplitudes;
    double co = 0.0, cross = 0.0;
    constexpr int kPlaces = 2000;
    for (int i = 0; i < kPlaces; ++i) {
      const SignalPaths paths = trace(*model, *scene, {90.0 * (i % 50), 90.0 * (i / 50), 1.5}, s, 50.0 * i);
      amplitudes.push_back(std::abs(1.0 + scattered(paths)));
      co += std::norm(scattered(paths)) / kPlaces;
      cross += std::norm(scattered(paths, true)) / kPlaces;
    }
    EXPECT_NEAR(co / (0.5 * power), 1.0, 4.0 / std::sqrt(kPlaces)) << moving;
    EXPECT_NEAR(cross / (0.5 * power), 1.0, 4.0 / std::sqrt(kPlaces)) << moving;
    const double sigma2 = 0.25 * power;  // of each quadrature
    for (const double x : {0.8, 0.9, 1.0, 1.1, 1.2}) {
      double expected = 0.0;
      const double step = 1e-4;
      for (double a = 0.5 * step; a < x; a += step) {
        const double b = a / sigma2;  // I0(b) exp(-b) by Abramowitz & Stegun 9.7.1, b > 10 where it counts
        const double scaled = (1.0 + 1.0 / (8.0 * b) + 9.0 / (128.0 * b * b)) / std::sqrt(2.0 * kPi * b);
        if (b > 2.0) expected += step * a / sigma2 * std::exp(-0.5 * (a - 1.0) * (a - 1.0) / sigma2) * scaled;
      }
      EXPECT_NEAR(share_below(amplitudes, x), expected, four_sigma(expected, kPlaces)) << moving << " " << x;
    }
  }
}

// A centimetre turns a scatterer's phase by at most 2 x 2 pi 0.01 m / wavelength and changes what is seen of it by a
// hundredth of a lattice of 2 m (in three coordinates); beside a house, so that some come and go. The square of the
// sum's step is on average that of independent phasors; six times its root is never passed (4e-16 a step).
TEST(StreetClutter, ACentimetreChangesTheFieldLittle) {
  const auto scene = WallScene().box({4, -30, 0}, {20, 0, 20}).box({-20, 5, 0}, {-5, 40, 15}).build();
  const auto model = model_of("clutter_moving_share = 0.0");
  const Eigen::Vector3d s = direction(200.0, 35.0);
  const double power = TwoStateLaw("suburban", 1.0).multipath_power(false, 35.0 * kDegree);
  const double turn = 2.0 * 2.0 * kPi * 0.01 / kL1WavelengthM, comes = 3.0 * 0.01 / 2.0;
  SignalPaths before = trace(*model, *scene, {0.0, -20.0, 1.8}, s);
  double largest = 0.0;
  for (int i = 1; i <= 1500; ++i) {
    const SignalPaths now = trace(*model, *scene, {0.0, -20.0 + 0.01 * i, 1.8}, s);
    const double step = std::abs(scattered(now) - scattered(before));
    largest = std::max(largest, step);
    EXPECT_LT(step, 6.0 * std::sqrt(0.5 * power) * (turn + comes)) << i;
    // Shading: at most 3 pi / 4 per cell of 2 m, 16 corners of at most 5, some dB a unit of the field.
    EXPECT_LT(std::abs(std::abs(now.direct) - std::abs(before.direct)), 0.02) << i;
    before = now;
  }
  EXPECT_GT(largest, 0.01 * std::sqrt(0.5 * power) * turn);  // it does change
}

// The static part is the street's, on every pass and for every seed; the moving part is the seed's and the time's. A
// hundredth of the coherence time changes it by its own size at most 3 pi / 4 / 100.
TEST(StreetClutter, TheSameStreetIsTheSameOnEveryPass) {
  const auto scene = open_place();
  const Eigen::Vector3d p(3.0, 4.0, 1.5), s = direction(40.0, 40.0);
  const auto still1 = model_of("clutter_moving_share = 0.0", 1), still2 = model_of("clutter_moving_share = 0.0", 2);
  EXPECT_EQ(scattered(trace(*still1, *scene, p, s)), scattered(trace(*still2, *scene, p, s, 777.0)));
  EXPECT_EQ(trace(*still1, *scene, p, s).direct, trace(*still2, *scene, p, s, 777.0).direct);
  EXPECT_NE(scattered(trace(*model_of("clutter_moving_share = 0.0\nclutter_street = 1"), *scene, p, s)),
            scattered(trace(*still1, *scene, p, s)));
  const auto moves1 = model_of("", 1), moves2 = model_of("", 2);
  const auto at = scattered(trace(*moves1, *scene, p, s, 60.0));
  EXPECT_EQ(scattered(trace(*moves1, *scene, p, s, 60.0)), at);
  EXPECT_NE(scattered(trace(*moves2, *scene, p, s, 60.0)), at);
  EXPECT_GT(std::abs(scattered(trace(*moves1, *scene, p, s, 66.0)) - at), 0.05 * std::abs(at));
  const double power = TwoStateLaw("suburban", 1.0).multipath_power(false, 40.0 * kDegree);
  EXPECT_LT(std::abs(scattered(trace(*moves1, *scene, p, s, 60.02)) - at),
            6.0 * std::sqrt(0.5 * 0.2 * power) * 0.75 * kPi / 100.0);
}

// A few places at once in any number of threads give the same bits as one after the other.
TEST(StreetClutter, ThreadsDoNotMatter) {
  const auto scene = WallScene().box({4, -30, 0}, {20, 0, 20}).build();
  const auto place = [](std::size_t i) { return Eigen::Vector3d(-0.7 * static_cast<double>(i), 1.0, 1.8); };
  std::vector<std::complex<double>> expected(40);
  const auto one = model_of("");
  for (std::size_t i = 0; i < expected.size(); ++i)
    expected[i] = scattered(trace(*one, *scene, place(i), direction(40.0, 40.0), 5.0));
  for (const int threads : {1, 2, 8}) {
    set_threads(threads);
    const auto model = model_of("");
    std::vector<std::complex<double>> found(expected.size());
    parallel_for(found.size(), 3, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        found[i] = scattered(trace(*model, *scene, place(i), direction(40.0, 40.0), 5.0));
    });
    EXPECT_EQ(found, expected) << threads;
  }
  set_threads(0);
}

// Behind a wall of 200 m all scatterers in sight within 30 m are in its shadow, and across from them stands another
// wall: their mean power, over 1000 places along the walls farther apart than twice the reach, is that of the table's
// bad state; from the other side, lit, that of the good one. Their light comes off the wall across: 15 to 75 m behind
// them, 21 to 106 m late, and bins are 15 m wide. Without the wall across they are dark. 2026-11-25: between the nodes
// of the lattice of directions, as at 187 degrees, up to three quarters of the power were lost.
TEST(StreetClutter, UnlitScatterersHaveTheBadStatesMultipath) {
  const auto scene = WallScene().box({-300, -30, 0}, {70000, -10, 200}).box({-300, 85, 0}, {70000, 95, 6}).build();
  const auto model = model_of("clutter_reach_m = 30.0\nclutter_moving_share = 0.0");
  const TwoStateLaw law("suburban", 1.0);
  constexpr int kPlaces = 1000;
  const double bound = 4.0 / std::sqrt(kPlaces);
  double lit = 0.0;
  for (const double azimuth_deg : {180.0, 187.0}) {
    double unlit = 0.0;
    for (int i = 0; i < kPlaces; ++i) {
      const Eigen::Vector3d p(65.0 * i, 40.0, 1.5);
      const SignalPaths hidden = trace(*model, *scene, p, direction(azimuth_deg, 45.0));
      EXPECT_FALSE(hidden.line_of_sight);
      for (const SignalPath& e : hidden.echoes) EXPECT_GE(e.excess_m, 15.0);
      unlit += std::norm(scattered(hidden)) / kPlaces;
      if (azimuth_deg == 180.0) lit += std::norm(scattered(trace(*model, *scene, p, direction(0.0, 45.0)))) / kPlaces;
    }
    EXPECT_NEAR(unlit / (0.5 * law.multipath_power(true, 45.0 * kDegree)), 1.0, bound) << azimuth_deg;
  }
  EXPECT_NEAR(lit / (0.5 * law.multipath_power(false, 45.0 * kDegree)), 1.0, bound);
  const auto one_wall = WallScene().box({-300, -30, 0}, {300, -10, 200}).build();
  EXPECT_EQ(trace(*model, *one_wall, {0, 40, 1.5}, direction(180.0, 45.0)).echoes.size(), 0u);
}

// What the scene finds is shaded by where it comes from, as the straight way is by where the satellite stands.
TEST(StreetClutter, EchoesAreShadedByTheirArrival) {
  const auto scene = WallScene().wall({-12, -100, 0}, {0, 200, 0}, {0, 0, 24}).build();
  GnssConfig config;
  testing::set_keys(config, "paths = \"specular1\"");
  const Eigen::Vector3d p(0, 0, 1.5), s = direction(90, 20.0);
  const auto bare = trace(**make_propagation(config.propagation, {}), *scene, p, s);
  testing::set_keys(config, "clutter = \"street\"\nclutter_echo_db = -40.0\nclutter_moving_share = 0.0");
  const auto street = trace(**make_propagation(config.propagation, {}), *scene, p, s);
  ASSERT_EQ(bare.echoes.size(), 1u);
  ASSERT_EQ(street.echoes.size(), 1u);
  const StreetShading shading(TwoStateLaw("suburban", 1.0), {.moving_share = 0.0}, 0, 0);
  const double direct_db = shading.level_db(p, s, {}), echo_db = shading.level_db(p, bare.echoes[0].arrival_W, {});
  EXPECT_NE(direct_db, echo_db);
  EXPECT_NEAR(std::abs(street.direct), std::pow(10.0, direct_db / 20.0), 1e-14);
  EXPECT_NEAR(std::abs(street.echoes[0].crosspolar / bare.echoes[0].crosspolar), std::pow(10.0, echo_db / 20.0), 1e-14);
}

// The scatterers are one street for all bands, each with the phase of its way at its own carrier: with one of them in
// reach, what it sends turns from band to band by its excess.
TEST(StreetClutter, BandsDifferByTheirPhase) {
  const auto scene = open_place();
  const auto model = model_of("clutter_cell_m = 50.0\nclutter_reach_m = 20.0\nclutter_moving_share = 0.0");
  const Eigen::Vector3d s = direction(10.0, 50.0);
  // A place with exactly one scatterer within reach: one bin pair.
  ClutterScatterers street(50.0, 0);
  Eigen::Vector3d p(0, 0, 1.5);
  std::vector<ClutterScatterer> near;
  do {
    p.x() += 5.0;
    street.near(*scene, p, 20.0, near);
  } while (near.size() != 1);
  const Eigen::Vector3d way = near[0].p_W - p;
  const double excess_m = way.norm() - way.dot(s);
  for (const double hz : {kL1Hz, 1227.6e6, 1176.45e6, 1602.0e6, 1561.098e6}) {
    const auto field = scattered(trace(*model, *scene, p, s, 0.0, hz), false, hz);
    const auto at_l1 = scattered(trace(*model, *scene, p, s));
    // The constant on both sides: amplitude and phase of the scatterer.
    const std::complex<double> expected = std::polar(1.0, -2.0 * kPi * excess_m * (hz - kL1Hz) / kSpeedOfLight);
    EXPECT_LT(std::abs(field / at_l1 - expected), 1e-9) << hz;
  }
}

}  // namespace
}  // namespace canyon::gnss
