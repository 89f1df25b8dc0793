#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "canyon/core/motion/rotation.h"
#include "canyon/lidar/registration/engine/match_form.h"
#include "canyon/lidar/registration/engine/robust_kernels.h"
#include "canyon/lidar/registration/engine/surface_target.h"
#include "canyon/lidar/registration/registration_covariance.h"

namespace canyon::lidar {

/// One round: normal equations of sum w d^T M d, d = X p_S - p_T, for a perturbation X Exp(xi), in the source frame,
/// where J = [-[p]x, I].
struct NormalEquations {
  Matrix6d A = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  double cost = 0;     ///< sum of w d^T M d
  double weight = 0;   ///< sum of w
  double missed = 0;   ///< mean over all points of min(1, across^2 / width^2), 1 where nothing matched
  double radius2 = 0;  ///< sum of |p|^2 of the matched
  std::int64_t matched = 0;
};

/// How the points of a source are matched and weighed.
struct Matching {
  const PreparedCloud* source;
  const SurfaceTarget* target;
  MatchForm* form;
  RobustKernel* kernel;
  double reach_m = 1.0;  ///< points farther apart are not matched
  double width_m = 1.0;  ///< of the kernel, and of `missed`
};

/// Matches every `stride`-th point and sums in chunks of a fixed length, in order: the same bits for any number of
/// threads. `last` holds the last match of each such point; none at first.
NormalEquations normal_equations(const Matching& matching, const Pose& X_TS, std::size_t stride,
                                 std::vector<LastMatch>& last);

/// What a pose leaves unexplained of every point: min(1, across^2 / width^2); below 0: the point has no match, which
/// tells as little as a target that is sparse there.
std::vector<double> missed_by_point(const Matching& matching, const Pose& X_TS, std::span<const LastMatch> matches);

/// Of the points that `before` matches to planes, the share that lie on a surface at `X_TS` too: by a match of
/// `matches`, or within reach of the plane that they were matched to. A plane may go on where the target's beams left a
/// gap, as it does between rings on level ground. Points that were matched to no plane, as those of a ring by itself,
/// tell neither way and are not counted; 1 where all are such.
double share_still_on_surfaces(const Matching& matching, const Pose& X_TS, std::span<const LastMatch> matches,
                               std::span<const LastMatch> before);

/// By how many of its sigma pose b leaves more unexplained than a, over the points that both match, with cubes of edge
/// `block_m` of the source as independent witnesses; 0 where they tell nothing.
double evidence_against(std::span<const double> a, std::span<const double> b, const PreparedCloud& source,
                        double block_m);

/// The sums that the covariance is made of, of the matches of a round over all points; those of noise if asked for.
CovarianceSums covariance_sums(const Matching& matching, const Pose& X_TS, std::span<const LastMatch> matches,
                               double block_m, bool of_noise);

}  // namespace canyon::lidar
