#pragma once

#include <optional>
#include <string>
#include <vector>

#include "canyon/gnss/paths/path_omissions.h"
#include "canyon/mission/omissions.h"

namespace canyon::mission {

/// Watches whether the true vehicle is where a plan has been made for. Once it is not, nothing is left out any more:
/// what was shown for the corridor does not hold beside it, nor for what follows from having been beside it.
class CorridorGuard {
 public:
  explicit CorridorGuard(std::vector<PlannedPlace> corridor) : corridor_(std::move(corridor)) {}

  /// What may be left out with the body's origin at p, t_s after the start: all that a piece of the corridor allows
  /// which p lies in.
  gnss::PathOmissions at(double t_s, const Eigen::Vector3d& p_WB_W);
  /// When and where the corridor was left, in words; none: never.
  const std::optional<std::string>& left() const { return left_; }

 private:
  std::vector<PlannedPlace> corridor_;
  std::size_t last_ = 0;  // looked at first
  std::optional<std::string> left_;
};

}  // namespace canyon::mission
