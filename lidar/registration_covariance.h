#pragma once

#include <span>

#include <Eigen/Core>

#include "core/rotation.h"

namespace canyon::lidar {

/// A source point matched to a target point, at the end of a registration.
struct Correspondence {
  Eigen::Vector3d p_S;          ///< in the source frame
  Eigen::Vector3d residual;     ///< X_TS p_S - p_T, in the target frame, m
  Eigen::Matrix3d information;  ///< M of generalized ICP, in the target frame
  double tilt_variance = 0.0;   ///< of the matched planes' common normal, rad^2
};

/// How well the geometry and the residuals determine X_TS.
struct RegistrationPrecision {
  Matrix6d covariance;    ///< of xi in X = X_TS Exp(xi), source frame
  double rms_m = 0.0;     ///< of the residuals along the surface normals
  int unconstrained = 0;  ///< directions that the geometry leaves open
};

/// sigma given to a direction that the geometry leaves open (for rotations: at the cloud's rms radius).
inline constexpr double kUnconstrainedSigma_m = 10.0;

/// Covariance from the curvature of the point-to-plane part of the generalized-ICP cost.
///
/// With J_i = d(X p_i)/dxi = R_TS [-[p_i]x, I], M_i split into the weight across the surface and the rest,
/// M_i = M'_i + I/2 (1/2: the information along a surface when both unit-variance planes agree, which says nothing
/// about the motion, only that a neighbour was found nearby):
///   H   = sum J_i^T M'_i J_i,   s^2 = sum d_i^T M'_i d_i / (n - 6),   covariance = s^2 H_c^-1.
/// Normals err by tilt_variance t_i, which adds curvature along surfaces, N = sum t_i tr(M'_i) J_i^T (I - M'_i/tr M'_i)
/// J_i, even where there is none: along a corridor H is nothing but N. Therefore H_c = H - 2 N in the directions
/// (generalized eigenvectors of H against N) where that is positive; the others are unconstrained and get
/// kUnconstrainedSigma_m. `n` must exceed 6.
RegistrationPrecision registration_precision(std::span<const Correspondence> matches, const Eigen::Matrix3d& R_TS);

}  // namespace canyon::lidar
