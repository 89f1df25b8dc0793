#include <algorithm>
#include <cmath>

#include "canyon/core/truth.h"
#include "canyon/mission/collision/collision.h"
#include "canyon/mission/motion/vehicle_config.h"
#include "canyon/scene/scene_at.h"

namespace canyon::mission {
namespace {

constexpr double kBetweenChecks_m = 0.1;  // of travel

/// Segments through the body at two heights: outline, and lines along it at most 0.4 m apart, so that no pole fits
/// between. What is lower than a third of the body, or higher than four fifths, it does not meet; nor what comes to it
/// while it stands.
class Lines final : public CollisionCheck {
 public:
  Lines(const VehicleConfig& vehicle, const scene::SceneAt& scene) : vehicle_(vehicle), scene_(scene) {}

  std::optional<std::uint32_t> touched(const KinematicState& truth) override {
    const Eigen::Vector2d p = truth.X_WB.p.head<2>();
    if ((p - last_checked_).norm() < kBetweenChecks_m) return std::nullopt;
    last_checked_ = p;
    const double rear = -0.5 * (vehicle_.length_m - vehicle_.wheelbase_m), front = rear + vehicle_.length_m;
    const double half = 0.5 * vehicle_.width_m;
    const int lines = std::max(2, static_cast<int>(std::ceil(vehicle_.width_m / 0.4)) + 1);
    for (const double z : {0.35 * vehicle_.height_m, 0.8 * vehicle_.height_m}) {
      const auto met = [&](double x0, double y0, double x1, double y1) -> std::optional<std::uint32_t> {
        const Eigen::Vector3d a = truth.X_WB * Eigen::Vector3d(x0, y0, z), b = truth.X_WB * Eigen::Vector3d(x1, y1, z);
        const Eigen::Vector3d d = b - a;
        const scene::Hit hit = scene_.trace({a, d.normalized().cast<float>(), static_cast<float>(d.norm())});
        if (!hit.hit()) return std::nullopt;
        return scene_.surface(hit.triangle).object;
      };
      for (int i = 0; i < lines; ++i) {
        const double y = -half + 2.0 * half * i / (lines - 1);
        if (const auto object = met(rear, y, front, y)) return object;
      }
      for (const double x : {rear, front})
        if (const auto object = met(x, -half, x, half)) return object;
    }
    return std::nullopt;
  }

 private:
  VehicleConfig vehicle_;
  const scene::SceneAt& scene_;
  Eigen::Vector2d last_checked_ = Eigen::Vector2d::Constant(1e9);
};

}  // namespace

std::unique_ptr<CollisionCheck> make_line_check(const ModelParameters&, const VehicleConfig& vehicle,
                                                const scene::SceneAt& scene) {
  return std::make_unique<Lines>(vehicle, scene);
}

}  // namespace canyon::mission
