#pragma once

#include <optional>

#include "canyon/lidar/registration/registration.h"

namespace canyon::lidar {

/// What is known of a pose before surfaces are asked: log(X_prior^-1 X) is normal, with a covariance P that may be
/// singular (what is certain) and as large as 1e12 (what is unknown).
class PriorLaw {
 public:
  /// Symmetric and without roundings below 0. None of a covariance that is not finite: nothing is known then.
  static std::optional<PriorLaw> of(const PosePrior& prior);

  const Pose& pose() const { return X_; }
  /// Of xi at the prior's pose.
  const Matrix6d& covariance() const { return P_; }
  /// xi = log(X_prior^-1 X).
  Vector6d off(const Pose& X) const { return (X_.inverse() * X).log(); }
  /// The covariance as one of xi at X: a turn by which the two differ shifts what is far from the prior's place, and
  /// takes the prior's axes along.
  Matrix6d covariance_at(const Pose& X) const;
  /// Square of the distance from its pose, in its sigma; what is certain does not count.
  double distance_squared(const Pose& X) const;
  /// Covariance of xi at X where P there and `by_surfaces` are known together, with X the most probable pose by both.
  Matrix6d with(const Pose& X, const Matrix6d& by_surfaces) const;

 private:
  PriorLaw(const Pose& X, const Matrix6d& P) : X_(X), P_(P) {}
  Pose X_;
  Matrix6d P_;
};

}  // namespace canyon::lidar
