#include "canyon/core/process/cpu_time.h"
#include "canyon/core/process/progress.h"
#include "canyon/study/tradeoff/probes/heap_meter.h"
#include "canyon/study/tradeoff/probes/models.h"
#include "canyon/study/tradeoff/recorded/recorded_probe.h"

// What a receiver's solver makes of the pseudoranges that were recorded.
namespace canyon::study {
namespace {

/// The rung's solver, weighting and fault exclusion on the recorded pseudoranges, corrected with the rung's models of
/// the atmosphere; error of the fix against the surveyed truth.
class RecordedFixes final : public Probe {
 public:
  RecordedFixes(const ProbeSetup& setup, std::unique_ptr<gnss::PositionSolver> solver,
                std::unique_ptr<gnss::RangeWeighting> weighting, RecordedAtmosphere atmosphere)
      : setup_(setup),
        epochs_(setup.recording->spread(setup.samples)),
        solver_(std::move(solver)),
        weighting_(std::move(weighting)),
        atmosphere_(std::move(atmosphere)) {}

  Result<ProbeRun> run() override {
    const HeapMeter heap;
    const Eigen::Vector3d guess_E = setup_.recording->scene->frame().origin_E();
    ProbeRun run;
    run.samples.dimension = 3;
    CpuAccount account;
    for (const RecordedEpoch* epoch : epochs_) {
      throw_if_cancelled();
      gnss::PositionSolution solution;
      {
        const ChargeCpu charge(&account);
        solution = solver_->solve(ranges_of(*epoch), guess_E);
      }
      run.work += static_cast<std::int64_t>(epoch->satellites.size());
      if (solution.ok) {
        const Eigen::Vector3d error = solution.p_E - epoch->p_A_E;
        run.samples.values.push_back({error.x(), error.y(), error.z()});
      } else {
        run.samples.values.push_back({kNaN, kNaN, kNaN});
      }
    }
    run.cpu_s = account.seconds();
    run.simulated_s = static_cast<double>(epochs_.size()) / setup_.config.gnss.rate_hz;
    run.memory_mb = heap.grown_mb();
    return run;
  }

 private:
  std::vector<gnss::RangeMeasurement> ranges_of(const RecordedEpoch& epoch) const {
    std::vector<gnss::RangeMeasurement> ranges;
    for (const RecordedSatellite& satellite : epoch.satellites) {
      const double ionosphere_m = atmosphere_.ionosphere_m(epoch, satellite);
      const double sigma_m = weighting_->sigma_m({.system = satellite.sv.system,
                                                  .elevation_rad = satellite.elevation_rad,
                                                  .cn0_dbhz = satellite.cn0_dbhz,
                                                  .ionosphere_m = ionosphere_m});
      ranges.push_back({satellite.p_transmitted_E, satellite.range_m - atmosphere_.delay_m(epoch, satellite), sigma_m,
                        satellite.sv.system});
    }
    return ranges;
  }

  ProbeSetup setup_;
  std::vector<const RecordedEpoch*> epochs_;
  std::unique_ptr<gnss::PositionSolver> solver_;
  std::unique_ptr<gnss::RangeWeighting> weighting_;
  RecordedAtmosphere atmosphere_;
};

}  // namespace

Result<std::unique_ptr<Probe>> make_recorded_fix_probe(const ProbeSetup& setup) {
  CANYON_TRY_STATUS(check_recording(setup));
  const gnss::GnssConfig config = recorded_gnss(setup);
  const gnss::PositionConfig& position = config.position;
  CANYON_TRY(auto solver, position.solver.make("gnss.solver", position.parameters()));
  if (!solver->solves_clock())
    return Error{.key = "gnss.solver",
                 .what = "\"" + position.solver.name + "\" has no unknown for the clock of a real receiver",
                 .expected = "another solver"};
  CANYON_TRY(auto weighting,
             position.weighting.make("gnss.weighting", gnss::RangeWeightingParameters{position.solver_sigma_m}));
  CANYON_TRY(RecordedAtmosphere atmosphere, RecordedAtmosphere::make(setup, config));
  return std::unique_ptr<Probe>(
      std::make_unique<RecordedFixes>(setup, std::move(solver), std::move(weighting), std::move(atmosphere)));
}

}  // namespace canyon::study
