#include <algorithm>
#include <cmath>

#include "canyon/core/check.h"
#include "canyon/inertial/mems/integrator.h"

namespace canyon::inertial {
namespace {

/// exp of a matrix of norm below 1/2: the series, to the last digit.
Eigen::MatrixXd short_exponential(const Eigen::MatrixXd& m) {
  Eigen::MatrixXd term = Eigen::MatrixXd::Identity(m.rows(), m.cols()), sum = term;
  for (int k = 1; k <= 24; ++k) {
    term = term * m / k;
    sum += term;
  }
  return sum;
}

}  // namespace

/// On a step short enough for the series: phi = exp(A h), gamma from the matrix bordered with B, the covariance by Van
/// Loan (1978). Then the step is doubled until it is whole:
///   phi(2h) = phi^2,  gamma(2h) = phi gamma + gamma,  covariance(2h) = phi covariance phi^T + covariance.
/// The doubling only adds what is not negative; Van Loan's matrix over the whole step holds exp(-A h), which has no
/// digits left where the damping is strong (e^251 at 5 kHz, Q = 1/2 and 125 samples/s).
DiscretePlant exact_step(const LinearPlant& plant, double step_s) {
  const Eigen::Index n = plant.size();
  const double norm = plant.A.cwiseAbs().rowwise().sum().maxCoeff() * step_s;
  CANYON_CHECK(step_s > 0.0 && std::isfinite(norm), "step ", step_s, " s, norm ", norm);
  const int doublings = std::max(0, static_cast<int>(std::ceil(std::log2(std::max(norm, 1e-3) * 4.0))));
  const double h = std::ldexp(step_s, -doublings);

  Eigen::MatrixXd bordered = Eigen::MatrixXd::Zero(n + 1, n + 1);
  bordered.topLeftCorner(n, n) = plant.A * h;
  bordered.topRightCorner(n, 1) = plant.B * h;
  const Eigen::MatrixXd step = short_exponential(bordered);
  Eigen::MatrixXd loan = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  loan.topLeftCorner(n, n) = -plant.A * h;
  // Scaled to 1, as the intensities may be of any size.
  const double scale = std::max(plant.intensity.cwiseAbs().maxCoeff() * h, 1e-300);
  loan.topRightCorner(n, n) = plant.intensity * (h / scale);
  loan.bottomRightCorner(n, n) = plant.A.transpose() * h;
  const Eigen::MatrixXd noise = short_exponential(loan);

  DiscretePlant out{step.topLeftCorner(n, n), step.topRightCorner(n, 1), {}};
  out.covariance = scale * noise.bottomRightCorner(n, n).transpose() * noise.topRightCorner(n, n);
  for (int k = 0; k < doublings; ++k) {
    out.covariance += (out.phi * out.covariance * out.phi.transpose()).eval();
    out.gamma += (out.phi * out.gamma).eval();
    out.phi *= out.phi.eval();
  }
  out.covariance = (0.5 * (out.covariance + out.covariance.transpose())).eval();
  return out;
}

}  // namespace canyon::inertial
