#pragma once

#include "canyon/scene/tracing/ray_packet.h"

namespace canyon::lidar {

/// Where the sub-rays of a beam point: tangents of the angles off its middle, and what makes the direction a unit
/// vector again.
struct alignas(64) FootprintOffsets {
  static constexpr std::size_t kRays = scene::RayPacket::kRays;
  float across[kRays], along[kRays], scale[kRays];
};

/// Sixteen directions of equal energy for a Gaussian beam: four rings of four, each ring in the middle of its quarter
/// of the energy. Mean 0, standard deviations as given, no correlation, to rounding. `across` is along the turn of the
/// head, `along` along its axis.
FootprintOffsets footprint_offsets(double sigma_across_rad, double sigma_along_rad);

/// The sub-rays of the shot in `lane` of a packet. `up` is the spin axis in W; a lane that is not traced gives none.
void spread_beam(const scene::RayPacket& shots, std::size_t lane, const float* up, const FootprintOffsets& offsets,
                 scene::RayPacket& out);

}  // namespace canyon::lidar
