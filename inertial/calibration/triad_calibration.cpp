#include "canyon/inertial/calibration/triad_calibration.h"

#include <cmath>

#include <Eigen/LU>
#include <Eigen/QR>

#include "canyon/core/check.h"

namespace canyon::inertial {

Eigen::Vector3d TriadCalibration::corrected(const Eigen::Vector3d& measured) const {
  return (Eigen::Matrix3d::Identity() + gain).partialPivLu().solve(measured - bias);
}

Result<TriadCalibration> fit_to_reference(std::span<const Eigen::Vector3d> measured,
                                          std::span<const Eigen::Vector3d> truth) {
  CANYON_CHECK(measured.size() == truth.size(), measured.size(), " samples, ", truth.size(), " true ones");
  const auto n = static_cast<Eigen::Index>(measured.size());
  if (n < 5)
    return Error{.what = std::to_string(n) + " samples in common with the reference", .expected = "five or more"};
  Eigen::MatrixXd design(n, 4), errors(n, 3);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto i = static_cast<std::size_t>(k);
    design.row(k) << truth[i].transpose(), 1.0;
    errors.row(k) = (measured[i] - truth[i]).transpose();
  }
  // Of the true values' scatter about their mean, the least excited direction must be more than a thousandth.
  const Eigen::Matrix4d normal = design.transpose() * design;
  const Eigen::RowVector3d mean = design.leftCols(3).colwise().mean();
  const Eigen::MatrixXd scatter = design.leftCols(3).rowwise() - mean;
  const Eigen::VectorXd excitation =
      Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(scatter).matrixR().diagonal().cwiseAbs();
  if (!(excitation.minCoeff() > 1e-3 * excitation.maxCoeff()))
    return Error{.what = "the reference does not excite all three axes", .expected = "motion about every axis"};
  const Eigen::MatrixXd solution = design.colPivHouseholderQr().solve(errors);
  const Eigen::MatrixXd residuals = errors - design * solution;
  const Eigen::Vector4d spread = normal.inverse().diagonal().cwiseSqrt();
  TriadCalibration out;
  out.gain = solution.topRows(3).transpose();
  out.bias = solution.row(3).transpose();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double sigma = std::sqrt(residuals.col(axis).squaredNorm() / static_cast<double>(n - 4));
    out.gain_sigma.row(axis) = sigma * spread.head(3).transpose();
    out.bias_sigma[axis] = sigma * spread[3];
  }
  out.residual_rms = std::sqrt(residuals.squaredNorm() / static_cast<double>(3 * n));
  out.uncalibrated_rms = std::sqrt(errors.squaredNorm() / static_cast<double>(3 * n));
  out.used = measured.size();
  return out;
}

}  // namespace canyon::inertial
