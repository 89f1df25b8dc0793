#include "mission/vehicle.h"

#include <gtest/gtest.h>

#include "core/units.h"
#include "scene/city.h"

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

// Velocity and acceleration at the nodes are derivatives of the pose: integrating them over a step by Boole's rule
// gives the change of position and velocity. Boole's error is h^7/1e3 times the sixth derivative, far below 1e-12 m
// here; what is left is rounding, of the order of eps * |p| = 1e-13 m.
TEST_F(VehicleTest, NodesAreExactDerivativesOfOneAnother) {
  Vehicle vehicle = make();
  const GpsTime start = vehicle.state().t;
  double worst_p = 0, worst_v = 0, worst_R = 0;
  for (int k = 1; k <= 1000; ++k) {
    const double s = 0.01 * k;
    const auto& nodes = vehicle.advance({3.0, 0.1 * std::sin(s)}, tick(start, k, 100.0));
    const double h = (nodes[4].t - nodes[0].t) / 4;
    const auto boole = [&](auto member) {
      return Eigen::Vector3d(2 * h / 45 *
                             (7 * member(nodes[0]) + 32 * member(nodes[1]) + 12 * member(nodes[2]) +
                              32 * member(nodes[3]) + 7 * member(nodes[4])));
    };
    const Eigen::Vector3d dp = boole([](const KinematicState& n) { return n.v_WB_W; });
    const Eigen::Vector3d dv = boole([](const KinematicState& n) { return n.a_WB_W; });
    worst_p = std::max(worst_p, (nodes[4].X_WB.p - nodes[0].X_WB.p - dp).norm());
    worst_v = std::max(worst_v, (nodes[4].v_WB_W - nodes[0].v_WB_W - dv).norm());
    // Attitude: the rate at the middle node against a central difference of the attitude, error of order h^2.
    const Eigen::Vector3d w = so3_log(nodes[1].X_WB.R.conjugate() * nodes[3].X_WB.R) / (2 * h);
    worst_R = std::max(worst_R, (w - nodes[2].w_WB_B).norm());
  }
  EXPECT_LT(worst_p, 1e-12);
  EXPECT_LT(worst_v, 1e-12);
  EXPECT_LT(worst_R, 1e-3);
}

TEST_F(VehicleTest, AngularAccelerationIsTheDerivativeOfTheRate) {
  Vehicle vehicle = make();
  const GpsTime start = vehicle.state().t;
  for (int k = 1; k <= 500; ++k) {
    const auto& nodes = vehicle.advance({4.0, 0.15 * std::sin(0.03 * k)}, tick(start, k, 100.0));
    const double h = (nodes[4].t - nodes[0].t) / 4;
    const Eigen::Vector3d alpha = (nodes[3].w_WB_B - nodes[1].w_WB_B) / (2 * h);
    // Central difference: h^2/6 times the third derivative, 1e-6 * 1e3.
    ASSERT_LT((alpha - nodes[2].alpha_WB_B).norm(), 1e-3 * (1.0 + alpha.norm())) << "step " << k;
  }
}

TEST_F(VehicleTest, StateIsContinuousFromStepToStep) {
  Vehicle vehicle = make();
  const GpsTime start = vehicle.state().t;
  KinematicState before = vehicle.state();
  for (int k = 1; k <= 300; ++k) {
    const auto& nodes = vehicle.advance({k < 150 ? 5.0 : 0.0, 0.1}, tick(start, k, 100.0));
    EXPECT_LT((nodes[0].X_WB.p - before.X_WB.p).norm(), 1e-12);
    EXPECT_LT((nodes[0].v_WB_W - before.v_WB_W).norm(), 1e-12);
    EXPECT_LT(nodes[0].X_WB.R.angularDistance(before.X_WB.R), 1e-7);
    before = nodes[4];
  }
}

TEST_F(VehicleTest, StopsCompletelyAndStaysWithinItsLimits) {
  VehicleConfig config;
  config.roughness = "none";
  Vehicle vehicle = make(config);
  const GpsTime start = vehicle.state().t;
  double last_speed = 0;
  for (int k = 1; k <= 1000; ++k) {
    vehicle.advance({k < 600 ? 100.0 : 0.0, 10.0}, tick(start, k, 100.0));
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
  vehicle.advance({0, 0}, tick(start, 1001, 100.0));
  EXPECT_EQ(vehicle.distance_m(), distance);
}

// On a full circle of the tightest turn the rear axle runs on radius L / tan(delta).
TEST_F(VehicleTest, TurningRadiusIsThatOfTheBicycle) {
  VehicleConfig config;
  config.roughness = "none";
  Vehicle vehicle = make(config);
  const GpsTime start = vehicle.state().t;
  int k = 0;
  for (; k < 300;) {
    ++k;
    vehicle.advance({0.0, 10.0}, tick(start, k, 100.0));  // steer while standing
  }
  const double radius = config.wheelbase_m / std::tan(config.max_steering_deg * kDegree);
  const Eigen::Vector3d p0 = vehicle.state().X_WB.p;
  const double yaw = yaw_pitch_roll(vehicle.state().X_WB.R).yaw_rad;
  const Eigen::Vector2d center = p0.head<2>() + radius * Eigen::Vector2d(-std::sin(yaw), std::cos(yaw));
  for (; k < 2000;) {
    ++k;
    vehicle.advance({1.0, 10.0}, tick(start, k, 100.0));
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
