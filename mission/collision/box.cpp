#include <vector>

#include "canyon/core/truth.h"
#include "canyon/mission/collision/body_box.h"
#include "canyon/mission/collision/collision.h"
#include "canyon/mission/collision/near_triangles.h"
#include "canyon/mission/motion/vehicle_config.h"
#include "canyon/scene/scene_at.h"

namespace canyon::mission {
namespace {

/// The body as a box against all triangles, the ground's too, by separating axes.
class Box final : public CollisionCheck {
 public:
  Box(const VehicleConfig& vehicle, const scene::SceneAt& scene) : vehicle_(vehicle), scene_(scene), near_(scene) {}

  std::optional<std::uint32_t> touched(const KinematicState& truth) override {
    const OrientedBox body = body_box(vehicle_, truth.X_WB);
    for (const NearTriangle& triangle : near_.near(body.X_WC.p, body.radius_m()))
      if (touch(body, triangle.corners)) return scene_.surface(triangle.index).object;
    return std::nullopt;
  }

 private:
  VehicleConfig vehicle_;
  const scene::SceneAt& scene_;
  NearTriangles near_;
};

}  // namespace

std::unique_ptr<CollisionCheck> make_box_check(const ModelParameters&, const VehicleConfig& vehicle,
                                               const scene::SceneAt& scene) {
  return std::make_unique<Box>(vehicle, scene);
}

}  // namespace canyon::mission
