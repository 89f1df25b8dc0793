#pragma once

#include <array>

#include "scene/ray_packet.h"

namespace canyon::scene {

/// The plane of a triangle in double precision: x * p.x + y * p.y + z * p.z = offset, (x, y, z) a unit vector.
struct Plane {
  double x = 0.0, y = 0.0, z = 0.0, offset = 0.0;
};

/// Planes of the sixteen rays of a packet.
struct alignas(64) PlanePacket {
  Plane lanes[RayPacket::kRays];
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

/// The triangles that sixteen rays met, counted through: `first` of its geometry plus its number there, `nothing` where
/// the geometry is unknown. Sets hits.triangle and, to what was traced or infinity, hits.range_m.
struct TracedPacket {
  const std::uint32_t *geometry, *primitive;
  const float* far_m;
};
void count_through(const TracedPacket& traced, const std::array<std::uint32_t, 3>& first, std::uint32_t nothing,
                   HitPacket& hits);

/// Lays the planes out by lane, and the numbers that go with them.
void gather_planes(const Plane* planes, const std::uint32_t* numbers, const std::uint32_t* index, PlanePacket& out,
                   std::uint32_t* out_numbers);

/// plane_range() of sixteen rays, to the same bits: hits.range_m, which holds what was traced, and hits.cos_incidence.
/// Lanes that met nothing need a plane of zeros and keep their range.
void plane_ranges(const RayPacket& rays, const PlanePacket& planes, HitPacket& hits);

/// Where the ray tracer wants a packet's numbers.
struct TracerLanes {
  float *origin_x, *origin_y, *origin_z, *direction_x, *direction_y, *direction_z, *max_m;
  int* valid;
};
/// Copies a packet and marks the lanes that are to be traced (max_m >= 0) with -1, others with 0. False if an origin or
/// direction is infinite or NaN.
bool load_lanes(const RayPacket& rays, const TracerLanes& lanes);

}  // namespace canyon::scene
