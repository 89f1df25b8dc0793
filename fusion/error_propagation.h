#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "canyon/core/imu_noise.h"
#include "canyon/fusion/strapdown.h"

namespace canyon::fusion {

/// Layout of the error state. The first 15 are the navigation states; the last 18 are gain errors of the two triads
/// (row-major 3 x 3 each: scale factors on the diagonal, misalignments off it), which the filter carries so that its
/// covariance knows of them.
///   theta: right perturbation of R_EU, rad      b_g: rad/s       K_g: measured = (I + K_g) w + b_g + noise
///   p, v: additive, in E, m and m/s             b_a: m/s^2       K_a: measured = (I + K_a) f + b_a + noise
/// Every error is truth minus estimate (R = R_hat Exp(theta)).
struct ErrorIndex {
  static constexpr int kTheta = 0, kPosition = 3, kVelocity = 6, kGyroBias = 9, kAccelBias = 12;
  static constexpr int kNavigation = 15;
  static constexpr int kGyroGain = 15, kAccelGain = 24;
  static constexpr int kAll = 33;
};
/// Row-major, because propagation combines rows.
using ErrorMatrix = Eigen::Matrix<double, ErrorIndex::kAll, ErrorIndex::kAll, Eigen::RowMajor>;

/// Bias of one triad within three states: turn-on constant and in-run process in one.
///
/// A random constant c (sigma_c) plus a Gauss-Markov process (sigma_r, tau) would need two states per axis. One state
/// driven like the Gauss-Markov part but of the total variance stands for both:
///   sigma^2 = sigma_c^2 + sigma_r^2,   tau' = tau sigma^2 / sigma_r^2,
/// whose driving density 2 sigma^2 / tau' = 2 sigma_r^2 / tau is that of the in-run part, and whose variance never
/// exceeds the total. With sigma_c = 0 it is the Gauss-Markov process itself; with sigma_c >> sigma_r it forgets over
/// tau' >> tau. Using tau itself would make the filter forget the turn-on bias within tau and believe it had not.
struct BiasModel {
  double sigma = 0.0;
  double tau_s = 0.0;  ///< infinite if there is no in-run process

  explicit BiasModel(const TriadNoise& noise);
  double decay(double dt_s) const;           ///< exp(-dt / tau')
  double added_variance(double dt_s) const;  ///< sigma^2 (1 - decay^2)
};

/// Variance of element `element` (0..8, row-major) of a triad's gain error: scale factor on the diagonal, else
/// misalignment.
double gain_variance(const TriadNoise& noise, int element);

/// Linearization of one strapdown step: x = [theta, p, v] after it, from x before it and the errors z = [dtheta, dv] of
/// the increments fed in:
///   theta+ = theta_theta theta + theta_z z_g
///   v+     = v_theta theta + v_p p + v_v v + v_zg z_g + v_za z_a
///   p+     = p + (v + v+) dt / 2
struct StepJacobian {
  double dt_s = 0.0;
  Eigen::Matrix3d theta_theta, theta_zg;
  Eigen::Matrix3d v_theta, v_p, v_v, v_zg, v_za;

  /// `before`: state at the start of the interval; `in`: increments fed in; `gravity_gradient`: in E, at `before`.
  StepJacobian(const NavState& before, const Increments& in, const Eigen::Matrix3d& gravity_gradient);
};

/// What the filter knows of the IMU's errors: biases and gain errors K, taken out of raw increments.
struct Calibration {
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero(), accel_bias = Eigen::Vector3d::Zero();
  Eigen::Matrix3d gyro_gain = Eigen::Matrix3d::Zero(), accel_gain = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d gyro_inverse = Eigen::Matrix3d::Identity(), accel_inverse = Eigen::Matrix3d::Identity();

  /// Sets the gain errors and with them the inverses (I + K)^-1.
  void set_gains(const Eigen::Matrix3d& gyro, const Eigen::Matrix3d& accel);
  /// (I + K)^-1 (raw - bias dt).
  Increments apply(double dt_s, const Eigen::Vector3d& dtheta_raw, const Eigen::Vector3d& dv_raw) const;
};

/// The processes behind the errors of the increments.
struct ErrorProcesses {
  ErrorProcesses(const ImuNoise& noise, bool with_gains, double gain_tau_s);

  ImuNoise noise;
  BiasModel gyro_bias, accel_bias;
  bool with_gains;    ///< the 18 gain errors take part
  double gain_tau_s;  ///< their correlation time; 0: constant
};

/// Covariance over one step: white noise of the increments, bias and gain processes, and what the errors of biases and
/// gains do to attitude, velocity and position. Keeps P exactly symmetric. `in` are the calibrated increments.
void propagate_covariance(ErrorMatrix& P, const StepJacobian& step, const Increments& in,
                          const Calibration& calibration, const ErrorProcesses& processes);

/// Errors over one step, column by column: what propagate_covariance() does to its rows, without noise.
void propagate_errors(ErrorMatrix& errors, const StepJacobian& step, const Increments& in,
                      const Calibration& calibration, const ErrorProcesses& processes);

}  // namespace canyon::fusion
