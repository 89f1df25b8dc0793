#include "canyon/fusion/error_state_filter.h"

#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "canyon/core/check.h"
#include "canyon/core/earth/earth.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/units.h"
#include "canyon/fusion/antenna_position.h"
#include "canyon/fusion/consistency.h"

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

using Columns3 = Eigen::Matrix<double, Index::kAll, 3>;

/// P += a b'.
void add_outer(ErrorMatrix& P, const Columns3& a, const Columns3& b) {
  const Eigen::Matrix<double, 3, Index::kAll, Eigen::RowMajor> rows = b.transpose();
  for (int i = 0; i < Index::kAll; ++i)
    P.row(i) += a(i, 0) * rows.row(0) + a(i, 1) * rows.row(1) + a(i, 2) * rows.row(2);
}

/// Covariance of the fix with the configured floor; raising diagonal terms keeps it positive definite.
Eigen::Matrix3d fix_covariance(const GnssFix& fix, double floor_m) {
  Eigen::Matrix3d R = 0.5 * (fix.covariance_E + fix.covariance_E.transpose());
  for (int i = 0; i < 3; ++i) R(i, i) = std::max(R(i, i), floor_m * floor_m);
  CANYON_CHECK(Eigen::LLT<Eigen::Matrix3d>(R).info() == Eigen::Success, "covariance of the GNSS fix at ", fix.t.iso(),
               " is not positive definite: diagonal ", R.diagonal().transpose());
  return R;
}

/// What rounding may take off an eigenvalue of H P H': an epsilon of each of the 9 x 9 terms of an element, and of the
/// three elements of a row.
double rounding_of_HPHt(const Eigen::Matrix<double, 3, 9>& H, const ErrorMatrix& P) {
  const Eigen::Matrix<double, 3, 9> magnitude = H.cwiseAbs();
  const Eigen::Matrix3d terms =
      magnitude.lazyProduct(P.topLeftCorner<9, 9>().cwiseAbs().eval()).eval().lazyProduct(magnitude.transpose());
  return 81.0 * std::numeric_limits<double>::epsilon() * terms.rowwise().sum().maxCoeff();
}

constexpr ModelRow<ImuGains> kImuGains[] = {
    {"estimate", ImuGains::kEstimate, "beside the 15 states, if the IMU is said to have any"},
    {"ignore", ImuGains::kIgnore, "strictly 15 states"},
};

bool estimates_gains(const FilterConfig& config, const ImuNoise& noise) {
  const auto has_gain_errors = [](const TriadNoise& n) {
    return n.scale_sigma > 0.0 || n.misalignment_sigma_rad > 0.0;
  };
  return config.imu_gains == ImuGains::kEstimate && (has_gain_errors(noise.gyro) || has_gain_errors(noise.accel));
}

}  // namespace

void visit(FieldVisitor& f, FilterConfig& c) {
  f.file("imu", c.imu, ".toml", "sensor whose datasheet the filter is told; empty: the one of [imu] sensor");
  f.number("initial_attitude_sigma_deg_roll_pitch", c.initial_attitude_sigma_deg_roll_pitch, {1e-6, 180},
           "1-sigma of roll and pitch at the start");
  f.number("initial_attitude_sigma_deg_heading", c.initial_attitude_sigma_deg_heading, {1e-6, 180},
           "1-sigma of heading at the start");
  f.number("initial_position_sigma_m", c.initial_position_sigma_m, {1e-6, 1e6},
           "1-sigma of position per axis at the start");
  f.number("initial_velocity_sigma_m_s", c.initial_velocity_sigma_m_s, {1e-6, 1e3},
           "1-sigma of velocity per axis at the start");
  f.number("gate_sigma", c.gate_sigma, {0, 20},
           "fixes less likely than a deviation of this many sigma are refused; 0 accepts every fix");
  f.number("fix_sigma_floor_m", c.fix_sigma_floor_m, {0, 1e3}, "lower bound on a fix's 1-sigma per axis");
  f.choice("integrator", c.integrator, strapdown_names(), "strapdown integrator");
  f.choice("imu_gains", c.imu_gains, ModelTable<ImuGains>(kImuGains), "scale factors and misalignments of the IMU");
  f.number("imu_gain_tau_s", c.imu_gain_tau_s, {0, 1e9}, "their correlation time; 0: constant over a run");
}

ErrorStateFilter::ErrorStateFilter(const FilterConfig& config, const ImuNoise& noise, const LocalFrame& frame,
                                   const Eigen::Vector3d& lever_U_B, const Eigen::Vector3d& lever_A_B)
    : config_(config),
      processes_(noise, estimates_gains(config, noise), config.imu_gain_tau_s),
      frame_(frame),
      lever_U_B_(lever_U_B),
      lever_A_B_(lever_A_B),
      strapdown_(make_strapdown(config.integrator)) {}

void ErrorStateFilter::initialize(GpsTime t, const Pose& X_WB, const Eigen::Vector3d& v_WB_W) {
  CANYON_CHECK(X_WB.R.coeffs().allFinite() && X_WB.p.allFinite() && v_WB_W.allFinite(), "initial state at ", t.iso());
  const Eigen::Matrix3d& R_EW = frame_.R_EW();
  const Eigen::Matrix3d R_WB = X_WB.R.toRotationMatrix();
  state_ = {.t = t,
            .R_EU = (Eigen::Quaterniond(R_EW) * X_WB.R).normalized(),
            .p_EU_E = frame_.to_E(X_WB * lever_U_B_),
            .v_EU_E = R_EW * v_WB_W};
  calibration_ = {};
  w_EU_U_.setZero();
  strapdown_->reset();
  gravity_gradient_at_E_ = state_.p_EU_E;
  gravity_gradient_ = gravity_gradient_E(state_.p_EU_E);

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
    P_(Index::kGyroBias + i, Index::kGyroBias + i) = processes_.gyro_bias.sigma * processes_.gyro_bias.sigma;
    P_(Index::kAccelBias + i, Index::kAccelBias + i) = processes_.accel_bias.sigma * processes_.accel_bias.sigma;
  }
  if (processes_.with_gains) {
    for (int i = 0; i < 9; ++i) {
      P_(Index::kGyroGain + i, Index::kGyroGain + i) = gain_variance(processes_.noise.gyro, i);
      P_(Index::kAccelGain + i, Index::kAccelGain + i) = gain_variance(processes_.noise.accel, i);
    }
  }
  P_ = 0.5 * (P_ + P_.transpose()).eval();
}

void ErrorStateFilter::predict(const ImuSample& imu) {
  check_finite(imu);
  const double elapsed_s = imu.t - state_.t;
  CANYON_CHECK(std::abs(elapsed_s - imu.dt_s) <= 0.5 * imu.dt_s, "IMU sample at ", imu.t.iso(), " covers ", imu.dt_s,
               " s, but ", elapsed_s, " s have passed since the last one");
  if ((state_.p_EU_E - gravity_gradient_at_E_).squaredNorm() > kGradientReach_m * kGradientReach_m) {
    gravity_gradient_at_E_ = state_.p_EU_E;
    gravity_gradient_ = gravity_gradient_E(state_.p_EU_E);
  }

  const Increments in = calibration_.apply(imu.dt_s, imu.dtheta_U, imu.dv_U);
  const StepJacobian step(state_, in, gravity_gradient_);
  propagate_covariance(P_, step, in, calibration_, processes_);
  if (response_ != nullptr) response_->predicted(step, in, calibration_, processes_);

  strapdown_->advance(state_, in);
  state_.t = imu.t;
  w_EU_U_ = in.dtheta_U / in.dt_s - state_.R_EU.conjugate() * earth_rate_E();
  calibration_.gyro_bias *= processes_.gyro_bias.decay(imu.dt_s);
  calibration_.accel_bias *= processes_.accel_bias.decay(imu.dt_s);
  if (processes_.with_gains && config_.imu_gain_tau_s > 0.0) {
    const double decay = std::exp(-imu.dt_s / config_.imu_gain_tau_s);
    calibration_.set_gains(decay * calibration_.gyro_gain, decay * calibration_.accel_gain);
  }
}

void ErrorStateFilter::restart(const Eigen::Vector3d& innovation, const Eigen::Matrix3d& R,
                               const Eigen::Matrix3d& H_theta) {
  state_.p_EU_E += innovation;
  state_.v_EU_E.setZero();
  // The antenna is where the fix says; the IMU's place beside it is as well known as the attitude.
  const Eigen::Matrix<double, 3, Index::kAll> lever = -H_theta * P_.middleRows<3>(Index::kTheta);
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
  const double age_s = fix.t - state_.t;
  CANYON_CHECK(std::abs(age_s) <= kMaxFixAge_s, "GNSS fix at ", fix.t.iso(), " is ", age_s,
               " s away from the last IMU sample");

  const AntennaPosition antenna = antenna_position(state_, w_EU_U_, lever_A_B_ - lever_U_B_, age_s);
  const Eigen::Matrix<double, 3, 9>& H = antenna.H;
  report.innovation = fix.p_A_E - antenna.p_A_E;
  Eigen::Matrix3d R = fix_covariance(fix, config_.fix_sigma_floor_m);
  if (P_.diagonal().segment<3>(Index::kPosition).maxCoeff() > kLost_m * kLost_m) {
    restart(report.innovation, R, antenna.H.leftCols<3>());
    if (response_ != nullptr) response_->restarted(antenna.H.leftCols<3>());
    report.accepted = true;
    return report;
  }
  report.dimension = 3;

  const Columns3 PHt = P_.leftCols<9>().lazyProduct(H.transpose());
  Eigen::Matrix3d S = H.lazyProduct(PHt.topRows<9>()) + R;
  S = 0.5 * (S + S.transpose()).eval();
  Eigen::LLT<Eigen::Matrix3d> S_llt(S);
  if (S_llt.info() != Eigen::Success) {
    // Both the antenna and the fix are known better than the terms of H P H' are rounded: the fix then counts as known
    // to that rounding.
    const double rounding = rounding_of_HPHt(H, P_);
    R.diagonal().array() += rounding;
    S.diagonal().array() += rounding;
    S_llt.compute(S);
  }
  CANYON_CHECK(S_llt.info() == Eigen::Success, "innovation covariance is not positive definite: diagonal ",
               S.diagonal().transpose());
  report.nis = report.innovation.dot(S_llt.solve(report.innovation));
  // The square of more than 1e154 sigma is more than a double holds.
  if (!std::isfinite(report.nis)) report.nis = std::numeric_limits<double>::infinity();
  if (config_.gate_sigma > 0.0 && chi_square_tail(report.nis, 3) < normal_two_sided_tail(config_.gate_sigma))
    return report;
  report.accepted = true;

  const Eigen::Matrix3d S_inverse = S_llt.solve(Eigen::Matrix3d::Identity());
  const Columns3 K = PHt.lazyProduct(S_inverse);
  if (response_ != nullptr) response_->corrected(K, H);

  // Joseph: (I - K H) P (I - K H)' + K R K', as two rank-3 corrections from the left and from the right.
  add_outer(P_, -K, PHt);
  const Columns3 MHt = P_.leftCols<9>().lazyProduct(H.transpose());
  const Columns3 right = K.lazyProduct(R) - MHt;
  add_outer(P_, right, K);
  P_ = 0.5 * (P_ + P_.transpose()).eval();

  inject(K.lazyProduct(report.innovation));
  return report;
}

void ErrorStateFilter::inject(const Eigen::Matrix<double, Index::kAll, 1>& error) {
  const Eigen::Vector3d theta = error.segment<3>(Index::kTheta);
  state_.R_EU = (state_.R_EU * so3_exp(theta)).normalized();
  state_.p_EU_E += error.segment<3>(Index::kPosition);
  state_.v_EU_E += error.segment<3>(Index::kVelocity);
  calibration_.gyro_bias += error.segment<3>(Index::kGyroBias);
  calibration_.accel_bias += error.segment<3>(Index::kAccelBias);
  if (processes_.with_gains) {
    using Gain = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    const Eigen::Matrix<double, 9, 1> gyro = error.segment<9>(Index::kGyroGain);
    const Eigen::Matrix<double, 9, 1> accel = error.segment<9>(Index::kAccelGain);
    calibration_.set_gains(calibration_.gyro_gain + Eigen::Map<const Gain>(gyro.data()),
                           calibration_.accel_gain + Eigen::Map<const Gain>(accel.data()));
  }
  // The attitude error is now counted from the corrected attitude: Exp(theta + e) = Exp(theta) Exp(Jr(theta) e).
  const Eigen::Matrix3d reset = so3_right_jacobian(theta);
  Eigen::Matrix<double, 3, Index::kAll> rows = reset.lazyProduct(P_.topRows<3>());
  const Eigen::Matrix3d P_theta = rows.leftCols<3>() * reset.transpose();
  rows.leftCols<3>() = 0.5 * (P_theta + P_theta.transpose());
  P_.topRows<3>() = rows;
  P_.leftCols<3>() = rows.transpose();
}

Eigen::Matrix<double, 3, 9> ErrorStateFilter::body_jacobian() const {
  return antenna_position(state_, w_EU_U_, -lever_U_B_, 0.0).H;
}

ErrorStateFilter::StateMatrix ErrorStateFilter::covariance() const {
  return P_.topLeftCorner<kStates, kStates>();
}

NavEstimate ErrorStateFilter::estimate() const {
  const Eigen::Matrix3d R_WE = frame_.R_EW().transpose();
  const Eigen::Matrix3d R_EB = state_.R_EU.toRotationMatrix();  // axes of U are parallel to B
  NavEstimate out;
  out.t = state_.t;
  out.X_WB.R = (Eigen::Quaterniond(R_WE) * state_.R_EU).normalized();
  out.X_WB.p = frame_.to_W(state_.p_EU_E) - out.X_WB.R * lever_U_B_;
  out.v_WB_W = R_WE * (state_.v_EU_E - R_EB * w_EU_U_.cross(lever_U_B_));
  out.gyro_bias_U = calibration_.gyro_bias;
  out.accel_bias_U = calibration_.accel_bias;

  // xi = [theta; R' dp_B], and dp_B = dp_U + R [l]x theta.
  Eigen::Matrix<double, 6, kStates> J = Eigen::Matrix<double, 6, kStates>::Zero();
  J.block<3, 3>(0, Index::kTheta).setIdentity();
  J.block<3, 3>(3, Index::kTheta) = skew(lever_U_B_);
  J.block<3, 3>(3, Index::kPosition) = R_EB.transpose();
  const StateMatrix P = covariance();
  out.pose_covariance = J.lazyProduct(P).eval().lazyProduct(J.transpose());
  out.pose_covariance = 0.5 * (out.pose_covariance + out.pose_covariance.transpose()).eval();

  // dv_B = dv_U + R [w x l]x theta - R [l]x b_g, in W.
  Eigen::Matrix<double, 3, kStates> V = Eigen::Matrix<double, 3, kStates>::Zero();
  V.block<3, 3>(0, Index::kTheta) = R_WE * R_EB * skew(w_EU_U_.cross(lever_U_B_));
  V.block<3, 3>(0, Index::kVelocity) = R_WE;
  V.block<3, 3>(0, Index::kGyroBias) = -R_WE * R_EB * skew(lever_U_B_);
  out.velocity_covariance_W = V.lazyProduct(P).eval().lazyProduct(V.transpose());
  out.velocity_covariance_W = 0.5 * (out.velocity_covariance_W + out.velocity_covariance_W.transpose()).eval();
  return out;
}

}  // namespace canyon::fusion
