#pragma once

#include "canyon/scene/tracing/ray_packet.h"

namespace canyon::lidar {

/// Sixteen glints of equal energy, weighted by what the receiver gets of each: reflectivity over the square of its
/// range, nearer than full overlap over that of the overlap.
struct GlintSum {
  float nearest_m = 0.0f, farthest_m = 0.0f;  ///< of the rays that met something; infinity and 0 if none did
  float power = 0.0f;                         ///< of all
  float beyond = 0.0f;                        ///< of each times its way beyond the nearest, summed
  float cosine = 0.0f;                        ///< of each times its cos_incidence, summed
  int brightest = 0;                          ///< lane; the first of equals; 16: nothing was met
};

/// Sums in a fixed order, so that the bits do not depend on the processor.
void sum_glints(const scene::HitPacket& hits, const float* reflectivity, float overlap_m2, GlintSum& out);

}  // namespace canyon::lidar
