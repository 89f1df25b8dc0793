#pragma once

#include <Eigen/Core>

namespace canyon::inertial {

/// A linear system with one input, driven by white noise: ds/dt = A s + B u + w, output C s.
/// `intensity` is that of w: the covariance of the integral of w over dt is intensity * dt, the two-sided spectral
/// density. States are scaled so that A's entries are rates of one order (position times resonance, not position):
/// matrix exponentials of unscaled mechanics lose ten digits.
struct LinearPlant {
  Eigen::MatrixXd A;
  Eigen::VectorXd B;
  Eigen::RowVectorXd C;
  Eigen::MatrixXd intensity;

  Eigen::Index size() const { return A.rows(); }
  /// |C (j w - A)^-1 B|.
  double gain(double frequency_hz) const;
  /// The state in which a constant input leaves the system at rest. A must be invertible.
  Eigen::VectorXd rest(double u) const;
};

/// The plant over one step h, input held constant: s+ = phi s + gamma u + n, n of covariance `covariance`.
struct DiscretePlant {
  Eigen::MatrixXd phi;
  Eigen::VectorXd gamma;
  Eigen::MatrixXd covariance;
};

/// `second` driven by `first`'s output. Its own noise stays.
LinearPlant in_series(const LinearPlant& first, const LinearPlant& second);

/// Butterworth low-pass of order 1 to 4, gain 1 at rest, -3 dB at `corner_hz`; no noise.
LinearPlant butterworth(int order, double corner_hz);

/// The plant with one more state, last: the integral of its output.
LinearPlant with_integral(const LinearPlant& plant);

/// L with L L^T = covariance, also where that is singular.
Eigen::MatrixXd noise_root(const Eigen::MatrixXd& covariance);

/// Largest magnitude of the eigenvalues: what a step multiplies its slowest state by. 1 or more: the step diverges.
double spectral_radius(const Eigen::MatrixXd& phi);

}  // namespace canyon::inertial
