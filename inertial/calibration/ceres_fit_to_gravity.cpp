#include <array>
#include <cmath>

#include <ceres/ceres.h>
#include <Eigen/LU>
#include <Eigen/QR>

#include "canyon/core/check.h"
#include "canyon/core/process/progress.h"
#include "canyon/inertial/calibration/triad_calibration.h"
#include "canyon/inertial/ceres_cancel_callback.h"
#include "canyon/inertial/ceres_part.h"

namespace canyon::inertial {

namespace {

// Bias, then the lower triangle of gain: xx, yx, yy, zx, zy, zz.
constexpr int kParameters = 9;
constexpr int kTriangle[6][2] = {{0, 0}, {1, 0}, {1, 1}, {2, 0}, {2, 1}, {2, 2}};

/// Magnitude of the corrected mean of one position, against gravity.
struct Magnitude {
  Eigen::Vector3d measured;
  double sigma, gravity;

  template <class T>
  bool operator()(const T* p, T* residual) const {
    // (I + gain)^-1 by forward substitution.
    const T x = (measured.x() - p[0]) / (1.0 + p[3]);
    const T y = (measured.y() - p[1] - p[4] * x) / (1.0 + p[5]);
    const T z = (measured.z() - p[2] - p[6] * x - p[7] * y) / (1.0 + p[8]);
    using std::sqrt;
    residual[0] = (sqrt(x * x + y * y + z * z) - gravity) / sigma;
    return true;
  }
};

}  // namespace

Result<TriadCalibration> fit_to_gravity_with_ceres(std::span<const Eigen::Vector3d> positions, double sigma_m_s2,
                                                   double gravity_m_s2) {
  CANYON_CHECK(sigma_m_s2 > 0.0 && gravity_m_s2 > 0.0, "sigma ", sigma_m_s2, ", gravity ", gravity_m_s2);
  if (positions.size() < static_cast<std::size_t>(kParameters))
    return Error{.what = std::to_string(positions.size()) + " resting positions",
                 .expected = "nine or more, each axis up and down and some between"};
  std::array<double, kParameters> p{};
  ceres::Problem problem;
  double before = 0.0;
  for (const Eigen::Vector3d& f : positions) {
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<Magnitude, 1, kParameters>(new Magnitude{f, sigma_m_s2, gravity_m_s2}), nullptr,
        p.data());
    before += std::pow(f.norm() - gravity_m_s2, 2);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  options.function_tolerance = 1e-14;
  options.parameter_tolerance = 1e-14;
  options.max_num_iterations = 100;
  const auto cancel = make_cancel_callback();
  options.callbacks.push_back(cancel.get());
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  throw_if_cancelled();
  // Covariance from the normal equations, which positions that leave a direction open make singular.
  ceres::CRSMatrix sparse;
  problem.Evaluate(ceres::Problem::EvaluateOptions(), nullptr, nullptr, nullptr, &sparse);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(sparse.num_rows, sparse.num_cols);
  for (int row = 0; row < sparse.num_rows; ++row)
    for (int i = sparse.rows[static_cast<std::size_t>(row)]; i < sparse.rows[static_cast<std::size_t>(row) + 1]; ++i)
      jacobian(row, sparse.cols[static_cast<std::size_t>(i)]) = sparse.values[static_cast<std::size_t>(i)];
  const Eigen::VectorXd pivots = jacobian.colPivHouseholderQr().matrixR().diagonal().cwiseAbs();
  if (!summary.IsSolutionUsable() || !(pivots.minCoeff() > 1e-6 * pivots.maxCoeff()))
    return Error{.what = "the " + std::to_string(positions.size()) + " positions leave a parameter open",
                 .expected = "each axis up and down and some positions between"};
  const Eigen::MatrixXd covariance = (jacobian.transpose() * jacobian).inverse();
  const auto n = static_cast<double>(positions.size());
  // Means that agree worse than their noise says (tilting supports, vibration) widen the sigmas.
  const double inflation =
      n > kParameters ? std::sqrt(std::max(1.0, 2.0 * summary.final_cost / (n - kParameters))) : 1.0;
  TriadCalibration out;
  const auto sigma_of = [&](int i) { return inflation * std::sqrt(covariance(i, i)); };
  for (int i = 0; i < 3; ++i) {
    out.bias[i] = p[static_cast<std::size_t>(i)];
    out.bias_sigma[i] = sigma_of(i);
  }
  for (int i = 0; i < 6; ++i) {
    out.gain(kTriangle[i][0], kTriangle[i][1]) = p[static_cast<std::size_t>(3 + i)];
    out.gain_sigma(kTriangle[i][0], kTriangle[i][1]) = sigma_of(3 + i);
  }
  out.residual_rms = sigma_m_s2 * std::sqrt(2.0 * summary.final_cost / n);
  out.uncalibrated_rms = std::sqrt(before / n);
  out.used = positions.size();
  return out;
}

}  // namespace canyon::inertial
