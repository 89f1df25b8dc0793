#pragma once

#include <vector>

#include "canyon/core/motion/rotation.h"

namespace canyon::lidar {

/// Directions of xi, source frame, measured where a rotation counts by what it moves at `radius_m`. The open ones are
/// of length 1 and at right angles.
class OpenDirections {
 public:
  explicit OpenDirections(double radius_m, std::vector<Vector6d> open = {});

  const std::vector<Vector6d>& open() const { return open_; }
  bool empty() const { return open_.empty(); }
  /// Takes in what of `v` is at right angles to those before; false: nothing is.
  bool add(const Vector6d& v);

  /// What is left of xi at right angles to the open directions.
  Vector6d closed_part(const Vector6d& xi) const;
  /// X moved along its open directions alone, until log(X_prior^-1 X) has no part along them. The move is X Exp(v), in
  /// the frame where the directions were found: were it taken out of the logarithm, a turn between the two poses would
  /// lead it off the surfaces by half its angle.
  Pose held_at(const Pose& X_prior, Pose X) const;
  /// Columns: directions at right angles to the open ones, of length 1. `dual`: what takes xi to its coordinates.
  Eigen::MatrixXd closed_basis() const;
  Eigen::MatrixXd closed_dual() const;
  /// Opens the closed directions along which `covariance` has more than sigma_m.
  void open_wide(const Matrix6d& covariance, double sigma_m);
  /// `covariance` in the closed directions, and `sigma_m` along the open ones.
  Matrix6d with_open(const Matrix6d& covariance, double sigma_m) const;
  /// What the open directions' own uncertainty adds to the closed ones: whoever holds a pose at a prior of covariance P
  /// along a direction that leans, leads it off the surfaces. H: curvature by surfaces; along an open v it is what
  /// errors of the normals feign, so that v leans by H_cv / H_cc, of which the square is at most v^T H v / H_cc (Cauchy
  /// and Schwarz), and a share of 1 / pieces where as many pieces of the cloud err independently.
  Matrix6d leaning(const Matrix6d& H, double pieces, const Matrix6d& P) const;

 private:
  Eigen::MatrixXd closed_scaled() const;
  Vector6d root_;  ///< y = root xi is Euclidean
  std::vector<Vector6d> open_;
};

}  // namespace canyon::lidar
