#include "canyon/lidar/beam/footprint/footprint_rays.h"

#include <cmath>

#include "canyon/core/process/vector_clones.h"
#include "canyon/core/units.h"

namespace canyon::lidar {

FootprintOffsets footprint_offsets(double sigma_across_rad, double sigma_along_rad) {
  FootprintOffsets out;
  double x[FootprintOffsets::kRays], y[FootprintOffsets::kRays];
  double squares = 0.0;
  for (std::size_t i = 0; i < FootprintOffsets::kRays; ++i) {
    const auto ring = static_cast<double>(i / 4), spoke = static_cast<double>(i % 4);
    // A quarter of the energy lies within each ring's band; its middle at the median radius. Rings are turned against
    // each other so that no four directions line up.
    const double radius = std::sqrt(-2.0 * std::log(1.0 - (ring + 0.5) / 4.0));
    const double angle = 0.5 * kPi * spoke + 0.5 * kPi * (ring + 0.5) / 4.0;
    x[i] = radius * std::cos(angle), y[i] = radius * std::sin(angle);
    squares += radius * radius;
  }
  const double unit = std::sqrt(2.0 * static_cast<double>(FootprintOffsets::kRays) / squares);
  for (std::size_t i = 0; i < FootprintOffsets::kRays; ++i) {
    const double a = unit * sigma_across_rad * x[i], b = unit * sigma_along_rad * y[i];
    out.across[i] = static_cast<float>(a);
    out.along[i] = static_cast<float>(b);
    out.scale[i] = static_cast<float>(1.0 / std::sqrt(1.0 + a * a + b * b));
  }
  return out;
}

CANYON_VECTOR_CLONES void spread_beam(const scene::RayPacket& shots, std::size_t lane, const float* up,
                                      const FootprintOffsets& __restrict offsets, scene::RayPacket& __restrict rays) {
  const float dx = shots.direction_x[lane], dy = shots.direction_y[lane], dz = shots.direction_z[lane];
  // Across: up x direction; for a beam along the axis anything square to it.
  float ux = up[1] * dz - up[2] * dy, uy = up[2] * dx - up[0] * dz, uz = up[0] * dy - up[1] * dx;
  float square = ux * ux + uy * uy + uz * uz;
  if (square < 1e-8f) {
    const bool along_x = dx * dx > 0.5f;
    ux = along_x ? -dz : 0.0f, uy = along_x ? 0.0f : dz, uz = along_x ? dx : -dy;
    square = ux * ux + uy * uy + uz * uz;
  }
  const float unit = square > 0.0f ? 1.0f / std::sqrt(square) : 0.0f;  // 0: not traced
  ux *= unit, uy *= unit, uz *= unit;
  const float vx = dy * uz - dz * uy, vy = dz * ux - dx * uz, vz = dx * uy - dy * ux;
  const float ox = shots.origin_x[lane], oy = shots.origin_y[lane], oz = shots.origin_z[lane];
  const float max_m = shots.max_m[lane];
  for (std::size_t i = 0; i < FootprintOffsets::kRays; ++i) {
    const float a = offsets.across[i], b = offsets.along[i], s = offsets.scale[i];
    rays.direction_x[i] = s * (dx + a * ux + b * vx);
    rays.direction_y[i] = s * (dy + a * uy + b * vy);
    rays.direction_z[i] = s * (dz + a * uz + b * vz);
    rays.origin_x[i] = ox, rays.origin_y[i] = oy, rays.origin_z[i] = oz;
    rays.max_m[i] = max_m;
  }
}

}  // namespace canyon::lidar
