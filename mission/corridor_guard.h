#pragma once

#include <optional>
#include <string>
#include <vector>

#include "canyon/core/motion/rotation.h"
#include "canyon/gnss/paths/path_omissions.h"
#include "canyon/mission/omissions.h"

namespace canyon::mission {

/// Watches whether the true vehicle is where and when a plan has been made for. Once it is not, nothing is left out any
/// more: what was shown for the corridor does not hold beside it, nor for what follows from having been beside it.
class CorridorGuard {
 public:
  /// The corridor holds until so long after the start.
  CorridorGuard(std::vector<PlannedPlace> corridor, double until_s)
      : corridor_(std::move(corridor)), until_s_(until_s) {}

  /// What may be left out with the body there, t_s after the start: all that a piece of the corridor allows which it
  /// is in.
  gnss::PathOmissions at(double t_s, const Pose& X_WB);
  /// The piece that at() has found last; null: none, or the corridor was left.
  const PlannedPlace* place() const { return left_ || corridor_.empty() ? nullptr : &corridor_[last_]; }
  /// When and where the corridor was left, in words; none: never.
  const std::optional<std::string>& left() const { return left_; }

 private:
  std::vector<PlannedPlace> corridor_;
  double until_s_;
  std::size_t last_ = 0;  // looked at first
  std::optional<std::string> left_;
};

}  // namespace canyon::mission
