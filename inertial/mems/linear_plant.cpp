#include "canyon/inertial/mems/linear_plant.h"

#include <array>
#include <cmath>
#include <complex>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "canyon/core/check.h"
#include "canyon/core/units.h"

namespace canyon::inertial {

double LinearPlant::gain(double frequency_hz) const {
  const std::complex<double> jw(0.0, 2.0 * kPi * frequency_hz);
  const Eigen::MatrixXcd resolvent = jw * Eigen::MatrixXcd::Identity(size(), size()) - A.cast<std::complex<double>>();
  const Eigen::VectorXcd response = resolvent.partialPivLu().solve(B.cast<std::complex<double>>());
  return std::abs((C.cast<std::complex<double>>() * response)(0));
}

Eigen::VectorXd LinearPlant::rest(double u) const {
  return -A.fullPivLu().solve(B * u);
}

LinearPlant in_series(const LinearPlant& first, const LinearPlant& second) {
  const Eigen::Index n = first.size(), m = second.size();
  LinearPlant out;
  out.A = Eigen::MatrixXd::Zero(n + m, n + m);
  out.A.topLeftCorner(n, n) = first.A;
  out.A.bottomRightCorner(m, m) = second.A;
  out.A.bottomLeftCorner(m, n) = second.B * first.C;
  out.B = Eigen::VectorXd::Zero(n + m);
  out.B.head(n) = first.B;
  out.C = Eigen::RowVectorXd::Zero(n + m);
  out.C.tail(m) = second.C;
  out.intensity = Eigen::MatrixXd::Zero(n + m, n + m);
  out.intensity.topLeftCorner(n, n) = first.intensity;
  out.intensity.bottomRightCorner(m, m) = second.intensity;
  return out;
}

LinearPlant butterworth(int order, double corner_hz) {
  CANYON_CHECK(order >= 1 && order <= 4 && corner_hz > 0.0, "order ", order, ", corner ", corner_hz, " Hz");
  // Coefficients of 1, s, s^2, s^3 of the normalised polynomials; the highest is 1.
  static const std::array<std::array<double, 4>, 4> kCoefficients = {
      {{1.0, 0.0, 0.0, 0.0},
       {1.0, std::sqrt(2.0), 0.0, 0.0},
       {1.0, 2.0, 2.0, 0.0},
       {1.0, 2.0 * (std::cos(kPi / 8.0) + std::sin(kPi / 8.0)), 2.0 + std::sqrt(2.0),
        2.0 * (std::cos(kPi / 8.0) + std::sin(kPi / 8.0))}}};
  const double w = 2.0 * kPi * corner_hz;
  LinearPlant out;
  out.A = Eigen::MatrixXd::Zero(order, order);
  for (int i = 0; i + 1 < order; ++i) out.A(i, i + 1) = w;
  for (int i = 0; i < order; ++i)
    out.A(order - 1, i) = -w * kCoefficients[static_cast<std::size_t>(order - 1)][static_cast<std::size_t>(i)];
  out.B = Eigen::VectorXd::Zero(order);
  out.B(order - 1) = w;
  out.C = Eigen::RowVectorXd::Zero(order);
  out.C(0) = 1.0;
  out.intensity = Eigen::MatrixXd::Zero(order, order);
  return out;
}

LinearPlant with_integral(const LinearPlant& plant) {
  const Eigen::Index n = plant.size();
  LinearPlant integral;
  integral.A = Eigen::MatrixXd::Zero(1, 1);
  integral.B = Eigen::VectorXd::Ones(1);
  integral.C = Eigen::RowVectorXd::Ones(1);
  integral.intensity = Eigen::MatrixXd::Zero(1, 1);
  LinearPlant out = in_series(plant, integral);
  CANYON_CHECK(out.size() == n + 1, "states ", out.size());
  return out;
}

Eigen::MatrixXd noise_root(const Eigen::MatrixXd& covariance) {
  // The parts differ by many powers of ten; scaled to correlations, the small ones keep their digits.
  const Eigen::VectorXd sigma = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Eigen::VectorXd inverse = sigma.unaryExpr([](double s) { return s > 0.0 ? 1.0 / s : 0.0; });
  const Eigen::MatrixXd correlation = inverse.asDiagonal() * covariance * inverse.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(correlation);
  return sigma.asDiagonal() * eigen.eigenvectors() *
         eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal().toDenseMatrix();
}

double spectral_radius(const Eigen::MatrixXd& phi) {
  return phi.size() > 0 ? phi.eigenvalues().cwiseAbs().maxCoeff() : 0.0;
}

}  // namespace canyon::inertial
