#include "canyon/study/tradeoff/measuring/repetitions.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "canyon/core/check.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/random/random.h"

namespace canyon::study {
namespace {

constexpr double kShortest_s = 2e-3;

bool same_bits(const Samples& a, const Samples& b) {
  if (a.values.size() != b.values.size()) return false;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    const auto &x = a.values[i], &y = b.values[i];
    if (x.size() != y.size() || (!x.empty() && std::memcmp(x.data(), y.data(), x.size() * sizeof(double)) != 0))
      return false;
  }
  return true;
}

}  // namespace

double Repeated::median_s() const {
  std::vector<double> sorted = cpu_s;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t n = sorted.size();
  return n % 2 == 1 ? sorted[n / 2] : 0.5 * (sorted[n / 2 - 1] + sorted[n / 2]);
}
double Repeated::least_s() const {
  return *std::min_element(cpu_s.begin(), cpu_s.end());
}
double Repeated::most_s() const {
  return *std::max_element(cpu_s.begin(), cpu_s.end());
}

std::vector<std::size_t> shuffled(std::size_t count, std::uint64_t seed, std::uint64_t repetition) {
  const RandomStream stream(seed, "tradeoff.order");
  std::vector<std::size_t> order(count);
  for (std::size_t i = 0; i < count; ++i) order[i] = i;
  for (std::size_t i = count; i > 1; --i)  // Fisher & Yates
    std::swap(order[i - 1], order[static_cast<std::size_t>(stream.uniform(static_cast<std::uint32_t>(i), repetition) *
                                                           static_cast<double>(i))]);
  return order;
}

Result<std::vector<Repeated>> repeat(const std::vector<std::unique_ptr<Probe>>& probes, int repetitions,
                                     std::uint64_t seed) {
  std::vector<Repeated> out(probes.size());
  std::vector<int> times(probes.size(), 1);
  for (std::size_t i = 0; i < probes.size(); ++i) {
    throw_if_cancelled();
    CANYON_TRY(out[i].first, probes[i]->run());
    times[i] = static_cast<int>(std::clamp(kShortest_s / std::max(out[i].first.cpu_s, 1e-9), 1.0, 1e4));
  }
  for (int r = 0; r < repetitions; ++r) {
    for (const std::size_t i : shuffled(probes.size(), seed, static_cast<std::uint64_t>(r))) {
      double cpu_s = 0.0;
      for (int k = 0; k < times[i]; ++k) {
        throw_if_cancelled();
        CANYON_TRY(const ProbeRun run, probes[i]->run());
        CANYON_CHECK(run.work == out[i].first.work, "work ", run.work, " after ", out[i].first.work);
        CANYON_CHECK(same_bits(run.samples, out[i].first.samples), "a probe that gives other values each time");
        cpu_s += run.cpu_s;
      }
      out[i].cpu_s.push_back(cpu_s / times[i]);
    }
  }
  return out;
}

}  // namespace canyon::study
