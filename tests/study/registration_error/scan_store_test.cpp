#include "canyon/study/registration_error/scan_store.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/lidar/registration/prepared_cloud.h"
#include "canyon/study/registration_error/error_sources.h"
#include "canyon/tests/study/registration_error/taped_start.h"

namespace canyon::study {
namespace {

constexpr std::int64_t kPlenty = 1'000'000'000;

bool same_returns(const LidarScan& a, const LidarScan& b) {
  return a.t == b.t && a.period_s == b.period_s &&
         std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(),
                    [](const LidarPoint& p, const LidarPoint& q) {
                      return p.x == q.x && p.y == q.y && p.z == q.z && p.intensity == q.intensity &&
                             p.time_s == q.time_s && p.ring == q.ring && p.return_index == q.return_index;
                    });
}

/// The true motion of the short mission's first seconds, and a moment of it.
struct ScannedStart : testing::TapedStart {
  Trajectory truth;
  GpsTime t;

  ScannedStart() : testing::TapedStart(testing::taped_start("high", 4.0)) {
    for (const TapeNode& node : tape.nodes)
      truth.append({mission.start + (node.motion.t - tape.nodes.front().motion.t), node.motion.X_WB});
    t = mission.start + 3.0;
  }
  LidarScan scan(lidar::Scanner& scanner, std::int64_t index, const Trajectory& along) const {
    return scanner.scan(index, t, along, scene::SceneAt(*mission.scene)).scan;
  }
  LidarScan of_store(ScanStore& store, const mission::MissionConfig& of, std::int64_t index,
                     const Trajectory& along) const {
    auto scanner = store.scanner(of);
    EXPECT_TRUE(scanner.ok());
    return scan(**scanner, index, along);
  }
  LidarScan of_scanner(const mission::MissionConfig& of, std::int64_t index, const Trajectory& along) const {
    auto scanner = lidar::make_scanner(of.lidar, static_cast<std::uint64_t>(of.run.seed));
    EXPECT_TRUE(scanner.ok());
    return scan(**scanner, index, along);
  }
};

TEST(ScanStore, AScanIsTakenWhereNothingOfItDiffers) {
  const ScannedStart on;
  ScanStore store(kPlenty);
  const LidarScan first = on.of_store(store, on.config, 30, on.truth);
  EXPECT_GT(first.points.size(), 1000U);
  EXPECT_TRUE(same_returns(first, on.of_scanner(on.config, 30, on.truth)));
  EXPECT_EQ(store.counts().scans_taken, 0);

  mission::MissionConfig other_filter = on.config;  // and what comes after the scanner
  other_filter.lidar.deskew = "truth";
  other_filter.imu.errors = "none";
  other_filter.run.truth_as_guess = true;
  EXPECT_TRUE(same_returns(on.of_store(store, on.config, 30, on.truth), first));
  EXPECT_TRUE(same_returns(on.of_store(store, other_filter, 30, on.truth), first));
  EXPECT_EQ(store.counts().scans_made, 1);
  EXPECT_EQ(store.counts().scans_taken, 2);
}

TEST(ScanStore, WhatDiffersIsScannedAnew) {
  const ScannedStart on;
  ScanStore store(kPlenty);
  const LidarScan first = on.of_store(store, on.config, 30, on.truth);
  std::int64_t made = 1;
  const auto expect_its_own = [&](const mission::MissionConfig& config, std::int64_t index, const Trajectory& truth,
                                  const char* what) {
    const LidarScan scan = on.of_store(store, config, index, truth);
    EXPECT_TRUE(same_returns(scan, on.of_scanner(config, index, truth))) << what;
    EXPECT_FALSE(same_returns(scan, first)) << what << " acts";
    EXPECT_EQ(store.counts().scans_made, ++made) << what;
  };
  const auto changed = [&](const std::function<void(mission::MissionConfig&)>& change) {
    mission::MissionConfig out = on.config;
    change(out);
    return out;
  };
  for (std::size_t i = 0; i < error_sources().size(); ++i)
    if (error_sources()[i].name == std::string("beam"))
      expect_its_own(without_sources(on.config, 1u << i, HiddenRemoval::kHealed), 30, on.truth, "the beam");
  expect_its_own(changed([](auto& c) { c.lidar.latency_s = 0.05; }), 30, on.truth, "the latency");
  expect_its_own(changed([](auto& c) { c.lidar.range_noise_m *= 2.0; }), 30, on.truth, "the noise");
  expect_its_own(changed([](auto& c) { c.lidar.mount_m.z() += 0.1; }), 30, on.truth, "the place on the vehicle");
  expect_its_own(changed([](auto& c) { ++c.run.seed; }), 30, on.truth, "the seed");
  expect_its_own(on.config, 31, on.truth, "the revolution");
  Trajectory beside = on.truth;
  beside.move({Eigen::Quaterniond::Identity(), {0.2, 0.1, 0.0}});
  expect_its_own(on.config, 30, beside, "the true motion");
  EXPECT_EQ(store.counts().scans_taken, 0);
}

TEST(ScanStore, KeepsNoMoreThanItMay) {
  const ScannedStart on;
  ScanStore nothing(0), plenty(kPlenty);
  for (int k = 0; k < 2; ++k) on.of_store(nothing, on.config, 30, on.truth);
  EXPECT_EQ(nothing.counts().scans_taken, 0);
  EXPECT_EQ(nothing.counts().scans_made, 2);
  EXPECT_EQ(nothing.counts().kept_bytes, 0);

  const LidarScan first = on.of_store(plenty, on.config, 30, on.truth);
  const std::int64_t one = plenty.counts().kept_bytes;
  EXPECT_GE(one, static_cast<std::int64_t>(first.points.size() * sizeof(LidarPoint)));
  ScanStore little(one + one / 2);
  for (int k = 0; k < 2; ++k)
    for (const std::int64_t index : {30, 31})
      EXPECT_TRUE(
          same_returns(on.of_store(little, on.config, index, on.truth), on.of_scanner(on.config, index, on.truth)));
  EXPECT_EQ(little.counts().scans_taken, 1) << "of the first";
  EXPECT_EQ(little.counts().scans_made, 3);
  EXPECT_EQ(little.counts().kept_bytes, one);
}

// Of what its readers have no use for returns may be missing: that is nobody else's scan.
TEST(ScanStore, PartOfAScanIsNotKept) {
  const ScannedStart on;
  ScanStore store(kPlenty);
  auto scanner = store.scanner(on.config);
  ASSERT_TRUE(scanner.ok());
  const lidar::KeptRoom room{.low_m = -1.0, .high_m = 1.0, .reach_m = 5.0};
  (*scanner)->keep(&room);
  EXPECT_LT(on.scan(**scanner, 30, on.truth).points.size(), on.of_scanner(on.config, 30, on.truth).points.size());
  EXPECT_EQ(store.counts().kept_bytes, 0);
  (*scanner)->keep(nullptr);
  EXPECT_TRUE(same_returns(on.scan(**scanner, 30, on.truth), on.of_scanner(on.config, 30, on.truth)));
  EXPECT_GT(store.counts().kept_bytes, 0);
  (*scanner)->keep(&room);
  EXPECT_LT(on.scan(**scanner, 30, on.truth).points.size(), on.of_scanner(on.config, 30, on.truth).points.size());
  EXPECT_EQ(store.counts().scans_taken, 0);
}

mission::MissionConfig registering(const std::string& deskew, const std::string& more = "") {
  return mission::testing::short_config(
      "low", "low", "[lidar]\ndeskew = \"" + deskew + "\"\n[registration]\nmethod = \"gicp\"\n" + more);
}

/// A corner of ground and two walls.
std::vector<Eigen::Vector3f> corner() {
  std::vector<Eigen::Vector3f> out;
  for (int i = 1; i <= 30; ++i)
    for (int k = 1; k <= 30; ++k) {
      const float a = 0.3f * static_cast<float>(i), b = 0.3f * static_cast<float>(k);
      out.emplace_back(a, b, 0.0f);
      out.emplace_back(0.0f, a, b);
      out.emplace_back(a, 0.0f, b);
    }
  return out;
}

TEST(ScanStore, ACloudIsTakenWhereItsPointsAndItsMethodAreTheSame) {
  ScanStore store(kPlenty);
  const auto prepared = [&store](const mission::MissionConfig& config, const std::vector<Eigen::Vector3f>& points) {
    auto registration = store.registration(config);
    EXPECT_TRUE(registration.ok());
    return (*registration)->prepare(points);
  };
  const mission::MissionConfig by_truth = registering("truth");
  const std::vector<Eigen::Vector3f> points = corner();
  const auto first = prepared(by_truth, points);
  EXPECT_EQ(prepared(by_truth, points), first);
  EXPECT_EQ(prepared(registering("none"), points), first);
  EXPECT_EQ(store.counts().clouds_taken, 2);
  const auto method = lidar::make_registration(by_truth.registration);
  ASSERT_TRUE(method.ok());
  const auto own = (*method)->prepare(points);
  EXPECT_GT(own->points.size(), 100U);
  EXPECT_TRUE(first->points == own->points);
  EXPECT_TRUE(first->normals == own->normals);
  EXPECT_TRUE(first->tilt_variance == own->tilt_variance);

  std::vector<Eigen::Vector3f> nearly = points;
  nearly.back().x() = std::nextafter(nearly.back().x(), std::numeric_limits<float>::infinity());
  EXPECT_NE(prepared(by_truth, nearly), first);
  EXPECT_NE(prepared(registering("truth", "leaf_m = 1.0\n"), points), first);
  EXPECT_EQ(store.counts().clouds_taken, 2);
}

// The filter's motion puts straight hardly two runs' scans alike: their clouds would fill the store for nothing.
TEST(ScanStore, CloudsThatTheFilterPutStraightAreNotKept) {
  ScanStore store(kPlenty);
  const std::vector<Eigen::Vector3f> points = corner();
  for (const char* by : {"prediction", "estimate"})
    for (int k = 0; k < 2; ++k) {
      auto registration = store.registration(registering(by));
      ASSERT_TRUE(registration.ok());
      EXPECT_GT((*registration)->prepare(points)->points.size(), 100U);
    }
  EXPECT_EQ(store.counts().clouds_taken, 0);
  EXPECT_EQ(store.counts().kept_bytes, 0);
}

}  // namespace
}  // namespace canyon::study
