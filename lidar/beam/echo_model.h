#pragma once

#include <memory>

#include "canyon/core/model_choice.h"
#include "canyon/lidar/beam/echoes.h"
#include "canyon/lidar/beam/surfaces.h"
#include "canyon/lidar/beam/volley.h"

namespace canyon::scene {
class SceneAt;
}

namespace canyon::lidar {

struct LidarConfig;

/// How a beam meets the scene. Const and thread-safe: volleys are traced side by side.
class EchoModel {
 public:
  virtual ~EchoModel() = default;
  /// The echoes of all shots whose ray has max_m >= 0.
  virtual void trace(const Volley& volley, const scene::SceneAt& scene, const Surfaces& surfaces,
                     Echoes& out) const = 0;
  virtual std::size_t rays_per_shot() const = 0;
};

/// `[lidar] model`.
using MakeEchoModel = std::unique_ptr<EchoModel>(const ModelParameters& own, const LidarConfig& config,
                                                 std::uint64_t seed);
ModelTable<MakeEchoModel> echo_models();

std::unique_ptr<EchoModel> make_single_ray(const ModelParameters& own, const LidarConfig& config, std::uint64_t seed);
std::unique_ptr<EchoModel> make_footprint(const ModelParameters& own, const LidarConfig& config, std::uint64_t seed);
void footprint_parameters(ModelParameters& section);

}  // namespace canyon::lidar
