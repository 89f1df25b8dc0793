#include "canyon/gnss/paths/clutter/street_shading.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/gnss/paths/clutter/lattice_noise.h"
#include "canyon/tests/gnss/paths/normal_law.h"
#include "canyon/tests/gnss/paths/wall_scene.h"

namespace canyon::gnss {
namespace {

using testing::below;
using testing::direction;
using testing::four_sigma;
using testing::share_below;

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

}  // namespace
}  // namespace canyon::gnss
