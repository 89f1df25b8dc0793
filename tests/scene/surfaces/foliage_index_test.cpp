#include "canyon/scene/surfaces/foliage_index.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"

namespace canyon::scene {
namespace {

/// Chord of one crown, cut to [0, max]: the roots of |(p + s d - c) / r|^2 = 1.
double chord_m(const Foliage& f, const Eigen::Vector3d& p, const Eigen::Vector3d& d, double max_m) {
  const Eigen::Vector3d o = (p - f.center_W).cwiseQuotient(f.radii_m), v = d.cwiseQuotient(f.radii_m);
  const double a = v.squaredNorm(), b = o.dot(v), c = o.squaredNorm() - 1.0;
  if (b * b - a * c <= 0.0) return 0.0;
  const double root = std::sqrt(b * b - a * c);
  return std::max(std::min((-b + root) / a, max_m) - std::max((-b - root) / a, 0.0), 0.0);
}

TEST(FoliageIndex, GivesTheSumOverAllCrowns) {
  const RandomStream random(4, "test.crowns");
  std::vector<Foliage> crowns;
  for (std::uint64_t i = 0; i < 800; ++i) {
    const double x = random.uniform(-200, 200, 0, i), y = random.uniform(-150, 150, 1, i);
    crowns.push_back({{x, y, 0.05 * x - 0.02 * y + random.uniform(3, 9, 2, i)},
                      {random.uniform(1, 4, 3, i), random.uniform(1, 4, 4, i), random.uniform(1, 4, 5, i)}});
  }
  const FoliageIndex index(crowns);
  int met = 0;
  for (std::uint64_t i = 0; i < 3000; ++i) {
    const Eigen::Vector3d p(random.uniform(-300, 300, 6, i), random.uniform(-300, 300, 7, i),
                            random.uniform(-20, 30, 8, i));
    Eigen::Vector3d d(random.normal(9, i), random.normal(10, i), 0.3 * random.normal(11, i));
    if (i % 10 == 0) d = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(i / 10 % 3));
    d.normalize();
    const double max_m = i % 2 == 0 ? 1e5 : random.uniform(1, 200, 12, i);
    double expected_m = 0.0;
    for (const Foliage& f : crowns) expected_m += chord_m(f, p, d, max_m);
    EXPECT_NEAR(index.chords_m(p, d, max_m), expected_m, 1e-9) << i;
    met += expected_m > 0.0 ? 1 : 0;
  }
  EXPECT_GT(met, 150);
}

TEST(FoliageIndex, FewOrNoCrowns) {
  EXPECT_EQ(FoliageIndex().chords_m({0, 0, 0}, {0, 0, 1}, 1e5), 0.0);
  const FoliageIndex one({{{0, 0, 5}, {2, 2, 2}}});
  EXPECT_NEAR(one.chords_m({0, 0, 0}, {0, 0, 1}, 1e5), 4.0, 1e-12);
  EXPECT_NEAR(one.chords_m({-9, 0, 5}, {1, 0, 0}, 8.0), 1.0, 1e-12);
  EXPECT_EQ(one.chords_m({0, 0, 8}, {0, 0, 1}, 1e5), 0.0);
}

TEST(FoliageIndex, LeafDensityWeighsAndPassagesTellTheChords) {
  const FoliageIndex two({{{0, 0, 5}, {2, 2, 2}, 0.5}, {{10, 0, 5}, {1, 1, 1}, 3.0}});
  EXPECT_NEAR(two.chords_m({-9, 0, 5}, {1, 0, 0}, 1e5), 0.5 * 4.0 + 3.0 * 2.0, 1e-12);
  std::vector<CrownPassage> passages{{}, {}, {}};
  two.passages({-9, 0, 5}, {1, 0, 0}, 19.5, passages);
  ASSERT_EQ(passages.size(), 2u);
  EXPECT_EQ(passages[0].crown, 0u);
  EXPECT_NEAR(passages[0].enter_m, 7.0, 1e-12);
  EXPECT_NEAR(passages[0].leave_m, 11.0, 1e-12);
  EXPECT_EQ(passages[0].leaf_density_m2_m3, 0.5);
  EXPECT_EQ(passages[1].crown, 1u);
  EXPECT_NEAR(passages[1].enter_m, 18.0, 1e-12);
  EXPECT_NEAR(passages[1].leave_m, 19.5, 1e-12);  // cut by the ray's end
  two.passages({-9, 0, 9}, {1, 0, 0}, 1e5, passages);
  EXPECT_TRUE(passages.empty());
}

}  // namespace
}  // namespace canyon::scene
