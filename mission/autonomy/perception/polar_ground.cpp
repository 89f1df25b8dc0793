#include "canyon/mission/autonomy/perception/polar_ground.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "canyon/core/process/parallel.h"

namespace canyon::mission {
namespace {

constexpr float kNone = std::numeric_limits<float>::infinity();
constexpr std::size_t kPolarChunk = 4096;  // returns
constexpr float kWidth = static_cast<float>(PolarGround::kBin_m);

}  // namespace

PolarGround::PolarGround(const Rule& rule, double reach_m)
    : rule_(rule), bins_(static_cast<int>(std::ceil(reach_m / kBin_m)) + 1) {
  lowest_.resize(slot(kSectors, 0));
  height_.resize(slot(kSectors, 0));
  last_seen_.resize(kSectors);
}

/// By |x| + |y| instead of an angle: a third of the work, and sectors differ in width by a factor of two at most.
int PolarGround::sector(float x, float y) {
  const float sum = std::abs(x) + std::abs(y);
  if (sum <= 0.0F) return 0;
  const float q = y / sum;                             // from -1 to 1 over the half plane ahead
  const float turn = x >= 0.0F ? 1.0F + q : 3.0F - q;  // from 0 to 4
  return std::clamp(static_cast<int>(0.25F * kSectors * turn), 0, kSectors - 1);
}

void PolarGround::fit(const std::vector<PlaneReturn>& returns) {
  std::fill(lowest_.begin(), lowest_.end(), Lowest{kNone, 0.0F});
  polar_.resize(returns.size());
  parallel_for(returns.size(), kPolarChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const PlaneReturn& r = returns[k];
      polar_[k] = {sector(r.x_m, r.y_m), std::sqrt(r.x_m * r.x_m + r.y_m * r.y_m)};
    }
  });
  for (std::size_t k = 0; k < returns.size(); ++k) {
    const auto [sector, distance] = polar_[k];
    const int bin = static_cast<int>(distance / kWidth);
    if (bin >= bins_) continue;
    Lowest& lowest = lowest_[slot(sector, bin)];
    if (returns[k].above_m < lowest.above_m) lowest = {returns[k].above_m, distance};
  }
  parallel_for(kSectors, kSectors / 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) walk(static_cast<int>(s));
  });
}

void PolarGround::walk(int sector) {
  const auto slope = static_cast<float>(rule_.max_slope), noise = static_cast<float>(rule_.noise_m);
  float from_m = 0.0F, from_above = 0.0F;  // it stands on the ground
  int filled = 0;
  const auto fill = [&](int until, float to_m, float to_above) {
    for (; filled < until; ++filled) {
      const float at_m = (static_cast<float>(filled) + 0.5F) * kWidth;
      const float share = to_m > from_m ? std::clamp((at_m - from_m) / (to_m - from_m), 0.0F, 1.0F) : 1.0F;
      height_[slot(sector, filled)] = from_above + share * (to_above - from_above);
    }
  };
  for (int bin = 0; bin < bins_; ++bin) {
    const Lowest& lowest = lowest_[slot(sector, bin)];
    if (lowest.above_m == kNone) continue;
    if (std::abs(lowest.above_m - from_above) > slope * (lowest.distance_m - from_m) + noise) continue;
    fill(bin + 1, lowest.distance_m, lowest.above_m);
    from_m = lowest.distance_m;
    from_above = lowest.above_m;
  }
  last_seen_[static_cast<std::size_t>(sector)] = from_m;
  fill(bins_, from_m, from_above);
}

PolarGround::Height PolarGround::at(int sector, float distance_m) const {
  const int bin = std::min(bins_ - 1, static_cast<int>(distance_m / kWidth));
  const float beyond = distance_m - last_seen_[static_cast<std::size_t>(sector)];
  return {height_[slot(sector, bin)], std::max(0.0F, beyond) * static_cast<float>(rule_.max_slope)};
}

}  // namespace canyon::mission
