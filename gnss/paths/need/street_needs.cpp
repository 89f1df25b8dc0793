// What needs walls, or a street between houses.
#include <algorithm>
#include <cmath>

#include "canyon/gnss/paths/bounce.h"
#include "canyon/gnss/paths/need/path_question.h"

namespace canyon::gnss {

std::vector<Need> scatter_needs(const PathQuestion& q) {
  const auto& facets = q.scene.facets().facets();
  const bool walls = std::any_of(facets.begin(), facets.end(), [&](const scene::Facet& f) {
    return std::abs(f.normal_W.z()) <= kUprightSlope && !q.scene.materials()[f.material].rf_absorbing;
  });
  if (walls) return {{.effect = kScattering, .reason = "walls scatter in all directions"}};
  return {{.effect = kScattering, .verdict = Verdict::kNotNeeded, .reason = "there are no walls"}};
}

std::vector<Need> clutter_needs(const PathQuestion& q) {
  if (!q.scene.facets().facets().empty())
    return {{.effect = kClutter, .reason = "what stands in a street may shade any satellite"}};
  return {{.effect = kClutter, .verdict = Verdict::kNotNeeded, .reason = "there is no street without a house"}};
}

}  // namespace canyon::gnss
