#pragma once

#include <cstdint>
#include <string>

#include "canyon/core/result.h"

namespace canyon::scene {

/// What a scene is going to take, known before it is made.
struct SceneCost {
  double triangles = 0.0;
  /// Most memory that making it and tracing in it take; kBytesPerTriangle.
  double memory_mb() const { return triangles * kBytesPerTriangle / 1e6; }
  /// Peak resident memory of `scene info`, measured and rounded up: 216 bytes over the built-in city of 5.8 million
  /// triangles, 285 over an OBJ file of a million, which is held beside the scene.
  static constexpr double kBytesPerTriangle = 300.0;
};

/// [scene] max_triangles.
inline constexpr std::int64_t kMaxTriangles = 20'000'000;

/// "72.0 million triangles, 21.6 GB".
std::string cost_text(const SceneCost& cost);

/// Refuses what has more triangles than the limit; `larger` names the keys that make it smaller.
Status check_cost(const SceneCost& cost, std::int64_t max_triangles, const std::string& key,
                  const std::string& smaller);

}  // namespace canyon::scene
