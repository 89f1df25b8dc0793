#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "canyon/lidar/registration/engine/engine_registration.h"
#include "canyon/lidar/registration/engine/match_sums.h"
#include "canyon/lidar/registration/engine/open_directions.h"
#include "canyon/lidar/registration/engine/prior_law.h"

namespace canyon::lidar {

/// Where a search has come to.
struct FoundPose {
  Pose X;               ///< of the source in the target's frame, X_TS
  double missed = 1.0;  ///< as NormalEquations::missed
  bool settled = false;
  Vector6d last_step = Vector6d::Zero();  ///< where it settled with a step that still tells
  std::vector<LastMatch> matches;
  NormalEquations equations;
  std::optional<CovarianceSums> sums;  ///< there, with all points; made when asked for
};

/// What keeps a search from going where the surfaces alone would.
struct Held {
  const OpenDirections* open = nullptr;  ///< along these the prior has it
  bool surfaces_alone = false;           ///< the prior has no other part
};

/// Over which errors are correlated: normals of neighbours share points, and pieces of a surface are bent alike however
/// fine they are thinned.
inline double block_m(double leaf_m) {
  return std::max(16.0 * leaf_m, 8.0);
}

/// Whether a motion leads to another place, not to the same once more.
bool are_apart(const Vector6d& xi);

/// Looks for poses of a source at which its points lie on a target's surfaces: coarse to fine, Levenberg and Marquardt
/// on SE(3), with the prior as one more measurement.
class PoseSearch {
 public:
  PoseSearch(const PreparedCloud& source, const SurfaceTarget& target, MatchForm* form,
             const MatchingParameters& matching, const EngineParameters& engine, const PosePrior& prior);

  /// Some places that may be it, the likeliest first, each from a part of the points.
  std::vector<FoundPose> coarse();
  /// More of them, with all as at X but moved along `way`, a shift of length 1 in the source frame, to where a part of
  /// the points fits better than a step either side; as far as the prior reaches (its 99.9 % ellipsoid), its last steps
  /// included, but not what lies between these and its border. At most six, those that fit best.
  std::vector<FoundPose> along(const Pose& X, const Vector6d& way);
  /// After coarse(): whether the prior reaches so far that there may be several; without one it does not.
  bool several() const { return several_; }
  /// On with all points.
  void refine(FoundPose& at, const Held& how = {});
  /// From where it is, without its matches: so many coarse rounds, and all points.
  void anew(FoundPose& at, int rounds, const Held& how = {});
  /// X where the prior has it along `open`; where it is without a prior, whose search runs from where it began.
  Pose held(const OpenDirections& open, const Pose& X) const;

  const Pose& guess() const { return guess_; }  ///< the prior's pose, also where nothing else is known of it
  const std::optional<PriorLaw>& prior() const { return prior_; }
  /// By the prior: the square of its distance in sigma, 0 without one.
  double improbable(const Pose& X) const { return prior_ ? prior_->distance_squared(X) : 0.0; }
  Matching matching_at(double reach_m) const;
  double radius_m() const { return radius_m_; }  ///< rms distance of the source's points from its origin
  int rounds() const { return rounds_; }
  std::int64_t matched() const { return matched_; }  ///< in all rounds

 private:
  /// Rounds on every stride-th point, with a reach that shrinks from `reach_m` to the last one.
  struct Stage {
    std::size_t stride;
    double reach_m;
    std::int64_t rounds;
    double settled_m, settled_rad;
  };
  void descend(const Stage& stage, FoundPose& at, const Held& how);
  Vector6d step(const NormalEquations& equations, const Pose& X, double damping, const Held& how) const;
  /// Settled where the whole step from X, undamped, is one that may be left; it then stays as the last one.
  void settle_nearly(const NormalEquations& equations, const Pose& X, FoundPose& at, const Held& how) const;
  std::vector<Pose> starts() const;
  std::size_t coarse_stride() const;
  double first_reach_m() const;

  const PreparedCloud& source_;
  const SurfaceTarget& target_;
  MatchForm* form_;
  RobustKernel* kernel_;
  const MatchingParameters& own_;
  const EngineParameters& engine_;
  Pose guess_;
  std::optional<PriorLaw> prior_;
  double radius_m_ = 1.0;
  std::size_t blocks_ = 1;  ///< independent pieces of the source
  bool several_ = false;
  int rounds_ = 0;
  std::int64_t matched_ = 0;
};

}  // namespace canyon::lidar
