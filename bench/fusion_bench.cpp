// Predictions and updates of the filter per second, by the states that it carries.
#include <benchmark/benchmark.h>

#include "canyon/core/units.h"
#include "canyon/fusion/error_state_filter.h"
#include "canyon/fusion/stress/simulated_drive.h"
#include "canyon/tests/fusion/tactical_noise.h"

namespace canyon::fusion {
namespace {

const LocalFrame kFrame(Geodetic{32.35 * kDegree, -90.88 * kDegree, 60.0});
const Eigen::Vector3d kImu(0.0, 0.0, 0.4), kAntenna(-0.3, 0.0, 1.2);

/// A unit that turns and pushes a little, at 100 Hz; arguments: gains or not, jittering intervals or not. It begins
/// anew every ten seconds: left alone for hours it would fall at a speed that no vehicle has.
class Stage {
 public:
  explicit Stage(const benchmark::State& state)
      : filter_(config(state.range(0) != 0), tactical_noise(), kFrame, kImu, kAntenna) {
    begin();
  }

  void predict(double dt_s = 0.01) {
    if (++steps_ == 1000) begin();
    ImuSample s;
    t_ = t_ + dt_s;
    s.t = t_;
    s.dt_s = dt_s;
    s.dtheta_U = {1e-4, -2e-4, 3e-3};
    s.dv_U = {0.01, -0.02, 0.098};
    filter_.predict(s);
  }
  void update() {
    GnssFix fix;
    fix.t = t_;
    fix.status = FixStatus::kDifferential;
    fix.p_A_E = kFrame.to_E(kAntenna);
    fix.covariance_E = 0.25 * Eigen::Matrix3d::Identity();
    benchmark::DoNotOptimize(filter_.update(fix));
  }
  NavEstimate estimate() const { return filter_.estimate(); }

 private:
  void begin() {
    filter_.initialize(t_, Pose{}, Eigen::Vector3d::Zero());
    steps_ = 0;
  }
  static FilterConfig config(bool gains) {
    FilterConfig c;
    if (!gains) c.states = {"biases"};
    return c;
  }
  GpsTime t_ = GpsTime::from_week_sow(1590, 396000.0);
  ErrorStateFilter filter_;
  int steps_ = 0;
};

void Predict(benchmark::State& state) {
  Stage stage(state);
  for (auto _ : state) stage.predict();
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(Predict)->ArgName("gains")->Arg(0)->Arg(1);

void PredictWithJitter(benchmark::State& state) {
  Stage stage(state);
  bool longer = false;
  for (auto _ : state) stage.predict((longer = !longer) ? 0.0101 : 0.0099);
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(PredictWithJitter)->ArgName("gains")->Arg(0)->Arg(1);

void Update(benchmark::State& state) {
  Stage stage(state);
  stage.predict();
  for (auto _ : state) stage.update();
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(Update)->ArgName("gains")->Arg(0)->Arg(1);

void Estimate(benchmark::State& state) {
  Stage stage(state);
  stage.predict();
  for (auto _ : state) benchmark::DoNotOptimize(stage.estimate());
}
BENCHMARK(Estimate)->ArgName("gains")->Arg(1);

/// A minute of a drive at 100 Hz with a fix a second, as a row of smoothers() makes a trajectory of it; the counter
/// says how many seconds of the drive one second is enough for. Row `none` is the filter.
void Smooth(benchmark::State& state, const char* row, const char* states) {
  const Drive drive = simulated_drive(1, {.rate_hz = 100.0, .outage_from_s = 1e9, .outage_to_s = 1e9, .keys = states});
  for (auto _ : state) benchmark::DoNotOptimize(smoothed_by(row, drive));
  state.counters["x_real_time"] =
      benchmark::Counter(60.0 * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
constexpr const char *kBiases = "states = [\"biases\"]",
                     *kGains = "states = [\"biases\", \"gains\"]\nimu_gain_tau_s = 1000";
BENCHMARK_CAPTURE(Smooth, filter_biases, "none", kBiases)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Smooth, rts_biases, "rts", kBiases)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Smooth, batch_graph_biases, "batch_graph", kBiases)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Smooth, fixed_lag_graph_biases, "fixed_lag_graph", kBiases)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Smooth, filter_gains, "none", kGains)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Smooth, rts_gains, "rts", kGains)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Smooth, batch_graph_gains, "batch_graph", kGains)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Smooth, fixed_lag_graph_gains, "fixed_lag_graph", kGains)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace canyon::fusion
