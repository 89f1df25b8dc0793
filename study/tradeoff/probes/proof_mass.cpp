#include <cmath>

#include "canyon/core/process/cpu_time.h"
#include "canyon/inertial/mems/element_model.h"
#include "canyon/inertial/mems/integrator.h"
#include "canyon/study/tradeoff/probes/heap_meter.h"
#include "canyon/study/tradeoff/probes/models.h"

namespace canyon::study {
namespace {

using inertial::DiscretePlant;
using SchemeRow = ModelRow<inertial::DiscretizePlant>;

const SchemeRow& scheme_of(const ProbeSettings& own) {
  return model_row(inertial::integrators(), own.at("mems.integrator"));
}

/// A displaced proof mass left to itself for one period of its resonance, against the matrix exponential.
class ProofMassProbe final : public Probe {
 public:
  ProofMassProbe(const SchemeRow& scheme, double step_periods) : scheme_(scheme) {
    inertial::ElementFigures figures;
    figures.quality_factor = 2.0;
    figures.pick_off = "piezoresistive";  // does not pull, so that the resonance is the spring's
    plant_ = (*inertial::accelerometer_model(figures, 300.0)).mechanics;
    period_s_ = 1.0 / figures.resonance_hz;
    steps_ = static_cast<int>(std::lround(1.0 / step_periods));
  }

  Result<ProbeRun> run() override {
    const HeapMeter heap;
    const DiscretePlant step = scheme_.make(plant_, period_s_ / steps_);
    const Eigen::VectorXd truth = inertial::exact_step(plant_, period_s_).phi.col(0);
    Eigen::VectorXd state = Eigen::VectorXd::Unit(plant_.size(), 0), next = state;
    CpuAccount account;
    {
      const ChargeCpu charge(&account);
      for (int k = 0; k < steps_; ++k) {
        next.noalias() = step.phi * state;
        state.swap(next);
      }
    }
    const Eigen::VectorXd error = state - truth;
    ProbeRun run;
    run.samples.dimension = static_cast<std::size_t>(error.size());
    run.samples.values.emplace_back(error.begin(), error.end());
    run.cpu_s = account.seconds();
    run.simulated_s = period_s_;
    run.work = steps_;
    run.memory_mb = heap.grown_mb();
    return run;
  }

 private:
  const SchemeRow& scheme_;
  inertial::LinearPlant plant_;
  double period_s_ = 0.0;
  int steps_ = 0;
};

}  // namespace

Result<std::unique_ptr<Probe>> make_proof_mass_probe(const ProbeSetup& setup) {
  return std::unique_ptr<Probe>(
      std::make_unique<ProofMassProbe>(scheme_of(setup.own), setup.own_number("mems.step_periods")));
}

std::optional<double> proof_mass_order(const ProbeSettings& own, const mission::MissionConfig&) {
  return scheme_of(own).order;
}

}  // namespace canyon::study
