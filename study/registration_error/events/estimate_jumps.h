#pragma once

#include <optional>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/study/registration_error/events/event_kinds.h"

namespace canyon::study {

/// Jumps of the estimate that places scans, seen from keyframe to keyframe: what it has been corrected by is where it
/// is now, less the keyframe before moved on by what was predicted since (a correction is not motion). It is a jump if
/// it is over kJump_m long, or lies beyond the 3-sigma ellipsoid (0.27 %) of the position as predicted: then the
/// estimate was off by more than it said, before or now. Nobody knows the covariance between a keyframe's pose and the
/// motion after it, so the two are added.
class EstimateJumps {
 public:
  static constexpr double kJump_m = 1.0;

  /// The next keyframe: `t_s` after the start, motion of B since the keyframe before by prediction alone, or, where no
  /// keyframe is registered, since the start.
  void add(double t_s, const NavEstimate& estimate, const RelativePose& motion);
  const std::vector<MapEvent>& events() const { return events_; }

 private:
  struct Keyframe {
    double t_s;
    NavEstimate estimate;
    RelativePose motion;
  };
  std::optional<Keyframe> last_;
  std::vector<MapEvent> events_;
};

}  // namespace canyon::study
