// The way through tree crowns: tangents, from inside, from far away, overlapping.
#include <cmath>
#include <cstdio>
#include <limits>

#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/scene/stress/made_scenes.h"
#include "canyon/scene/stress/subjects.h"

namespace canyon::scene {
namespace {

using stress::kEpsilon;

/// A ball of radius 4 m passed at `beside_m` of its middle from `away_m`: 2 sqrt(r^2 - b^2). The distance squared
/// cancels to eps (away^2 + r^2), of which the chord makes that over itself; at the tangent its root.
StressFigure ball(double away_m, double beside_m) {
  SceneParts parts = made::nothing();
  parts.foliage.push_back({{3.0, 5.0, 8.0}, {4.0, 4.0, 4.0}, 1.0});
  const auto scene = made::scene_of(std::move(parts));
  const double cancel = 16.0 * kEpsilon * (away_m * away_m + 16.0);
  StressFigure out{0.0, 1.0};
  for (int k = 0; k < 64; ++k) {
    const Eigen::Vector3d d =
        Eigen::Vector3d(std::sin(1.0 * k), std::cos(1.7 * k), std::sin(2.3 * k + 0.5)).normalized();
    const Eigen::Vector3d o = Eigen::Vector3d(3.0, 5.0, 8.0) - away_m * d + beside_m * d.unitOrthogonal();
    const double exact = beside_m < 4.0 ? 2.0 * std::sqrt(16.0 - beside_m * beside_m) : 0.0;
    const double bound = exact > 0.0 ? cancel / exact + 16.0 * kEpsilon * away_m : 2.0 * std::sqrt(cancel);
    take_worst(out, std::abs(SceneAt(*scene).foliage_m(o, d, 1e9) - exact) / bound);
  }
  return out;
}

/// From inside of it only what lies ahead counts, and no more than the reach; two crowns in one place count twice, by
/// their density. 16 eps of 4 m.
StressFigure inside() {
  SceneParts parts = made::nothing();
  parts.foliage.push_back({{0.0, 0.0, 8.0}, {4.0, 2.0, 1.0}, 1.0});
  parts.foliage.push_back({{0.0, 0.0, 8.0}, {4.0, 2.0, 1.0}, 0.5});
  const auto scene = made::scene_of(std::move(parts));
  const SceneAt now(*scene);
  StressFigure out{0.0, 16.0 * kEpsilon * 8.0};
  const auto expect = [&](const Eigen::Vector3d& o, const Eigen::Vector3d& d, double reach, double exact) {
    take_worst(out, std::abs(now.foliage_m(o, d, reach) - 1.5 * exact));
  };
  const Eigen::Vector3d m(0.0, 0.0, 8.0), x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                                          z = Eigen::Vector3d::UnitZ();
  expect(m, x, 1e5, 4.0), expect(m, y, 1e5, 2.0), expect(m, z, 1e5, 1.0), expect(m, -z, 1e5, 1.0);
  expect(m, x, 1.5, 1.5), expect(m, x, 0.0, 0.0), expect(m - 10.0 * x, x, 6.0, 0.0), expect(m - 10.0 * x, x, 7.0, 1.0);
  expect(m + 5.0 * x, x, 1e5, 0.0), expect(m + 4.0 * x, x, 1e5, 0.0), expect(m - 4.0 * x, x, 1e5, 8.0);
  expect(m - 10.0 * y, y, 1e5, 4.0), expect(m - 10.0 * z, z, 1e5, 2.0);
  return out;
}

/// A forest of n x n crowns 16 m apart, passed straight through along a row: n chords of 8 m, from far outside. Cells
/// of the grid may not lose one.
StressFigure row_of(int n, double away_m) {
  SceneParts parts = made::nothing();
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) parts.foliage.push_back({{16.0 * i, 16.0 * j, 8.0}, {4.0, 4.0, 4.0}, 1.0});
  const auto scene = made::scene_of(std::move(parts));
  const SceneAt now(*scene);
  const double far_m = away_m + 16.0 * n;
  // Each chord: what cancels of far^2 over 8 m, and the ends' own digits.
  StressFigure out{0.0, n * (16.0 * kEpsilon * far_m * far_m / 8.0 + 16.0 * kEpsilon * far_m)};
  const double exact = 8.0 * n;
  for (int j = 0; j < n; j += 7) {
    take_worst(out, std::abs(now.foliage_m({-away_m, 16.0 * j, 8.0}, Eigen::Vector3d::UnitX(), 1e9) - exact));
    take_worst(out, std::abs(now.foliage_m({16.0 * j, far_m, 8.0}, -Eigen::Vector3d::UnitY(), 1e9) - exact));
  }
  const Eigen::Vector3d diagonal = Eigen::Vector3d(1.0, 1.0, 0.0).normalized();
  take_worst(out, std::abs(now.foliage_m(Eigen::Vector3d(0.0, 0.0, 8.0) - away_m * diagonal, diagonal, 1e9) - exact));
  return out;
}

}  // namespace

std::vector<StressCase> crown_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "the way through a crown, by its middle, its rim and beside it",
           "a root of a difference that is negative by rounding at the tangent: NaN; a far start that cancels",
           "2 sqrt(r^2 - b^2) but for 16 eps (away^2 + r^2) in the square", "of the bound"});
  struct Way {
    double away, beside;
    const char* name;
  };
  for (const Way& w :
       {Way{20.0, 0.0, "through_the_middle"}, Way{20.0, 4.0, "tangent"}, Way{20.0, 3.999999, "just_inside"},
        Way{20.0, 4.000001, "just_outside"}, Way{1e4, 2.0, "from_10_km"}, Way{1e4, 4.0, "tangent_from_10_km"}})
    rows.add(std::string("crowns/ball_") + w.name, [w] { return ball(w.away, w.beside); });
  rows.of({StressGroup::kGeometry, "a way that begins or ends in a crown",
           "what lies behind is counted, or the reach is not kept", "what lies ahead, times the density; 16 eps", "m"});
  rows.add("crowns/from_inside", inside);
  rows.of({StressGroup::kGeometry, "a row of a forest, along the cells of its grid",
           "a crown on a cell's border is in none of two cells", "n chords of 8 m", "m"});
  rows.add("crowns/row_of_50", [] { return row_of(50, 100.0); }).add("crowns/row_of_50_from_10_km", [] {
    return row_of(50, 1e4);
  });
  return rows.take();
}

}  // namespace canyon::scene
