#include "canyon/mission/corridor_guard.h"

#include <cstdio>

namespace canyon::mission {

gnss::PathOmissions CorridorGuard::at(double t_s, const Eigen::Vector3d& p_WB_W) {
  if (left_ || corridor_.empty()) return {};
  for (std::size_t k = 0; k < corridor_.size(); ++k) {
    const std::size_t i = (last_ + k) % corridor_.size();
    if (!corridor_[i].segment.contains(p_WB_W)) continue;
    last_ = i;
    return corridor_[i].paths;
  }
  char text[160];
  std::snprintf(text, sizeof text,
                "left the plan's corridor at %.2f s, x %.1f m, y %.1f m: nothing is left out from there on", t_s,
                p_WB_W.x(), p_WB_W.y());
  left_ = text;
  return {};
}

}  // namespace canyon::mission
