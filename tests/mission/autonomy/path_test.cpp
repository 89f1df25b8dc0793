#include "canyon/mission/autonomy/path.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace canyon::mission {
namespace {

TEST(Path, RoundsACornerWithTheAskedRadius) {
  const Path path({{0, 0}, {50, 0}, {50, 50}}, 6.0, 0.05);
  // Two legs shortened by the tangent length r, plus a quarter circle; chords of 0.05 m shorten the arc by (ds/r)^2/24.
  EXPECT_NEAR(path.length_m(), 2 * 44.0 + 6.0 * std::numbers::pi / 2, 1e-3);
  EXPECT_NEAR(path.curvature(44.0 + 3.0 * std::numbers::pi / 2), 1.0 / 6.0, 2e-3);  // middle of the arc
  EXPECT_NEAR(path.curvature(20.0), 0.0, 1e-12);
}

TEST(Path, ProjectsWithinAWindow) {
  const Path path({{0, 0}, {100, 0}, {100, 20}, {0, 20}}, 1.0);
  // (30, 12) is nearer to the way back, but the window says it is still the way out.
  EXPECT_NEAR(path.project({30, 12}, 20, 40), 30.0, 1e-9);
  EXPECT_NEAR(path.offset({30, 2}, 30), 2.0, 1e-12);
  EXPECT_NEAR(path.offset({30, -1}, 30), -1.0, 1e-12);
}

TEST(Path, EndsAreClampedAndRepeatedPointsMerged) {
  const Path path({{0, 0}, {0, 0}, {10, 0}, {10, 0}}, 5.0);
  EXPECT_NEAR(path.length_m(), 10.0, 1e-12);
  EXPECT_NEAR(path.at(-5).x(), 0.0, 1e-12);
  EXPECT_NEAR(path.at(50).x(), 10.0, 1e-12);
  EXPECT_TRUE(Path({{1, 1}, {1, 1}}, 5.0).empty());
}

// Trapezoidal profile: L/v + v/2 (1/a + 1/b), sampled every 0.5 m.
TEST(NominalTime, OfAStraightLine) {
  const Path path({{0, 0}, {200, 0}}, 5.0);
  const double time = nominal_drive_time_s(path, {5.0, 1.0, 1.0, 2.0}, {200.0});
  EXPECT_NEAR(time, 200.0 / 5 + 2.5 * (1.0 / 1 + 1.0 / 2), 0.5);
  const double with_stop = nominal_drive_time_s(path, {5.0, 1.0, 1.0, 2.0}, {100.0, 200.0});
  EXPECT_NEAR(with_stop - time, 2.5 * (1.0 / 1 + 1.0 / 2), 0.5);
}

}  // namespace
}  // namespace canyon::mission
