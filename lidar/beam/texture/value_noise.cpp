#include "canyon/lidar/beam/texture/value_noise.h"

#include <bit>

#include "canyon/core/process/vector_clones.h"

namespace canyon::lidar {
namespace {

// The rotation of the quaternion (1, sqrt 2, sqrt 3, sqrt 5) / sqrt 11.
constexpr double kTurn[3][3] = {{-0.45454545454545453, 0.03880395732425244, 0.8898779032249557},
                                {0.8519195855059941, -0.2727272727272727, 0.4470490516062403},
                                {0.2600412459271822, 0.9613085288328204, 0.09090909090909091}};
constexpr std::size_t kPlaces = scene::RayPacket::kRays;

/// What a corner has, in [-2^31, 2^31): two rounds of shift and multiply (constants of Wellons' lowbias32), of which
/// the upper bits count. One round would leave corners beside one another correlated: their sums differ by a constant.
[[gnu::always_inline]] inline float corner(std::uint32_t mixed) {
  const std::uint32_t once = (mixed ^ (mixed >> 16)) * 0x7feb352du;
  const std::uint32_t twice = (once ^ (once >> 15)) * 0x846ca68bu;
  return static_cast<float>(static_cast<std::int32_t>(twice));
}

/// A coordinate in grains, cut into the number of its cube and how far in it lies. Cubes are counted from the one that
/// a place is in, up to its upper face: the same brightness either way.
struct Cut {
  std::uint32_t cube;
  float share;
};
[[gnu::always_inline]] inline Cut cut(double at) {
  constexpr double kShift = 6755399441055744.0;  // 1.5 * 2^52: its last bits count whole numbers, for |at| < 2^51
  const double shifted = (at - 0.5) + kShift;
  const auto share = static_cast<float>(at - (shifted - kShift));
  const float least = share > 0.0f ? share : 0.0f;
  return {static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(shifted)), least < 1.0f ? least : 1.0f};
}

[[gnu::always_inline]] inline float between(float a, float b, float share) {
  return a + share * (b - a);
}

[[gnu::always_inline]] inline float varied(double x, double y, double z, double per_m, float widest,
                                           std::uint32_t key) {
  const Cut i = cut(per_m * (kTurn[0][0] * x + kTurn[0][1] * y + kTurn[0][2] * z));
  const Cut j = cut(per_m * (kTurn[1][0] * x + kTurn[1][1] * y + kTurn[1][2] * z));
  const Cut k = cut(per_m * (kTurn[2][0] * x + kTurn[2][1] * y + kTurn[2][2] * z));
  constexpr std::uint32_t kI = 0x9e3779b1u, kJ = 0x85ebca77u, kK = 0xc2b2ae3du;  // odd, of no simple ratio
  const std::uint32_t first = key + i.cube * kI + j.cube * kJ + k.cube * kK;
  const float a = between(corner(first), corner(first + kI), i.share);
  const float b = between(corner(first + kJ), corner(first + kJ + kI), i.share);
  const float c = between(corner(first + kK), corner(first + kK + kI), i.share);
  const float d = between(corner(first + kK + kJ), corner(first + kK + kJ + kI), i.share);
  return 1.0f + (widest * 0x1p-31f) * between(between(a, b, j.share), between(c, d, j.share), k.share);
}

}  // namespace

CANYON_VECTOR_CLONES void vary(const Places& places, const Grains& grains, float* factor) {
  float out[kPlaces];
  for (std::size_t i = 0; i < kPlaces; ++i)
    out[i] = varied(places.x[i], places.y[i], places.z[i], static_cast<double>(grains.per_m[i]), grains.widest[i],
                    grains.key[i]);
  for (std::size_t i = 0; i < kPlaces; ++i) factor[i] = out[i];
}

float vary(const Eigen::Vector3d& p_W, float widest, float per_m, std::uint32_t key) {
  return varied(p_W.x(), p_W.y(), p_W.z(), static_cast<double>(per_m), widest, key);
}

}  // namespace canyon::lidar
