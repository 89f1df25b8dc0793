#include "canyon/lidar/beam/footprint/glint_sum.h"

#include <limits>

#include "canyon/core/process/vector_clones.h"

namespace canyon::lidar {
namespace {

constexpr int kRays = scene::RayPacket::kRays;

template <int kHalf, class T, class Join>
[[gnu::always_inline]] inline void join_half(T* values, const Join& join) {
  for (int i = 0; i < kHalf; ++i) values[i] = join(values[i], values[i + kHalf]);
}
/// Joins sixteen values, halves upon halves.
template <class T, class Join>
[[gnu::always_inline]] inline T join_all(T* values, const Join& join) {
  static_assert(kRays == 16);
  join_half<8>(values, join), join_half<4>(values, join), join_half<2>(values, join), join_half<1>(values, join);
  return values[0];
}

}  // namespace

CANYON_VECTOR_CLONES void sum_glints(const scene::HitPacket& hits, const float* reflectivity, float overlap_m2,
                                     GlintSum& out) {
  constexpr float kNothing_m = std::numeric_limits<float>::infinity();
  const auto add = [](float a, float b) { return a + b; };
  const auto less = [](auto a, auto b) { return a < b ? a : b; };
  const auto more = [](float a, float b) { return a > b ? a : b; };

  float near_m[kRays], far_m[kRays];
  for (int i = 0; i < kRays; ++i) {
    const float range_m = hits.range_m[i];
    near_m[i] = range_m;
    far_m[i] = range_m < kNothing_m ? range_m : 0.0f;
  }
  const float nearest_m = join_all(near_m, less);
  float each[kRays], power[kRays], beyond[kRays], cosine[kRays], most[kRays];
  for (int i = 0; i < kRays; ++i) {
    const float range_m = hits.range_m[i];
    const bool met = range_m < kNothing_m;
    const float square_m2 = range_m * range_m;
    const float received = reflectivity[i] / (square_m2 > overlap_m2 ? square_m2 : overlap_m2);
    const float p = met ? received : 0.0f;
    const float way = p * (range_m - nearest_m);
    power[i] = p;
    beyond[i] = met ? way : 0.0f;
    cosine[i] = p * hits.cos_incidence[i];
    each[i] = most[i] = met ? p : -1.0f;
  }
  const float brightest = join_all(most, more);
  int lane[kRays];
  for (int i = 0; i < kRays; ++i) lane[i] = each[i] == brightest && each[i] >= 0.0f ? i : kRays;
  out.nearest_m = nearest_m;
  out.farthest_m = join_all(far_m, more);
  out.power = join_all(power, add);
  out.beyond = join_all(beyond, add);
  out.cosine = join_all(cosine, add);
  out.brightest = join_all(lane, less);
}

}  // namespace canyon::lidar
