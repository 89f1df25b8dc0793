#include <numeric>

#include "canyon/core/process/cpu_time.h"
#include "canyon/gnss/sensor/sensor.h"
#include "canyon/study/tradeoff/probes/heap_meter.h"
#include "canyon/study/tradeoff/probes/models.h"
#include "canyon/study/tradeoff/probes/true_tape.h"

// What a receiver in the scene measures at the tape's true places: pseudoranges, fixes.
namespace canyon::study {
namespace {

/// Where and when one epoch is measured.
struct Place {
  std::int64_t index;
  GpsTime t;
  Eigen::Vector3d p_A_W, v_A_W;
};

Result<std::unique_ptr<gnss::GnssSensor>> sensor_of(const ProbeSetup& setup, const mission::MissionConfig& config) {
  return gnss::make_gnss_sensor(config.gnss, static_cast<std::uint64_t>(config.run.seed), setup.mission.start,
                                setup.mission.start + setup.tape.duration_s(), *setup.mission.scene);
}

enum class What { kPseudorange, kFix };

class GnssProbe final : public Probe {
 public:
  GnssProbe(const ProbeSetup& setup, What what, const std::vector<std::int64_t>& ticks)
      : setup_(setup), config_(setup.config), what_(what) {
    const TrueMotion motion = true_motion(setup.tape, setup.mission.start);
    for (const std::int64_t k : ticks) {
      const GpsTime t = tick(setup.mission.start, k, config_.gnss.rate_hz);
      if (t > motion.last()) break;
      const KinematicState truth = motion.at(t);
      const Eigen::Vector3d lever = config_.gnss.lever_arm_m;
      places_.push_back({k, t, truth.X_WB * lever, truth.v_WB_W + truth.X_WB.R * truth.w_WB_B.cross(lever)});
    }
  }

  Result<ProbeRun> run() override {
    const HeapMeter heap;
    CANYON_TRY(const auto sensor, sensor_of(setup_, config_));
    scene::SceneAt scene(*setup_.mission.scene);
    ProbeRun run;
    run.samples.dimension = what_ == What::kFix ? 3 : 1;
    CpuAccount account;
    for (const Place& place : places_) {
      if (!setup_.mission.traffic.empty())
        scene.set_instances(setup_.mission.traffic.at(place.t - setup_.mission.start));
      gnss::GnssOutput output;
      {
        const ChargeCpu charge(&account);
        output = sensor->measure(place.index, place.t, place.p_A_W, place.v_A_W, scene);
      }
      run.samples.values.push_back(what_ == What::kFix ? fix_error(output) : pseudoranges(output));
    }
    run.cpu_s = account.seconds();
    run.simulated_s = static_cast<double>(places_.size()) / config_.gnss.rate_hz;
    const gnss::GnssCounters work = sensor->counters();
    run.work = work.epochs + work.occlusion_rays + work.path_searches + work.facets_tested;
    run.memory_mb = heap.grown_mb();
    return run;
  }

 private:
  /// By satellite, for which every rung has the same place.
  static std::vector<double> pseudoranges(const gnss::GnssOutput& output) {
    constexpr std::size_t kSystems = 6, kPrns = 256;
    std::vector<double> out(kSystems * kPrns, kNaN);
    for (const GnssObservation& one : output.epoch.observations)
      out.at(static_cast<std::size_t>(one.sv.system) * kPrns + one.sv.prn) = one.pseudorange_m;
    return out;
  }
  static std::vector<double> fix_error(const gnss::GnssOutput& output) {
    if (output.fix.status == FixStatus::kNone) return {kNaN, kNaN, kNaN};
    const Eigen::Vector3d error = output.fix.p_A_E - output.truth.p_A_E;
    return {error.x(), error.y(), error.z()};
  }

  ProbeSetup setup_;
  const mission::MissionConfig config_;
  What what_;
  std::vector<Place> places_;
};

Result<std::unique_ptr<Probe>> make(const ProbeSetup& setup, What what, const std::vector<std::int64_t>& ticks) {
  CANYON_TRY(const auto sensor, sensor_of(setup, setup.config));  // what it refuses is told before it runs
  auto probe = std::make_unique<GnssProbe>(setup, what, ticks);
  return std::unique_ptr<Probe>(std::move(probe));
}

}  // namespace

Result<std::unique_ptr<Probe>> make_pseudorange_probe(const ProbeSetup& setup) {
  return make(setup, What::kPseudorange, spread_ticks(setup, setup.config.gnss.rate_hz, 0.0));
}

Result<std::unique_ptr<Probe>> make_fix_probe(const ProbeSetup& setup) {
  return make(setup, What::kFix, spread_ticks(setup, setup.config.gnss.rate_hz, 0.0));
}

Result<std::unique_ptr<Probe>> make_fix_sequence_probe(const ProbeSetup& setup) {
  std::vector<std::int64_t> ticks(setup.samples);
  std::iota(ticks.begin(), ticks.end(), std::int64_t{1});
  return make(setup, What::kFix, ticks);
}

}  // namespace canyon::study
