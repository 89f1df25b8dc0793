#include "lidar/aim.h"

#include <cstring>

#include "core/vector_clones.h"

namespace canyon::lidar {

constexpr std::size_t kShots = AimPacket::kShots;

CANYON_VECTOR_CLONES void aim_head(const HeadBeam& beam, const HeadAngles& head, AimPacket& out) {
  const HeadBeam b = beam;
  const float* __restrict cosine = head.cosine;
  const float* __restrict sine = head.sine;
  AimPacket& __restrict aim = out;
  for (std::size_t i = 0; i < kShots; ++i) {
    const float c = cosine[i] * b.cos_azimuth - sine[i] * b.sin_azimuth;
    const float s = sine[i] * b.cos_azimuth + cosine[i] * b.sin_azimuth;
    aim.direction_x[i] = -b.cos_elevation * c;
    aim.direction_y[i] = b.cos_elevation * s;
    aim.direction_z[i] = b.sin_elevation;
  }
  for (std::size_t i = 0; i < kShots; ++i) {
    // Forward of the head is (-c, s), its left (-s, -c).
    const float c = cosine[i] * b.cos_turn - sine[i] * b.sin_turn;
    const float s = sine[i] * b.cos_turn + cosine[i] * b.sin_turn;
    aim.origin_x[i] = -b.origin_out * c - b.origin_left * s;
    aim.origin_y[i] = b.origin_out * s - b.origin_left * c;
    aim.origin_z[i] = b.origin_up;
  }
}

CANYON_VECTOR_CLONES void bend_placements(const double* node, const double* rate_before, const double* rate_after,
                                          double time_s, double step_s, PlacementPacket& out) {
  double early_s[kShots], late_s[kShots];
  for (std::size_t i = 0; i < kShots; ++i) {
    const double t = time_s + static_cast<double>(static_cast<int>(i)) * step_s;
    early_s[i] = t < 0.0 ? t : 0.0;
    late_s[i] = t < 0.0 ? 0.0 : t;
  }
  for (std::size_t k = 0; k < 12; ++k) {
    const double start = node[k], before = rate_before[k], after = rate_after[k];
    float* __restrict row = k < 9 ? out.R[3 * (k % 3) + k / 3] : out.p[k - 9];
    for (std::size_t i = 0; i < kShots; ++i)
      row[i] = static_cast<float>(start + (early_s[i] * before + late_s[i] * after));
  }
}

CANYON_VECTOR_CLONES void spread_some_placements(const double* from, const double* to, const double* shares,
                                                 const int* among, PlacementPacket& out) {
  double share[kShots];
  int taken[kShots];
  std::memcpy(share, shares, sizeof share);
  std::memcpy(taken, among, sizeof taken);
  for (std::size_t k = 0; k < 12; ++k) {
    const double start = from[k], change = to[k] - from[k];
    float* row = k < 9 ? out.R[3 * (k % 3) + k / 3] : out.p[k - 9];
    float values[kShots];
    std::memcpy(values, row, sizeof values);
    for (std::size_t i = 0; i < kShots; ++i) {
      const auto value = static_cast<float>(start + share[i] * change);
      values[i] = taken[i] != 0 ? value : values[i];
    }
    std::memcpy(row, values, sizeof values);
  }
}

CANYON_VECTOR_CLONES void place_shots(const AimPacket& __restrict aim, const PlacementPacket& __restrict placements,
                                      float late_s, float max_m, scene::RayPacket& __restrict rays) {
  // What the sensor turns and moves until the shot, to first order.
  const float wx = late_s * placements.w_WL_L[0], wy = late_s * placements.w_WL_L[1],
              wz = late_s * placements.w_WL_L[2];
  const float vx = late_s * placements.v_WL_W[0], vy = late_s * placements.v_WL_W[1],
              vz = late_s * placements.v_WL_W[2];
  const auto& R = placements.R;
  const auto& p = placements.p;
  for (std::size_t i = 0; i < kShots; ++i) {
    const float x = aim.direction_x[i], y = aim.direction_y[i], z = aim.direction_z[i];
    const float dx = x + (wy * z - wz * y), dy = y + (wz * x - wx * z), dz = z + (wx * y - wy * x);
    const float ox = aim.origin_x[i], oy = aim.origin_y[i], oz = aim.origin_z[i];
    rays.direction_x[i] = R[0][i] * dx + R[1][i] * dy + R[2][i] * dz;
    rays.direction_y[i] = R[3][i] * dx + R[4][i] * dy + R[5][i] * dz;
    rays.direction_z[i] = R[6][i] * dx + R[7][i] * dy + R[8][i] * dz;
    rays.origin_x[i] = p[0][i] + (vx + (R[0][i] * ox + R[1][i] * oy + R[2][i] * oz));
    rays.origin_y[i] = p[1][i] + (vy + (R[3][i] * ox + R[4][i] * oy + R[5][i] * oz));
    rays.origin_z[i] = p[2][i] + (vz + (R[6][i] * ox + R[7][i] * oy + R[8][i] * oz));
    rays.max_m[i] = max_m;
  }
}

}  // namespace canyon::lidar
