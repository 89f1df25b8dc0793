#pragma once

#include <optional>
#include <span>
#include <vector>

#include "canyon/lidar/registration/engine/engine_registration.h"
#include "canyon/lidar/registration/engine/match_sums.h"
#include "canyon/lidar/registration/engine/open_directions.h"

namespace canyon::lidar {

/// One source onto one target, in the target's frame: coarse to fine, Levenberg and Marquardt on SE(3).
class Aligner {
 public:
  Aligner(const PreparedCloud& source, const SurfaceTarget& target, MatchForm* form, const MatchingParameters& matching,
          const EngineParameters& engine, const PosePrior& prior);

  RegistrationResult align();

 private:
  /// Where a search has come to.
  struct Candidate {
    Pose X;
    double missed = 1.0;  ///< as NormalEquations::missed
    bool settled = false;
    Vector6d last_step = Vector6d::Zero();  ///< where it settled with a step that still tells
    std::vector<LastMatch> matches;
    NormalEquations equations;
    std::optional<CovarianceSums> sums;  ///< there, with all points; sums_at()
  };
  /// Rounds on every stride-th point, with a reach that shrinks from `reach_m` to the last one.
  struct Stage {
    std::size_t stride;
    double reach_m;
    std::int64_t rounds;
    double settled_m, settled_rad;
  };

  Matching matching_at(double reach_m) const;
  void descend(const Stage& stage, Candidate& at);
  Vector6d step(const NormalEquations& equations, const Pose& X, double damping) const;
  Pose by_surfaces(const Candidate& at, const OpenDirections& open);
  std::vector<Pose> starts() const;
  std::vector<Candidate> coarse();
  void refine(Candidate& at);
  const CovarianceSums& sums_at(Candidate& at) const;
  Pose held(const OpenDirections& open, const Pose& X) const;
  RegistrationPrecision precision_at(Candidate& at, const Matrix6d& B, const OpenDirections& open) const;
  bool keep_open_at_prior(Candidate& at, OpenDirections& open);
  std::vector<double> unexplained(const Candidate& at) const;
  double from_prior(const Pose& X) const;
  static bool explains_less(const Candidate& a, const Candidate& b);
  double odds(const Candidate& a, std::span<const double> missed_a, const Candidate& b,
              std::span<const double> missed_b) const;
  std::vector<Vector6d> restarts(const Candidate& at);
  bool beyond_prior(const RegistrationPrecision& precision, const RegistrationResult& result) const;
  void judge(const Candidate& best, const RegistrationPrecision& precision, bool ambiguous, RegistrationResult& result);

  const PreparedCloud& source_;
  const SurfaceTarget& target_;
  MatchForm* form_;
  RobustKernel* kernel_;
  const MatchingParameters& own_;
  const EngineParameters& engine_;
  Pose X_prior_;
  std::optional<Matrix6d> P_prior_;
  std::optional<Matrix6d> held_law_;  ///< the same, also while the surfaces are asked alone
  double radius_m_ = 1.0;             ///< rms distance of the source's points from its origin
  std::size_t blocks_ = 1;            ///< independent pieces of the source
  OpenDirections open_;               ///< held at the prior
  int rounds_ = 0;
  std::int64_t matched_ = 0;
};

}  // namespace canyon::lidar
