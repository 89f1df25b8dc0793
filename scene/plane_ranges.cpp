#include "scene/plane_ranges.h"

#include "core/vector_clones.h"

namespace canyon::scene {
namespace {

constexpr std::size_t kRays = RayPacket::kRays;

}  // namespace

CANYON_VECTOR_CLONES void plane_ranges(const RayPacket& rays, const PlanePacket& planes, HitPacket& hits) {
  // Arrays of its own, so that the compiler knows that nothing overlaps.
  float range_m[kRays], cosine[kRays];
  for (std::size_t i = 0; i < kRays; ++i) {
    const PlaneRange found =
        plane_range({planes.x[i], planes.y[i], planes.z[i], planes.offset[i]}, rays.origin_x[i], rays.origin_y[i],
                    rays.origin_z[i], rays.direction_x[i], rays.direction_y[i], rays.direction_z[i], hits.range_m[i]);
    const double towards = found.approach < 0.0 ? -found.approach : found.approach;
    range_m[i] = found.range_m;
    cosine[i] = static_cast<float>(towards < 1.0 ? towards : 1.0);
  }
  for (std::size_t i = 0; i < kRays; ++i) hits.range_m[i] = range_m[i];
  for (std::size_t i = 0; i < kRays; ++i) hits.cos_incidence[i] = cosine[i];
}

CANYON_VECTOR_CLONES int lanes_to_trace(const RayPacket& rays, int* valid) {
  int count = 0, not_finite = 0;
  for (std::size_t i = 0; i < kRays; ++i) {
    const float ox = rays.origin_x[i], oy = rays.origin_y[i], oz = rays.origin_z[i];
    const float dx = rays.direction_x[i], dy = rays.direction_y[i], dz = rays.direction_z[i];
    // v - v is 0 for finite numbers and NaN else.
    const float sum = ((ox - ox) + (oy - oy) + (oz - oz)) + ((dx - dx) + (dy - dy) + (dz - dz));
    not_finite |= sum == 0.0f ? 0 : 1;
    const int traced = rays.max_m[i] >= 0.0f ? 1 : 0;
    valid[i] = -traced;
    count += traced;
  }
  return not_finite == 0 ? count : -1;
}

}  // namespace canyon::scene
