#include "canyon/gnss/solver/ellipse_coverage.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "canyon/core/earth/earth.h"
#include "canyon/core/units.h"

namespace canyon::gnss {

void EllipseCoverage::add(const Eigen::Vector3d& error_enu_m, const Eigen::Matrix3d& covariance_enu_m2) {
  const Eigen::Vector2d e = error_enu_m.head<2>();
  const Eigen::Matrix2d P = covariance_enu_m2.topLeftCorner<2, 2>();
  const double determinant = P.determinant();
  if (!e.allFinite() || !P.allFinite() || !(determinant > 0.0)) return;
  const double square = e.dot(P.inverse() * e);
  squares_.push_back(square);
  log_sum_ += -std::log(2.0 * kPi) - 0.5 * std::log(determinant) - 0.5 * square;
}

void EllipseCoverage::add(const GnssFix& fix, const Eigen::Vector3d& true_E) {
  const Eigen::Matrix3d R = rotation_E_from_enu(geodetic_from_ecef(true_E));
  add(R.transpose() * (fix.p_A_E - true_E), R.transpose() * fix.covariance_E * R);
}

double EllipseCoverage::inside(double share) const {
  return inside_square(-2.0 * std::log(1.0 - share));  // chi-square of two degrees of freedom
}

double EllipseCoverage::inside_square(double square) const {
  if (squares_.empty()) return kNaN;
  const auto n = std::count_if(squares_.begin(), squares_.end(), [square](double s) { return s <= square; });
  return static_cast<double>(n) / static_cast<double>(squares_.size());
}

double EllipseCoverage::log_score() const {
  return squares_.empty() ? kNaN : log_sum_ / static_cast<double>(squares_.size());
}

}  // namespace canyon::gnss
