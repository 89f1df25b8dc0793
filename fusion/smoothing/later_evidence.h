#pragma once

#include <Eigen/Core>

namespace canyon::fusion {

/// What becomes of the errors between two records of a filter: the first nine depend on all, the others fade by
/// themselves.
struct Transition {
  Eigen::MatrixXd moving;  ///< 9 x n
  Eigen::VectorXd kept;    ///< n - 9
};

/// What the measurements after an instant say of a filter's error at it, carried backwards in time: the fixed-interval
/// smoother of Rauch, Tung & Striebel (1965, AIAA Journal 3(8)) in the form of Bryson & Frazier as Bierman modified it
/// (1973, International Journal of Control 18(1)). Of an error with the filter's covariance P it says
///   mean P lambda,   covariance P - P Lambda P,
/// the same as theirs, but no covariance is inverted: states without variance and measurements without noise are no
/// special case. Lambda is positive semidefinite by the way it is made, so that what is smoothed is never less certain
/// than the filter.
class LaterEvidence {
 public:
  /// Nothing comes later. n states.
  explicit LaterEvidence(Eigen::Index states) { forget(states); }
  void forget(Eigen::Index states);

  /// Back over a change of coordinates of the attitude error, e+ = J e.
  void before_reset(const Eigen::Matrix3d& J);
  /// Back over an update with gain K (n x m), measurement matrix H (m x n), inverse innovation covariance, and
  /// residual.
  void before_correction(const Eigen::MatrixXd& K, const Eigen::MatrixXd& H, const Eigen::MatrixXd& S_inverse,
                         const Eigen::VectorXd& residual);
  void before(const Transition& step);

  Eigen::VectorXd mean(const Eigen::MatrixXd& P) const { return P * lambda_; }
  Eigen::MatrixXd covariance(const Eigen::MatrixXd& P) const;

 private:
  Eigen::VectorXd lambda_;
  Eigen::MatrixXd information_;  // Lambda
};

}  // namespace canyon::fusion
