// Normal random numbers: our counter-based streams, one by one and in batches, beside the standard library's generator.
#include <random>
#include <vector>

#include <benchmark/benchmark.h>

#include "canyon/core/random/random.h"

namespace {

constexpr std::size_t kNumbers = 4096;

void standard_library(benchmark::State& state) {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  std::vector<double> out(kNumbers);
  for (auto _ : state) {
    for (double& x : out) x = normal(generator);
    benchmark::DoNotOptimize(out.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kNumbers));
}
BENCHMARK(standard_library)->Name("normal/mt19937_64");

void one_by_one(benchmark::State& state) {
  const canyon::RandomStream stream(1, "bench.normal");
  std::vector<double> out(kNumbers);
  for (auto _ : state) {
    for (std::size_t i = 0; i < kNumbers; ++i) out[i] = stream.normal(0, i);
    benchmark::DoNotOptimize(out.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kNumbers));
}
BENCHMARK(one_by_one)->Name("normal/canyon_one_by_one");

void batch(benchmark::State& state) {
  const canyon::RandomStream stream(1, "bench.normal");
  std::vector<double> out(kNumbers);
  for (auto _ : state) {
    stream.fill_normal(out, 0, 0);
    benchmark::DoNotOptimize(out.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kNumbers));
}
BENCHMARK(batch)->Name("normal/canyon_batch");

}  // namespace
