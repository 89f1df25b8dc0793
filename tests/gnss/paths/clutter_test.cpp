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
#include "canyon/tests/gnss/paths/wall_scene.h"
#include "canyon/tests/gnss/sensor/gnss_keys.h"

namespace canyon::gnss {
namespace {

using testing::direction;
using testing::WallScene;

double below(double z) {
  return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

/// Share of values below x, and how far it may be off: 4 sigma of n independent ones (6e-5 a comparison).
double share_below(const std::vector<double>& values, double x) {
  return static_cast<double>(std::count_if(values.begin(), values.end(), [&](double v) { return v < x; })) /
         static_cast<double>(values.size());
}
double four_sigma(double p, std::size_t n) {
  return 4.0 * std::sqrt(p * (1.0 - p) / static_cast<double>(n));
}

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

// Levels over 20,000 streets far apart against the law: a normal mixture in dB, at each elevation of each table, static
// and with a share that moves. Mean levels only: the spread about them is set to nothing by reading the field itself.
TEST(StreetShading, MeanLevelsAreTheTwoStates) {
  constexpr std::size_t kStreets = 20000;
  for (const std::string& environment : TwoStateLaw::environments()) {
    const TwoStateLaw law(environment, 1.0);
    const LatticeNoise noise(5, "test.streets");
    for (const auto& e : law.table()) {
      std::vector<double> levels_db;
      for (std::size_t i = 0; i < kStreets; ++i)
        levels_db.push_back(law.mean_level_db(noise.at<2>({3.3 * static_cast<double>(i), 0.6}, 0), e.elevation_rad));
      for (const double x_db : {-25.0, -18.0, -14.0, -10.0, -6.0, -3.0, -1.5, 0.0}) {
        const double expected = (1.0 - e.shaded_share) * below((x_db - e.good.ma_db) / e.good.ma_sigma_db) +
                                e.shaded_share * below((x_db - e.bad.ma_db) / e.bad.ma_sigma_db);
        EXPECT_NEAR(share_below(levels_db, x_db), expected, four_sigma(expected, kStreets) + 2e-4)
            << environment << " " << e.elevation_rad / kDegree << " " << x_db;
      }
    }
  }
}

/// Levels at places 50 m apart and directions of one elevation; from place to place `step_s` later.
std::vector<double> street_levels(const StreetShading& shading, double elevation_deg, double t_s, double step_s = 0.0) {
  std::vector<double> out;
  for (int x = 0; x < 100; ++x)
    for (int y = 0; y < 100; ++y)
      out.push_back(shading.level_db({50.0 * x + 3.0, 50.0 * y + 8.0, 2.0},
                                     direction(17.0 * ((x * 100 + y) % 21), elevation_deg),
                                     GpsTime{} + (t_s + step_s * (x * 100 + y))));
  return out;
}

// The whole level: mean level's mixture with the spread about it, against 400,000 draws of the law by another way (a
// state first, then its normals). Between states the spread is that of the state whose mean is nearer, so shares may be
// off by what lies between: 1 %.
TEST(StreetShading, LevelsAreTheLawsOwn) {
  const TwoStateLaw law("suburban", 1.0);
  const auto& e = law.table()[1];
  const RandomStream draws(11, "test.law");
  std::vector<double> expected_db;
  for (std::uint64_t i = 0; i < 400000; ++i) {
    const SignalState& state = draws.uniform(0, i) < e.shaded_share ? e.bad : e.good;
    const double ma_db = state.ma_db + state.ma_sigma_db * draws.normal(1, i);
    expected_db.push_back(ma_db + std::max(state.g1 * ma_db + state.g2_db, 0.0) * draws.normal(2, i));
  }
  for (const double moving : {0.0, 0.2}) {
    const StreetShading shading(law, {.moving_share = moving}, 0, 1);
    const auto levels_db = street_levels(shading, 30.0, 100.0, 10.0);
    for (const double x_db : {-16.0, -12.0, -8.0, -4.0, -2.0, 0.0, 1.0}) {
      const double p = share_below(expected_db, x_db);
      EXPECT_NEAR(share_below(levels_db, x_db), p, 0.01 + 1.5 * four_sigma(p, levels_db.size())) << x_db << moving;
    }
  }
}

/// The standard normal number at which the two states meet, by halving.
double state_border(const TwoStateLaw::Elevation& e) {
  double low = -5.0, high = 5.0;
  for (int k = 0; k < 60; ++k) (below(0.5 * (low + high)) < e.shaded_share ? low : high) = 0.5 * (low + high);
  return low;
}

/// How often the state changes along straight lines far apart, changes a metre: their mean and its standard error.
struct StateChanges {
  double mean_per_m, error_per_m;
};
/// Lines lead `heading_deg` from north, satellites stand all around. The level about the mean is that of one cell as
/// large as all streets: it shifts the level at which the states meet, and no more.
StateChanges state_changes(const TwoStateLaw& law, const TwoStateLaw::Elevation& e, double heading_deg,
                           double moving_share, double speed_m_s) {
  constexpr int kLines = 120, kSteps = 2800;  // of 1 m, a fourteenth of a cell: steps of half of it find as many
  constexpr double kWorld = 1e12;
  const StreetShading shading(law, {.spread_m = kWorld, .spread_rad = kWorld, .moving_share = moving_share}, 0, 1);
  const double spread = LatticeNoise(0, "gnss.clutter.shade").at<4>({0.0, 0.0, 0.0, 0.0}, 1);
  const double meet_db = law.mean_level_db(state_border(e), e.elevation_rad);
  const double limit_db = meet_db + spread * law.spread_db(meet_db, e.elevation_rad);
  const Eigen::Vector3d along = direction(heading_deg, 0.0);
  double sum = 0.0, sum2 = 0.0;
  for (int line = 0; line < kLines; ++line) {
    const Eigen::Vector3d from(1e4 * line + 3.0, 8.0, 2.0), s = direction(17.0 * line, e.elevation_rad / kDegree);
    const auto shaded = [&](int step) {
      return shading.level_db(from + step * along, s, GpsTime{} + (1000.0 * line + step / speed_m_s)) < limit_db;
    };
    bool before = shaded(0);
    double changes = 0.0;
    for (int i = 1; i <= kSteps; ++i) {
      const bool now = shaded(i);
      changes += now != before ? 1.0 : 0.0;
      before = now;
    }
    sum += changes / kLines;
    sum2 += changes * changes / kLines;
  }
  return {sum / kSteps, std::sqrt((sum2 - sum * sum) / (kLines - 1)) / kSteps};
}

// States last about as long as the table says, not just as long: one cell of 14 m serves all elevations, and what moves
// changes with the time that a vehicle takes. A normal field that turns by a quarter of a circle a cell passes z
// exp(-z^2 / 2) / 2 times a cell, whatever its way of turning (Rice 1945). Where it turns in several coordinates at
// once it is the root of the squares of their rates, and up to sqrt(6 / 5) of that where they do not turn fastest
// together (root of the mean square of one's turning over its mean). All within four standard errors of 120 lines (1e-4
// a comparison); against a change in each of the table's mean stretches it is what docs/gnss.md says.
TEST(StreetShading, StatesChangeAboutAsOftenAsTheTableSays) {
  struct Said {
    double elevation_deg, by_place, at_5_m_s;  ///< times as often
  };
  const TwoStateLaw law("suburban", 1.0);
  const ShadingScale scale;
  for (const Said& said : {Said{20.0, 0.95, 1.1}, Said{30.0, 1.15, 1.3}, Said{45.0, 1.5, 1.7}, Said{60.0, 0.9, 1.0}}) {
    const auto e = std::find_if(law.table().begin(), law.table().end(), [&](const TwoStateLaw::Elevation& one) {
      return std::abs(one.elevation_rad / kDegree - said.elevation_deg) < 1e-9;
    });
    ASSERT_NE(e, law.table().end());
    const double table_per_m = 2.0 / (e->good.mean_duration_m + e->bad.mean_duration_m);
    const double z = state_border(*e), a_cell = 0.5 * std::exp(-0.5 * z * z);
    const double by_place_per_m = a_cell / scale.state_m;
    EXPECT_NEAR(by_place_per_m / table_per_m, said.by_place, 0.03) << said.elevation_deg;  // as rounded

    const StateChanges along = state_changes(law, *e, 0.0, 0.0, 1.0);
    EXPECT_NEAR(along.mean_per_m, by_place_per_m, 4.0 * along.error_per_m) << said.elevation_deg;
    EXPECT_LT(along.error_per_m, 0.05 * by_place_per_m) << said.elevation_deg;  // so 4 of them tell 1 from 1.3
    const auto expect_between = [&](const StateChanges& changes, double least_per_m) {
      EXPECT_GT(changes.mean_per_m, least_per_m - 4.0 * changes.error_per_m) << said.elevation_deg;
      EXPECT_LT(changes.mean_per_m, std::sqrt(1.2) * least_per_m + 4.0 * changes.error_per_m) << said.elevation_deg;
    };
    expect_between(state_changes(law, *e, 45.0, 0.0, 1.0), by_place_per_m);

    const StateChanges driven = state_changes(law, *e, 0.0, scale.moving_share, 5.0);
    expect_between(driven, a_cell * std::hypot(std::sqrt(1.0 - scale.moving_share) / scale.state_m,
                                               std::sqrt(scale.moving_share) / (5.0 * scale.coherence_s)));
    EXPECT_NEAR(driven.mean_per_m / table_per_m, said.at_5_m_s, 0.05 + 4.0 * driven.error_per_m / table_per_m)
        << said.elevation_deg;  // as rounded
  }
}

// The same street has the same static fade on every pass and for every seed; what moves has another.
TEST(StreetShading, TheSameStreetFadesAlike) {
  const TwoStateLaw law("suburban", 1.0);
  const StreetShading still1(law, {.moving_share = 0.0}, 0, 1), still2(law, {.moving_share = 0.0}, 0, 2),
      other(law, {.moving_share = 0.0}, 1, 1);
  EXPECT_EQ(street_levels(still1, 25.0, 0.0), street_levels(still2, 25.0, 5000.0));
  EXPECT_NE(street_levels(still1, 25.0, 0.0), street_levels(other, 25.0, 0.0));
  const StreetShading moves1(law, {}, 0, 1), moves2(law, {}, 0, 2);
  EXPECT_EQ(street_levels(moves1, 25.0, 7.0), street_levels(moves1, 25.0, 7.0));
  EXPECT_NE(street_levels(moves1, 25.0, 7.0), street_levels(moves2, 25.0, 7.0));
  EXPECT_NE(street_levels(moves1, 25.0, 7.0), street_levels(moves1, 25.0, 9.0));
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
