#pragma once

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
  struct Place {
    FoundPose found;
    OpenDirections open;  ///< held at the prior
    bool determined = true;
    std::vector<double> missed;  ///< of each point; empty where it is the only one, or no answer
  };

  std::vector<Place> places();
  const CovarianceSums& sums_at(FoundPose& at) const;
  RegistrationPrecision precision_at(FoundPose& at, const CovarianceForm& form, const OpenDirections& open);
  bool keep_open_at_prior(Place& place);
  Pose by_surfaces(const FoundPose& at, const OpenDirections& open);
  std::vector<double> unexplained(const FoundPose& at) const;
  static bool explains_less(const FoundPose& a, const FoundPose& b);
  double odds(const Place& a, const Place& b) const;
  bool loses_to(const Place& a, const Place& b) const;
  bool rivals(const Place& a, const Place& b) const;
  std::vector<Vector6d> restarts(const FoundPose& at);
  bool beyond_prior(const RegistrationResult& result) const;
  bool turned_is_far_better(const FoundPose& at, double overlap);
  void judge(const FoundPose& best, bool ambiguous, RegistrationResult& result) const;

  const PreparedCloud& source_;
  const SurfaceTarget& target_;
  const MatchingParameters& own_;
  const EngineParameters& engine_;
  PoseSearch search_;
};

}  // namespace canyon::lidar
