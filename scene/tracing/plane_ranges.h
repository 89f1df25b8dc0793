#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "canyon/scene/tracing/ray_packet.h"

namespace canyon::scene {

/// The plane of a triangle in double precision: x * p.x + y * p.y + z * p.z = offset, (x, y, z) a unit vector.
struct Plane {
  double x = 0.0, y = 0.0, z = 0.0, offset = 0.0;
};

/// Where a ray meets the plane of the triangle that the ray tracer found at `traced_m`: computed in double precision
/// and rounded once, so that it does not depend on the tracer's instruction set. A ray within its own plane's rounding
/// of grazing keeps the traced range. `approach`: the plane's normal times the direction.
struct PlaneRange {
  float range_m;
  double approach;
};
[[gnu::always_inline]] inline PlaneRange plane_range(const Plane& plane, double ox, double oy, double oz, double dx,
                                                     double dy, double dz, float traced_m) {
  const double approach = plane.x * dx + plane.y * dy + plane.z * dz;
  const double range_m = (plane.offset - (plane.x * ox + plane.y * oy + plane.z * oz)) / approach;
  const double traced = static_cast<double>(traced_m);
  const double off_m = range_m - traced;
  const double tolerance_m = 1e-3 * (1.0 + traced);
  const double ahead_m = range_m > 0.0 ? range_m : 0.0;
  const double kept_m = off_m * off_m <= tolerance_m * tolerance_m ? ahead_m : traced;  // NaN: traced
  return {static_cast<float>(kept_m), approach};
}

/// A triangle's plane and its index in the mesh, side by side in memory: a ray's triangle is most often a cache miss.
struct PlaneRow {
  Plane plane;
  std::uint32_t triangle = 0;
};

/// The triangles of a scene counted through, geometry after geometry; the last one stands for what met nothing: a plane
/// of zeros and Hit::kMiss.
struct PlaneTable {
  const PlaneRow* rows;
  std::array<std::uint32_t, 3> first;  ///< where each geometry begins
  std::uint32_t nothing;               ///< the last one's place
};

/// What a ray tracer found for sixteen rays: geometry (unknown: nothing), triangle in it, range.
struct TracedPacket {
  const std::uint32_t *geometry, *primitive;
  const float* far_m;
};

/// Planes by lane, kept from packet to packet: neighbours often meet the same.
struct alignas(64) HeldPlanes {
  Plane planes[RayPacket::kRays];
  std::uint32_t places[RayPacket::kRays];  ///< in the table
  std::uint32_t triangles[RayPacket::kRays];
  HeldPlanes() { std::fill_n(places, RayPacket::kRays, 0xffffffffu); }  // no place: nothing is held
};

/// plane_range() of sixteen rays, to the same bits, and what else is told of them.
void hits_of(const TracedPacket& traced, const PlaneTable& table, const RayPacket& rays, HeldPlanes& held,
             HitPacket& hits);

/// Where the ray tracer wants a packet's numbers.
struct TracerLanes {
  float *origin_x, *origin_y, *origin_z, *direction_x, *direction_y, *direction_z, *max_m;
  int* valid;
};
/// Copies a packet and marks the lanes that are to be traced (max_m >= 0) with -1, others with 0. False if an origin or
/// direction is farther than kFarthest_m or NaN.
bool load_lanes(const RayPacket& rays, const TracerLanes& lanes);

}  // namespace canyon::scene
