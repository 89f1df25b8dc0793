#pragma once

#include <array>

#include <Eigen/Core>

namespace canyon::fusion {

/// What a first-order Gauss-Markov process x' = -x / tau + w does over a step, exactly, whatever the step is to its
/// correlation time: the discretization of Van Loan (1978, IEEE Trans. Automatic Control 23(3)) of x and its integrals
/// I_1 (of x), I_2 (of I_1) and I_3 (of I_2), which all start at zero.
struct MarkovMoments {
  double decay = 1.0;               ///< of x
  std::array<double, 3> carried{};  ///< I_1, I_2, I_3 at the end, of an x that was 1 at the start: s, s^2, s^3
  Eigen::Matrix4d driven;           ///< covariance of [I_1, I_2, I_3, x] at the end that w of unit density makes

  /// dt_s > 0; tau_s > 0, infinite for a random walk.
  MarkovMoments(double dt_s, double tau_s);
};

/// Covariance of [I_1, I_2, I_3] after dt_s if x is white noise of unit density itself.
Eigen::Matrix3d white_moments(double dt_s);

}  // namespace canyon::fusion
