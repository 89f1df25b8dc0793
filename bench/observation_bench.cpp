// Reading a day of 30 s observations of all systems, Hatanaka-compressed and gzipped, beside merely unpacking the gzip
// file. Names the file in CANYON_BENCH_OBSERVATIONS; without it there is nothing to read and both are skipped.
#include <cstdlib>

#include <benchmark/benchmark.h>

#include "canyon/core/files/files.h"
#include "canyon/gnss/rinex/observation/hatanaka.h"
#include "canyon/gnss/rinex/observation/observation_file.h"

namespace {

std::string path() {
  const char* given = std::getenv("CANYON_BENCH_OBSERVATIONS");
  return given == nullptr ? "" : given;
}

void unpack_gzip(benchmark::State& state) {
  if (path().empty()) return state.SkipWithError("CANYON_BENCH_OBSERVATIONS names no file");
  for (auto _ : state) benchmark::DoNotOptimize(canyon::read_text_or_gzip_file(path()));
}

void undo_hatanaka(benchmark::State& state) {
  if (path().empty()) return state.SkipWithError("CANYON_BENCH_OBSERVATIONS names no file");
  const auto text = canyon::read_text_or_gzip_file(path());
  for (auto _ : state) benchmark::DoNotOptimize(canyon::gnss::undo_hatanaka(*text, path()));
}

void read_observations(benchmark::State& state) {
  if (path().empty()) return state.SkipWithError("CANYON_BENCH_OBSERVATIONS names no file");
  std::size_t epochs = 0;
  for (auto _ : state) {
    const auto file = canyon::gnss::read_observation_file(path());
    if (!file.ok()) return state.SkipWithError(file.error().str().c_str());
    epochs = file->epochs.size();
  }
  state.counters["epochs"] = static_cast<double>(epochs);
}

BENCHMARK(unpack_gzip)->Unit(benchmark::kMillisecond);
BENCHMARK(undo_hatanaka)->Unit(benchmark::kMillisecond);
BENCHMARK(read_observations)->Unit(benchmark::kMillisecond);

}  // namespace
