#include "canyon/inertial/motion/motion.h"

#include <cmath>
#include <cstdio>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/earth/earth.h"
#include "canyon/core/files/navigation_file.h"
#include "canyon/core/units.h"
#include "canyon/inertial/motion/models.h"
#include "canyon/inertial/motion/quintic_spline.h"
#include "canyon/inertial/motion/rigid_motion.h"
#include "canyon/inertial/true_increments.h"
#include "canyon/tests/inertial/smooth_motion.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::inertial {
namespace {

std::string temporary(const std::string& name, const std::string& text) {
  const std::string path = testing::temporary_file(name);
  std::ofstream(path) << text;
  return path;
}

/// A weave with every coordinate and angle in motion, as a file of points.
std::string points_file() {
  std::string text = "t_s,x_m,y_m,z_m,yaw_deg,pitch_deg,roll_deg\n";
  for (int i = 0; i <= 40; ++i) {
    const double t = 0.5 * i;
    char row[200];
    std::snprintf(row, sizeof row, "%.1f,%.9f,%.9f,%.9f,%.9f,%.9f,%.9f\n", t, 8.0 * t, 5.0 * std::sin(0.7 * t),
                  std::cos(0.5 * t), 170.0 + 40.0 * std::sin(0.4 * t), 85.0 * std::sin(0.3 * t), 20.0 * t);
    text += row;
  }
  return temporary("points.csv", text);
}

std::vector<MotionConfig> one_of_each() {
  std::vector<MotionConfig> configs(9);
  configs[0].path = "stationary";
  configs[0].pitch_deg = 20.0;
  configs[1].path = "straight";
  configs[1].profile_s = {2.0, 7.0, 12.0};
  configs[1].profile_m_s = {0.0, 30.0, 5.0};
  configs[2].path = "circle";
  configs[3].path = "figure_eight";
  configs[3].climb_m = 5.0;
  configs[3].sway_deg = 20.0;
  configs[4].path = "coning";
  configs[4].cone_deg = 30.0;
  configs[4].cone_hz = 0.5;
  configs[5].path = "spline";
  configs[5].file = points_file();
  configs[6] = configs[5];
  configs[6].smoothing_s = 3.0;
  configs[7] = configs[5];
  configs[7].file = temporary("track.csv", "t_s,x_m,y_m,z_m\n0,0,0,0\n2,20,5,1\n3,30,15,2\n6,30,40,0\n8,0,50,0\n");
  configs[8] = configs[3];
  configs[8].vibration.sinusoid = {
      {.frequency_hz = 3.0, .acceleration_m_s2 = {1.0, 2.0, 3.0}, .angle_deg = {4.0, 5.0, 6.0}}};
  configs[8].vibration.psd_hz = {0.5, 2.0};
  configs[8].vibration.psd_g2_per_hz = {0.01, 0.02};
  return configs;
}

/// Every path's derivatives are its derivatives: eighth-order central differences of the poses and velocities.
TEST(Motion, DerivativesAreThoseOfThePath) {
  for (const MotionConfig& config : one_of_each()) {
    const auto placed = make_motion(config, 1);
    ASSERT_TRUE(placed) << placed.error().str();
    const auto difference = [&](double t, auto value) -> Eigen::Vector3d {
      constexpr double h = 2e-3, weight[4] = {4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0};
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (int k = 1; k <= 4; ++k)
        sum += weight[k - 1] * (value(placed->motion->at(t + k * h)) - value(placed->motion->at(t - k * h)));
      return sum / h;
    };
    // Away from knots (multiples of 0.5 s), where a fifth derivative may jump.
    for (const double t : {0.77, 3.21, 4.36, 6.6}) {
      const KinematicState k = placed->motion->at(t);
      const auto where = config.path + config.file + " at " + std::to_string(t);
      // Rounding: eps of 60 m or 1 rad over h, a few times; truncation far below.
      EXPECT_LT((difference(t, [](const auto& s) { return s.X_WB.p; }) - k.v_WB_W).norm(), 1e-10) << where;
      EXPECT_LT((difference(t, [](const auto& s) { return s.v_WB_W; }) - k.a_WB_W).norm(), 1e-10) << where;
      EXPECT_LT((difference(t, [](const auto& s) { return s.w_WB_B; }) - k.alpha_WB_B).norm(), 1e-10) << where;
      const auto turned = [&](const auto& s) { return so3_log(k.X_WB.R.conjugate() * s.X_WB.R); };
      EXPECT_LT((difference(t, turned) - k.w_WB_B).norm(), 1e-10) << where;
    }
  }
}

TEST(Motion, PathsAreWhatTheirNamesSay) {
  MotionConfig c;
  c.path = "circle";
  c.radius_m = 20.0;
  c.speed_m_s = 5.0;
  c.heading_deg = 90.0;
  const auto circle = make_motion(c, 1);
  const KinematicState quarter = circle->motion->at(0.5 * kPi * 20.0 / 5.0);
  EXPECT_LT((quarter.X_WB.p - Eigen::Vector3d(20.0, 20.0, 0.0)).norm(), 1e-13 * 20);  // a few eps of the radius
  EXPECT_LT((quarter.v_WB_W - Eigen::Vector3d(0.0, 5.0, 0.0)).norm(), 1e-13 * 5);
  EXPECT_LT((quarter.w_WB_B - Eigen::Vector3d(0.0, 0.0, 0.25)).norm(), 1e-15);

  c.path = "straight";
  c.profile_s = {1.0, 3.0};
  c.profile_m_s = {0.0, 8.0};
  const auto straight = make_motion(c, 1);
  EXPECT_EQ(straight->motion->at(1.0).X_WB.p, Eigen::Vector3d::Zero());
  EXPECT_DOUBLE_EQ(straight->motion->at(2.0).v_WB_W.x(), 4.0);                        // the middle of the step
  EXPECT_NEAR(straight->motion->at(2.0).a_WB_W.x(), 1.875 * 8.0 / 2.0, 1e-14 * 7.5);  // its steepest slope
  EXPECT_NEAR(straight->motion->at(5.0).X_WB.p.x(), 8.0 + 16.0, 1e-14 * 24);
}

/// The spline goes through its points, and its fourth derivative has no jump there.
TEST(Motion, SplinePassesItsPointsSmoothly) {
  MotionConfig c;
  c.path = "spline";
  c.file = points_file();
  const auto placed = make_motion(c, 1);
  ASSERT_TRUE(placed) << placed.error().str();
  EXPECT_DOUBLE_EQ(placed->motion->duration_s(), 20.0);
  for (int i = 1; i < 40; ++i) {
    const double t = 0.5 * i;
    const KinematicState k = placed->motion->at(t);
    EXPECT_LT((k.X_WB.p - Eigen::Vector3d(8.0 * t, 5.0 * std::sin(0.7 * t), std::cos(0.5 * t))).norm(), 1e-9) << t;
    const Eigen::Quaterniond R = rotation_from({.yaw_rad = (170.0 + 40.0 * std::sin(0.4 * t)) * kDegree,
                                                .pitch_rad = 85.0 * std::sin(0.3 * t) * kDegree,
                                                .roll_rad = 20.0 * t * kDegree});
    EXPECT_LT(k.X_WB.R.angularDistance(R), 1e-10) << t;  // the file has nine decimals of a degree
    // Second differences of the acceleration on both sides of the point: the fourth derivative of the path, which a C3
    // spline would let jump by its own size (here 0.3 to 3 m/s^4), to truncation h times the fifth.
    const double h = 1e-3;
    const auto fourth = [&](int side) -> Eigen::Vector3d {
      const auto a = [&](int n) { return placed->motion->at(t + side * n * h).a_WB_W; };
      return (a(0) - 2.0 * a(1) + a(2)) / (h * h);
    };
    EXPECT_LT((fourth(1) - fourth(-1)).norm(), 0.02) << t;
  }
}

TEST(Motion, SmoothingLeavesHalfOfTheStatedPeriod) {
  std::vector<double> t;
  Eigen::MatrixXd y(801, 3);
  for (int i = 0; i <= 800; ++i) {
    t.push_back(0.1 * i);
    for (int j = 0; j < 3; ++j) y(i, j) = std::sin(2.0 * kPi * t.back() / (2.0 * std::pow(2.0, j)));  // 2, 4, 8 s
  }
  const QuinticSpline spline(t, y, 4.0);
  const double expected[3] = {1.0 / 65.0, 0.5, 64.0 / 65.0};
  for (int j = 0; j < 3; ++j) {
    // The gain by correlation over whole periods in the middle; the ends' influence has died away there.
    double gain = 0.0;
    for (int i = 320; i < 480; ++i) gain += 2.0 / 160.0 * spline.at(t[i], j).value() * y(i, j);
    EXPECT_NEAR(gain, expected[j], 2e-3) << j;  // sampling: (pi h / period)^2 at the least period
  }
}

/// Increments of adjoining intervals add up, and agree with the quadrature over nodes.
TEST(MotionIncrements, AddUpToTheirTolerance) {
  for (const MotionConfig& config : one_of_each()) {
    const auto placed = make_motion(config, 1);
    ASSERT_TRUE(placed);
    const ImuSample whole = motion_increments(*placed, 1.0, 2.0);
    ImuSample sum;
    for (int k = 0; k < 100; ++k) {
      const ImuSample part = motion_increments(*placed, 1.0 + 0.01 * k, 1.0 + 0.01 * (k + 1));
      sum.dtheta_U += part.dtheta_U;
      sum.dv_U += part.dv_U;
    }
    EXPECT_LT((whole.dtheta_U - sum.dtheta_U).norm(), 2e-12) << config.path;
    EXPECT_LT((whole.dv_U - sum.dv_U).norm(), 2e-12 + 100 * 1e-15) << config.path;
  }
}

TEST(MotionIncrements, VibrationFarAboveTheSampleRate) {
  MotionConfig c;
  c.vibration.sinusoid = {{.frequency_hz = 2000.0, .acceleration_m_s2 = {0.0, 0.0, 500.0}, .phase_deg = 30.0}};
  const auto placed = make_motion(c, 1);
  const ImuSample sample = motion_increments(*placed, 0.0, 0.00987);
  MotionConfig still;
  const ImuSample rest = motion_increments(*make_motion(still, 1), 0.0, 0.00987);
  const double w = 2.0 * kPi * 2000.0;
  const double expected = 500.0 / w * (std::cos(kPi / 6) - std::cos(w * 0.00987 + kPi / 6));
  // Gravity changes by 3e-6 1/s^2 times the 3e-6 m of travel, and Coriolis by 1e-4 1/s times it: below 1e-11 of 0.01 s.
  EXPECT_NEAR((sample.dv_U - rest.dv_U).z(), expected, 1e-11);
}

TEST(MotionVibration, RandomHasItsDensity) {
  MotionConfig c;
  c.vibration.psd_hz = {20.0, 80.0, 200.0};
  c.vibration.psd_g2_per_hz = {0.001, 0.004, 0.004};
  c.vibration.psd_lines = 400;
  const auto placed = make_motion(c, 7);
  // Area: from 20 to 80 Hz the density is f times 5e-5, then constant.
  const double variance =
      (0.5 * 5e-5 * (80.0 * 80.0 - 20.0 * 20.0) + 0.004 * 120.0) * kStandardGravity * kStandardGravity;
  Eigen::Vector3d power = Eigen::Vector3d::Zero();
  const int n = 20000;
  for (int k = 0; k < n; ++k) power += placed->motion->at(0.00137 * k).a_WB_W.cwiseAbs2() / n;
  for (int axis = 0; axis < 3; ++axis) {
    // 400 lines at random places of their steps: the area to a share of a step, 1 / 400; averaging over 27 s: 1e-2.
    EXPECT_NEAR(power[axis] / variance, 1.0, 0.03) << axis;
  }
  EXPECT_NE(make_motion(c, 8)->motion->at(1.0).X_WB.p, placed->motion->at(1.0).X_WB.p);
  EXPECT_EQ(make_motion(c, 7)->motion->at(1.0).X_WB.p, placed->motion->at(1.0).X_WB.p);
}

/// Extremes: 2000 deg/s at 100 g on an arm, at the poles. The force is centripetal, and gravity and Earth rate are
/// there.
TEST(Motion, CentrifugeOfAHundredG) {
  for (const double lat_deg : {90.0, -90.0, 0.0}) {
    MotionConfig c;
    c.path = "circle";
    c.lat_deg = lat_deg;
    const double rate = 2000.0 * kDegree;
    c.radius_m = 100.0 * kStandardGravity / (rate * rate);
    c.speed_m_s = rate * c.radius_m;
    const auto placed = make_motion(c, 1);
    const ImuSample s = motion_increments(*placed, 0.0, 0.005);
    const Eigen::Vector3d w = s.dtheta_U / s.dt_s, f = s.dv_U / s.dt_s;
    EXPECT_NEAR(w.z(), rate + Wgs84::rate_rad_s * std::sin(lat_deg * kDegree), 1e-12 * rate) << lat_deg;
    // Centripetal, leftwards; Coriolis of 28 m/s is below 5e-3 m/s^2 and counted.
    const double coriolis = 2.0 * Wgs84::rate_rad_s * std::sin(lat_deg * kDegree) * c.speed_m_s;
    EXPECT_NEAR(f.y(), 100.0 * kStandardGravity + coriolis, 1e-5) << lat_deg;  // gravity tilts by 1e-7 rad over 1 m
  }
}

/// The generator against Newton's and Euler's equations in inertial space, integrated by an independent method: Gragg,
/// Bulirsch & Stoer's extrapolation (Hairer, Norsett & Wanner, II.9), eighth order, nothing shared with the strapdown.
class InertialSpace {
 public:
  using State = Eigen::Matrix<double, 10, 1>;  // quaternion of U in I, position, velocity

  explicit InertialSpace(const PlacedMotion& placed) : placed_(placed) {}

  State truth(double t_s) const {
    const KinematicState k = placed_.imu_at(t_s);
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(Wgs84::rate_rad_s * t_s, Eigen::Vector3d::UnitZ()));
    const Eigen::Quaterniond q = turn * Eigen::Quaterniond(placed_.frame.R_EW()) * k.X_WB.R;
    const Eigen::Vector3d p_E = placed_.frame.to_E(k.X_WB.p);
    const Eigen::Vector3d v_E = placed_.frame.R_EW() * k.v_WB_W + earth_rate_E().cross(p_E);
    State x;
    x << q.w(), q.x(), q.y(), q.z(), turn * p_E, turn * v_E;
    return x;
  }

  State derivative(double t_s, const State& x) const {
    const InertialInput in = inertial_input(placed_.motion->at(t_s), placed_.frame, placed_.lever_arm_m);
    const Eigen::Quaterniond q(x[0], x[1], x[2], x[3]), w(0.0, in.w_IU_U.x(), in.w_IU_U.y(), in.w_IU_U.z());
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(Wgs84::rate_rad_s * t_s, Eigen::Vector3d::UnitZ()));
    const Eigen::Vector3d p_E = turn.conjugate() * x.segment<3>(4);
    const Eigen::Vector3d gravitation = gravity_E(p_E) + earth_rate_E().cross(earth_rate_E().cross(p_E));
    const Eigen::Quaterniond rate = q * w;
    State d;
    d << 0.5 * rate.w(), 0.5 * rate.x(), 0.5 * rate.y(), 0.5 * rate.z(), x.tail<3>(),
        q.normalized() * in.f_U + turn * gravitation;
    return d;
  }

  State step(double t_s, const State& x, double H) const {
    State T[4][4];  // rows: 2, 4, 6, 8 midpoint steps; columns: powers of h^2 taken out
    for (int j = 0; j < 4; ++j) {
      const int n = 2 * (j + 1);
      const double h = H / n;
      State before = x, now = x + h * derivative(t_s, x);
      for (int k = 1; k < n; ++k) {
        const State next = before + 2.0 * h * derivative(t_s + k * h, now);
        before = now;
        now = next;
      }
      T[j][0] = 0.5 * (before + now + h * derivative(t_s + H, now));
      for (int k = 1; k <= j; ++k) {
        const double ratio = static_cast<double>(j + 1) / static_cast<double>(j + 1 - k);
        T[j][k] = T[j][k - 1] + (T[j][k - 1] - T[j - 1][k - 1]) / (ratio * ratio - 1.0);
      }
    }
    return T[3][3];
  }

 private:
  const PlacedMotion& placed_;
};

TEST(Motion, GeneratorObeysNewtonAndEulerOverTenMinutes) {
  std::vector<std::pair<const char*, PlacedMotion>> motions = {{"smooth path", testing::smooth_motion()}};
  MotionConfig eight;
  eight.path = "figure_eight";
  eight.climb_m = 5.0;
  eight.sway_deg = 20.0;
  motions.emplace_back("figure eight", *make_motion(eight, 1));
  motions.back().second.lever_arm_m = {0.5, -0.3, 1.0};
  eight.lat_deg = 90.0;
  motions.emplace_back("figure eight at the pole", *make_motion(eight, 1));
  for (const auto& [name, placed] : motions) {
    const InertialSpace space(placed);
    InertialSpace::State x = space.truth(0.0);
    double worst_m = 0.0, worst_rad = 0.0;
    constexpr double kStep_s = 0.1;
    for (int k = 0; k < 6000; ++k) {
      x = space.step(kStep_s * k, x, kStep_s);
      const InertialSpace::State truth = space.truth(kStep_s * (k + 1));
      worst_m = std::max(worst_m, (x - truth).segment<3>(4).norm());
      const double cosine = std::abs(x.head<4>().normalized().dot(truth.head<4>().normalized()));
      worst_rad = std::max(worst_rad, 2.0 * std::sqrt(std::max(0.0, 2.0 - 2.0 * cosine)));
    }
    std::printf("generator, %s: after 600 s within %.1e m and %.1e rad of an eighth-order integration\n", name, worst_m,
                worst_rad);
    // Rounding: positions of 6.4e6 m in 6000 steps, 1e-9 m sqrt(6000), carried on by velocity: 1e-5 m at most.
    EXPECT_LT(worst_m, 1e-5) << name;
    EXPECT_LT(worst_rad, 1e-7) << name;  // sqrt of eps: the cosine's rounding
  }
}

// 2026-11-22: an absolute tolerance of 1e-12, halved with every panel, is below the rounding of 1e7 m/s^2: the panels
// were halved 40 times each, for ever. The closed form: the force is v^2 / r on the left, the rate v / r about z.
TEST(MotionIncrements, FastMotionsAreIntegratedToTheirRounding) {
  MotionConfig c;
  c.path = "circle";
  c.radius_m = 1e-3;
  c.speed_m_s = 100.0;
  const auto placed = make_motion(c, 1);
  IncrementAccuracy reached;
  const ImuSample s = motion_increments(*placed, 1.0, 1.005, &reached);
  const double rate = 1e5, force = 1e7;
  EXPECT_NEAR(s.dtheta_U.z() / s.dt_s, rate + Wgs84::rate_rad_s * std::sin(c.lat_deg * kDegree), 1e-12 * rate);
  EXPECT_NEAR(s.dv_U.y() / s.dt_s, force, 0.02);  // Coriolis: 2 * 7.3e-5 * 100 m/s
  // Two terms of 1e7 m/s^2, 50 epsilons.
  EXPECT_LT(reached.dv_m_s, 3.0 * force * 0.005 * 50.0 * 2.3e-16);
  EXPECT_LT(reached.dtheta_rad, 2.0 * rate * 0.005 * 50.0 * 2.3e-16);
  EXPECT_GT(reached.dv_m_s, 1e-12);
  // Halves add up within what is said.
  IncrementAccuracy first_reached, second_reached;
  const ImuSample first = motion_increments(*placed, 1.0, 1.0025, &first_reached);
  const ImuSample second = motion_increments(*placed, 1.0025, 1.005, &second_reached);
  EXPECT_LE((first.dv_U + second.dv_U - s.dv_U).cwiseAbs().maxCoeff(),
            reached.dv_m_s + first_reached.dv_m_s + second_reached.dv_m_s);
  EXPECT_LE((first.dtheta_U + second.dtheta_U - s.dtheta_U).cwiseAbs().maxCoeff(),
            reached.dtheta_rad + first_reached.dtheta_rad + second_reached.dtheta_rad);
}

/// What is too fast for the panels is said: 1e6 turns in the interval.
TEST(MotionIncrements, WhatTheWorkDoesNotReachIsSaid) {
  MotionConfig c;
  c.path = "coning";
  c.cone_deg = 90.0;
  c.cone_hz = 1e5;
  c.pitch_deg = 0.0;
  const auto placed = make_motion(c, 1);
  IncrementAccuracy reached;
  const ImuSample s = motion_increments(*placed, 0.0, 10.0, &reached);
  EXPECT_TRUE(s.dv_U.allFinite());
  EXPECT_GT(reached.dv_m_s, 1e-3);
}

/// One coordinate far away, and all coordinates far away: it ends, and is as accurate as it says.
TEST(MotionIncrements, FarPlacesEnd) {
  for (const bool all : {false, true}) {
    std::string tum;
    for (int k = 0; k < 20; ++k) tum += std::to_string(0.1 * k) + (all || k == 9 ? " 1e9 0" : " 5 0") + " 0 0 0 0 1\n";
    MotionConfig c;
    c.path = "recorded";
    c.file = temporary("far.tum", tum);
    const auto placed = make_motion(c, 1);
    ASSERT_TRUE(placed) << placed.error().str();
    IncrementAccuracy whole_reached;
    const ImuSample whole = motion_increments(*placed, 0.0, 1.9, &whole_reached);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double allowed = whole_reached.dv_m_s;
    for (int k = 0; k < 190; ++k) {
      IncrementAccuracy reached;
      sum += motion_increments(*placed, 0.01 * k, 0.01 * (k + 1), &reached).dv_U;
      allowed += reached.dv_m_s;
    }
    EXPECT_LE((sum - whole.dv_U).cwiseAbs().maxCoeff(), allowed);
    EXPECT_LT(allowed, all ? 1e-3 : 1e-10 * 1e11);  // of 1e11 m/s^2 around the one that is far
  }
}

}  // namespace
}  // namespace canyon::inertial
