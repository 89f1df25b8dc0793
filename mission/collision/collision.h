#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "canyon/core/model_choice.h"

namespace canyon {
struct KinematicState;
namespace scene {
class SceneAt;
}
}  // namespace canyon

namespace canyon::mission {

struct VehicleConfig;

/// Whether the true body touches something. One-level interface; the models are in the table below, each in its own
/// file with its own parameters.
class CollisionCheck {
 public:
  virtual ~CollisionCheck() = default;
  /// At every master step: the object that is touched, as SceneAt counts them. A model may look less often.
  virtual std::optional<std::uint32_t> touched(const KinematicState& truth) = 0;
};

/// The scene must outlive what is made.
using MakeCollisionCheck = std::unique_ptr<CollisionCheck>(const ModelParameters& own, const VehicleConfig& vehicle,
                                                           const scene::SceneAt& scene);
/// [success] collision
ModelTable<MakeCollisionCheck> collision_checks();

/// Makers of the rows of the table in collision_checks.cpp.
std::unique_ptr<CollisionCheck> make_line_check(const ModelParameters& own, const VehicleConfig& vehicle,
                                                const scene::SceneAt& scene);
std::unique_ptr<CollisionCheck> make_box_check(const ModelParameters& own, const VehicleConfig& vehicle,
                                               const scene::SceneAt& scene);

}  // namespace canyon::mission
