#include "canyon/scene/scene_cost.h"

#include <cstdio>

namespace canyon::scene {

std::string cost_text(const SceneCost& cost) {
  char text[80];
  if (cost.triangles >= 1e6)
    std::snprintf(text, sizeof text, "%.1f million triangles, %.1f GB", cost.triangles / 1e6, cost.memory_mb() / 1e3);
  else
    std::snprintf(text, sizeof text, "%.0f triangles, %.0f MB", cost.triangles, cost.memory_mb());
  return text;
}

Status check_cost(const SceneCost& cost, std::int64_t max_triangles, const std::string& key,
                  const std::string& smaller) {
  if (cost.triangles <= static_cast<double>(max_triangles)) return Ok{};
  return Error{.key = key,
               .what = "a scene of about " + cost_text(cost),
               .expected = smaller + ", or scene.max_triangles above " + std::to_string(max_triangles)};
}

}  // namespace canyon::scene
