// Predictions and updates of the filter per second, by the states that it carries.
#include <benchmark/benchmark.h>

#include "canyon/core/units.h"
#include "canyon/fusion/error_state_filter.h"

namespace canyon::fusion {
namespace {

const LocalFrame kFrame(Geodetic{32.35 * kDegree, -90.88 * kDegree, 60.0});
const Eigen::Vector3d kImu(0.0, 0.0, 0.4), kAntenna(-0.3, 0.0, 1.2);

ImuNoise noise() {
  ImuNoise n;
  n.gyro = {.white_per_sqrt_hz = 4.4e-5,
            .turn_on_bias_sigma = 1.5e-5,
            .in_run_bias_sigma = 2.4e-6,
            .in_run_bias_tau_s = 1000.0,
            .scale_sigma = 5e-4,
            .misalignment_sigma_rad = 1e-3};
  n.accel = {.white_per_sqrt_hz = 1e-3,
             .turn_on_bias_sigma = 7e-3,
             .in_run_bias_sigma = 5e-4,
             .in_run_bias_tau_s = 1000.0,
             .scale_sigma = 3e-4,
             .misalignment_sigma_rad = 1e-3};
  return n;
}

/// A unit that turns and pushes a little, at 100 Hz; arguments: gains or not, jittering intervals or not.
class Stage {
 public:
  explicit Stage(const benchmark::State& state)
      : filter_(config(state.range(0) != 0), noise(), kFrame, kImu, kAntenna) {
    filter_.initialize(t_, Pose{}, Eigen::Vector3d::Zero());
  }

  void predict(double dt_s = 0.01) {
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
  static FilterConfig config(bool gains) {
    FilterConfig c;
    if (!gains) c.states = {"biases"};
    return c;
  }
  GpsTime t_ = GpsTime::from_week_sow(1590, 396000.0);
  ErrorStateFilter filter_;
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

}  // namespace
}  // namespace canyon::fusion
