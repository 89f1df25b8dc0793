#include "canyon/study/statistics/block_bootstrap.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "canyon/core/random/random.h"

namespace canyon::study {
namespace {

constexpr std::size_t kReplicates = 1000;
constexpr std::size_t kFewest = 8;  // samples: four blocks of two

double rms_of(const SquareSum& total) {
  return total.count > 0 ? std::sqrt(total.sum / total.count) : kNaN;
}

SquareSum replicate(std::span<const SquareSum> samples, std::size_t length, const RandomStream& stream,
                    std::uint64_t index) {
  SquareSum total;
  for (std::size_t taken = 0, block = 0; taken < samples.size(); ++block) {
    const auto first = static_cast<std::size_t>(stream.uniform(static_cast<std::uint32_t>(block), index) *
                                                static_cast<double>(samples.size()));
    for (std::size_t i = 0; i < length && taken < samples.size(); ++i, ++taken) {
      const SquareSum& one = samples[(first + i) % samples.size()];
      total.sum += one.sum;
      total.count += one.count;
    }
  }
  return total;
}

}  // namespace

RmsEstimate block_bootstrap_rms(std::span<const SquareSum> samples, std::uint64_t seed) {
  SquareSum total;
  for (const SquareSum& one : samples) total = {total.sum + one.sum, total.count + one.count};
  RmsEstimate out;
  out.rms = rms_of(total);
  if (samples.size() < kFewest || !std::isfinite(out.rms)) return out;
  const auto length = static_cast<std::size_t>(std::ceil(std::cbrt(static_cast<double>(samples.size())) - 1e-9));
  const RandomStream stream(seed, "tradeoff.bootstrap");
  std::vector<double> values;
  for (std::size_t r = 0; r < kReplicates; ++r) {
    const double value = rms_of(replicate(samples, length, stream, r));
    if (std::isfinite(value)) values.push_back(value);
  }
  if (values.size() < 2) return out;
  std::sort(values.begin(), values.end());
  double mean = 0.0, square = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  for (const double value : values) square += (value - mean) * (value - mean);
  out.sigma = std::sqrt(square / static_cast<double>(values.size() - 1));
  const auto quantile = [&](double q) {
    return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
  };
  out.interval = {quantile(0.025), quantile(0.975)};
  return out;
}

}  // namespace canyon::study
