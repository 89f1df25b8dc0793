#include "canyon/lidar/registration/engine/covariance_forms.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "canyon/core/random/random.h"
#include "canyon/lidar/registration/engine/match_form.h"

namespace canyon::lidar {
namespace {

Matrix6d hessian(const CovarianceCase& of) {
  return of.sums.cost / static_cast<double>(std::max<std::int64_t>(of.sums.matched - 6, 1)) * of.sums.A;
}

Matrix6d sandwich(const CovarianceCase& of) {
  return gradient_scatter(of.sums);
}

/// Censi 2007, "An accurate closed-form estimate of ICP's covariance": independent noise of each matched point of both
/// clouds through the implicit function of the minimum.
Matrix6d censi(const CovarianceCase& of) {
  return 2.0 * of.point_sigma_m * of.point_sigma_m * of.sums.point_noise;
}

/// Bootstrap over the cloud's blocks: the step that each of 200 resamplings would take from the solution.
Matrix6d sampled(const CovarianceCase& of) {
  constexpr std::size_t kDraws = 200;
  const std::size_t blocks = of.sums.block_gradients.size();
  if (blocks < 12) return sandwich(of);  // as few blocks leave out whole walls when drawn
  const RandomStream random(1, "registration.bootstrap");
  Matrix6d squares = Matrix6d::Zero();
  for (std::size_t draw = 0; draw < kDraws; ++draw) {
    Matrix6d A = Matrix6d::Zero();
    Vector6d g = Vector6d::Zero();
    for (std::size_t k = 0; k < blocks; ++k) {
      const auto b = std::min(
          static_cast<std::size_t>(random.uniform(static_cast<std::uint32_t>(k), draw) * static_cast<double>(blocks)),
          blocks - 1);
      A += of.sums.block_curvatures[b];
      g += of.sums.block_gradients[b];
    }
    const Vector6d step = A.ldlt().solve(g);
    if (step.allFinite()) squares += step * step.transpose();
  }
  return of.sums.A * (squares / static_cast<double>(kDraws)) * of.sums.A;
}

/// Brossard, Bonnabel and Barrau 2020, "A new approach to 3D ICP covariance estimation": what the guess leaves in the
/// result (unscented, 12 registrations), white noise of the points, and a bias common to all of a cloud's ranges.
Matrix6d guess_and_bias(const CovarianceCase& of) {
  Matrix6d spread = Matrix6d::Zero();
  for (const Vector6d& xi : of.restarts) spread += xi * xi.transpose() / static_cast<double>(of.restarts.size());
  // Of the two clouds' biases only what differs moves the result: the root of two.
  const Vector6d bias = std::sqrt(2.0) * of.range_bias_m * of.sums.common_range;
  return of.sums.A * spread * of.sums.A + censi(of) + bias * bias.transpose();
}

constexpr ModelRow<CovarianceForm> kForms[] = {
    {"hessian", {hessian, false, false, false}, "every residual by itself: s^2 A^-1, known to be far too small"},
    {"sandwich", {sandwich, false, false, false}, "from the residuals themselves, by blocks of the cloud"},
    {"calibrated", {sandwich, false, true, false}, "the sandwich, wider where few blocks tell of a direction"},
    {"censi", {censi, false, false, true}, "independent noise of the points alone, known to be too small"},
    {"sampled", {sampled, false, false, false}, "bootstrap over blocks of the cloud"},
    {"guess_and_bias", {guess_and_bias, true, false, true}, "where other guesses end, noise, and a bias of all ranges"},
};

}  // namespace

ModelTable<CovarianceForm> covariance_forms() {
  return kForms;
}

}  // namespace canyon::lidar
