#include "canyon/core/process/cpu_time.h"
#include "canyon/gnss/products/precise_orbits.h"
#include "canyon/study/tradeoff/probes/heap_meter.h"
#include "canyon/study/tradeoff/probes/models.h"

// Precise orbits (SP3) give samples, and a polynomial between them: how far apart may they be?
namespace canyon::study {
namespace {

constexpr double kHalfSpan_s = 6 * 3600.0;  // so that ten samples of an hour lie around every instant asked for

/// Samples of circular orbits (gnss/satellites/constellation.h: the nominal GPS slots) at an interval, interpolated
/// as SP3 files are, against the orbits themselves.
class OrbitProbe final : public Probe {
 public:
  explicit OrbitProbe(const ProbeSetup& setup) : setup_(setup), orbits_(gnss::make_nominal_gps()) {
    const double interval_s = setup.own_number("sp3.interval_s");
    gnss::PreciseOrbits samples;
    samples.interval_s = interval_s;
    const auto n = static_cast<int>(std::ceil(kHalfSpan_s / interval_s));
    for (const SatelliteId sv : orbits_->satellites())
      for (int k = -n; k <= n; ++k) {
        const GpsTime t = setup.mission.start + k * interval_s;
        samples.satellites[sv].push_back({.t = t, .p_E = orbits_->state(sv, t)->p_E, .clock_s = 0.0, .v_E = {}});
      }
    interpolated_ = gnss::make_precise(samples);
  }

  Result<ProbeRun> run() override {
    const HeapMeter heap;
    ProbeRun run;
    run.samples.dimension = 3;
    CpuAccount account;
    for (std::size_t i = 0; i < setup_.samples; ++i) {
      // Over an hour, at odd times, so that no rung's samples are met.
      const GpsTime t =
          setup_.mission.start + 3600.0 * ((static_cast<double>(i) + 0.37) / static_cast<double>(setup_.samples) - 0.5);
      std::vector<double> errors;
      for (const SatelliteId sv : orbits_->satellites()) {
        std::optional<gnss::SatelliteState> state;
        {
          const ChargeCpu charge(&account);
          state = interpolated_->state(sv, t);
        }
        const Eigen::Vector3d error =
            state ? Eigen::Vector3d(state->p_E - orbits_->state(sv, t)->p_E) : Eigen::Vector3d::Constant(kNaN);
        errors.insert(errors.end(), error.begin(), error.end());
        ++run.work;
      }
      run.samples.values.push_back(std::move(errors));
    }
    run.cpu_s = account.seconds();
    run.simulated_s = static_cast<double>(setup_.samples) / setup_.config.gnss.rate_hz;
    run.memory_mb = heap.grown_mb();
    return run;
  }

 private:
  ProbeSetup setup_;
  std::unique_ptr<gnss::Constellation> orbits_, interpolated_;
};

}  // namespace

Result<std::unique_ptr<Probe>> make_orbit_probe(const ProbeSetup& setup) {
  return std::unique_ptr<Probe>(std::make_unique<OrbitProbe>(setup));
}

}  // namespace canyon::study
