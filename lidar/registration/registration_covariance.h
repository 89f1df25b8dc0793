#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/motion/rotation.h"

namespace canyon::lidar {

/// A source point matched to a target point, at the end of a registration.
struct Correspondence {
  Eigen::Vector3d p_S;          ///< in the source frame
  Eigen::Vector3d residual;     ///< d = X_TS p_S - p_T, in the target frame, m
  Eigen::Matrix3d information;  ///< M of generalized ICP, in the target frame
  double tilt_variance = 0.0;   ///< of the matched planes' common normal, rad^2
};

/// Sums over all matches of a registration, in the source frame; names as at registration_precision().
struct CovarianceSums {
  Matrix6d A = Matrix6d::Zero();
  Matrix6d H = Matrix6d::Zero();
  Matrix6d N = Matrix6d::Zero();
  Vector6d along = Vector6d::Zero();  ///< g_along
  double cost = 0;                    ///< d^T M' d
  double weight = 0;                  ///< tr M'
  double radius2 = 0;                 ///< |p_S|^2
  std::int64_t matched = 0;
  std::vector<Vector6d> block_gradients;
  // What only the own engine sums up (engine/match_sums.h).
  std::vector<Matrix6d> block_curvatures;  ///< A of each block
  std::vector<Matrix6d> block_surfaces;    ///< H of each block
  // These only where asked for.
  Matrix6d point_noise = Matrix6d::Zero();   ///< sum J^T M M J
  Vector6d common_range = Vector6d::Zero();  ///< sum J^T M p / |p|
};

/// How well geometry and residuals determine X_TS.
struct RegistrationPrecision {
  Matrix6d covariance;    ///< of xi in X = X_TS Exp(xi), source frame; NaN unless determines_pose(A)
  double rms_m = 0.0;     ///< of the residuals along the surface normals
  int unconstrained = 0;  ///< directions that the geometry leaves open
  /// These, of length 1 and at right angles where a rotation counts by what it moves at the cloud's rms radius.
  std::vector<Vector6d> open;
};

/// Whether a curvature A = sum J^T M J, as below, determines all six directions at all: points on a line leave the turn
/// about it open, whatever M says. `radius_m` is the root mean square distance of the points from the source's origin.
/// False where, with rotations at that radius, the smallest eigenvalue is below 1e-10 of the largest: the points then
/// lie within 1e-5 of their distance from one line, some hundred times what single precision can tell.
bool determines_pose(const Matrix6d& A, double radius_m);

/// With fewer blocks of the cloud their scatter tells too little.
inline constexpr std::size_t kFewestBlocks = 24;

/// sigma given to a direction that the geometry leaves open (for rotations: at the cloud's rms radius).
inline constexpr double kUnconstrainedSigma_m = 10.0;

/// Covariance of a generalized-ICP result from its own residuals; frames as in Correspondence.
///
/// With J = d(X p)/dxi = R_TS [-[p]x, I], the curvature A = sum J^T M J, and the gradient of each block b of the cloud
/// (a cube of edge `block_m`), g_b = sum over b of J^T M d:
///
///   covariance = A^-1 B A^-1,   B = b / (b - 6) sum g_b g_b^T + g_along g_along^T,
///
/// the sandwich estimator with clusters (Huber 1967; Liang and Zeger 1986). The textbook form s^2 A^-1 takes every
/// residual as independent; but neighbours share normals, target points and the surface's departures from a plane, and
/// on street scenes that makes it too small by a factor of six in sigma. With fewer than 24 blocks, s^2 (n / b) A
/// replaces the sum: all residuals of a block as one. g_along = sum J^T d_along / 2 is the pull of the residuals along
/// the surfaces, which come from where rings and voxels happen to lie and not from a motion: a bias of known size,
/// which goes in as if it were its own sigma. (Measured: sigma right within a factor of 2 at a street crossing and,
/// over the built-in city, by 1.3 too small on average.)
///
/// Directions that the geometry leaves open. M = M' + I/2, where I/2 says only that a neighbour was found nearby; so
/// what the surfaces constrain is H = sum J^T M' J. Normals err by their tilt variance t, which feigns curvature along
/// surfaces, N = sum t (tr(M') J^T J - J^T M' J): along a corridor H is nothing but N. In the generalized eigenvectors
/// of H against N, a curvature of r has covariance scaled by (r / (r - 4))^2 if r > 4, else the direction is open and
/// gets kUnconstrainedSigma_m.
///
/// Needs more than 6 matches.
RegistrationPrecision registration_precision(std::span<const Correspondence> matches, const Eigen::Matrix3d& R_TS,
                                             double block_m);

/// B as above, of the sums of 6 matches and more.
Matrix6d gradient_scatter(const CovarianceSums& sums);

/// The same of sums and any covariance B of the gradient at the solution.
RegistrationPrecision registration_precision(const CovarianceSums& sums, const Matrix6d& B);

}  // namespace canyon::lidar
