#include "canyon/inertial/true_increments.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/check.h"
#include "canyon/core/earth/earth.h"
#include "canyon/core/units.h"
#include "canyon/tests/inertial/smooth_path.h"

namespace canyon::inertial {
namespace {

using testing::SmoothPath;

const GpsTime kStart = GpsTime::from_week_sow(1590, 396000.0);
const Geodetic kVicksburg{32.35 * kDegree, -90.88 * kDegree, 60.0};

/// Somigliana's closed formula (WGS84, TR8350.2 eq. 4-1), gravity on the ellipsoid: independent of core's.
double somigliana(double lat_rad) {
  const double s2 = std::sin(lat_rad) * std::sin(lat_rad);
  return 9.7803253359 * (1.0 + 0.00193185265241 * s2) / std::sqrt(1.0 - Wgs84::e2 * s2);
}

TEST(InertialInput, AtRestFeelsGravityUpAndTheEarthTurn) {
  for (double lat_deg : {-60.0, 0.0, 32.35, 45.0, 80.0}) {
    const double lat = lat_deg * kDegree;
    const LocalFrame frame(Geodetic{lat, 0.3, 0.0});
    KinematicState still;
    still.t = kStart;
    const InertialInput input = inertial_input(still, frame, Eigen::Vector3d::Zero());
    // Somigliana's printed constants have 12 digits.
    EXPECT_NEAR(input.f_U.z(), somigliana(lat), 1e-9) << lat_deg;
    EXPECT_LT(input.f_U.head<2>().norm(), 1e-9) << lat_deg;
    const double rate = Wgs84::rate_rad_s;
    const Eigen::Vector3d expected(0.0, rate * std::cos(lat), rate * std::sin(lat));  // east, north, up
    EXPECT_LT((input.w_IU_U - expected).norm(), 8e-16 * rate) << lat_deg;             // few eps
  }
}

TEST(InertialInput, TurnsWithTheBody) {
  const LocalFrame frame(kVicksburg);
  KinematicState level, tilted;
  tilted.X_WB.R = rotation_from({.yaw_rad = 0.4, .pitch_rad = -0.2, .roll_rad = 1.0});
  const InertialInput a = inertial_input(level, frame, Eigen::Vector3d::Zero());
  const InertialInput b = inertial_input(tilted, frame, Eigen::Vector3d::Zero());
  const double eps = std::numeric_limits<double>::epsilon();
  EXPECT_LT((tilted.X_WB.R * b.f_U - a.f_U).norm(), 16 * eps * 9.8);
  EXPECT_LT((tilted.X_WB.R * b.w_IU_U - a.w_IU_U).norm(), 16 * eps * Wgs84::rate_rad_s);
}

TEST(InertialInput, LeverArmOfASteadyTurnIsCentripetal) {
  const LocalFrame frame(kVicksburg);
  KinematicState turning;
  turning.w_WB_B = {0.0, 0.0, 0.5};
  turning.alpha_WB_B = {0.0, 0.0, 0.2};
  const Eigen::Vector3d lever(2.0, 0.0, 0.0);
  const InertialInput at_b = inertial_input(turning, frame, Eigen::Vector3d::Zero());
  const InertialInput at_u = inertial_input(turning, frame, lever);
  // -w^2 l inward, alpha l sideways, and the Coriolis force of the speed w l; gravity changes by under 1e-5 over 2 m.
  const Eigen::Vector3d earth = frame.R_EW().transpose() * earth_rate_E();
  const Eigen::Vector3d coriolis = 2.0 * earth.cross(Eigen::Vector3d(0.0, 1.0, 0.0));
  const Eigen::Vector3d expected = Eigen::Vector3d(-0.5, 0.4, 0.0) + coriolis;
  const Eigen::Vector3d gravity_change =
      frame.R_EW().transpose() * (gravity_E(frame.to_E(Eigen::Vector3d::Zero())) - gravity_E(frame.to_E(lever)));
  EXPECT_LT((at_u.f_U - at_b.f_U - expected - gravity_change).norm(), 1e-14);  // 64 eps of gravity
}

/// The same force from inertial space: f = R_UI (d2 p_I / dt2 - gravitation), with p_I by turning E, and the derivative
/// by a sixth-order central difference. Nothing of the formula under test is used.
TEST(InertialInput, AgreesWithNewtonInInertialSpace) {
  const LocalFrame frame(kVicksburg);
  const SmoothPath path(kStart);
  const Eigen::Vector3d lever(0.3, -0.5, 0.4);
  const double h = 0.02;
  for (double s : {3.0, 17.0, 41.0}) {
    const GpsTime t = kStart + s;
    const auto inertial_position = [&](int i) -> Eigen::Vector3d {
      const KinematicState k = path.at(t + i * h);
      const Eigen::Vector3d from_here = frame.R_EW() * (k.X_WB * lever);
      // Turned about the present instant, so that the large constant part of p_E is treated exactly below.
      const double angle = Wgs84::rate_rad_s * i * h;
      const Eigen::Matrix3d turn_minus_one =
          (Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix() - Eigen::Matrix3d::Identity());
      Eigen::Vector3d of_origin = turn_minus_one * frame.origin_E();
      const double versine = 2.0 * std::sin(0.5 * angle) * std::sin(0.5 * angle);  // 1 - cos without cancellation
      of_origin.x() = -versine * frame.origin_E().x() - std::sin(angle) * frame.origin_E().y();
      of_origin.y() = std::sin(angle) * frame.origin_E().x() - versine * frame.origin_E().y();
      of_origin.z() = 0.0;
      return of_origin + from_here + turn_minus_one * from_here;
    };
    const Eigen::Vector3d acceleration =
        (2.0 * (inertial_position(3) + inertial_position(-3)) - 27.0 * (inertial_position(2) + inertial_position(-2)) +
         270.0 * (inertial_position(1) + inertial_position(-1)) - 490.0 * inertial_position(0)) /
        (180.0 * h * h);
    const KinematicState now = path.at(t);
    const Eigen::Vector3d p_E = frame.to_E(now.X_WB * lever);
    const Eigen::Vector3d w = earth_rate_E();
    const Eigen::Vector3d gravitation = gravity_E(p_E) + w.cross(w.cross(p_E));
    const Eigen::Matrix3d R_EU = frame.R_EW() * now.X_WB.R.toRotationMatrix();
    const Eigen::Vector3d expected = R_EU.transpose() * (acceleration - gravitation);
    const InertialInput input = inertial_input(now, frame, lever);
    // Rounding of positions of 1e3 m (of_origin moves 24 m in 3 h): 1e3 eps * 490 * 4 / 180 / h^2 = 6e-9.
    EXPECT_LT((input.f_U - expected).norm(), 1e-8) << s;
  }
}

/// A quadrature of order n: the error over a fixed time falls as the n-th power of the node spacing.
TEST(TrueIncrements, QuadratureHasItsOrder) {
  const LocalFrame frame(kVicksburg);
  const SmoothPath path(kStart);
  const auto error = [&](int intervals, double rate_hz) {
    const ImuSample fine = true_increments(path.nodes(0, rate_hz, 64), frame, Eigen::Vector3d::Zero());
    const ImuSample coarse = true_increments(path.nodes(0, rate_hz, intervals), frame, Eigen::Vector3d::Zero());
    return (coarse.dv_U - fine.dv_U).norm();
  };
  const double simpson = std::log2(error(2, 0.5) / error(6, 0.5)) / std::log2(3.0);
  EXPECT_NEAR(simpson, 4.0, 0.2);
  const double boole = std::log2(error(8, 0.5) / error(16, 0.5));
  EXPECT_NEAR(boole, 6.0, 0.2);
}

TEST(TrueIncrements, FiveNodesAtAHundredHertzAreExactToRounding) {
  const LocalFrame frame(kVicksburg);
  const SmoothPath path(kStart);
  const ImuSample fine = true_increments(path.nodes(500, 100.0, 16), frame, Eigen::Vector3d::Zero());
  const ImuSample usual = true_increments(path.nodes(500, 100.0, 4), frame, Eigen::Vector3d::Zero());
  // Node stamps are rounded to 1 ns (0.5 ns of 10 ms, times the change of force in it) and sums to a few eps of 0.1
  // m/s.
  EXPECT_LT((fine.dv_U - usual.dv_U).norm(), 1e-12);
  EXPECT_LT((fine.dtheta_U - usual.dtheta_U).norm(), 1e-12);
  EXPECT_EQ(usual.t, tick(kStart, 501, 100.0));
  EXPECT_DOUBLE_EQ(usual.dt_s, 0.01);
}

TEST(TrueIncrements, RefusesWhatIsNotAQuadrature) {
  const LocalFrame frame(kVicksburg);
  const SmoothPath path(kStart);
  std::vector<KinematicState> nodes = path.nodes(0, 100.0, 4);
  const std::span<const KinematicState> all(nodes);
  EXPECT_THROW((void)true_increments(all.first(4), frame, Eigen::Vector3d::Zero()), ProgramError);
  EXPECT_THROW((void)true_increments(all.first(1), frame, Eigen::Vector3d::Zero()), ProgramError);
  nodes[1].t = nodes[1].t + 1e-4;
  EXPECT_THROW((void)true_increments(nodes, frame, Eigen::Vector3d::Zero()), ProgramError);
  nodes = path.nodes(0, 100.0, 4);
  nodes[2].a_WB_W.x() = std::nan("");
  try {
    (void)true_increments(nodes, frame, Eigen::Vector3d::Zero());
    FAIL() << "a motion that is not finite was taken";
  } catch (const ProgramError& e) {
    EXPECT_NE(std::string(e.what()).find("not finite at node 2"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace canyon::inertial
