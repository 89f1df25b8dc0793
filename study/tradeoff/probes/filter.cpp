#include <algorithm>
#include <cmath>

#include "canyon/core/config/text.h"
#include "canyon/core/process/cpu_time.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/fusion/error_state_filter.h"
#include "canyon/gnss/sensor/sensor.h"
#include "canyon/study/tradeoff/probes/heap_meter.h"
#include "canyon/study/tradeoff/probes/imu_samples.h"
#include "canyon/study/tradeoff/probes/models.h"
#include "canyon/study/tradeoff/probes/true_tape.h"

namespace canyon::study {
namespace {

constexpr double kLongest_s = 60.0;
constexpr double kFine_hz = 1000.0;  ///< of which slower samples are sums

/// What the filter is given, and the truth beside it.
struct FilterInput {
  std::vector<ImuSample> samples;
  std::vector<GnssFix> fixes;
  KinematicState start;
  std::vector<KinematicState> truth;  ///< at whole seconds
};

Result<std::vector<GnssFix>> fixes_of(const ProbeSetup& setup, const TrueMotion& motion, double duration_s) {
  const mission::MissionConfig& config = setup.config;
  CANYON_TRY(const auto sensor,
             gnss::make_gnss_sensor(config.gnss, static_cast<std::uint64_t>(config.run.seed), setup.mission.start,
                                    setup.mission.start + duration_s, *setup.mission.scene));
  scene::SceneAt scene(*setup.mission.scene);
  std::vector<GnssFix> fixes;
  for (std::int64_t k = 1; tick(setup.mission.start, k, config.gnss.rate_hz) <= setup.mission.start + duration_s; ++k) {
    const GpsTime t = tick(setup.mission.start, k, config.gnss.rate_hz);
    const KinematicState truth = motion.at(t);
    if (!setup.mission.traffic.empty()) scene.set_instances(setup.mission.traffic.at(t - setup.mission.start));
    const Eigen::Vector3d lever = config.gnss.lever_arm_m;
    fixes.push_back(
        sensor->measure(k, t, truth.X_WB * lever, truth.v_WB_W + truth.X_WB.R * truth.w_WB_B.cross(lever), scene).fix);
  }
  return fixes;
}

Result<FilterInput> input_of(const ProbeSetup& setup, double rate_hz) {
  const TrueMotion motion = true_motion(setup.tape, setup.mission.start);
  const int seconds = static_cast<int>(std::floor(std::min(kLongest_s, setup.tape.duration_s())));
  FilterInput input;
  input.start = motion.at(setup.mission.start);
  for (int s = 1; s <= seconds; ++s) input.truth.push_back(motion.at(setup.mission.start + s));
  CANYON_TRY(input.fixes, fixes_of(setup, motion, seconds));
  // With a rate of the filter's own the unit is sampled finely and summed; else it is the mission's unit.
  const bool sums = !std::isnan(setup.own_number("filter.rate_hz"));
  inertial::ImuConfig unit = setup.config.imu;
  unit.rate_hz = sums ? kFine_hz : rate_hz;
  CANYON_TRY(const auto imu,
             inertial::make_imu(unit, static_cast<std::uint64_t>(setup.config.run.seed), setup.mission.scene->frame()));
  const auto last = static_cast<std::int64_t>(std::floor(seconds * unit.rate_hz + 1e-9));
  input.samples = imu_samples(*imu, motion, setup.mission.start, unit.rate_hz, 0, last);
  if (sums) input.samples = summed(input.samples, static_cast<std::size_t>(std::lround(kFine_hz / rate_hz)));
  return input;
}

/// The error-state filter on recorded input, as in a mission but for the time within a sample at which a fix is used.
class FilterProbe final : public Probe {
 public:
  FilterProbe(const ProbeSetup& setup, FilterInput input, const ImuNoise& noise)
      : config_(setup.config), frame_(setup.mission.scene->frame()), input_(std::move(input)), noise_(noise) {}

  Result<ProbeRun> run() override {
    const HeapMeter heap;
    fusion::ErrorStateFilter filter(config_.fusion, noise_, frame_, config_.imu.lever_arm_m, config_.gnss.lever_arm_m);
    const RandomStream stream(static_cast<std::uint64_t>(config_.run.seed), "mission.initial_attitude");
    Pose start = input_.start.X_WB;
    const Eigen::Vector3d error = stream.normal3(0).cwiseProduct(config_.run.initial_attitude_error_deg) * kDegree;
    start.R = (start.R * so3_exp(error)).normalized();
    filter.initialize(input_.start.t, start, input_.start.v_WB_W);

    ProbeRun run;
    run.samples.dimension = 3;
    CpuAccount account;
    auto fix = input_.fixes.begin();
    auto truth = input_.truth.begin();
    for (const ImuSample& sample : input_.samples) {
      {
        const ChargeCpu charge(&account);
        filter.predict(sample);
        ++run.work;
        for (; fix != input_.fixes.end() && fix->t <= sample.t; ++fix, ++run.work) filter.update(*fix);
      }
      if (truth == input_.truth.end() || sample.t < truth->t) continue;
      const NavEstimate estimate = filter.estimate();
      const Eigen::Vector3d e = estimate.X_WB.p + (truth->t - sample.t) * estimate.v_WB_W - truth->X_WB.p;
      run.samples.values.push_back({e.x(), e.y(), e.z()});
      ++truth;
    }
    run.cpu_s = account.seconds();
    run.simulated_s = static_cast<double>(run.samples.values.size());
    run.memory_mb = heap.grown_mb();
    return run;
  }

 private:
  const mission::MissionConfig config_;
  LocalFrame frame_;
  FilterInput input_;
  ImuNoise noise_;
};

}  // namespace

Result<std::unique_ptr<Probe>> make_filter_probe(const ProbeSetup& setup) {
  const double own_hz = setup.own_number("filter.rate_hz");
  const double rate_hz = std::isnan(own_hz) ? setup.config.imu.rate_hz : own_hz;
  if (!std::isnan(own_hz) && std::fmod(kFine_hz, own_hz) != 0.0)
    return Error{.key = "filter.rate_hz", .what = number_text(own_hz), .expected = "a rate that divides 1000"};
  CANYON_TRY(FilterInput input, input_of(setup, rate_hz));
  CANYON_TRY(const ImuNoise noise, mission::noise_told_to_filter(setup.config));
  return std::unique_ptr<Probe>(std::make_unique<FilterProbe>(setup, std::move(input), noise));
}

}  // namespace canyon::study
