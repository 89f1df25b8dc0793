#include <cmath>

#include "canyon/core/config/text.h"
#include "canyon/core/process/cpu_time.h"
#include "canyon/inertial/mounting.h"
#include "canyon/study/tradeoff/probes/heap_meter.h"
#include "canyon/study/tradeoff/probes/imu_samples.h"
#include "canyon/study/tradeoff/probes/models.h"
#include "canyon/study/tradeoff/probes/true_tape.h"

namespace canyon::study {
namespace {

/// So short that the vertical channel, which grows as e^(t / 570 s) (fusion/rounding_growth.h), adds 2 % of itself to
/// an error and nothing to rounding; so long that noise shows.
constexpr double kWindow_s = 10.0;
constexpr std::int64_t kLookBack = 2;  // intervals that an integrator wants to have seen

/// Free inertial navigation from the truth over windows all along the tape.
class FreeInertialProbe final : public Probe {
 public:
  FreeInertialProbe(const ProbeSetup& setup, std::size_t fine_per_step)
      : setup_(setup),
        config_(setup.config),
        fine_per_step_(fine_per_step),
        motion_(true_motion(setup.tape, setup.mission.start)) {
    // Whole seconds are ticks of every rate.
    for (const std::int64_t second : spread_ticks(setup, 1.0, kWindow_s + 1.0)) starts_s_.push_back(second);
  }

  Result<ProbeRun> run() override {
    const HeapMeter heap;
    ProbeRun run;
    run.samples.dimension = 3;
    const double rate_hz = config_.imu.rate_hz;
    const auto steps = static_cast<std::int64_t>(std::llround(kWindow_s * rate_hz));
    CpuAccount account;
    CANYON_TRY(const auto unit, make_unit(rate_hz));
    const double fine_hz = rate_hz * static_cast<double>(fine_per_step_);
    CANYON_TRY(const auto fine_unit, make_unit(fine_hz));
    for (const std::int64_t second : starts_s_) {
      const auto first = static_cast<std::int64_t>(std::llround(static_cast<double>(second) * rate_hz));
      std::vector<ImuSample> samples;
      {
        const ChargeCpu charge(&account);
        samples = imu_samples(*unit, motion_, setup_.mission.start, rate_hz, first - kLookBack, first + steps);
      }
      if (fine_per_step_ > 1) {
        const auto n = static_cast<std::int64_t>(fine_per_step_);
        samples = summed(imu_samples(*fine_unit, motion_, setup_.mission.start, fine_hz, (first - kLookBack) * n,
                                     (first + steps) * n),
                         fine_per_step_);
      }
      run.samples.values.push_back(navigate(samples, account));
      run.work += 2 * static_cast<std::int64_t>(samples.size());
    }
    run.cpu_s = account.seconds();
    run.simulated_s = kWindow_s * static_cast<double>(starts_s_.size());
    run.memory_mb = heap.grown_mb();
    return run;
  }

 private:
  Result<std::unique_ptr<inertial::ImuModel>> make_unit(double rate_hz) const {
    inertial::ImuConfig imu = config_.imu;
    imu.rate_hz = rate_hz;
    return inertial::make_imu(imu, static_cast<std::uint64_t>(config_.run.seed), setup_.mission.scene->frame());
  }

  /// Error at the window's end, in E.
  std::vector<double> navigate(const std::vector<ImuSample>& samples, CpuAccount& account) const {
    const LocalFrame& frame = setup_.mission.scene->frame();
    const auto R_BU = inertial::mounting(config_.imu, static_cast<std::uint64_t>(config_.run.seed));
    const auto state_at = [&](GpsTime t) { return imu_state(motion_.at(t), frame, config_.imu.lever_arm_m, R_BU); };
    const GpsTime start = samples[kLookBack].t - samples[kLookBack].dt_s;
    fusion::NavState state = state_at(start);
    const auto strapdown = fusion::make_strapdown(config_.fusion.integrator);
    {
      const ChargeCpu charge(&account);
      for (std::size_t k = 0; k < samples.size(); ++k) {
        if (k == kLookBack) state = state_at(start);
        strapdown->advance(state, {.dt_s = samples[k].dt_s, .dtheta_U = samples[k].dtheta_U, .dv_U = samples[k].dv_U});
      }
    }
    const Eigen::Vector3d error = state.p_EU_E - state_at(samples.back().t).p_EU_E;
    return {error.x(), error.y(), error.z()};
  }

  ProbeSetup setup_;
  const mission::MissionConfig config_;
  std::size_t fine_per_step_;
  TrueMotion motion_;
  std::vector<std::int64_t> starts_s_;
};

}  // namespace

Result<std::unique_ptr<Probe>> make_free_inertial_probe(const ProbeSetup& setup) {
  const double fine_hz = setup.own_number("imu.summed_from_hz"), rate_hz = setup.config.imu.rate_hz;
  const double ratio = std::isnan(fine_hz) ? 1.0 : fine_hz / rate_hz;
  if (ratio < 1.0 || ratio != std::floor(ratio))
    return Error{.key = "imu.rate_hz",
                 .what = number_text(rate_hz) + " samples are no sums of " + number_text(fine_hz),
                 .expected = "a rate that divides " + number_text(fine_hz)};
  if (rate_hz != std::floor(rate_hz))
    return Error{.key = "imu.rate_hz", .what = number_text(rate_hz), .expected = "whole samples a second"};
  if (setup.tape.duration_s() < 2 * (kWindow_s + 2.0))
    return Error{.key = "tape", .what = "is shorter than 24 s", .expected = "windows of 10 s and one before it"};
  return std::unique_ptr<Probe>(std::make_unique<FreeInertialProbe>(setup, static_cast<std::size_t>(ratio)));
}

}  // namespace canyon::study
