#include "canyon/gnss/paths/rows/near_waves.h"

#include <algorithm>
#include <limits>

#include "canyon/core/process/vector_clones.h"

namespace canyon::gnss {
namespace {

constexpr std::size_t kWaveRow = 8, kAxesAtOnce = 64;

struct AxisColumns {
  const float *x, *y, *z, *least;
  std::size_t begin, end;
};
struct WaveColumns {
  const float *x, *y, *z;
  std::size_t count;  ///< whole rows
};

/// Returns how many pairs it wrote; there is room for all.
CANYON_VECTOR_CLONES std::size_t write_near(const AxisColumns& axes, const WaveColumns& waves, AxisAndWave* out) {
  AxisAndWave* next = out;
  for (std::size_t i = axes.begin; i < axes.end; ++i) {
    const float x = axes.x[i], y = axes.y[i], z = axes.z[i], least = axes.least[i];
    for (std::size_t begin = 0; begin < waves.count; begin += kWaveRow) {
      std::uint32_t reaches[kWaveRow], any = 0;
      for (std::size_t j = 0; j < kWaveRow; ++j) {
        const float along = x * waves.x[begin + j] + y * waves.y[begin + j] + z * waves.z[begin + j];
        reaches[j] = along >= least ? 1U : 0U;
      }
      for (std::size_t j = 0; j < kWaveRow; ++j) any |= reaches[j];
      if (any == 0) continue;
      for (std::size_t j = 0; j < kWaveRow; ++j)
        if (reaches[j] != 0) *next++ = {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(begin + j)};
    }
  }
  return static_cast<std::size_t>(next - out);
}

}  // namespace

void NearWaves::fill(std::span<const Eigen::Vector3d> directions_W) {
  const std::size_t rows = (directions_W.size() + kWaveRow - 1) / kWaveRow;
  for (auto* of : {&x_, &y_, &z_}) of->assign(rows * kWaveRow, std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < directions_W.size(); ++i) {
    x_[i] = static_cast<float>(directions_W[i].x());
    y_[i] = static_cast<float>(directions_W[i].y());
    z_[i] = static_cast<float>(directions_W[i].z());
  }
}

void NearWaves::find(const WaveAxes& axes, std::vector<AxisAndWave>& out) const {
  thread_local std::vector<AxisAndWave> some;
  some.resize(kAxesAtOnce * x_.size());
  out.clear();
  for (std::size_t begin = 0; begin < axes.size(); begin += kAxesAtOnce) {
    const std::size_t count = write_near({axes.x.data(), axes.y.data(), axes.z.data(), axes.least.data(), begin,
                                          std::min(begin + kAxesAtOnce, axes.size())},
                                         {x_.data(), y_.data(), z_.data(), x_.size()}, some.data());
    out.insert(out.end(), some.begin(), some.begin() + static_cast<std::ptrdiff_t>(count));
  }
}

}  // namespace canyon::gnss
