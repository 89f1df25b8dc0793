#pragma once

#include "canyon/lidar/registration/engine/open_directions.h"
#include "canyon/lidar/registration/registration_covariance.h"

namespace canyon::lidar {

/// Of how many blocks of the cloud, as alike as Satterthwaite (1946) counts them, a coordinate of the solution is told:
/// (sum w)^2 / sum w^2, where w = t^T H_b t is what block b has of its variance if A t = l, for the coordinate l^T xi.
double witnesses(const CovarianceSums& sums, const Vector6d& t);

/// By how much a sigma that is itself estimated with so many degrees of freedom has to grow for its 99.9 % bound to be
/// one: Student's over the normal's. From 1 for many to 193 for one; infinite below one. Between two lines of a table:
/// never more than 2e-4 too small; too large by up to 0.3 of it between one and two degrees, 0.04 to three, then 0.01.
double student_over_normal(double degrees);

/// `covariance` with each of its principal axes among the closed directions as wide as the number of its witnesses
/// makes it, less one that their mean takes: scatter of few says little of their error (Bell and McCaffrey 2002, of
/// clusters). An axis with hardly more than one of them is as good as open. Of clouds with fewer than kFewestBlocks as
/// it is: there the residuals of all blocks together tell of each.
Matrix6d widened_by_witnesses(const Matrix6d& covariance, const CovarianceSums& sums, const OpenDirections& open);

}  // namespace canyon::lidar
