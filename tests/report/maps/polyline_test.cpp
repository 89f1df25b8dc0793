#include "canyon/report/maps/polyline.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace canyon::report {
namespace {

using Points = std::vector<Eigen::Vector2d>;
using Indices = std::vector<std::size_t>;

TEST(Polyline, AStraightLineKeepsItsEnds) {
  Points line;
  for (int i = 0; i <= 100; ++i) line.emplace_back(i, 2 * i);
  EXPECT_EQ(simplify_polyline(line, 0.01), (Indices{0, 100}));
}

TEST(Polyline, CornersStay) {
  EXPECT_EQ(simplify_polyline({{0, 0}, {5, 0}, {10, 0}, {10, 5}, {10, 10}}, 0.1), (Indices{0, 2, 4}));
}

TEST(Polyline, TurningPointsOfALineThatComesBackStay) {
  EXPECT_EQ(simplify_polyline({{0, 0}, {5, 0}, {10, 0}, {5, 0}, {0, 0}}, 0.1), (Indices{0, 2, 4}));
}

TEST(Polyline, StaysWithinTheTolerance) {
  Points curve;
  for (int i = 0; i <= 1000; ++i) curve.emplace_back(0.1 * i, 5 * std::sin(0.1 * i));
  constexpr double kTolerance_m = 0.05;
  const Indices kept = simplify_polyline(curve, kTolerance_m);
  EXPECT_LT(kept.size(), 300u);
  for (std::size_t k = 1; k < kept.size(); ++k) {
    const Eigen::Vector2d a = curve[kept[k - 1]], ab = curve[kept[k]] - a;
    for (std::size_t i = kept[k - 1]; i <= kept[k]; ++i) {
      const double s = std::clamp((curve[i] - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
      EXPECT_LE((curve[i] - a - s * ab).norm(), kTolerance_m * (1 + 1e-12));
    }
  }
}

TEST(Polyline, FewPoints) {
  EXPECT_TRUE(simplify_polyline({}, 1).empty());
  EXPECT_EQ(simplify_polyline({{1, 1}}, 1), (Indices{0}));
  EXPECT_EQ(simplify_polyline({{1, 1}, {1, 1}}, 1), (Indices{0, 1}));
}

}  // namespace
}  // namespace canyon::report
