#include "canyon/study/tradeoff/measuring/fidelities.h"

#include "canyon/study/tradeoff/measuring/repetitions.h"
#include "canyon/study/tradeoff/probes/taped_run.h"

namespace canyon::study {
namespace {

constexpr double kRun_s = 60.0;

/// A fidelity's whole run as a probe; the figures of the last run stay.
class FidelityProbe final : public Probe {
 public:
  FidelityProbe(const Comparison& comparison, std::size_t i) : comparison_(comparison), i_(i) {}

  Result<ProbeRun> run() override {
    CANYON_TRY(summary, taped_run(comparison_.configs[i_], comparison_.missions[i_], *comparison_.tape, kRun_s));
    ProbeRun run;
    run.samples.values = {{summary.position_m.rms}};
    run.cpu_s = summary.cpu_s;
    run.simulated_s = summary.duration_s;
    run.work = work_of(summary);
    return run;
  }

  RunSummary summary;

 private:
  const Comparison& comparison_;
  std::size_t i_;
};

}  // namespace

Result<std::vector<MeasuredFidelity>> measure_fidelities(const Comparison& comparison, int repetitions,
                                                         std::uint64_t seed) {
  std::vector<std::unique_ptr<Probe>> probes;
  std::vector<const FidelityProbe*> runs;
  for (std::size_t i = 0; i < comparison.plan.size(); ++i) {
    auto probe = std::make_unique<FidelityProbe>(comparison, i);
    runs.push_back(probe.get());
    probes.push_back(std::move(probe));
  }
  CANYON_TRY(const std::vector<Repeated> repeated, repeat(probes, repetitions, seed));
  std::vector<MeasuredFidelity> out;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const RunSummary& run = runs[i]->summary;
    const bool registered = run.keyframes_registered.has_value();
    const double s = repeated[i].first.simulated_s;
    out.push_back({.name = comparison.plan[i].name,
                   .position_error_rms_m = run.position_m.rms,
                   .map_error_rms_m = (registered ? run.registered_map : run.prior_map).map_error_rms_m,
                   .registration_error_rms_m = run.registration_rms_m,
                   .cpu_s = repeated[i].median_s() / s,
                   .cpu_low_s = repeated[i].least_s() / s,
                   .cpu_high_s = repeated[i].most_s() / s,
                   .simulated_s = s,
                   .work = repeated[i].first.work});
  }
  return out;
}

}  // namespace canyon::study
