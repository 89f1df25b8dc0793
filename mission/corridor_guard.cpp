#include "canyon/mission/corridor_guard.h"

#include <cstdio>

namespace canyon::mission {

gnss::PathOmissions CorridorGuard::at(double t_s, const Pose& X_WB) {
  if (left_ || corridor_.empty()) return {};
  const bool in_time = t_s <= until_s_;
  for (std::size_t k = 0; in_time && k < corridor_.size(); ++k) {
    const std::size_t i = (last_ + k) % corridor_.size();
    if (!corridor_[i].segment.contains(X_WB)) continue;
    last_ = i;
    return corridor_[i].paths;
  }
  char text[160];
  std::snprintf(text, sizeof text, "%s the plan's %s at %.2f s, x %.1f m, y %.1f m: nothing is left out from there on",
                in_time ? "left" : "drives beyond", in_time ? "corridor" : "time limit", t_s, X_WB.p.x(), X_WB.p.y());
  left_ = text;
  return {};
}

}  // namespace canyon::mission
