#include "canyon/lidar/beam/texture/places.h"

#include <limits>

#include "canyon/core/process/vector_clones.h"

namespace canyon::lidar {
namespace {

CANYON_VECTOR_CLONES void place_all(const scene::RayPacket& rays, const scene::HitPacket& hits, double x_W, double y_W,
                                    double z_W, Places& places) {
  constexpr std::size_t kRays = scene::RayPacket::kRays;
  double x[kRays], y[kRays], z[kRays];
  for (std::size_t i = 0; i < kRays; ++i) {
    const float met_m = hits.range_m[i];
    const double range_m = met_m < std::numeric_limits<float>::infinity() ? met_m : 0.0f;
    x[i] = place_on(x_W, rays.origin_x[i], range_m, rays.direction_x[i]);
    y[i] = place_on(y_W, rays.origin_y[i], range_m, rays.direction_y[i]);
    z[i] = place_on(z_W, rays.origin_z[i], range_m, rays.direction_z[i]);
  }
  for (std::size_t i = 0; i < kRays; ++i) places.x[i] = x[i], places.y[i] = y[i], places.z[i] = z[i];
}

}  // namespace

void find_places(const scene::RayPacket& rays, const scene::HitPacket& hits, const Eigen::Vector3d& origin_W,
                 Places& places) {
  place_all(rays, hits, origin_W.x(), origin_W.y(), origin_W.z(), places);
}

}  // namespace canyon::lidar
