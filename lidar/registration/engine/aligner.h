#pragma once

#include <optional>
#include <vector>

#include "canyon/lidar/registration/engine/covariance_forms.h"
#include "canyon/lidar/registration/engine/pose_search.h"

namespace canyon::lidar {

/// One source onto one target, in the target's frame: which of the places that a search finds it is, what is open
/// there, how sure that is, and whether to be believed.
class Aligner {
 public:
  Aligner(const PreparedCloud& source, const SurfaceTarget& target, MatchForm* form, const MatchingParameters& matching,
          const EngineParameters& engine, const PosePrior& prior);

  RegistrationResult align();

 private:
  /// What a place is weighed by against others: how it fits where nothing is held. A place that is held at the prior
  /// fits worse the more of it is open, which tells nothing against it.
  struct Fit {
    Pose X;  ///< of the source in the target's frame, X_TS
    std::int64_t matched = 0;
    double missed = 1.0;  ///< as NormalEquations::missed
    bool settled = false;
    std::vector<double> by_point{};  ///< what it leaves unexplained; empty where it was not asked for, or no answer
  };
  struct Place {
    FoundPose found;
    Fit fit;
    OpenDirections open;  ///< held at the prior
    bool determined = true;
    /// Not determined, as by what was opened for its width alone all else followed: its pose is from before, where the
    /// surfaces left nothing open.
    bool kept = false;
    bool opened_wide = false;  ///< some of what is open is so for its width alone
  };
  /// Where the surfaces by themselves have it, and how sure they are there.
  struct Alone {
    FoundPose at;
    OpenDirections open;  ///< without a scale; held at the prior
    RegistrationPrecision precision;
  };

  std::vector<Place> places();
  void take_in(FoundPose found, std::vector<Place>& places);
  std::size_t likeliest(const std::vector<Place>& places) const;
  std::optional<Vector6d> weakest_way(Place& place) const;
  const CovarianceSums& sums_at(FoundPose& at) const;
  RegistrationPrecision precision_at(FoundPose& at, const CovarianceForm& form, const OpenDirections& open);
  bool keep_open_at_prior(Place& place);
  Pose by_surfaces(const FoundPose& at, const OpenDirections& open);
  std::vector<double> unexplained(const FoundPose& at) const;
  static bool explains_less(const Fit& a, const Fit& b);
  double odds(const Place& a, const Place& b) const;
  bool loses_to(const Place& a, const Place& b) const;
  bool rivals(const Place& a, const Place& b) const;
  std::vector<Vector6d> restarts(const FoundPose& at);
  bool beyond_prior(const Pose& X, const Matrix6d& by_surfaces) const;
  Alone by_themselves(const Place& best);
  void doubt_prior(const Place& best, RegistrationResult& result);
  RegistrationResult finite_or_degenerate(RegistrationResult result) const;
  bool turned_is_far_better(const FoundPose& at, double overlap);
  void judge(const Place& best, bool ambiguous, RegistrationResult& result) const;

  const PreparedCloud& source_;
  const SurfaceTarget& target_;
  const MatchingParameters& own_;
  const EngineParameters& engine_;
  PoseSearch search_;
};

}  // namespace canyon::lidar
