#include "canyon/fusion/error_state_filter.h"

#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "canyon/core/check.h"
#include "canyon/core/earth/earth.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/units.h"
#include "canyon/fusion/consistency.h"
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

using Columns3 = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor, kMostStates, 3>;
using Rows3 = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor, 3, kMostStates>;

/// P += a b.
void add_outer(ErrorMatrix& P, const Columns3& a, const Rows3& b) {
  add_products(P.data(), static_cast<int>(P.rows()), static_cast<int>(P.cols()), a.data(), b.data());
}

/// H P; what H does not know costs nothing. Rows beyond those of H are zero.
Rows3 rows_of(const Measurement::Rows& H, const ErrorMatrix& P) {
  Rows3 out = Rows3::Zero(3, P.cols());
  for (Eigen::Index i = 0; i < H.rows(); ++i) {
    for (Eigen::Index k = 0; k < H.cols(); ++k)
      if (H(i, k) != 0.0) out.row(i) += H(i, k) * P.row(k);
  }
  return out;
}

/// A H' with the rows of A = H P, or with the columns of A = P.
Measurement::Square times_transposed(const Rows3& HP, const Measurement::Rows& H) {
  const Eigen::Index m = H.rows();
  Measurement::Square out = Measurement::Square::Zero(m, m);
  for (Eigen::Index j = 0; j < m; ++j) {
    for (Eigen::Index k = 0; k < H.cols(); ++k) {
      if (H(j, k) == 0.0) continue;
      for (Eigen::Index i = 0; i < m; ++i) out(i, j) += HP(i, k) * H(j, k);
    }
  }
  return 0.5 * (out + out.transpose());
}

void symmetrize(ErrorMatrix& P) {
  for (Eigen::Index i = 0; i < P.rows(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) P(i, j) = P(j, i) = 0.5 * (P(i, j) + P(j, i));
  }
}

/// What rounding may take off an eigenvalue of H P H': an epsilon of each of the n x n terms of an element, and of the
/// elements of a row.
double rounding_of_HPHt(const Measurement::Rows& H, const ErrorMatrix& P) {
  double terms = 0.0, known = 0.0;
  for (Eigen::Index k = 0; k < H.cols(); ++k) {
    const double h = H.col(k).cwiseAbs().maxCoeff();
    if (h == 0.0) continue;
    ++known;
    for (Eigen::Index l = 0; l < H.cols(); ++l) terms += h * std::abs(P(k, l)) * H.col(l).cwiseAbs().maxCoeff();
  }
  return known * known * std::numeric_limits<double>::epsilon() * static_cast<double>(H.rows()) * terms;
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
      P_(ErrorMatrix::Zero(state_.padded_size(), state_.padded_size())) {
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

  const double tilt = config_.initial_attitude_sigma_deg_roll_pitch * kDegree;
  const double heading = config_.initial_attitude_sigma_deg_heading * kDegree;
  const Eigen::Matrix3d P_theta =
      R_WB.transpose() * Eigen::Vector3d(tilt * tilt, tilt * tilt, heading * heading).asDiagonal() * R_WB;
  // The configured position is B's; the state's is U's, so the lever arm couples it to attitude.
  const Eigen::Matrix3d p_theta = -(R_EW * R_WB) * skew(lever_U_B_);

  P_.setZero();
  P_.block<3, 3>(Index::kTheta, Index::kTheta) = P_theta;
  P_.block<3, 3>(Index::kPosition, Index::kTheta) = p_theta * P_theta;
  P_.block<3, 3>(Index::kTheta, Index::kPosition) = P_theta * p_theta.transpose();
  P_.block<3, 3>(Index::kPosition, Index::kPosition) = p_theta * P_theta * p_theta.transpose();
  for (int i = 0; i < 3; ++i) {
    P_(Index::kPosition + i, Index::kPosition + i) +=
        config_.initial_position_sigma_m * config_.initial_position_sigma_m;
    P_(Index::kVelocity + i, Index::kVelocity + i) =
        config_.initial_velocity_sigma_m_s * config_.initial_velocity_sigma_m_s;
  }
  for (const ErrorState::Member& member : state_.members()) {
    for (int i = 0; i < member.block->size(); ++i) P_(member.offset + i, member.offset + i) = member.block->variance(i);
  }
  symmetrize(P_);
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
  propagation_.propagate(P_);
  if (response_ != nullptr) response_->predicted(propagation_);

  strapdown_->advance(state_.nav, in);
  state_.nav.t = imu.t;
  w_EU_U_ = in.dtheta_U / in.dt_s - state_.nav.R_EU.conjugate() * earth_rate_E();
  f_U_ = in.dv_U / in.dt_s;
  predicted_R_EU_ = state_.nav.R_EU;
  predicted_p_EU_E_ = state_.nav.p_EU_E;
  state_.fade(propagation_.decay());
  for (Aid& aid : aids_)
    if (auto m = aid.model->stepped(view(), in)) reports_.push_back(correct(aid, *m));
}

void ErrorStateFilter::update(const AidingMessage& message) {
  for (Aid& aid : aids_)
    if (auto m = aid.model->received(view(), message)) reports_.push_back(correct(aid, *m));
}

void ErrorStateFilter::restart(const Eigen::Vector3d& innovation, const Eigen::Matrix3d& R,
                               const Eigen::Matrix3d& H_theta) {
  state_.nav.p_EU_E += innovation;
  state_.nav.v_EU_E.setZero();
  // The antenna is where the fix says; the IMU's place beside it is as well known as the attitude.
  const Rows3 lever = -H_theta * P_.middleRows<3>(Index::kTheta);
  const Eigen::Matrix3d P_lever = lever.middleCols<3>(Index::kTheta) * -H_theta.transpose();
  P_.middleRows<3>(Index::kPosition) = lever;
  P_.middleCols<3>(Index::kPosition) = lever.transpose();
  P_.block<3, 3>(Index::kPosition, Index::kPosition) = R + 0.5 * (P_lever + P_lever.transpose());
  P_.middleRows<3>(Index::kVelocity).setZero();
  P_.middleCols<3>(Index::kVelocity).setZero();
  P_.diagonal().segment<3>(Index::kVelocity).setConstant(kUnknownSpeed_m_s * kUnknownSpeed_m_s);
}

UpdateReport ErrorStateFilter::update(const GnssFix& fix) {
  UpdateReport report;
  report.t = fix.t;
  if (fix.status == FixStatus::kNone) return report;
  check_finite(fix);
  const double age_s = fix.t - state_.nav.t;
  CANYON_CHECK(std::abs(age_s) <= kMaxFixAge_s, "GNSS fix at ", fix.t.iso(), " is ", age_s,
               " s away from the last IMU sample");
  for (Aid& aid : aids_) {
    auto m = aid.model->received(view(), fix);
    if (!m) continue;
    const bool of_position = aid.name == kPositionModel;
    CANYON_CHECK(m->R.llt().info() == Eigen::Success, "covariance of the GNSS fix at ", fix.t.iso(),
                 " is not positive definite: diagonal ", m->R.diagonal().transpose());
    if (of_position && P_.diagonal().segment<3>(Index::kPosition).maxCoeff() > kLost_m * kLost_m) {
      const Eigen::Matrix3d H_theta = m->H.leftCols<3>();
      restart(m->residual, m->R, H_theta);
      if (response_ != nullptr) response_->restarted(H_theta);
      report.innovation = m->residual;
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

UpdateReport ErrorStateFilter::correct(Aid& aid, Measurement& m) {
  const int n = m.dimension();
  UpdateReport report{.measurement = aid.name, .t = state_.nav.t, .dimension = n};
  report.innovation.head(n) = m.residual;
  Rows3 HP = rows_of(m.H, P_);
  Measurement::Square predicted = times_transposed(HP, m.H);
  Eigen::LLT<Measurement::Square> S_llt(predicted + m.R);
  if (S_llt.info() != Eigen::Success) {
    // Both what is measured and the measurement are known better than the terms of H P H' are rounded: it then counts
    // as known to that rounding.
    m.R.diagonal().array() += rounding_of_HPHt(m.H, P_);
    S_llt.compute(predicted + m.R);
  }
  CANYON_CHECK(S_llt.info() == Eigen::Success, "innovation covariance is not positive definite: diagonal ",
               (predicted + m.R).diagonal().transpose());
  report.nis = m.residual.dot(S_llt.solve(m.residual));
  // The square of more than 1e154 sigma is more than a double holds.
  if (!std::isfinite(report.nis)) report.nis = std::numeric_limits<double>::infinity();

  const Decision decision = aid.acceptance->decide(
      {.t = state_.nav.t, .residual = m.residual, .R = m.R, .predicted = predicted, .nis = report.nis});
  if (!decision.accepted) return report;
  report.accepted = true;
  if (decision.noise_scale != 1.0 || decision.covariance_scale != 1.0) {
    m.R *= decision.noise_scale;
    P_ *= decision.covariance_scale;
    HP *= decision.covariance_scale;
    predicted *= decision.covariance_scale;
    S_llt.compute(predicted + m.R);
  }

  Columns3 K = Columns3::Zero(P_.rows(), 3);
  K.leftCols(n) = HP.topRows(n).transpose().lazyProduct(S_llt.solve(Measurement::Square::Identity(n, n)).eval());
  if (response_ != nullptr) response_->corrected(K.leftCols(n), m.H, aid.name == kPositionModel);

  // Joseph: (I - K H) P (I - K H)' + K R K', as two corrections of the rank of the measurement, from the left and from
  // the right.
  add_outer(P_, -K, HP);
  Columns3 right = Columns3::Zero(P_.rows(), 3);
  right.leftCols(n) = K.leftCols(n).lazyProduct(m.R);
  for (Eigen::Index k = 0; k < P_.cols(); ++k) {
    for (int i = 0; i < n; ++i)
      if (m.H(i, k) != 0.0) right.col(i) -= m.H(i, k) * P_.col(k);
  }
  add_outer(P_, right, K.transpose());
  symmetrize(P_);

  inject(K.leftCols(n).lazyProduct(m.residual));
  return report;
}

void ErrorStateFilter::inject(const Eigen::VectorXd& error) {
  state_.inject(error);
  // The attitude error is now counted from the corrected attitude: Exp(theta + e) = Exp(theta) Exp(Jr(theta) e).
  const Eigen::Matrix3d reset = so3_right_jacobian(error.segment<3>(Index::kTheta));
  Rows3 rows = reset.lazyProduct(P_.topRows<3>());
  const Eigen::Matrix3d P_theta = rows.leftCols<3>() * reset.transpose();
  rows.leftCols<3>() = 0.5 * (P_theta + P_theta.transpose());
  P_.topRows<3>() = rows;
  P_.leftCols<3>() = rows.transpose();
}

void ErrorStateFilter::watch(FixResponse* response) {
  response_ = response;
  if (response_ != nullptr) response_->begin(P_.rows());
}

Eigen::Matrix<double, 3, 9> ErrorStateFilter::body_jacobian() const {
  Eigen::Matrix<double, 3, 9> J = Eigen::Matrix<double, 3, 9>::Zero();
  J.leftCols<3>() = state_.nav.R_EU.toRotationMatrix() * skew(lever_U_B_);
  J.middleCols<3>(Index::kPosition).setIdentity();
  return J;
}

Eigen::MatrixXd ErrorStateFilter::covariance() const {
  return P_.topLeftCorner(state_.size(), state_.size());
}

Pose ErrorStateFilter::body_pose(const Eigen::Quaterniond& R_EU, const Eigen::Vector3d& p_EU_E) const {
  const Eigen::Quaterniond R_WB = (Eigen::Quaterniond(frame_.R_EW().transpose().eval()) * R_EU).normalized();
  return {R_WB, frame_.to_W(p_EU_E) - R_WB * lever_U_B_};
}

NavEstimate ErrorStateFilter::estimate() const {
  const NavState& nav = state_.nav;
  const Calibration imu = state_.calibration();
  const Eigen::Matrix3d R_WE = frame_.R_EW().transpose();
  const Eigen::Matrix3d R_EB = nav.R_EU.toRotationMatrix();  // axes of U are parallel to B
  NavEstimate out;
  out.t = nav.t;
  out.X_WB = body_pose(nav.R_EU, nav.p_EU_E);
  out.v_WB_W = R_WE * (nav.v_EU_E - R_EB * w_EU_U_.cross(lever_U_B_));
  out.gyro_bias_U = imu.gyro_bias;
  out.accel_bias_U = imu.accel_bias;

  // xi = [theta; R' dp_B], and dp_B = dp_U + R [l]x theta.
  Matrix6d J = Matrix6d::Zero();
  J.topLeftCorner<3, 3>().setIdentity();
  J.bottomLeftCorner<3, 3>() = skew(lever_U_B_);
  J.bottomRightCorner<3, 3>() = R_EB.transpose();
  out.pose_covariance = J.lazyProduct(P_.topLeftCorner<6, 6>()).eval().lazyProduct(J.transpose());
  out.pose_covariance = 0.5 * (out.pose_covariance + out.pose_covariance.transpose()).eval();

  // dv_B = dv_U + R [w x l]x theta - R [l]x e, e being the error of the gyroscopes that the states make; in W.
  Eigen::Matrix<double, 9, 9> P;
  P.topLeftCorner<3, 3>() = P_.block<3, 3>(Index::kTheta, Index::kTheta);
  P.block<3, 3>(0, 3) = P_.block<3, 3>(Index::kTheta, Index::kVelocity);
  P.block<3, 3>(3, 3) = P_.block<3, 3>(Index::kVelocity, Index::kVelocity);
  Rows3 e = Rows3::Zero(3, P_.cols());
  for (const Feed& feed : state_.feeds())
    if (feed.axis < 3) e.row(feed.axis) += feed.rate * P_.row(feed.state);
  Eigen::Matrix3d P_e = Eigen::Matrix3d::Zero();
  for (const Feed& feed : state_.feeds())
    if (feed.axis < 3) P_e.col(feed.axis) += feed.rate * e.col(feed.state);
  P.block<3, 3>(0, 6) = e.middleCols<3>(Index::kTheta).transpose();
  P.block<3, 3>(3, 6) = e.middleCols<3>(Index::kVelocity).transpose();
  P.block<3, 3>(6, 6) = P_e;
  P.triangularView<Eigen::StrictlyLower>() = P.transpose();
  Eigen::Matrix<double, 3, 9> V;
  V.leftCols<3>() = R_WE * R_EB * skew(w_EU_U_.cross(lever_U_B_));
  V.middleCols<3>(3) = R_WE;
  V.rightCols<3>() = -R_WE * R_EB * skew(lever_U_B_);
  out.velocity_covariance_W = V.lazyProduct(P).eval().lazyProduct(V.transpose());
  out.velocity_covariance_W = 0.5 * (out.velocity_covariance_W + out.velocity_covariance_W.transpose()).eval();
  return out;
}

}  // namespace canyon::fusion
