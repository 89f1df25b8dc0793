#include <bit>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "canyon/mission/autonomy/autonomy.h"

namespace canyon::mission {
namespace {

/// FNV-1a over the bits of doubles.
class Digest {
 public:
  void add(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (int byte = 0; byte < 8; ++byte) hash_ = (hash_ ^ ((bits >> (8 * byte)) & 0xffU)) * 0x100000001b3U;
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325U;
};

/// Level ground, and two blocks a metre high beside the way, in L.
LidarScan scan_of(const Eigen::Vector2d& vehicle, GpsTime t) {
  LidarScan scan;
  scan.t = t;
  const auto add = [&](double x, double y, double z) {
    const Eigen::Vector2d p = Eigen::Vector2d(x, y) - vehicle;
    if (p.norm() < 30.0)
      scan.points.push_back(
          {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(z - 1.8), 0.3F, 0.0F, 0, 0});
  };
  for (double x = -10.0; x <= 90.0; x += 0.5)
    for (double y = -8.0; y <= 8.0; y += 0.5) add(x, y, 0.0);
  for (double z = 0.0; z <= 1.0; z += 0.125) {
    for (double y = -1.0; y <= 1.0; y += 0.125) add(25.0, y, z);
    for (double y = -4.0; y <= 0.5; y += 0.125) add(50.0, y, z);
  }
  return scan;
}

// What it commanded before there was another reference autonomy, to the bit: one drive past two blocks, on level
// ground, over which the estimate jumps by half a metre in height and moves sideways.
TEST(Reference2012, CommandsWhatItAlwaysDid) {
  const GpsTime start = GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0);
  AutonomyConfig config;
  config.model.name = "reference_2012";
  config.waypoints = {{"W1", {40.0, 0.0}, "building 1"}, {"W2", {80.0, 0.0}, ""}};
  PriorKnowledge prior;
  prior.route = Path({{0.0, 0.0}, {80.0, 0.0}}, config.corner_radius_m);
  prior.waypoint_s_m = {40.0, 80.0};
  const auto autonomy = make_autonomy(config, prior, start);

  Digest digest;
  double x = 0.0, y = 0.0, yaw = 0.0, speed = 0.0, furthest = 0.0;
  for (int k = 0; k < 4000; ++k) {
    const GpsTime t = start + 0.01 * k;
    NavEstimate estimate;
    estimate.t = t;
    estimate.X_WB.R = Eigen::Quaterniond(std::cos(0.5 * yaw), 0.0, 0.0, std::sin(0.5 * yaw));
    estimate.X_WB.p = {x, y + 0.0002 * k, k < 900 ? 0.0 : 0.5};
    estimate.v_WB_W = {speed, 0.0, 0.0};
    const Pose X_WL{Eigen::Quaterniond::Identity(), estimate.X_WB.p + Eigen::Vector3d(0.0, 0.0, 1.8)};
    if (k % 10 == 0) autonomy->see(scan_of({x, y}, t), X_WL, estimate);
    const DriveCommand command = autonomy->drive(estimate);
    digest.add(command.speed_m_s);
    digest.add(command.curvature_1_m);
    digest.add(static_cast<double>(autonomy->state()));
    speed += std::fmax(-0.03, std::fmin(0.015, command.speed_m_s - speed));
    yaw += 0.01 * speed * std::fmax(-0.35, std::fmin(0.35, command.curvature_1_m));
    x += 0.01 * speed * std::cos(yaw);
    y += 0.01 * speed * std::sin(yaw);
    furthest = std::fmax(furthest, std::fabs(y));
  }
  EXPECT_GT(x, 45.0) << "past the first block, and having looked";
  EXPECT_GT(furthest, 1.0) << "around it";
  EXPECT_EQ(digest.value(), 5536415660945983608U);
}

}  // namespace
}  // namespace canyon::mission
