#pragma once

#include <memory>
#include <string>
#include <vector>

#include "canyon/lidar/beam/echoes.h"
#include "canyon/lidar/beam/surfaces.h"
#include "canyon/lidar/beam/volley.h"
#include "canyon/lidar/lidar_config.h"
#include "canyon/scene/scene_at.h"

namespace canyon::lidar {

/// How a beam meets the scene. Const and thread-safe: volleys are traced side by side.
class EchoModel {
 public:
  virtual ~EchoModel() = default;
  /// The echoes of all shots whose ray has max_m >= 0.
  virtual void trace(const Volley& volley, const scene::SceneAt& scene, const Surfaces& surfaces,
                     Echoes& out) const = 0;
  virtual std::size_t rays_per_shot() const = 0;
};

/// One row per model: `[lidar] model`.
struct EchoModelRow {
  const char* name;
  std::unique_ptr<EchoModel> (*make)(const LidarConfig& config, std::uint64_t seed);
  const char* doc;
};
const std::vector<EchoModelRow>& echo_models();

std::unique_ptr<EchoModel> make_single_ray(const LidarConfig& config, std::uint64_t seed);
std::unique_ptr<EchoModel> make_footprint(const LidarConfig& config, std::uint64_t seed);

}  // namespace canyon::lidar
