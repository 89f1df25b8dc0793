#include <algorithm>
#include <cmath>
#include <map>

#include "canyon/core/math/median.h"
#include "canyon/core/process/cpu_time.h"
#include "canyon/core/process/progress.h"
#include "canyon/gnss/sensor/sensor.h"
#include "canyon/gnss/signal.h"
#include "canyon/study/tradeoff/probes/heap_meter.h"
#include "canyon/study/tradeoff/probes/models.h"
#include "canyon/study/tradeoff/recorded/recorded_probe.h"

// What a model says of the pseudoranges and signal strengths that were recorded, at the true places of the recording.
namespace canyon::study {
namespace {

enum class What { kPseudorange, kStrength };

/// A prediction of one epoch by satellite, in the order of RecordedEpoch::satellites; NaN where it is not tracked.
struct Predicted {
  std::vector<double> multipath_m, cn0_dbhz;
};

/// Measured minus predicted. What a model of the scene cannot know is taken out, the same way for every rung: of
/// pseudoranges the receiver's clock, by the median of each epoch's satellites of one system; of strengths the
/// receiver's gain, by the median over the drive. A satellite that was recorded though the model does not track it
/// counts too: as one without reflections, and as one at the threshold of tracking, which is what the model allows it
/// at most. So all rungs are judged by the same observations.
class RecordedSignals final : public Probe {
 public:
  RecordedSignals(const ProbeSetup& setup, What what, RecordedAtmosphere atmosphere)
      : setup_(setup),
        config_(recorded_gnss(setup)),
        what_(what),
        epochs_(setup.recording->spread(setup.samples)),
        atmosphere_(std::move(atmosphere)) {}

  Result<ProbeRun> run() override {
    const HeapMeter heap;
    CANYON_TRY(const auto sensor, recorded_sensor(setup_, config_));
    const scene::SceneAt scene(*setup_.recording->scene);
    ProbeRun run;
    CpuAccount account;
    std::int64_t index = 0;
    for (const RecordedEpoch* epoch : epochs_) {
      throw_if_cancelled();
      gnss::GnssOutput output;
      {
        const ChargeCpu charge(&account);
        output = sensor->measure(index, epoch->t, epoch->p_A_W, epoch->v_A_W, scene);
      }
      index += 2;  // no epoch follows the one before: each finds the receiver running
      const Predicted predicted = by_satellite(*epoch, output);
      run.samples.values.push_back(what_ == What::kPseudorange ? range_residuals(*epoch, predicted)
                                                               : strength_residuals(*epoch, predicted));
    }
    if (what_ == What::kStrength) take_out_median(run.samples.values);
    run.cpu_s = account.seconds();
    run.simulated_s = static_cast<double>(epochs_.size()) / config_.rate_hz;
    const gnss::GnssCounters work = sensor->counters();
    run.work = work.epochs + work.occlusion_rays + work.path_searches + work.facets_tested;
    run.memory_mb = heap.grown_mb();
    return run;
  }

 private:
  static Predicted by_satellite(const RecordedEpoch& epoch, const gnss::GnssOutput& output) {
    std::map<SatelliteId, double> multipath_m, cn0_dbhz;
    for (const GnssObservationTruth& truth : output.truth.satellites)
      if (truth.tracked) multipath_m[truth.sv] = truth.multipath_m;
    for (const GnssObservation& one : output.epoch.observations) cn0_dbhz[one.sv] = one.cn0_dbhz;
    const auto of = [](const std::map<SatelliteId, double>& all, SatelliteId sv) {
      const auto found = all.find(sv);
      return found == all.end() ? kNaN : found->second;
    };
    Predicted out;
    for (const RecordedSatellite& satellite : epoch.satellites) {
      out.multipath_m.push_back(of(multipath_m, satellite.sv));
      out.cn0_dbhz.push_back(of(cn0_dbhz, satellite.sv));
    }
    return out;
  }

  std::vector<double> range_residuals(const RecordedEpoch& epoch, const Predicted& predicted) const {
    std::vector<double> out;
    for (std::size_t i = 0; i < epoch.satellites.size(); ++i) {
      const double multipath_m = std::isfinite(predicted.multipath_m[i]) ? predicted.multipath_m[i] : 0.0;
      out.push_back(epoch.satellites[i].beyond_m(epoch.p_A_E) - atmosphere_.delay_m(epoch, epoch.satellites[i]) -
                    multipath_m);
    }
    take_out_clocks(epoch.satellites, out);
    return out;
  }

  std::vector<double> strength_residuals(const RecordedEpoch& epoch, const Predicted& predicted) const {
    std::vector<double> out;
    for (std::size_t i = 0; i < epoch.satellites.size(); ++i) {
      const double said = predicted.cn0_dbhz[i];
      out.push_back(epoch.satellites[i].cn0_dbhz -
                    (std::isfinite(said) ? said : config_.locks.tracking_threshold_dbhz));
    }
    return out;
  }

  static void take_out_median(std::vector<std::vector<double>>& residuals) {
    std::vector<double> all;
    for (const auto& epoch : residuals)
      for (const double one : epoch)
        if (std::isfinite(one)) all.push_back(one);
    const double gain_db = median(all);
    for (auto& epoch : residuals)
      for (double& one : epoch) one -= gain_db;
  }

  ProbeSetup setup_;
  const gnss::GnssConfig config_;
  What what_;
  std::vector<const RecordedEpoch*> epochs_;
  RecordedAtmosphere atmosphere_;
};

Result<std::unique_ptr<Probe>> make(const ProbeSetup& setup, What what) {
  CANYON_TRY_STATUS(check_recording(setup));
  const gnss::GnssConfig config = recorded_gnss(setup);
  CANYON_TRY(const auto sensor, recorded_sensor(setup, config));  // what it refuses is told before it runs
  CANYON_TRY(RecordedAtmosphere atmosphere, RecordedAtmosphere::make(setup, config));
  return std::unique_ptr<Probe>(std::make_unique<RecordedSignals>(setup, what, std::move(atmosphere)));
}

}  // namespace

Result<std::unique_ptr<Probe>> make_recorded_pseudorange_probe(const ProbeSetup& setup) {
  return make(setup, What::kPseudorange);
}

Result<std::unique_ptr<Probe>> make_recorded_strength_probe(const ProbeSetup& setup) {
  return make(setup, What::kStrength);
}

}  // namespace canyon::study
