#pragma once

#include <span>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "canyon/core/messages.h"
#include "canyon/fusion/error_state.h"
#include "canyon/fusion/filter_config.h"
#include "canyon/fusion/propagation/error_propagation.h"

namespace canyon::fusion {

/// What an IMU measured between two instants, independent of where it was: rotation, change of velocity and of position
/// by specific force alone, seen from axes that stand still in inertial space and were U's at the first instant
/// (Forster, Carlone, Dellaert & Scaramuzza 2017, IEEE Trans. Robotics 33(1)). Earth rate and gravity enter where it is
/// used (imu_factor.h).
struct PreintegratedImu {
  double dt_s = 0.0;
  Eigen::Quaterniond dR = Eigen::Quaterniond::Identity();
  Eigen::Vector3d dv = Eigen::Vector3d::Zero();  ///< m/s
  Eigen::Vector3d dp = Eigen::Vector3d::Zero();  ///< m
  /// Values of the states after the first nine at the first instant, with which the sensors' errors were taken out.
  Eigen::VectorXd values;
  /// Derivative of [dR (right perturbation), dp, dv] by them, 9 x m.
  Eigen::MatrixXd by_values;
  Eigen::VectorXd kept;  ///< what is left of each of them at the second instant
  /// Of the noise in [dR, dp, dv] and in the values' own processes, n x n with n = 9 + m.
  Eigen::MatrixXd covariance;

  /// [dR, dp, dv] of other values, to first order.
  PreintegratedImu moved_to(const Eigen::VectorXd& other) const;
};

/// Integrates samples with coning and sculling from two of them (the strapdown row `two_sample`: second order in the
/// sample interval), in double precision. The derivative is that of this sum, exactly; the covariance is that of the
/// filter (error_propagation.h), of any of its states.
class Preintegrator {
 public:
  Preintegrator(const FilterConfig& config, const ImuNoise& noise);

  /// The layout of the states.
  const ErrorState& state() const { return state_; }
  /// `before`: the sample before the first, or null. `values`: as in PreintegratedImu.
  PreintegratedImu integrate(std::span<const ImuSample> samples, const ImuSample* before,
                             const Eigen::VectorXd& values);

 private:
  /// Increments without the sensors' known errors, and their derivative by the values at the start, 3 x m each.
  struct Sample {
    Increments in;
    Eigen::Matrix<double, 3, Eigen::Dynamic> dtheta, dv;
  };
  Sample calibrated(const ImuSample& raw, const Calibration& known, const Eigen::VectorXd& share);

  ErrorState state_;
  ErrorPropagation propagation_;
};

}  // namespace canyon::fusion
