// Reading an IMU log: 3300 s of KF-GINS text at 200 Hz, some 75 MB, beside the bare conversion of the same numbers.
#include <charconv>
#include <cstdio>
#include <filesystem>

#include <benchmark/benchmark.h>
#include <unistd.h>

#include "canyon/core/check.h"
#include "canyon/core/files/files.h"
#include "canyon/inertial/imu_log.h"

namespace canyon::inertial {
namespace {

constexpr int kLines = 660'000;

std::string text_of_a_drive() {
  std::string text;
  char line[200];
  for (int k = 1; k <= kLines; ++k) {
    // Level and slowly turning; digits differ from line to line, as noise makes them.
    const double noise = 1e-6 * (static_cast<double>(std::int64_t{k} * 7919 % 1009) - 504.0) / 504.0;
    std::snprintf(line, sizeof line, "%.6f %.12e %.12e %.12e %.12e %.12e %.12e\n", 457000.0 + 0.005 * k, 1e-6 + noise,
                  2e-6 - noise, 3e-5 + 2 * noise, 1e-4 + 3 * noise, -2e-4 + noise, -0.049 + noise);
    text += line;
  }
  return text;
}

void bare_conversion(benchmark::State& state) {
  const std::string text = text_of_a_drive();
  for (auto _ : state) {
    double sum = 0.0, value = 0.0;
    for (const char *at = text.data(), *end = at + text.size(); at < end; ++at) {
      at = std::from_chars(at, end, value).ptr;
      sum += value;
    }
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * kLines);
}
BENCHMARK(bare_conversion)->Name("imu_log/numbers_alone")->Unit(benchmark::kMillisecond);

void read_log(benchmark::State& state) {
  const std::string path =
      (std::filesystem::temp_directory_path() / ("canyon-bench-" + std::to_string(getpid()) + ".txt")).string();
  CANYON_CHECK(write_text_file(path, text_of_a_drive()).ok(), path);
  for (auto _ : state) {
    const auto log = read_imu_log(path, {.columns = "kf_gins", .mend = true});
    CANYON_CHECK(log.ok() && log->size() == kLines, path);
    benchmark::DoNotOptimize(log->t_s.data());
  }
  std::filesystem::remove(path);
  state.SetItemsProcessed(state.iterations() * kLines);
}
BENCHMARK(read_log)->Name("imu_log/3300_s_at_200_hz")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace canyon::inertial
