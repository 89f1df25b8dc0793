#pragma once

#include <cstdint>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace canyon::fusion {

/// Normalized squared error e' P^-1 e: NEES of an estimation error, NIS of an innovation. Chi-square distributed with
/// as many degrees of freedom as e has, mean that number, if P is right. NaN if P is not positive definite.
template <class Error, class Covariance>
double normalized_squared(const Eigen::MatrixBase<Error>& e, const Eigen::MatrixBase<Covariance>& P) {
  const auto llt = P.eval().llt();
  if (llt.info() != Eigen::Success) return std::numeric_limits<double>::quiet_NaN();
  return e.dot(llt.solve(e));
}

/// Probability that a chi-square variable of `dof` degrees of freedom (1 to 100) exceeds x >= 0.
double chi_square_tail(double x, int dof);
/// Probability that |z| > sigma for a standard normal z.
double normal_two_sided_tail(double sigma);

/// Interval that the mean of `count` independent chi-square(dof) values leaves with probability `false_alarm`, both
/// sides together, by the Wilson-Hilferty approximation (relative error below 1 % for count * dof >= 30).
struct Band {
  double low = 0.0;
  double high = 0.0;
  bool contains(double x) const { return low <= x && x <= high; }
};
Band mean_chi_square_band(int dof, std::int64_t count, double false_alarm);

/// Running mean of normalized squared errors.
class ConsistencyMean {
 public:
  void add(double normalized, int dof);
  std::int64_t count() const { return count_; }
  /// Mean of normalized / dof; 1 is consistent, above 1 too confident. NaN before the first value.
  double per_state() const;

 private:
  std::int64_t count_ = 0;
  double sum_ = 0.0, dof_ = 0.0;
};

}  // namespace canyon::fusion
