#include "canyon/fusion/error_state_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "canyon/core/check.h"
#include "canyon/core/earth/earth.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/units.h"
#include "canyon/fusion/consistency.h"
#include "canyon/fusion/measurements/body_motion.h"
#include "canyon/fusion/measurements/innovation_covariance.h"
#include "canyon/fusion/states/state_block.h"

namespace canyon::fusion {
namespace {

using Index = ErrorIndex;
constexpr double kMaxFixAge_s = 0.1;
/// Moving this far changes the gravity gradient by 1e-4 of itself, which no covariance notices.
constexpr double kGradientReach_m = 500.0;
/// From this 1-sigma on the position is not known on Earth: gravity and what is linear about it tell nothing. Without
/// fixes the vertical channel comes there within two hours (e-folding 570 s).
constexpr double kLost_m = 1e6;
constexpr double kUnknownSpeed_m_s = 1e3;
constexpr std::string_view kPositionModel = "position";

void check_finite(const ImuSample& imu) {
  const bool good = std::isfinite(imu.dt_s) && imu.dt_s > 0.0 && imu.dtheta_U.allFinite() && imu.dv_U.allFinite();
  CANYON_CHECK(good, "IMU sample at ", imu.t.iso(), ": dt_s = ", imu.dt_s, ", dtheta = ", imu.dtheta_U.transpose(),
               ", dv = ", imu.dv_U.transpose());
}

void check_finite(const GnssFix& fix) {
  const bool good = fix.p_A_E.allFinite() && fix.covariance_E.allFinite();
  CANYON_CHECK(good, "GNSS fix at ", fix.t.iso(), ": p_A_E = ", fix.p_A_E.transpose(),
               ", covariance diagonal = ", fix.covariance_E.diagonal().transpose());
}

/// Room of this thread's own for the covariance while it is changed, so that no correction asks for memory.
ErrorMatrix& copied(const ErrorMatrix& P) {
  thread_local ErrorMatrix room;
  room = P;
  return room;
}

/// Where the states are that hold what lasts of the error of what is measured; -1 if none do.
int lasting_error(const ErrorState& state, const Measurement& m) {
  const int lasting = state.offset("fix_error");
  return lasting < 0 || m.H.middleCols<3>(lasting).isZero(0.0) ? -1 : lasting;
}

}  // namespace

ErrorStateFilter::ErrorStateFilter(const FilterConfig& config, const ImuNoise& noise, const LocalFrame& frame,
                                   const Eigen::Vector3d& lever_U_B, const Eigen::Vector3d& lever_A_B)
    : config_(config),
      frame_(frame),
      lever_U_B_(lever_U_B),
      lever_A_B_(lever_A_B),
      strapdown_(make_strapdown(config.integrator)),
      state_(filter_parts(config).states, config.own, {.noise = noise}),
      propagation_(state_, noise),
      estimator_(model_row(estimators(), config.estimator).make()) {
  const FilterParts parts = filter_parts(config);
  for (const std::string& name : parts.measurements) {
    const auto& row = model_row(measurement_models(), name);
    aids_.push_back({row.name, row.make(config.own, {.state = state_, .noise = noise}),
                     model_row(acceptance_models(), parts.acceptance).make(config.own)});
  }
}

FilterView ErrorStateFilter::view() const {
  return {.state = state_,
          .frame = frame_,
          .lever_U_B = lever_U_B_,
          .lever_A_B = lever_A_B_,
          .imu = state_.over_step(),
          .w_EU_U = w_EU_U_,
          .f_U = f_U_};
}

void ErrorStateFilter::initialize(GpsTime t, const Pose& X_WB, const Eigen::Vector3d& v_WB_W) {
  CANYON_CHECK(X_WB.R.coeffs().allFinite() && X_WB.p.allFinite() && v_WB_W.allFinite(), "initial state at ", t.iso());
  const Eigen::Matrix3d& R_EW = frame_.R_EW();
  const Eigen::Matrix3d R_WB = X_WB.R.toRotationMatrix();
  state_.start({.t = t,
                .R_EU = (Eigen::Quaterniond(R_EW) * X_WB.R).normalized(),
                .p_EU_E = frame_.to_E(X_WB * lever_U_B_),
                .v_EU_E = R_EW * v_WB_W});
  w_EU_U_.setZero();
  f_U_.setZero();
  for (Aid& aid : aids_) {
    aid.model->start();
    aid.acceptance->start();
  }
  reports_.clear();
  state_.feeds({.dt_s = 1.0});  // of biases, until the unit has measured
  strapdown_->reset();
  gravity_gradient_at_E_ = state_.nav.p_EU_E;
  gravity_gradient_ = gravity_gradient_E(state_.nav.p_EU_E);

  const Eigen::Matrix3d P_theta = first_attitude(R_WB);
  // The configured position is B's; the state's is U's, so the lever arm couples it to attitude.
  const Eigen::Matrix3d p_theta = -(R_EW * R_WB) * skew(lever_U_B_);

  ErrorMatrix P = ErrorMatrix::Zero(state_.padded_size(), state_.padded_size());
  P.block<3, 3>(Index::kTheta, Index::kTheta) = P_theta;
  P.block<3, 3>(Index::kPosition, Index::kTheta) = p_theta * P_theta;
  P.block<3, 3>(Index::kTheta, Index::kPosition) = P_theta * p_theta.transpose();
  P.block<3, 3>(Index::kPosition, Index::kPosition) = p_theta * P_theta * p_theta.transpose();
  for (int i = 0; i < 3; ++i) {
    P(Index::kPosition + i, Index::kPosition + i) +=
        config_.initial_position_sigma_m * config_.initial_position_sigma_m;
    P(Index::kVelocity + i, Index::kVelocity + i) =
        config_.initial_velocity_sigma_m_s * config_.initial_velocity_sigma_m_s;
  }
  for (const ErrorState::Member& member : state_.members()) {
    for (int i = 0; i < member.block->size(); ++i) P(member.offset + i, member.offset + i) = member.block->variance(i);
  }
  if (const int mounting = state_.mounting(); mounting >= 0) {
    // It is B that is known so well: of the IMU's axes also what they are off those of B is unknown.
    const Eigen::Matrix3d P_mounting = P.block<3, 3>(mounting, mounting);
    P.block<3, 3>(Index::kTheta, Index::kTheta) += P_mounting;
    P.block<3, 3>(Index::kTheta, mounting) = P.block<3, 3>(mounting, Index::kTheta) = -P_mounting;
  }
  estimator_->set(0.5 * (P + P.transpose()));
}

Eigen::Matrix3d ErrorStateFilter::first_attitude(const Eigen::Matrix3d& R_WU) const {
  const double tilt = config_.initial_attitude_sigma_deg_roll_pitch * kDegree;
  const double heading = config_.initial_attitude_sigma_deg_heading * kDegree;
  return R_WU.transpose() * Eigen::Vector3d(tilt * tilt, tilt * tilt, heading * heading).asDiagonal() * R_WU;
}

void ErrorStateFilter::predict(const ImuSample& imu) {
  check_finite(imu);
  const double elapsed_s = imu.t - state_.nav.t;
  CANYON_CHECK(std::abs(elapsed_s - imu.dt_s) <= 0.5 * imu.dt_s, "IMU sample at ", imu.t.iso(), " covers ", imu.dt_s,
               " s, but ", elapsed_s, " s have passed since the last one");
  if ((state_.nav.p_EU_E - gravity_gradient_at_E_).squaredNorm() > kGradientReach_m * kGradientReach_m) {
    gravity_gradient_at_E_ = state_.nav.p_EU_E;
    gravity_gradient_ = gravity_gradient_E(state_.nav.p_EU_E);
  }

  reports_.clear();
  propagation_.set_interval(imu.dt_s);
  const Calibration& known = state_.step_calibration(propagation_.mean_share());
  const Increments in = known.apply(imu.dt_s, imu.dtheta_U, imu.dv_U);
  propagation_.set_step(state_, in, known, gravity_gradient_);
  estimator_->propagate(propagation_);
  if (watcher_.observer != nullptr) watcher_.observer->predicted(propagation_);

  strapdown_->advance(state_.nav, in);
  state_.nav.t = imu.t;
  w_EU_U_ = in.dtheta_U / in.dt_s - Wgs84::rate_rad_s * state_.nav.R_EU.toRotationMatrix().row(2).transpose();
  f_U_ = in.dv_U / in.dt_s;
  predicted_R_EU_ = state_.nav.R_EU;
  predicted_p_EU_E_ = state_.nav.p_EU_E;
  state_.fade(propagation_.decay(), imu.dt_s);
  for (Aid& aid : aids_)
    if (auto m = aid.model->stepped(view(), in)) reports_.push_back(correct(aid, *m));
}

void ErrorStateFilter::update(const AidingMessage& message) {
  for (Aid& aid : aids_) {
    const int parts = aid.model->parts(view(), message);
    renew(aid.model->renewed());
    for (int part = 0; part < parts; ++part)
      if (auto m = aid.model->received(view(), message, part)) reports_.push_back(correct(aid, *m));
  }
}

void ErrorStateFilter::renew(std::span<const Renewal> states) {
  if (states.empty()) return;
  ErrorMatrix& P = copied(estimator_->covariance());
  for (const auto [state, kept] : states) {
    P.row(state) *= kept;
    P.col(state) *= kept;
    P(state, state) += (1.0 - kept * kept) * state_.first_variance(state);
    state_.renew(state, kept);
  }
  estimator_->set(P);
  if (watcher_.observer != nullptr) watcher_.observer->renewed(states);
}

void ErrorStateFilter::doubt(double v_m_s) {
  ErrorMatrix& P = copied(estimator_->covariance());
  P.block<3, 3>(Index::kTheta, Index::kTheta) +=
      first_attitude(frame_.R_EW().transpose() * state_.nav.R_EU.toRotationMatrix());
  P.diagonal().segment<3>(Index::kVelocity).array() += v_m_s * v_m_s;
  if (const int mounting = state_.mounting(); mounting >= 0)
    for (int i = 0; i < 3; ++i) P(Index::kTheta + i, Index::kTheta + i) += state_.first_variance(mounting + i);
  estimator_->set(0.5 * (P + P.transpose()));
  std::vector<Renewal> taught;
  for (const ErrorState::Member& member : state_.members()) {
    if (member.offset == state_.offset("clone")) continue;
    for (int i = 0; i < member.block->size(); ++i) taught.push_back({member.offset + i, 0.0});
  }
  renew(taught);
}

void ErrorStateFilter::take_clone() {
  const int clone = state_.offset("clone");
  if (clone < 0) return;
  state_.take_clone();
  ErrorMatrix P = estimator_->covariance();
  P.middleRows<6>(clone) = P.topRows<6>().eval();
  P.middleCols<6>(clone) = P.leftCols<6>().eval();
  estimator_->set(P);
}

void ErrorStateFilter::loosen(double theta_rad, double p_m, double v_m_s) {
  ErrorMatrix P = estimator_->covariance();
  P.diagonal().segment<3>(Index::kTheta).array() += theta_rad * theta_rad;
  P.diagonal().segment<3>(Index::kPosition).array() += p_m * p_m;
  P.diagonal().segment<3>(Index::kVelocity).array() += v_m_s * v_m_s;
  estimator_->set(P);
}

void ErrorStateFilter::restart(const Measurement& fix) {
  state_.nav.p_EU_E += fix.residual;
  state_.nav.v_EU_E.setZero();
  // The antenna is where the fix says; the IMU's place beside it is as well known as the attitude and what lasts of the
  // fix's error.
  Measurement::Rows others = -fix.H;
  others.middleCols<6>(Index::kPosition).setZero();
  ErrorMatrix P = estimator_->covariance();
  const Measurement::Rows position = rows_of(others, P);
  P.middleRows<3>(Index::kPosition) = position;
  P.middleCols<3>(Index::kPosition) = position.transpose();
  P.block<3, 3>(Index::kPosition, Index::kPosition) = fix.R + times_transposed(position, others);
  P.middleRows<3>(Index::kVelocity).setZero();
  P.middleCols<3>(Index::kVelocity).setZero();
  P.diagonal().segment<3>(Index::kVelocity).setConstant(kUnknownSpeed_m_s * kUnknownSpeed_m_s);
  estimator_->set(P);
}

UpdateReport ErrorStateFilter::update(const GnssFix& fix) {
  UpdateReport report;
  report.t = fix.t;
  if (fix.status == FixStatus::kNone) return report;
  check_finite(fix);
  // By its stamp, or by what the state time_offset makes of it: that may be estimated as any.
  const int offset = state_.offset("time_offset");
  const double by_stamp_s = fix.t - state_.nav.t, age_s = by_stamp_s + (offset < 0 ? 0.0 : value(offset));
  CANYON_CHECK(std::min(std::abs(by_stamp_s), std::abs(age_s)) <= kMaxFixAge_s, "GNSS fix at ", fix.t.iso(), " is ",
               age_s, " s away from the last IMU sample");
  const AidingMessage message(fix);
  for (Aid& aid : aids_) {
    aid.model->parts(view(), message);
    renew(aid.model->renewed());
    auto m = aid.model->received(view(), message, 0);
    if (!m) continue;
    const bool of_position = aid.name == kPositionModel;
    CANYON_CHECK(m->R.llt().info() == Eigen::Success, "covariance of the GNSS fix at ", fix.t.iso(),
                 " is not positive definite: diagonal ", m->R.diagonal().transpose());
    if (of_position && P().diagonal().segment<3>(Index::kPosition).maxCoeff() > kLost_m * kLost_m) {
      restart(*m);
      if (watcher_.observer != nullptr) watcher_.observer->restarted(*m);
      report.innovation.head<3>() = m->residual;
      report.accepted = true;
      return report;
    }
    UpdateReport made = correct(aid, *m);
    made.t = fix.t;
    if (of_position)
      report = made;
    else
      reports_.push_back(made);
  }
  return report;
}

PlaceBeside ErrorStateFilter::place_beside(const Measurement& m, double nis) const {
  PlaceBeside out{.off_m = m.residual,
                  .leaving_m_s = m.motion->residual_m_s,
                  .velocity_measured = m.motion->measured,
                  .speed_m_s = m.motion->speed_m_s,
                  .nis = nis};
  const int lasting = lasting_error(state_, m);
  if (lasting < 0) return out;
  const Eigen::Matrix3d share = m.H.middleCols<3>(lasting);
  out.off_m += share * state_.values(lasting, 3);
  Measurement::Rows others = m.H;
  others.middleCols<3>(lasting).setZero();
  const Eigen::Matrix3d S =
      times_transposed(rows_of(others, P()), others) + m.R + state_.first_variance(lasting) * share * share.transpose();
  out.nis = out.off_m.dot(S.llt().solve(out.off_m));
  if (!std::isfinite(out.nis)) out.nis = std::numeric_limits<double>::infinity();
  return out;
}

UpdateReport ErrorStateFilter::correct(Aid& aid, Measurement& m) {
  const int n = m.dimension();
  UpdateReport report{.measurement = aid.name, .t = state_.nav.t, .dimension = n};
  report.innovation.head(n) = m.residual;
  Measurement::Rows HP = rows_of(m.H, P());
  Measurement::Square predicted = times_transposed(HP, m.H);
  Eigen::LLT<Measurement::Square> S_llt(predicted + m.R);
  if (S_llt.info() != Eigen::Success || nearly_exact(m, predicted)) {
    // Both what is measured and the measurement are known better than the terms of H P H' are rounded: it then counts
    // as known to that rounding.
    count_rounding(m, HP, predicted, P());
    S_llt.compute(predicted + m.R);
  }
  CANYON_CHECK(S_llt.info() == Eigen::Success, "innovation covariance is not positive definite: diagonal ",
               (predicted + m.R).diagonal().transpose());
  report.nis = m.residual.dot(S_llt.solve(m.residual));
  report.normalized.head(n) = S_llt.matrixL().solve(m.residual);
  // The square of more than 1e154 sigma is more than a double holds.
  if (!std::isfinite(report.nis)) report.nis = std::numeric_limits<double>::infinity();

  const int lasting = lasting_error(state_, m);
  PlaceBeside place;
  if (m.motion) place = place_beside(m, report.nis);
  const Decision decision = aid.acceptance->decide({.t = state_.nav.t,
                                                    .residual = m.residual,
                                                    .R = m.R,
                                                    .predicted = predicted,
                                                    .nis = report.nis,
                                                    .place = m.motion ? &place : nullptr});
  if (!decision.accepted) return report;
  report.accepted = true;
  if (decision.noise_scale != 1.0 || decision.loosening != 1.0) {
    m.R *= decision.noise_scale;
    if (decision.loosening != 1.0) {
      if (lasting >= 0) {
        // It has been estimated from a place that is given up.
        m.residual += m.H.middleCols<3>(lasting) * state_.values(lasting, 3);
        renew(std::array{Renewal{lasting, 0.0}, Renewal{lasting + 1, 0.0}, Renewal{lasting + 2, 0.0}});
      }
      if (decision.loosening_m_s > 0.0) doubt(decision.loosening_m_s);
      // What is off is what is measured, and not by what else is off with it as a rule.
      ErrorMatrix& P = copied(estimator_->covariance());
      const double per_state = m.H.middleCols<3>(m.about).squaredNorm() / n;
      P.diagonal().segment<3>(m.about).array() +=
          (decision.loosening - 1.0) * (predicted + m.R).diagonal().maxCoeff() / per_state;
      estimator_->set(P);
      HP = rows_of(m.H, P);
      predicted = times_transposed(HP, m.H);
    }
    S_llt.compute(predicted + m.R);
  }

  const Measurement::Square S_inverse = S_llt.solve(Measurement::Square::Identity(n, n));
  const Gain K = HP.transpose().lazyProduct(S_inverse);
  if (watcher_.observer != nullptr) watcher_.observer->corrected({m, K, S_inverse, aid.name == kPositionModel});
  estimator_->correct(m, K, HP);
  const ErrorVector error = K.lazyProduct(m.residual);
  for (Aid& other : aids_) other.acceptance->moved(error.segment<3>(Index::kPosition), &other == &aid);
  estimator_->inject(state_, error);
  return report;
}

void ErrorStateFilter::watch(FilterObserver* observer) {
  watcher_.observer = observer;
  if (observer != nullptr) observer->begin(state_);
}

Eigen::Matrix<double, 3, 9> ErrorStateFilter::body_jacobian() const {
  Eigen::Matrix<double, 3, 9> J = Eigen::Matrix<double, 3, 9>::Zero();
  J.leftCols<3>() = state_.nav.R_EU.toRotationMatrix() * skew(lever_U_B_);
  J.middleCols<3>(Index::kPosition).setIdentity();
  return J;
}

Eigen::MatrixXd ErrorStateFilter::covariance() const {
  return P().topLeftCorner(state_.size(), state_.size());
}

Pose ErrorStateFilter::pose_of(const Eigen::Quaterniond& R_EU, const Eigen::Vector3d& p_EU_E) const {
  const Eigen::Quaterniond R_WE(frame_.R_EW().transpose().eval());
  const Eigen::Quaterniond R_WB = state_.mounting() < 0
                                      ? (R_WE * R_EU).normalized()
                                      : (R_WE * R_EU * Eigen::Quaterniond(state_.R_UB())).normalized();
  return {R_WB, frame_.to_W(p_EU_E) - R_WB * lever_U_B_};
}

Eigen::Matrix<double, 9, 9> ErrorStateFilter::body_covariance() const {
  const Measurement::Rows pose = canyon::fusion::body_pose(view()).H,
                          velocity = frame_.R_EW().transpose() * point_velocity(view(), Eigen::Vector3d::Zero()).H;
  const Measurement::Rows pose_P = rows_of(pose, P());
  Eigen::Matrix<double, 9, 9> out;
  out.topLeftCorner<6, 6>() = times_transposed(pose_P, pose);
  out.topRightCorner<6, 3>() = pose_P * velocity.transpose();
  out.bottomLeftCorner<3, 6>() = out.topRightCorner<6, 3>().transpose();
  out.bottomRightCorner<3, 3>() = times_transposed(rows_of(velocity, P()), velocity);
  return out;
}

NavEstimate ErrorStateFilter::estimate() const {
  const NavState& nav = state_.nav;
  const Calibration imu = state_.calibration();
  const Eigen::Matrix3d R_WE = frame_.R_EW().transpose();
  NavEstimate out;
  out.t = nav.t;
  out.X_WB = pose_of(nav.R_EU, nav.p_EU_E);
  out.v_WB_W = R_WE * (nav.v_EU_E - nav.R_EU.toRotationMatrix() * w_EU_U_.cross(state_.R_UB() * lever_U_B_));
  out.gyro_bias_U = imu.gyro_bias;
  out.accel_bias_U = imu.accel_bias;

  const Measurement::Rows pose = body_pose().H, velocity = R_WE * point_velocity(view(), Eigen::Vector3d::Zero()).H;
  out.pose_covariance = times_transposed(rows_of(pose, P()), pose);
  out.velocity_covariance_W = times_transposed(rows_of(velocity, P()), velocity);
  return out;
}

}  // namespace canyon::fusion
