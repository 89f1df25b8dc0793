#include "canyon/lidar/registration/submap.h"

#include <algorithm>
#include <memory>
#include <set>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/lidar/registration/prepared_cloud.h"

namespace canyon::lidar {
namespace {

constexpr double kLeaf_m = 0.5;

struct Step {
  std::shared_ptr<const PreparedCloud> cloud;
  Pose X_OC;
};

/// Clouds of 400 points within 6 m, 1 m apart and turned; the normals are marks, by which a point is known again.
std::vector<Step> way(std::size_t steps, bool with_normals) {
  const RandomStream draws(1, "tests.submap");
  std::vector<Step> out;
  for (std::uint32_t k = 0; k < steps; ++k) {
    const auto cloud = std::make_shared<PreparedCloud>();
    for (std::uint32_t i = 0; i < 400; ++i) {
      const auto at = [&](std::uint32_t a, double most) {
        return static_cast<float>(draws.uniform(-most, most, k, 3 * i + a));
      };
      cloud->points.emplace_back(at(0, 6.0), at(1, 6.0), at(2, 1.0));
      if (!with_normals) continue;
      cloud->normals.emplace_back(static_cast<float>(k), static_cast<float>(i), 0.0F);
      cloud->tilt_variance.push_back(static_cast<float>(i));
    }
    Vector6d xi;
    xi << 0.0, 0.0, 0.1 * k, 1.0 * k, 0.3 * k, 0.0;
    out.push_back({cloud, Pose::exp(xi)});
  }
  return out;
}

using Voxel = std::tuple<int, int, int>;
Voxel voxel_of(const Step& step, std::size_t i) {
  const Eigen::Matrix3d R = step.X_OC.R.toRotationMatrix();
  const auto v =
      voxel_coordinates((R * step.cloud->points[i].cast<double>() + step.X_OC.p).cast<float>(), kLeaf_m).value();
  return {v.x(), v.y(), v.z()};
}

TEST(Submap, AVoxelBelongsToTheNewestCloudThatShowsIt) {
  constexpr std::size_t kMost = 4;
  const auto steps = way(9, true);
  Submap submap(kLeaf_m, kMost);
  for (std::size_t n = 0; n < steps.size(); ++n) {
    submap.add(steps[n].cloud, steps[n].X_OC);
    const std::size_t held = std::min(n + 1, kMost);
    ASSERT_EQ(submap.size(), held);
    const Pose X_TO = steps[n].X_OC.inverse();
    const auto placed = submap.in(X_TO);
    ASSERT_EQ(placed.size(), held);
    std::set<Voxel> taken;
    std::size_t gone = 0;
    for (std::size_t back = 0; back < held; ++back) {  // newest first
      const Step& step = steps[n - back];
      const PreparedCloud& left = *placed[held - 1 - back].cloud;
      EXPECT_TRUE(placed[held - 1 - back].X_TC.matrix().isApprox((X_TO * step.X_OC).matrix(), 1e-12));
      std::vector<std::size_t> expected;
      std::set<Voxel> own;
      for (std::size_t i = 0; i < step.cloud->points.size(); ++i) {
        own.insert(voxel_of(step, i));
        if (taken.count(voxel_of(step, i)) == 0) expected.push_back(i);
      }
      ASSERT_EQ(left.points.size(), expected.size()) << "cloud " << n - back << " after " << n;
      for (std::size_t k = 0; k < expected.size(); ++k) {
        EXPECT_EQ(left.points[k], step.cloud->points[expected[k]]);
        EXPECT_EQ(left.normals[k], step.cloud->normals[expected[k]]);
        EXPECT_EQ(left.tilt_variance[k], step.cloud->tilt_variance[expected[k]]);
      }
      gone += step.cloud->points.size() - expected.size();
      taken.insert(own.begin(), own.end());
    }
    EXPECT_GE(gone, n > 0 ? 50u : 0u) << "there is something to look at";
  }
  for (const Step& step : steps) EXPECT_EQ(step.cloud->points.size(), 400u);  // nobody else's clouds are touched
  submap.clear();
  EXPECT_TRUE(submap.empty());
}

TEST(Submap, ColumnsThatAMethodDoesNotFillStayEmpty) {
  const auto steps = way(2, false);
  Submap submap(kLeaf_m, 10);
  for (const Step& step : steps) submap.add(step.cloud, step.X_OC);
  const auto placed = submap.in(Pose{});
  EXPECT_LT(placed[0].cloud->points.size(), 400u);
  EXPECT_TRUE(placed[0].cloud->normals.empty());
  EXPECT_EQ(placed[1].cloud, steps[1].cloud);
}

TEST(Submap, WithoutALeafAllCloudsStayAsTheyAre) {
  const auto steps = way(3, true);
  Submap submap(0.0, 2);
  for (const Step& step : steps) submap.add(step.cloud, step.X_OC);
  const auto placed = submap.in(Pose{});
  ASSERT_EQ(placed.size(), 2u);
  EXPECT_EQ(placed[0].cloud, steps[1].cloud);
  EXPECT_EQ(placed[1].cloud, steps[2].cloud);
  submap.clear();
  submap.add(steps[0].cloud, Pose{});
  EXPECT_EQ(submap.in(Pose{}).size(), 1u);
}

TEST(Submap, TooFarOutNothingIsThinned) {
  const auto steps = way(1, true);
  Submap submap(kLeaf_m, 10);
  const Pose far{Eigen::Quaterniond::Identity(), {2e6, 0.0, 0.0}};
  submap.add(steps[0].cloud, far);
  submap.add(steps[0].cloud, far);
  for (const auto& placed : submap.in(far.inverse())) EXPECT_EQ(placed.cloud, steps[0].cloud);
}

}  // namespace
}  // namespace canyon::lidar
