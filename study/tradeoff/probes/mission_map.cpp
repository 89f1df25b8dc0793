#include "canyon/study/tradeoff/probes/heap_meter.h"
#include "canyon/study/tradeoff/probes/models.h"
#include "canyon/study/tradeoff/probes/taped_run.h"

namespace canyon::study {
namespace {

constexpr double kRun_s = 20.0;

/// The map that a run on the tape's first seconds makes, against the true surfaces.
class MissionMapProbe final : public Probe {
 public:
  explicit MissionMapProbe(const ProbeSetup& setup) : setup_(setup), config_(setup.config) {}

  Result<ProbeRun> run() override {
    const HeapMeter heap;
    CANYON_TRY(const RunSummary summary, taped_run(config_, setup_.mission, setup_.tape, kRun_s));
    const lidar::MapQuality& map = lidar::registers(config_.registration) ? summary.registered_map : summary.prior_map;
    ProbeRun run;
    run.samples.values = {{map.map_error_rms_m}};
    run.cpu_s = summary.cpu_s;
    run.simulated_s = summary.duration_s;
    run.work = work_of(summary);
    run.memory_mb = heap.grown_mb();
    return run;
  }

 private:
  ProbeSetup setup_;
  const mission::MissionConfig config_;
};

}  // namespace

Result<std::unique_ptr<Probe>> make_mission_map_probe(const ProbeSetup& setup) {
  return std::unique_ptr<Probe>(std::make_unique<MissionMapProbe>(setup));
}

}  // namespace canyon::study
