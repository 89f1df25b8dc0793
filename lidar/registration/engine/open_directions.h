#pragma once

#include <span>
#include <vector>

#include "canyon/core/motion/rotation.h"
#include "canyon/lidar/registration/engine/prior_law.h"

namespace canyon::lidar {

/// What open directions add to the others' uncertainty.
struct Leaning {
  Matrix6d covariance = Matrix6d::Zero();  ///< of xi
  double directions = 1.0;                 ///< of how many open ones, as alike as Satterthwaite (1946) counts them
};

/// By how much a Leaning has to grow for its 99.9 % ellipsoid of the closed directions, 1 to 5, to be one. The error is
/// a product, of how far off the pose is along an open direction and of how much that leans. If both are normal, and
/// `open` directions lean alike in all the closed ones, its square is chi-square with `open` degrees of freedom, over
/// their number, times chi-square with `closed`, which has longer tails than a normal law of the same covariance: 4.17
/// with one open and five closed, 2.18 with three of each. Between whole numbers of open ones linear (within 3 %); more
/// than three count as three. Of the whole pose, whose open direction errs with it, 0.3 to 0.4 % then lie beyond.
double product_over_normal(double open, int closed);

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
  /// X moved along its open directions alone, to where a prior has its most probable pose given all others. The move is
  /// X Exp(v), in the frame where the directions were found: were it taken out of the logarithm, a turn between the two
  /// poses would lead it off the surfaces by half its angle.
  Pose held_at(const PriorLaw& prior, Pose X) const;
  /// Columns: directions at right angles to the open ones, of length 1. `dual`: what takes xi to its coordinates.
  Eigen::MatrixXd closed_basis() const;
  Eigen::MatrixXd closed_dual() const;
  /// Opens the closed directions along which `covariance` has a shift of more than sigma_m, or a turn of more than
  /// sigma_rad.
  void open_wide(const Matrix6d& covariance, double sigma_m, double sigma_rad);
  /// `covariance` in the closed directions, and `sigma_m` along the open ones.
  Matrix6d with_open(const Matrix6d& covariance, double sigma_m) const;
  /// What the open directions' own uncertainty adds to the closed ones: whoever holds a pose along a direction that
  /// leans leads it off the surfaces. `curvatures`: by surfaces alone, of each block of the cloud; `prior`: of xi where
  /// they were found. Along an open v the curvature H is what errors of the normals feign, so that v leans by
  /// H_cc^-1 H_cv, and how much that may be is told by how the blocks scatter about nothing: the sandwich again. With
  /// too few blocks for that, by the square's bound v^T H v / H_cc (Cauchy and Schwarz), a share of 1 / blocks of it.
  Leaning leaning(std::span<const Matrix6d> curvatures, const Matrix6d& prior) const;

 private:
  Eigen::MatrixXd open_scaled() const;
  Eigen::MatrixXd closed_scaled() const;
  Vector6d root_;  ///< y = root xi is Euclidean
  std::vector<Vector6d> open_;
};

}  // namespace canyon::lidar
