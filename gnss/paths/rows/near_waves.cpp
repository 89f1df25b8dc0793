#include "canyon/gnss/paths/rows/near_waves.h"

#include <algorithm>
#include <bit>

#include "canyon/core/process/vector_clones.h"

namespace canyon::gnss {
namespace {

constexpr std::size_t kAxesAtOnce = 64, kWavesAtOnce = 32;

struct AxisColumns {
  const float *x, *y, *z, *least;
  std::size_t count;
};
struct WaveColumns {
  const float *x, *y, *z;
  std::size_t count;
};

/// Bit k of `near[i]`: wave k, of 32 at most, comes from near axis i.
CANYON_VECTOR_CLONES void write_near(const AxisColumns& axes, const WaveColumns& waves,
                                     std::uint32_t* __restrict near) {
  for (std::size_t i = 0; i < axes.count; ++i) near[i] = 0;
  for (std::size_t k = 0; k < waves.count; ++k) {
    const float x = waves.x[k], y = waves.y[k], z = waves.z[k];
    const std::uint32_t bit = 1U << k;
    for (std::size_t i = 0; i < axes.count; ++i) {
      const float along = axes.x[i] * x + axes.y[i] * y + axes.z[i] * z;
      near[i] |= along >= axes.least[i] ? bit : 0U;
    }
  }
}

}  // namespace

void NearWaves::fill(std::span<const Eigen::Vector3d> directions_W) {
  for (auto* of : {&x_, &y_, &z_}) of->resize(directions_W.size());
  for (std::size_t i = 0; i < directions_W.size(); ++i) {
    x_[i] = static_cast<float>(directions_W[i].x());
    y_[i] = static_cast<float>(directions_W[i].y());
    z_[i] = static_cast<float>(directions_W[i].z());
  }
}

void NearWaves::find(const WaveAxes& axes, std::vector<AxisAndWave>& out) const {
  const std::size_t words = (x_.size() + kWavesAtOnce - 1) / kWavesAtOnce;
  thread_local std::vector<std::uint32_t> near;
  near.resize(words * kAxesAtOnce);
  out.clear();
  for (std::size_t begin = 0; begin < axes.size(); begin += kAxesAtOnce) {
    const std::size_t count = std::min(kAxesAtOnce, axes.size() - begin);
    for (std::size_t word = 0; word < words; ++word) {
      const std::size_t first = word * kWavesAtOnce;
      write_near(
          {axes.x.data() + begin, axes.y.data() + begin, axes.z.data() + begin, axes.least.data() + begin, count},
          {x_.data() + first, y_.data() + first, z_.data() + first, std::min(kWavesAtOnce, x_.size() - first)},
          near.data() + word * kAxesAtOnce);
    }
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t word = 0; word < words; ++word)
        for (std::uint32_t left = near[word * kAxesAtOnce + i]; left != 0; left &= left - 1)
          out.push_back(
              {static_cast<std::uint32_t>(begin + i),
               static_cast<std::uint32_t>(word * kWavesAtOnce) + static_cast<std::uint32_t>(std::countr_zero(left))});
  }
}

}  // namespace canyon::gnss
