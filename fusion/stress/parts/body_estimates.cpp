// The body's estimate, made of the unit's, and what fixes, steps and prediction do to it, against other runs.
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <Eigen/Eigenvalues>

#include "canyon/core/earth/earth.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/stress/looks.h"
#include "canyon/fusion/observers/fix_response.h"
#include "canyon/fusion/observers/predicted_motion.h"
#include "canyon/fusion/observers/step_response.h"
#include "canyon/fusion/smoothing/rts_smoother.h"
#include "canyon/fusion/smoothing/smoothed_state.h"
#include "canyon/fusion/stress/drawn_numbers.h"
#include "canyon/fusion/stress/parts/covariance_distance.h"
#include "canyon/fusion/stress/parts/subjects.h"
#include "canyon/fusion/stress/simulated_drive.h"

namespace canyon::fusion {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using stress::Looks;

/// Of the unit's state the body's: place, velocity and covariances of a filter that has turned, moved and been
/// corrected, as the filter itself says them, but for what it knows of the gyroscopes' biases.
StressFigure of_the_body() {
  Looks looks;
  Drive drive = simulated_drive(6, {.seconds = 3.0, .outage_from_s = 1e9});
  drive.lever_U_B = Vector3d(0.4, -0.3, 0.9);
  ErrorStateFilter filter(drive.config, drive.noise, drive.frame, drive.lever_U_B, drive.lever_A_B);
  filter.initialize(drive.start, drive.X_WB, drive.v_WB_W);
  for (std::size_t k = 0; k < drive.imu.size(); ++k) filter.predict(drive.imu[k]);
  for (const GnssFix& fix : drive.fixes)
    if (fix.t == filter.nav_state().t) filter.update(fix);
  const NavEstimate by_filter = filter.estimate(),
                    found = estimate_of(RtsSmoother::filtered(filter), drive.frame, drive.lever_U_B);
  looks.right(found.t == by_filter.t && found.gyro_bias_U == by_filter.gyro_bias_U &&
              found.accel_bias_U == by_filter.accel_bias_U);
  looks.near((found.X_WB.p - by_filter.X_WB.p).norm(), 0.0, 1e-8),
      looks.near(found.X_WB.R.angularDistance(by_filter.X_WB.R), 0.0, 1e-7);
  looks.near((found.v_WB_W - by_filter.v_WB_W).norm(), 0.0, 1e-12);
  looks.near(apart_by_sigma(by_filter.pose_covariance, found.pose_covariance), 0.0, 1e-9);
  // A metre of lever arm times the biases' 2e-4 rad/s, beside 5 cm/s.
  const Matrix3d less = by_filter.velocity_covariance_W - found.velocity_covariance_W;
  looks.near(less.norm() / by_filter.velocity_covariance_W.norm(), 0.0, 0.02);
  const auto both = filter.body_covariance();
  looks.near(apart_by_sigma(by_filter.pose_covariance, both.topLeftCorner<6, 6>()), 0.0, 1e-9);
  looks.near(apart_by_sigma(by_filter.velocity_covariance_W, both.bottomRightCorner<3, 3>()), 0.0, 1e-9);
  looks.near((both - both.transpose()).norm(), 0.0, 1e-14 * both.norm());
  return looks.figure();
}

/// The run of a filter with one of its fixes moved, and without: what it is told to do to the body's place, first order
/// (errors a thousandth of the usual ones, moved by a third of a sigma): a thousandth.
StressFigure moved_fixes() {
  Looks looks;
  const Drive drive = simulated_drive(
      4, {.seconds = 6.0, .rate_hz = 20.0, .outage_from_s = 1e9, .noise_scale = 1e-3, .keys = "states = [\"biases\"]"});
  const double by_m = 1.6e-4;
  const auto end_of = [&](int moved_fix, const Vector3d& by, FixResponse* response) {
    ErrorStateFilter filter(drive.config, drive.noise, drive.frame, drive.lever_U_B, drive.lever_A_B);
    filter.initialize(drive.start, drive.X_WB, drive.v_WB_W);
    if (response != nullptr) filter.watch(response);
    std::size_t next = 0;
    for (const ImuSample& sample : drive.imu) {
      filter.predict(sample);
      for (; next < drive.fixes.size() && drive.fixes[next].t <= sample.t; ++next) {
        GnssFix fix = drive.fixes[next];
        if (static_cast<int>(next) == moved_fix) fix.p_A_E += by;
        if (response != nullptr) response->expect(1.0 + 0.5 * static_cast<double>(next));
        filter.update(fix);
      }
      if (sample.t == drive.imu[drive.imu.size() - 7].t) break;
    }
    return filter;
  };
  FixResponse response;
  const ErrorStateFilter plain = end_of(-1, Vector3d::Zero(), &response);
  const Vector3d up = drive.frame.R_EW().col(2);
  Eigen::Matrix<double, 3, 9> of_unit = Eigen::Matrix<double, 3, 9>::Zero();
  of_unit.middleCols<3>(3).setIdentity();
  const FixResponse::Moved told = response.moved(of_unit, up);
  double any = 0.0, upwards = 0.0;
  for (int k = 0; k < 5; ++k) {
    Matrix3d J;
    for (int axis = 0; axis < 3; ++axis)
      J.col(axis) = (end_of(k, by_m * Vector3d::Unit(axis), nullptr).nav_state().p_EU_E -
                     end_of(k, -by_m * Vector3d::Unit(axis), nullptr).nav_state().p_EU_E) /
                    (2.0 * by_m);
    const double moved = 1.0 + 0.5 * k;
    any += moved * std::sqrt(Eigen::SelfAdjointEigenSolver<Matrix3d>(J * J.transpose()).eigenvalues()[2]);
    upwards += moved * (J.transpose() * up).norm();
  }
  looks.right(plain.nav_state().t == drive.imu[drive.imu.size() - 7].t);
  // A place on Earth rounds by 1e-9 of 3e-4 m.
  looks.near(told.any_m / any, 1.0, 2e-3), looks.near(told.up_m / upwards, 1.0, 2e-3);
  return looks.figure();
}

/// What steps do to an estimate by chance is the sum, over steps, of the squares of what each does alone, corrections
/// in between; and all together what they do one by one. Roundings of 60 steps.
StressFigure moved_steps() {
  Looks looks;
  const Drive drive = simulated_drive(8, {.seconds = 3.0,
                                          .rate_hz = 20.0,
                                          .outage_from_s = 1e9,
                                          .keys = "states = [\"biases\", \"fix_error\"]\nfix_error_way_m = 5"});
  DrawnNumbers draw(6);
  std::vector<StepMove> moves;
  for (std::size_t k = 0; k < drive.imu.size(); ++k)
    moves.push_back({1e-4 * draw.three(), 1e-3 * draw.three(), 1e-3 * draw.three()});
  Eigen::Matrix<double, 3, 9> J = Eigen::Matrix<double, 3, 9>::Zero();
  J.middleCols<3>(3).setIdentity(), J.leftCols<3>() = 0.3 * draw.any(3, 3);
  // Effects at once: all steps; and a few steps alone.
  const std::vector<std::size_t> alone = {0, 7, 19, 20, 33, 58};
  const auto run = [&](bool all, std::size_t only) {
    auto response = std::make_unique<StepResponse>();
    ErrorStateFilter filter(drive.config, drive.noise, drive.frame, drive.lever_U_B, drive.lever_A_B);
    filter.initialize(drive.start, drive.X_WB, drive.v_WB_W);
    filter.watch(response.get());
    std::size_t next = 0;
    for (std::size_t k = 0; k < drive.imu.size(); ++k) {
      const bool among = std::find(alone.begin(), alone.end(), k) != alone.end();
      response->expect({(all ? among : k == only) ? moves[k] : StepMove{}, StepMove{}});
      filter.predict(drive.imu[k]);
      for (; next < drive.fixes.size() && drive.fixes[next].t <= drive.imu[k].t; ++next)
        filter.update(drive.fixes[next]);
    }
    filter.watch(nullptr);
    return response;
  };
  const auto together = run(true, 0);
  Vector3d sum = Vector3d::Zero();
  Matrix3d squares = Matrix3d::Zero();
  for (const std::size_t k : alone) {
    const auto one = run(false, k);
    const Vector3d moved = one->moved_E(0, J);
    looks.near((one->by_chance_E(0, J) - moved * moved.transpose()).norm() / moved.squaredNorm(), 0.0, 1e-13);
    sum += moved, squares += moved * moved.transpose();
  }
  looks.near((together->moved_E(0, J) - sum).norm() / sum.norm(), 0.0, 1e-13);
  looks.near((together->by_chance_E(0, J) - squares).norm() / squares.norm(), 0.0, 1e-13);
  looks.right(together->moved_E(1, J).isZero(0.0) && together->by_chance_E(1, J).isZero(0.0));
  return looks.figure();
}

/// Motion by prediction alone, of a unit without noise: B now in B then, and its covariance by the differences of runs
/// from starts that are off by a little, as far off as the filter says they may be. First order: a part in 1e4, and of
/// turns a hundredth.
StressFigure predicted_motion() {
  Looks looks;
  Drive drive = simulated_drive(2, {.seconds = 2.0,
                                    .rate_hz = 20.0,
                                    .outage_from_s = 1e9,
                                    .noise_scale = 1e-2,
                                    .keys = "states = [\"wheel_scale\"]"});
  drive.noise = {};
  drive.lever_U_B = Vector3d(0.3, -0.5, 0.8);
  const auto at_end = [&](const Eigen::Matrix<double, 9, 1>& off, RelativePose* told) {
    ErrorStateFilter filter(drive.config, drive.noise, drive.frame, drive.lever_U_B, drive.lever_A_B);
    // Errors of the unit: attitude about its own axes, place and velocity along W's.
    const Pose X_WU = drive.X_WB * Pose{Eigen::Quaterniond::Identity(), drive.lever_U_B};
    const Pose moved{X_WU.R * so3_exp(off.head<3>()), X_WU.p + off.segment<3>(3)};
    filter.initialize(drive.start, moved * Pose{Eigen::Quaterniond::Identity(), -drive.lever_U_B},
                      drive.v_WB_W + off.tail<3>());
    const Pose start = filter.body_pose().X_EB;
    PredictedMotion motion(filter);
    for (const ImuSample& sample : drive.imu) filter.predict(sample), motion.predict(sample);
    if (told != nullptr) *told = motion.motion();
    return start.inverse() * filter.body_pose().X_EB;
  };
  RelativePose told;
  const Pose plain = at_end(Eigen::Matrix<double, 9, 1>::Zero(), &told);
  looks.right(told.target == drive.start && told.source == drive.imu.back().t);
  looks.near((plain.inverse() * told.X_TS).log().norm(), 0.0, 1e-8);
  ErrorStateFilter filter(drive.config, drive.noise, drive.frame, drive.lever_U_B, drive.lever_A_B);
  filter.initialize(drive.start, drive.X_WB, drive.v_WB_W);
  Eigen::Matrix<double, 9, 9> T = Eigen::Matrix<double, 9, 9>::Identity();
  T.block<3, 3>(3, 3) = T.block<3, 3>(6, 6) = drive.frame.R_EW().transpose();
  const Eigen::Matrix<double, 9, 9> P = T * filter.covariance().topLeftCorner<9, 9>() * T.transpose();
  Eigen::Matrix<double, 6, 9> J;
  for (int i = 0; i < 9; ++i) {
    const double h = i < 3 ? 1e-4 : 1e-2;
    const Eigen::Matrix<double, 9, 1> off = h * Eigen::Matrix<double, 9, 1>::Unit(i);
    J.col(i) =
        ((plain.inverse() * at_end(off, nullptr)).log() - (plain.inverse() * at_end(-off, nullptr)).log()) / (2.0 * h);
  }
  const MatrixXd expected = J * P * J.transpose();
  // Turns about its own start are known: beside the largest of each kind.
  const double turn = expected.diagonal().head<3>().maxCoeff<Eigen::PropagateNaN>() + 1e-14,
               way = expected.diagonal().tail<3>().maxCoeff<Eigen::PropagateNaN>();
  looks.near((told.covariance.bottomRightCorner<3, 3>() - expected.bottomRightCorner<3, 3>())
                     .cwiseAbs()
                     .maxCoeff<Eigen::PropagateNaN>() /
                 way,
             0.0, 1e-4);
  looks.near((told.covariance.topLeftCorner<3, 3>() - expected.topLeftCorner<3, 3>())
                     .cwiseAbs()
                     .maxCoeff<Eigen::PropagateNaN>() /
                 turn,
             0.0, 1e-2);
  looks.right(told.covariance == told.covariance.transpose());
  looks.right(is_of_motion(OdometerSample{}) && is_of_motion(BarometerSample{}) && is_of_motion(MagnetometerSample{}) &&
              is_of_motion(HeadingSample{}) && !is_of_motion(GnssFix{}) && !is_of_motion(GnssEpoch{}) &&
              !is_of_motion(PoseInMap{}) && !is_of_motion(RelativePose{}));
  PredictedMotion motion(filter);
  looks.right(stress::not_refused([&] { motion.update(AidingMessage(GnssFix{})); }) == 0);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> body_estimate_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "the body's estimate, and what moves an estimate",
           "a lever arm of the other sign, a response of another fix, a step that counts twice",
           "the filter's own words, other runs' differences, sums over steps: first order and roundings",
           "of the bound"});
  rows.add("runs/of_the_body", of_the_body)
      .add("runs/moved_fixes", moved_fixes)
      .add("runs/moved_steps", moved_steps)
      .add("runs/predicted_motion", predicted_motion);
  return rows.take();
}

}  // namespace canyon::fusion
