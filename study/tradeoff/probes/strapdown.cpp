#include "canyon/study/tradeoff/probes/strapdown.h"

#include <cmath>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/process/cpu_time.h"
#include "canyon/study/tradeoff/probes/heap_meter.h"
#include "canyon/study/tradeoff/probes/models.h"
#include "canyon/study/tradeoff/probes/smooth_motion.h"

namespace canyon::study {
namespace {

Eigen::Vector3d error_of(const fusion::NavState& state, const fusion::NavState& truth, SmoothFigure figure) {
  if (figure == SmoothFigure::kPosition) return state.p_EU_E - truth.p_EU_E;
  if (figure == SmoothFigure::kVelocity) return state.v_EU_E - truth.v_EU_E;
  return so3_log(truth.R_EU.conjugate() * state.R_EU);
}

class SmoothProbe final : public Probe {
 public:
  SmoothProbe(const fusion::StrapdownRow& row, int rate_hz, SmoothFigure figure)
      : row_(row),
        drive_(smooth_drive(row.order >= 4 ? SmoothMotion::kLively : SmoothMotion::kCalm, rate_hz)),
        figure_(figure) {}

  Result<ProbeRun> run() override {
    const HeapMeter heap;
    ProbeRun run;
    run.samples.dimension = 3;
    CpuAccount account;
    std::vector<fusion::NavState> states;
    {
      const ChargeCpu charge(&account);
      states = integrate(row_, drive_);
    }
    for (std::size_t i = 0; i < states.size(); ++i) {
      const Eigen::Vector3d error = error_of(states[i], drive_.truth[i + 1], figure_);
      run.samples.values.push_back({error.x(), error.y(), error.z()});
    }
    run.cpu_s = account.seconds();
    run.simulated_s = static_cast<double>(states.size());
    run.work = static_cast<std::int64_t>(drive_.increments.size());
    run.memory_mb = heap.grown_mb();
    return run;
  }

 private:
  const fusion::StrapdownRow& row_;
  const SmoothDrive& drive_;
  SmoothFigure figure_;
};

const fusion::StrapdownRow& row_of_config(const mission::MissionConfig& config) {
  return model_row(fusion::strapdown_models(), config.fusion.integrator);
}

Result<std::unique_ptr<Probe>> make(const ProbeSetup& setup, SmoothFigure figure) {
  const auto rate_hz = static_cast<int>(std::lround(setup.own_number("strapdown.rate_hz")));
  return make_smooth_probe(row_of_config(setup.config), rate_hz, figure);
}

}  // namespace

std::unique_ptr<Probe> make_smooth_probe(const fusion::StrapdownRow& row, int rate_hz, SmoothFigure figure) {
  return std::make_unique<SmoothProbe>(row, rate_hz, figure);
}

std::optional<double> claimed_order(const fusion::StrapdownRow& row, SmoothFigure figure) {
  if (figure == SmoothFigure::kPosition) return row.order;
  return figure == SmoothFigure::kVelocity ? row.make.velocity_order : row.make.attitude_order;
}

Result<std::unique_ptr<Probe>> make_smooth_position_probe(const ProbeSetup& setup) {
  return make(setup, SmoothFigure::kPosition);
}
Result<std::unique_ptr<Probe>> make_smooth_velocity_probe(const ProbeSetup& setup) {
  return make(setup, SmoothFigure::kVelocity);
}
Result<std::unique_ptr<Probe>> make_smooth_attitude_probe(const ProbeSetup& setup) {
  return make(setup, SmoothFigure::kAttitude);
}

std::optional<double> position_order(const ProbeSettings&, const mission::MissionConfig& config) {
  return claimed_order(row_of_config(config), SmoothFigure::kPosition);
}
std::optional<double> velocity_order(const ProbeSettings&, const mission::MissionConfig& config) {
  return claimed_order(row_of_config(config), SmoothFigure::kVelocity);
}
std::optional<double> attitude_order(const ProbeSettings&, const mission::MissionConfig& config) {
  return claimed_order(row_of_config(config), SmoothFigure::kAttitude);
}

}  // namespace canyon::study
