#pragma once

#include <cstddef>
#include <cstdint>

namespace canyon::scene {

/// Sixteen rays as plain arrays, as the ray tracer takes them: the fastest way in, for sensors of many rays. In W,
/// single precision; directions are unit vectors. A lane whose max_m is negative is not traced. Fast where the sixteen
/// are neighbours in direction.
struct alignas(64) RayPacket {
  static constexpr std::size_t kRays = 16;
  float origin_x[kRays], origin_y[kRays], origin_z[kRays];
  float direction_x[kRays], direction_y[kRays], direction_z[kRays];
  float max_m[kRays];
};

/// What the rays of a RayPacket met.
struct alignas(64) HitPacket {
  float range_m[RayPacket::kRays];           ///< infinity: nothing
  float cos_incidence[RayPacket::kRays];     ///< 0..1; 0 where nothing was met
  std::uint32_t triangle[RayPacket::kRays];  ///< Hit::kMiss: nothing
};

}  // namespace canyon::scene
