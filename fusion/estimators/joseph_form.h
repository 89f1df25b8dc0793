#pragma once

#include "canyon/fusion/estimators/estimator.h"

namespace canyon::fusion {

/// P by itself: (I - K H) P (I - K H)' + K R K', symmetric to the bit (Bucy & Joseph 1968).
class JosephForm {
 public:
  void set(const ErrorMatrix& P) { P_ = P; }
  const ErrorMatrix& covariance() const { return P_; }
  void propagate(ErrorPropagation& step) { step.propagate(P_); }
  void correct(const Measurement& m, const Gain& K, const Measurement::Rows& HP);
  /// Attitude errors are counted from an attitude corrected by `theta`: Exp(theta + e) = Exp(theta) Exp(Jr(theta) e).
  void reset_attitude(const Eigen::Vector3d& theta);
  /// The errors of attitude, position and velocity become T times themselves.
  void transform(const Eigen::Matrix<double, 9, 9>& T);

 private:
  ErrorMatrix P_;
};

}  // namespace canyon::fusion
