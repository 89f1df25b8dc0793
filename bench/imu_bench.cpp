// Errors of an IMU: six-axis samples per second of the chains on one thread, and normals per second beside them, with
// the same generator and the C library's functions as the peer.
#include <cmath>
#include <string>
#include <vector>

#include <Random123/philox.h>
#include <benchmark/benchmark.h>

#include "canyon/core/check.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/inertial/error_chain.h"
#include "canyon/inertial/errors/error_link.h"
#include "canyon/inertial/errors/flicker.h"
#include "canyon/tests/inertial/every_link.h"

namespace canyon::inertial {
namespace {

constexpr std::size_t kSamples = 4096;
constexpr double kRate_hz = 100.0;

void bare_generator(benchmark::State& state) {
  std::uint32_t block = 0;
  for (auto _ : state) {
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < kSamples; ++i) sum ^= r123::Philox4x32_R<10>()({{block++, 0, 0, 0}}, {{1, 2}})[0];
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kSamples));
}
BENCHMARK(bare_generator)->Name("philox/calls_of_four_words");

/// Scalar Philox and Box-Muller with the C library's log, sine and cosine.
void philox_and_libm(benchmark::State& state) {
  std::uint32_t block = 0;
  std::vector<double> out(kSamples);
  for (auto _ : state) {
    for (std::size_t i = 0; i < kSamples; i += 2) {
      const auto w = r123::Philox4x32_R<10>()({{block++, 0, 0, 0}}, {{1, 2}});
      const double radius = std::sqrt(-2.0 * std::log((w[0] + 1.0) * 0x1p-32));
      const double angle = 2.0 * kPi * w[2] * 0x1p-32;
      out[i] = radius * std::cos(angle);
      out[i + 1] = radius * std::sin(angle);
    }
    benchmark::DoNotOptimize(out.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kSamples));
}
BENCHMARK(philox_and_libm)->Name("normal/scalar_philox_and_libm");

void batch_of_normals(benchmark::State& state) {
  const RandomStream stream(1, "bench.imu");
  std::vector<double> out(kSamples);
  std::uint64_t first = 0;
  for (auto _ : state) {
    stream.fill_normal(out, 0, first);
    first += kSamples;
    benchmark::DoNotOptimize(out.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kSamples));
}
BENCHMARK(batch_of_normals)->Name("normal/canyon_batch");

void batch_of_uniforms(benchmark::State& state) {
  const RandomStream stream(1, "bench.imu");
  std::vector<double> out(kSamples);
  std::uint64_t first = 0;
  for (auto _ : state) {
    stream.fill_uniform(out, 0, first);
    first += kSamples;
    benchmark::DoNotOptimize(out.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kSamples));
}
BENCHMARK(batch_of_uniforms)->Name("uniform/canyon_batch");

std::unique_ptr<ErrorChain> make_chain(bool full) {
  ChainSetup setup{.entry = testing::every_link(),
                   .seed = 1,
                   .rate_hz = kRate_hz,
                   .leave_out = {},
                   .environment = testing::warming_up()};
  if (!full) {
    for (const std::string& name : model_names(error_links())) {
      if (name != "white_noise" && name != "in_run_bias") setup.leave_out.push_back(name);
    }
  }
  auto chain = make_error_chain("full", setup);
  CANYON_CHECK(chain.ok(), chain.ok() ? "" : chain.error().str());
  return *std::move(chain);
}

/// Normals that a sample costs: per axis one for white noise, one for each Markov process, and for what happens within
/// an interval where that counts.
int normals_per_sample(bool full) {
  if (!full) return 6 * 2;
  const UnitFigures f = testing::every_link().figures();
  const auto parts = [](const TriadFigures& t) {
    return static_cast<int>(flicker_parts(t.bias_instability, t.flicker_low_hz, t.flicker_high_hz).size());
  };
  // white, in-run bias, random walk with what is within, quantization noise; flicker, whose fastest part is too slow to
  // do anything within an interval at this rate
  return 6 * 5 + 3 * (parts(f.gyro) + parts(f.accel)) + 1;
}

void chain_in_batches(benchmark::State& state, bool full, std::size_t batch) {
  auto chain = make_chain(full);
  std::vector<ImuSample> clean(kSamples), samples;
  for (ImuSample& s : clean) {
    s.dt_s = 1.0 / kRate_hz;
    s.dtheta_U = {1e-3, -2e-3, 3e-3};
    s.dv_U = {0.01, 0.02, 0.098};
  }
  std::int64_t first = 0;
  for (auto _ : state) {
    samples = clean;
    for (std::size_t i = 0; i < kSamples; i += batch) {
      chain->corrupt_batch(first, std::span(samples).subspan(i, batch));
      first += static_cast<std::int64_t>(batch);
    }
    benchmark::DoNotOptimize(samples.data());
  }
  const auto count = static_cast<double>(state.iterations()) * static_cast<double>(kSamples);
  state.SetItemsProcessed(static_cast<std::int64_t>(count));
  state.counters["normals"] = benchmark::Counter(count * normals_per_sample(full), benchmark::Counter::kIsRate);
  state.counters["normals_per_sample"] = normals_per_sample(full);
}
BENCHMARK_CAPTURE(chain_in_batches, white_gauss_markov, false, kSamples)->Name("imu/white_gauss_markov");
BENCHMARK_CAPTURE(chain_in_batches, white_gauss_markov_singly, false, 1)->Name("imu/white_gauss_markov_one_by_one");
BENCHMARK_CAPTURE(chain_in_batches, full, true, kSamples)->Name("imu/full_chain");
BENCHMARK_CAPTURE(chain_in_batches, full_singly, true, 1)->Name("imu/full_chain_one_by_one");

}  // namespace
}  // namespace canyon::inertial
