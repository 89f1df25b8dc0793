#include "canyon/gnss/receiver/loop_noise.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/check.h"

namespace canyon::gnss {
namespace {

constexpr std::size_t kLongest = 1024;  // a loop slower than 60 epochs is cut off there, its variance kept

}  // namespace

LoopNoise::LoopNoise(std::uint64_t seed, std::string_view name, double loop_hz, double interval_s)
    : draws_(seed, name), rho_(std::exp(-4.0 * loop_hz * interval_s)) {
  CANYON_CHECK(loop_hz > 0.0 && interval_s > 0.0, "loop_hz = ", loop_hz, ", interval_s = ", interval_s);
  double weight = 1.0, sum = 0.0;
  while (weight > 1e-8 && weights_.size() < kLongest) {
    weights_.push_back(weight);
    sum += weight * weight;
    weight *= rho_;
  }
  for (double& w : weights_) w /= std::sqrt(sum);
}

double LoopNoise::at(std::uint32_t entity, std::int64_t index) const {
  CANYON_CHECK(index >= 0, "index = ", index);
  // The draws of epochs before the start have positive numbers too.
  const std::size_t n = weights_.size();
  std::vector<double> w(n);
  draws_.fill_normal(w, entity, static_cast<std::uint64_t>(index));
  double sum = 0.0;
  for (std::size_t j = 0; j < n; ++j) sum += weights_[j] * w[n - 1 - j];
  return sum;
}

}  // namespace canyon::gnss
