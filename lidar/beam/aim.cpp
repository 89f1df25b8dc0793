#include "canyon/lidar/beam/aim.h"

#include <cstring>

#include "canyon/core/process/vector_clones.h"

namespace canyon::lidar {

constexpr std::size_t kShots = AimPacket::kShots;

namespace {

/// A shot in L: where it leaves and its direction.
struct Shot {
  float ox, oy, oz, dx, dy, dz;
};

/// `cosine`, `sine`: of the head's azimuth.
[[gnu::always_inline]] inline Shot aimed(const HeadBeam& b, float cosine, float sine) {
  const float c = cosine * b.cos_azimuth - sine * b.sin_azimuth, s = sine * b.cos_azimuth + cosine * b.sin_azimuth;
  // Forward of the head is (-c, s), its left (-s, -c).
  const float hc = cosine * b.cos_turn - sine * b.sin_turn, hs = sine * b.cos_turn + cosine * b.sin_turn;
  return {-b.origin_out * hc - b.origin_left * hs,
          b.origin_out * hs - b.origin_left * hc,
          b.origin_up,
          -b.cos_elevation * c,
          b.cos_elevation * s,
          b.sin_elevation};
}

/// What the sensor turns (rad, in L) and moves (m, in W) until a shot, to first order.
struct Late {
  float wx, wy, wz, vx, vy, vz;
  Late(const PlacementPacket& at, float late_s)
      : wx(late_s * at.w_WL_L[0]),
        wy(late_s * at.w_WL_L[1]),
        wz(late_s * at.w_WL_L[2]),
        vx(late_s * at.v_WL_W[0]),
        vy(late_s * at.v_WL_W[1]),
        vz(late_s * at.v_WL_W[2]) {}
};

[[gnu::always_inline]] inline Shot placed(const Shot& shot, const PlacementPacket& at, const Late& l, std::size_t i) {
  const auto& R = at.R;
  const auto& p = at.p;
  const float dx = shot.dx + (l.wy * shot.dz - l.wz * shot.dy), dy = shot.dy + (l.wz * shot.dx - l.wx * shot.dz),
              dz = shot.dz + (l.wx * shot.dy - l.wy * shot.dx);
  return {p[0][i] + (l.vx + (R[0][i] * shot.ox + R[1][i] * shot.oy + R[2][i] * shot.oz)),
          p[1][i] + (l.vy + (R[3][i] * shot.ox + R[4][i] * shot.oy + R[5][i] * shot.oz)),
          p[2][i] + (l.vz + (R[6][i] * shot.ox + R[7][i] * shot.oy + R[8][i] * shot.oz)),
          R[0][i] * dx + R[1][i] * dy + R[2][i] * dz,
          R[3][i] * dx + R[4][i] * dy + R[5][i] * dz,
          R[6][i] * dx + R[7][i] * dy + R[8][i] * dz};
}

[[gnu::always_inline]] inline void store(const Shot& shot, std::size_t i, float max_m,
                                         scene::RayPacket& __restrict out) {
  out.origin_x[i] = shot.ox, out.origin_y[i] = shot.oy, out.origin_z[i] = shot.oz;
  out.direction_x[i] = shot.dx, out.direction_y[i] = shot.dy, out.direction_z[i] = shot.dz;
  out.max_m[i] = max_m;
}

}  // namespace

CANYON_VECTOR_CLONES void aim_head(const HeadBeam& beam, const HeadAngles& head, AimPacket& out) {
  const HeadBeam b = beam;
  const float* __restrict cosine = head.cosine;
  const float* __restrict sine = head.sine;
  AimPacket& __restrict aim = out;
  for (std::size_t i = 0; i < kShots; ++i) {
    const Shot shot = aimed(b, cosine[i], sine[i]);
    aim.origin_x[i] = shot.ox, aim.origin_y[i] = shot.oy, aim.origin_z[i] = shot.oz;
    aim.direction_x[i] = shot.dx, aim.direction_y[i] = shot.dy, aim.direction_z[i] = shot.dz;
  }
}

CANYON_VECTOR_CLONES void fire_head(const HeadBeam& beam, const HeadAngles& head, const PlacementPacket* placements,
                                    std::size_t packets, float late_s, float max_m, scene::RayPacket* out) {
  const HeadBeam b = beam;
  for (std::size_t k = 0; k < packets; ++k) {
    const float* __restrict cosine = head.cosine + k * kShots;
    const float* __restrict sine = head.sine + k * kShots;
    const PlacementPacket& __restrict at = placements[k];
    const Late late(at, late_s);
    for (std::size_t i = 0; i < kShots; ++i) store(placed(aimed(b, cosine[i], sine[i]), at, late, i), i, max_m, out[k]);
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
  const Late late(placements, late_s);
  for (std::size_t i = 0; i < kShots; ++i) {
    const Shot shot{aim.origin_x[i],    aim.origin_y[i],    aim.origin_z[i],
                    aim.direction_x[i], aim.direction_y[i], aim.direction_z[i]};
    store(placed(shot, placements, late, i), i, max_m, rays);
  }
}

}  // namespace canyon::lidar
