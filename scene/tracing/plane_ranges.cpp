#include "canyon/scene/tracing/plane_ranges.h"

#include <cstring>
#include <limits>

#include "canyon/core/process/vector_clones.h"
#include "canyon/scene/farthest.h"

namespace canyon::scene {
namespace {

constexpr std::size_t kRays = RayPacket::kRays;

}  // namespace

CANYON_VECTOR_CLONES void hits_of(const TracedPacket& traced, const PlaneTable& table, const RayPacket& rays,
                                  HeldPlanes& held, HitPacket& hits) {
  // Arrays of its own, so that the compiler knows that nothing overlaps.
  std::uint32_t place[kRays], changed[kRays];
  float far_m[kRays], range_m[kRays], cosine[kRays];
  const std::uint32_t first0 = table.first[0], first1 = table.first[1], first2 = table.first[2];
  const std::uint32_t nothing = table.nothing;
  for (std::size_t i = 0; i < kRays; ++i) {
    // Everything is read, met or not: what is read on a condition is not vectorised.
    const std::uint32_t geometry = traced.geometry[i], primitive = traced.primitive[i];
    const float found_m = traced.far_m[i];
    const std::uint32_t start = geometry == 0 ? first0 : geometry == 1 ? first1 : first2;
    place[i] = geometry <= 2 ? start + primitive : nothing;
    far_m[i] = geometry <= 2 ? found_m : std::numeric_limits<float>::infinity();
    changed[i] = place[i] ^ held.places[i];
  }
  std::uint32_t any = 0;
  for (std::size_t i = 0; i < kRays; ++i) any |= changed[i];
  if (any != 0) {
    for (std::size_t i = 0; i < kRays; ++i) {
      const PlaneRow& row = table.rows[place[i]];
      held.planes[i] = row.plane;
      held.triangles[i] = row.triangle;
    }
    std::memcpy(held.places, place, sizeof place);
  }
  for (std::size_t i = 0; i < kRays; ++i) {
    const PlaneRange found = plane_range(held.planes[i], rays.origin_x[i], rays.origin_y[i], rays.origin_z[i],
                                         rays.direction_x[i], rays.direction_y[i], rays.direction_z[i], far_m[i]);
    const double towards = found.approach < 0.0 ? -found.approach : found.approach;
    range_m[i] = found.range_m;
    cosine[i] = static_cast<float>(towards < 1.0 ? towards : 1.0);
  }
  std::memcpy(hits.range_m, range_m, sizeof range_m);
  std::memcpy(hits.cos_incidence, cosine, sizeof cosine);
  std::memcpy(hits.triangle, held.triangles, sizeof held.triangles);
}

CANYON_VECTOR_CLONES bool load_lanes(const RayPacket& rays, const TracerLanes& lanes) {
  const auto copy = [](const float* from, float* to) { std::memcpy(to, from, kRays * sizeof(float)); };
  constexpr auto kLargest = static_cast<float>(kFarthest_m * kFarthest_m);
  int not_finite = 0;
  int valid[kRays];
  for (std::size_t i = 0; i < kRays; ++i) {
    const float ox = rays.origin_x[i], oy = rays.origin_y[i], oz = rays.origin_z[i];
    const float dx = rays.direction_x[i], dy = rays.direction_y[i], dz = rays.direction_z[i];
    // A sum of squares is NaN, infinite or large if one of them is; 1e36 fits a float.
    const float sum = ((ox * ox) + (oy * oy) + (oz * oz)) + ((dx * dx) + (dy * dy) + (dz * dz));
    not_finite |= sum <= kLargest ? 0 : 1;
    valid[i] = rays.max_m[i] >= 0.0f ? -1 : 0;
  }
  std::memcpy(lanes.valid, valid, sizeof valid);
  copy(rays.origin_x, lanes.origin_x), copy(rays.origin_y, lanes.origin_y), copy(rays.origin_z, lanes.origin_z);
  copy(rays.direction_x, lanes.direction_x), copy(rays.direction_y, lanes.direction_y);
  copy(rays.direction_z, lanes.direction_z), copy(rays.max_m, lanes.max_m);
  return not_finite == 0;
}

}  // namespace canyon::scene
