#include "canyon/report/read/cloud_summary.h"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "canyon/core/files/pcd.h"
#include "canyon/tests/report/synthetic_results.h"
#include "canyon/tests/report/temporary_directory.h"

namespace canyon::report {
namespace {

using canyon::testing::store;
using canyon::testing::TemporaryDirectory;

struct Point {
  float x, y, z, intensity, error;
};

std::string pcd(const std::vector<Point>& points, const std::string& last = "error") {
  std::string out =
      pcd_header({{.name = "x"}, {.name = "y"}, {.name = "z"}, {.name = "intensity"}, {.name = last}}, points.size());
  if (!points.empty()) out.append(reinterpret_cast<const char*>(points.data()), points.size() * sizeof(Point));
  return out;
}

class Cloud : public ::testing::Test {
 protected:
  Result<CloudSummary> read(const std::string& text) {
    store(folder_.file("c.pcd"), text);
    return summarize_cloud(folder_.file("c.pcd"), grid_);
  }
  std::string error_of(const std::string& text) {
    const auto cloud = read(text);
    return cloud.ok() ? "no error" : cloud.error().str().substr(folder_.path().size() + 1);
  }
  TemporaryDirectory folder_;
  MapGrid grid_ = MapGrid::over({0, 0}, {10, 5}, 10);
};

TEST_F(Cloud, GridCoversTheRectangle) {
  EXPECT_EQ(grid_.columns, 10u);
  EXPECT_EQ(grid_.rows, 5u);
  EXPECT_DOUBLE_EQ(grid_.cell_m, 1);
}

TEST_F(Cloud, GathersErrorsAndCells) {
  const auto cloud = read(pcd(
      {{0.5f, 0.5f, 0, 0, 3}, {0.6f, 0.4f, 9, 0, 4}, {9.5f, 4.5f, 0, 0, 0.05f}, {-1, 2, 0, 0, 1}, {1, 1, 1, 1, NAN}}));
  ASSERT_TRUE(cloud.ok()) << cloud.error().str();
  EXPECT_EQ(cloud->points, 4u);
  EXPECT_EQ(cloud->undefined, 1u);
  EXPECT_EQ(cloud->outside, 1u);
  EXPECT_EQ(cloud->max_m, 4);
  EXPECT_EQ(cloud->at_max, 1u);
  const double small = double{0.05f};
  EXPECT_DOUBLE_EQ(cloud->rms_m(), std::sqrt((9 + 16 + small * small + 1) / 4));
  EXPECT_EQ(cloud->cell_rms_m[4 * 10 + 0], std::sqrt(12.5f));  // south-west: the last row's first cell
  EXPECT_EQ(cloud->cell_rms_m[0 * 10 + 9], std::sqrt(0.05f * 0.05f));
  EXPECT_LT(cloud->cell_rms_m[5], 0);
}

TEST_F(Cloud, QuantilesLieWithinABinOfTheExactOnes) {
  std::vector<Point> points;
  for (int i = 1; i <= 10'000; ++i) points.push_back({1, 1, 0, 0, 1e-4f * static_cast<float>(i)});  // uniform up to 1 m
  const auto cloud = read(pcd(points));
  ASSERT_TRUE(cloud.ok());
  const double bin = std::pow(10.0, 1.0 / ErrorBins::kPerDecade);
  for (const double share : {0.05, 0.5, 0.95}) {
    EXPECT_LT(cloud->quantile_m(share), share * bin);
    EXPECT_GT(cloud->quantile_m(share), share / bin);
  }
  EXPECT_DOUBLE_EQ(cloud->share_below_edge(ErrorBins::kCount), 1.0);
  EXPECT_NEAR(cloud->share_below_edge(2 * ErrorBins::kPerDecade), 0.1,
              1e-4);  // below 10 cm; one point on the edge may fall either way
}

TEST_F(Cloud, CountsThePointsAtTheGreatestError) {
  const auto cloud = read(pcd({{1, 1, 0, 0, 3}, {1, 1, 0, 0, 5}, {1, 1, 0, 0, 2}, {1, 1, 0, 0, 5}}));
  ASSERT_TRUE(cloud.ok());
  EXPECT_EQ(cloud->at_max, 2u);
}

TEST_F(Cloud, AnEmptyCloudHasNoFigures) {
  const auto cloud = read(pcd({}));
  ASSERT_TRUE(cloud.ok());
  EXPECT_TRUE(std::isnan(cloud->rms_m()));
  EXPECT_TRUE(std::isnan(cloud->quantile_m(0.5)));
}

TEST_F(Cloud, DamageIsTold) {
  const std::string good = pcd({{1, 1, 0, 0, 1}, {2, 2, 0, 0, 1}});
  EXPECT_EQ(error_of(good.substr(0, good.size() - 1)),
            "c.pcd: POINTS: the file holds 1 points, expected 2 as its header says");
  EXPECT_EQ(error_of(pcd({}, "quality")), "c.pcd: error: no such field, expected one of type F, size 4 and count 1");
}

}  // namespace
}  // namespace canyon::report
