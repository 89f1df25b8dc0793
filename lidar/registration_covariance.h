#pragma once

#include <span>

#include <Eigen/Core>

#include "core/rotation.h"

namespace canyon::lidar {

/// A source point matched to a target point, at the end of a registration.
struct Correspondence {
  Eigen::Vector3d p_S;          ///< in the source frame
  Eigen::Vector3d residual;     ///< d = X_TS p_S - p_T, in the target frame, m
  Eigen::Matrix3d information;  ///< M of generalized ICP, in the target frame
  double tilt_variance = 0.0;   ///< of the matched planes' common normal, rad^2
};

/// How well geometry and residuals determine X_TS.
struct RegistrationPrecision {
  Matrix6d covariance;    ///< of xi in X = X_TS Exp(xi), source frame
  double rms_m = 0.0;     ///< of the residuals along the surface normals
  int unconstrained = 0;  ///< directions that the geometry leaves open
};

/// sigma given to a direction that the geometry leaves open (for rotations: at the cloud's rms radius).
inline constexpr double kUnconstrainedSigma_m = 10.0;

/// Covariance of a generalized-ICP result from its own residuals; frames as in Correspondence.
///
/// With J = d(X p)/dxi = R_TS [-[p]x, I], the curvature A = sum J^T M J, and the gradient of each block b of the cloud
/// (a cube of edge `block_m`), g_b = sum over b of J^T M d:
///
///   covariance = A^-1 B A^-1,   B = b / (b - 6) sum g_b g_b^T,
///
/// the sandwich estimator with clusters (Huber 1967; Liang and Zeger 1986). The textbook form s^2 A^-1 takes every
/// residual as independent; but neighbours share normals, target points and the surface's departures from a plane, and
/// on street scenes that makes it too small by a factor of six in sigma. With fewer than 24 blocks, B = s^2 (n / b) A:
/// all residuals of a block as one.
///
/// Directions that the geometry leaves open. M = M' + I/2, where I/2 says only that a neighbour was found nearby; so
/// what the surfaces constrain is H = sum J^T M' J. Normals err by their tilt variance t, which feigns curvature along
/// surfaces, N = sum t (tr(M') J^T J - J^T M' J): along a corridor H is nothing but N. In the generalized eigenvectors
/// of H against N, a curvature of r has covariance scaled by (r / (r - 2))^2 if r > 2, else the direction is open and
/// gets kUnconstrainedSigma_m.
///
/// Needs more than 6 matches.
RegistrationPrecision registration_precision(std::span<const Correspondence> matches, const Eigen::Matrix3d& R_TS,
                                             double block_m);

}  // namespace canyon::lidar
