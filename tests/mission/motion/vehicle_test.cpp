#include "canyon/mission/motion/vehicle.h"

#include <gtest/gtest.h>

#include "canyon/core/motion/true_motion.h"
#include "canyon/core/units.h"
#include "canyon/scene/city/city.h"

namespace canyon::mission {
namespace {

class VehicleTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene::CityConfig config;
    config.empty = true;
    scene_ = new scene::Scene(scene::make_city(config));
  }
  static void TearDownTestSuite() { delete scene_; }
  static Vehicle make(const VehicleConfig& config = {}) {
    return {config, *scene_, 1, GpsTime::from_week_sow(1610, 305000)};
  }
  static scene::Scene* scene_;
};
scene::Scene* VehicleTest::scene_ = nullptr;

// Plan motion by a fine integration of its own: speed, yaw and position at the end of a step against a midpoint rule of
// 1000 parts under the accelerations of the nodes. Midpoint: h^2 / 24 times a second derivative below 10, over 10 s.
TEST_F(VehicleTest, NodesFitTogether) {
  Vehicle vehicle = make();
  TrueMotion motion;
  motion.append(vehicle.state());
  for (int k = 1; k <= 1000; ++k) {
    motion.append(vehicle.advance({3.0, 0.1 * std::sin(0.01 * k)}));
    ASSERT_EQ(vehicle.state().t.ns, motion.first().ns + k * Vehicle::kStep_ns);
  }
  // Where acceleration goes one way within a step its mean, which the velocities tell, lies between those of the ends:
  // it differs from their middle by at most half of what they differ by. Where it turns round within the step, as at a
  // crest, what it does there is less than what it does in the drive's steepest step.
  struct Step {
    double off, change;
  };
  std::vector<Step> linear, angular;
  for (int k = 100; k < 1000; ++k) {
    const KinematicState a = motion.at(motion.first() + 0.01 * k), b = motion.at(motion.first() + 0.01 * (k + 1));
    linear.push_back(
        {((b.v_WB_W - a.v_WB_W) / 0.01 - 0.5 * (a.a_WB_W + b.a_WB_W)).norm(), (b.a_WB_W - a.a_WB_W).norm()});
    const Eigen::Vector3d w = so3_log(a.X_WB.R.conjugate() * b.X_WB.R) / 0.01;
    angular.push_back({(w - 0.5 * (a.w_WB_B + b.w_WB_B)).norm(), (b.w_WB_B - a.w_WB_B).norm()});
  }
  for (const auto& steps : {linear, angular}) {
    double largest = 0.0;
    for (const Step& step : steps) largest = std::max(largest, step.change);
    for (const Step& step : steps) EXPECT_LE(step.off, 0.5 * largest);
  }
}

// 2026-11-22: suspension_hz = 5 with suspension_damping = 2 diverged at the built-in 100 Hz, both in their ranges.
TEST_F(VehicleTest, TheStiffestSuspensionStaysOnTheRoad) {
  VehicleConfig config;
  config.suspension_hz = 5.0;
  config.suspension_damping = 2.0;
  Vehicle vehicle = make(config);
  for (int k = 1; k <= 3000; ++k) {
    const KinematicState& state = vehicle.advance({5.0, 0.05 * std::sin(0.01 * k)});
    const auto ground = scene_->ground(state.X_WB.p.x(), state.X_WB.p.y());
    ASSERT_TRUE(ground.has_value());
    ASSERT_LT(std::abs(state.X_WB.p.z() - ground->height_m), 0.2) << "step " << k;  // road class B: 3 sigma = 3.6 cm
  }
}

TEST_F(VehicleTest, StopsCompletelyAndStaysWithinItsLimits) {
  VehicleConfig config;
  config.roughness = "none";
  Vehicle vehicle = make(config);
  double last_speed = 0;
  for (int k = 1; k <= 1000; ++k) {
    vehicle.advance({k < 600 ? 100.0 : 0.0, 10.0});
    EXPECT_LE(vehicle.speed_m_s(), config.max_speed_m_s + 1e-12);
    const double a = (vehicle.speed_m_s() - last_speed) / 0.01;
    EXPECT_LE(a, config.max_acceleration_m_s2 + 1e-9);
    // The last step of a halt may end harder: from below 1 mm/s.
    if (vehicle.speed_m_s() > 0) {
      EXPECT_GE(a, -config.max_deceleration_m_s2 - 1e-9);
    }
    last_speed = vehicle.speed_m_s();
  }
  EXPECT_EQ(vehicle.speed_m_s(), 0.0);
  const double distance = vehicle.distance_m();
  vehicle.advance({0, 0});
  EXPECT_EQ(vehicle.distance_m(), distance);
}

// On a full circle of the tightest turn the rear axle runs on radius L / tan(delta).
TEST_F(VehicleTest, TurningRadiusIsThatOfTheBicycle) {
  VehicleConfig config;
  config.roughness = "none";
  Vehicle vehicle = make(config);
  int k = 0;
  for (; k < 300;) {
    ++k;
    vehicle.advance({0.0, 10.0});  // steer while standing
  }
  const double radius = config.wheelbase_m / std::tan(config.max_steering_deg * kDegree);
  const Eigen::Vector3d p0 = vehicle.state().X_WB.p;
  const double yaw = yaw_pitch_roll(vehicle.state().X_WB.R).yaw_rad;
  const Eigen::Vector2d center = p0.head<2>() + radius * Eigen::Vector2d(-std::sin(yaw), std::cos(yaw));
  for (; k < 2000;) {
    ++k;
    vehicle.advance({1.0, 10.0});
    // The sprung body leans, but B's plan position is the rear axle's.
    ASSERT_NEAR((vehicle.state().X_WB.p.head<2>() - center).norm(), radius, 1e-9);
  }
}

TEST_F(VehicleTest, BodySettlesOnTheTerrain) {
  VehicleConfig config;
  config.roughness = "none";
  Vehicle vehicle = make(config);
  const auto ground = scene_->ground(config.start_m.x(), config.start_m.y());
  ASSERT_TRUE(ground.has_value());
  const Eigen::Vector3d up = vehicle.state().X_WB.R * Eigen::Vector3d::UnitZ();
  // Four wheels on a terrain of 2 m cells: the body's normal is the ground's to a few mrad, its height to centimetres.
  EXPECT_LT(std::acos(std::min(1.0, up.dot(ground->normal_W))), 0.02);
  EXPECT_NEAR(vehicle.state().X_WB.p.z(), ground->height_m, 0.05);
}

// ISO 8608: the variance of a profile over the band is the integral of G(n). Heights along many random lines.
TEST(RoadRoughness, VarianceIsThatOfTheRoadClass) {
  const double expected = 64e-6 * 0.01 * (1 / 0.05 - 1 / 1.4);
  double sum = 0;
  const int seeds = 400;
  for (int seed = 1; seed <= seeds; ++seed) {
    const double h = RoadRoughness("B", static_cast<std::uint64_t>(seed)).height_m({12.3, -4.5});
    sum += h * h;
  }
  // Mean of squares of near-normal values: relative sigma sqrt(2/N) = 0.071; 5 sigma, false alarm 6e-7.
  EXPECT_NEAR(sum / seeds, expected, 5 * expected * std::sqrt(2.0 / seeds));
  EXPECT_EQ(RoadRoughness("none", 1).height_m({1, 2}), 0.0);
}

}  // namespace
}  // namespace canyon::mission
