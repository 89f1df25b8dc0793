#include "canyon/study/tradeoff/measuring/fidelities.h"

#include "canyon/study/tradeoff/measuring/repetitions.h"
#include "canyon/study/tradeoff/probes/taped_run.h"

namespace canyon::study {
namespace {

constexpr double kTimed_s = 60.0;
constexpr const char* kPlanned = "_planned";

/// The first part of a fidelity's run as a probe, for its time.
class FidelityProbe final : public Probe {
 public:
  FidelityProbe(const Comparison& comparison, std::size_t i) : comparison_(comparison), i_(i) {}

  Result<ProbeRun> run() override {
    CANYON_TRY(const RunSummary summary, taped_run(comparison_.configs[i_], comparison_.missions[i_], *comparison_.tape,
                                                   kTimed_s, omissions(comparison_, i_)));
    ProbeRun run;
    run.samples.values = {{summary.position_m.rms}};
    run.cpu_s = summary.cpu_s;
    run.simulated_s = summary.duration_s;
    run.work = work_of(summary);
    return run;
  }

 private:
  const Comparison& comparison_;
  std::size_t i_;
};

Result<std::vector<Repeated>> timed(const Comparison& comparison, const WholeRuns& how) {
  std::vector<std::unique_ptr<Probe>> probes;
  for (std::size_t i = 0; i < comparison.plan.size(); ++i)
    probes.push_back(std::make_unique<FidelityProbe>(comparison, i));
  return repeat(probes, how.repetitions, how.seed);
}

MeasuredFidelity fidelity_of(const RunSummary& run, const Repeated& repeated) {
  const bool registered = run.keyframes_registered.has_value();
  const double s = repeated.first.simulated_s;
  return {.name = run.name,
          .position_error_rms_m = run.position_m.rms,
          .map_error_rms_m = (registered ? run.registered_map : run.prior_map).map_error_rms_m,
          .registration_error_rms_m = run.registration_rms_m,
          .tape_s = run.duration_s,
          .cpu_s = repeated.median_s() / s,
          .cpu_low_s = repeated.least_s() / s,
          .cpu_high_s = repeated.most_s() / s,
          .simulated_s = s,
          .work = repeated.first.work,
          .outcomes = {}};
}

}  // namespace

Result<Comparison> with_planned(const Comparison& comparison, const std::vector<Output>& outputs) {
  RunPlan planned = comparison.plan.front();
  CANYON_TRY(Plan plan, make_plan(comparison.configs.front(), comparison.missions.front(),
                                  {.fidelity = planned.name, .outputs = outputs}));
  planned.name += kPlanned;
  for (const RunPlan& run : comparison.plan)
    if (run.name == planned.name)
      return Error{.what = "the planned run would have the name of the fidelity \"" + run.name + "\"",
                   .expected = "another name for the fidelity"};
  Comparison out = comparison;
  out.plan.insert(out.plan.begin() + 1, std::move(planned));
  out.configs.insert(out.configs.begin() + 1, mission::without(comparison.configs.front(), plan.omissions));
  out.missions.insert(out.missions.begin() + 1, comparison.missions.front());
  out.plans.assign(comparison.plan.size(), Plan{});
  out.plans.insert(out.plans.begin() + 1, std::move(plan));
  return out;
}

Result<std::vector<MeasuredFidelity>> measure_fidelities(const Comparison& comparison, const WholeRuns& how) {
  CANYON_TRY(const Comparison runs, with_planned(comparison, how.outputs));
  CANYON_TRY(const Results whole, compare(runs, "", how.show_progress));
  CANYON_TRY(const std::vector<Repeated> repeated, timed(runs, how));
  std::vector<MeasuredFidelity> out;
  for (std::size_t i = 0; i < runs.plan.size(); ++i) out.push_back(fidelity_of(whole.summaries[i], repeated[i]));
  out[1].planned = true;
  if (how.seeds == 0) return out;
  CANYON_TRY(std::vector<MeasuredOutcomes> outcomes, measure_outcomes(runs, how.seeds, how.show_progress));
  for (std::size_t i = 0; i < out.size(); ++i) out[i].outcomes = std::move(outcomes[i]);
  return out;
}

}  // namespace canyon::study
