#pragma once

#include "canyon/scene/tracing/ray_packet.h"

namespace canyon::lidar {

/// Sixteen shots in the sensor's frame L as plain arrays: where each leaves (m) and its unit direction.
struct alignas(64) AimPacket {
  static constexpr std::size_t kShots = scene::RayPacket::kRays;
  float origin_x[kShots], origin_y[kShots], origin_z[kShots];
  float direction_x[kShots], direction_y[kShots], direction_z[kShots];
};

/// X_WL at sixteen evenly spaced times, with the rates of the motion there, so that shots a few microseconds later are
/// placed from the same numbers.
struct alignas(64) PlacementPacket {
  static constexpr std::size_t kShots = AimPacket::kShots;
  float R[9][kShots];    ///< row by row
  float p[3][kShots];    ///< m, in W
  float w_WL_L[3] = {};  ///< rad/s
  float v_WL_W[3] = {};  ///< m/s
};

/// Azimuths of the head at evenly spaced steps, clockwise seen from above from -x of L, as sine and cosine.
struct HeadAngles {
  const float* cosine;
  const float* sine;
};

/// A laser on the turning head: what is fixed as the head turns. `turn` is the azimuth added to each step's.
struct HeadBeam {
  float cos_turn, sin_turn;        ///< of the head's direction
  float cos_azimuth, sin_azimuth;  ///< of the beam's azimuth: turn plus its offset
  float cos_elevation, sin_elevation;
  float origin_out, origin_left, origin_up;  ///< m
};

/// Sixteen steps of one laser, from `head` on.
void aim_head(const HeadBeam& beam, const HeadAngles& head, AimPacket& out);
/// aim_head() and place_shots() in one, to the same bits, of many packets.
void fire_head(const HeadBeam& beam, const HeadAngles& head, const PlacementPacket* placements, std::size_t packets,
               float late_s, float max_m, scene::RayPacket* out);

/// Placements about a node: R by columns and p, twelve numbers, there, and their rates before and after it; at the
/// times time_s + i * step_s after it.
void bend_placements(const double* node, const double* rate_before, const double* rate_after, double time_s,
                     double step_s, PlacementPacket& out);

/// Placements between two nodes, for the lanes of which `among` is not 0, each at its own share of the way; the others
/// stay as they are.
void spread_some_placements(const double* from, const double* to, const double* shares, const int* among,
                            PlacementPacket& out);

/// Rays in W of shots fired `late_s` after the times of the placements; their reach is max_m.
void place_shots(const AimPacket& aim, const PlacementPacket& placements, float late_s, float max_m,
                 scene::RayPacket& out);

}  // namespace canyon::lidar
