#pragma once

#include <vector>

#include <Eigen/Core>

#include "canyon/core/imu_noise.h"
#include "canyon/fusion/error_state.h"
#include "canyon/fusion/propagation/markov_moments.h"
#include "canyon/fusion/propagation/row_kernels.h"
#include "canyon/fusion/propagation/step_jacobian.h"

namespace canyon::fusion {

/// What one step of the IMU does to errors and to their covariance: the linearized strapdown step, and the processes of
/// the state blocks with what they feed into it, discretized exactly for force and attitude that are constant within
/// the step (Van Loan; markov_moments.h). Two parts: what depends on the length of the step alone, and the rest.
class ErrorPropagation {
 public:
  /// `noise`: its white parts drive attitude and velocity; the rest is the state blocks'.
  ErrorPropagation(const ErrorState& state, const ImuNoise& noise);

  /// Of the steps that follow. Costs nothing while the length stays the same.
  void set_interval(double dt_s);
  /// What is left of each state at the end of a step, and what its mean over the step is, of what it was at the start;
  /// 1 for attitude, position and velocity.
  const Eigen::VectorXd& decay() const { return decay_; }
  const Eigen::VectorXd& mean_share() const { return mean_share_; }

  /// The next step, of the length last set: `state` at its start, increments without the known errors `imu`, and the
  /// gravity gradient in E.
  void set_step(ErrorState& state, const Increments& in, const Calibration& imu,
                const Eigen::Matrix3d& gravity_gradient);
  /// The same, of a step that somebody else has linearized.
  void set_step(ErrorState& state, const Increments& in, const StepJacobian& jacobian);
  /// Covariance over the step. Symmetric to the bit before and after.
  void propagate(ErrorMatrix& P);
  /// Errors over the step, column by column, without noise.
  void move(ErrorMatrix& errors);

 private:
  /// States that share one correlation time, and what they feed.
  struct Group {
    double tau_s = 0.0;
    MarkovMoments moments{1.0, 1.0};
    std::vector<int> states;
    std::vector<FeedTerm> terms;
  };
  /// Covariance, per axis, of the integrals of the white and driven parts of the IMU's error.
  struct AxisNoise {
    double m11 = 0.0, m12 = 0.0, m13 = 0.0, m22 = 0.0, m23 = 0.0, m33 = 0.0;
    void add(const Eigen::Matrix4d& moments, double density);
  };

  void integrate(const double* errors, int stride, int width);
  void add_noise(ErrorMatrix& P);
  void add_driven(ErrorMatrix& P, const Group& group);
  void add_drift(ErrorMatrix& P);

  int size_, padded_;
  ImuNoise noise_;
  double dt_s_ = 0.0;
  bool fades_ = false;
  Eigen::VectorXd decay_, mean_share_, density_;
  std::vector<Group> groups_;
  std::vector<int> group_of_;  // of each state
  std::vector<ErrorState::Integral> integrals_of_;
  StepCoefficients step_{};
  AxisNoise white_[2], axes_[6];  // of the triads' white noise alone, and of all that drives each axis
  // Scratch: integrals of the IMU's error; [theta, p, v] after the step; their transpose; and its [theta, p, v].
  ErrorMatrix integrals_, half_, half_transposed_, twice_;
};

}  // namespace canyon::fusion
