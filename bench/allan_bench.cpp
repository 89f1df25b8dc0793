// Overlapping Allan deviation of 12 million samples at 100 averaging times, beside the textbook's loop over the same
// phase data.
#include <cmath>
#include <numeric>
#include <vector>

#include <benchmark/benchmark.h>

#include "canyon/core/process/parallel.h"
#include "canyon/core/random/random.h"
#include "canyon/inertial/allan/deviation.h"

namespace {

constexpr std::size_t kSamples = 12'000'000;

const std::vector<double>& samples() {
  static const std::vector<double> out = [] {
    std::vector<double> x(kSamples);
    canyon::RandomStream(1, "bench.allan").fill_normal(x, 0, 0);
    return x;
  }();
  return out;
}

/// 100 factors, even in the logarithm.
const std::vector<std::int64_t>& factors() {
  static const std::vector<std::int64_t> out = [] {
    std::vector<std::int64_t> m;
    for (double f = 1.0; m.size() < 100; f *= 1.14) {
      const std::int64_t whole = std::llround(f);
      if (m.empty() || whole > m.back()) m.push_back(whole);
    }
    return m;
  }();
  return out;
}

void ours(benchmark::State& state) {
  canyon::set_threads(static_cast<int>(state.range(0)));
  const canyon::inertial::Sampling sampling{0.01, {{0, kSamples}}, 0.0};
  for (auto _ : state)
    benchmark::DoNotOptimize(canyon::inertial::deviation("overlapping", samples(), sampling, factors()));
  canyon::set_threads(0);
}
BENCHMARK(ours)->Name("adev_12M_100_taus/canyon_threads")->Arg(1)->Arg(2)->Unit(benchmark::kSecond)->UseRealTime();

void textbook(benchmark::State& state) {
  for (auto _ : state) {
    std::vector<double> phase(kSamples + 1, 0.0);
    std::partial_sum(samples().begin(), samples().end(), phase.begin() + 1);
    for (const std::int64_t factor : factors()) {
      const auto m = static_cast<std::size_t>(factor);
      double sum = 0.0;
      for (std::size_t k = 0; k + 2 * m < phase.size(); ++k) {
        const double d = phase[k + 2 * m] - 2.0 * phase[k + m] + phase[k];
        sum += d * d;
      }
      benchmark::DoNotOptimize(sum);
    }
  }
}
BENCHMARK(textbook)->Name("adev_12M_100_taus/textbook_loop")->Unit(benchmark::kSecond)->UseRealTime();

}  // namespace
