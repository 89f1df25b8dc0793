#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "canyon/scene/tracing/ray_packet.h"

namespace canyon::lidar {

/// Where in W the sixteen rays of a packet met something, m; where they met nothing, their own origins.
struct alignas(64) Places {
  double x[scene::RayPacket::kRays], y[scene::RayPacket::kRays], z[scene::RayPacket::kRays];
};

/// One coordinate of a place. The origin of rays is relative to `origin_W`. One order of rounding for single rays and
/// packets, so that both find the same place to the bit.
[[gnu::always_inline]] inline double place_on(double origin_W, double origin, double range_m, double direction) {
  return (origin_W + origin) + range_m * direction;
}

/// The places of a packet's hits. Origins of rays are relative to `origin_W`.
void find_places(const scene::RayPacket& rays, const scene::HitPacket& hits, const Eigen::Vector3d& origin_W,
                 Places& places);

}  // namespace canyon::lidar
