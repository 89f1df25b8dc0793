#include <algorithm>
#include <cmath>

#include "canyon/core/process/cpu_time.h"
#include "canyon/core/process/progress.h"
#include "canyon/study/tradeoff/probes/heap_meter.h"
#include "canyon/study/tradeoff/probes/models.h"
#include "canyon/study/tradeoff/recorded/recorded_probe.h"

// How far apart the samples of precise orbits may be before recorded pseudoranges show it.
namespace canyon::study {
namespace {

/// Every `step`-th sample of each satellite, counted from the first of the file.
gnss::PreciseOrbits thinned(const gnss::PreciseOrbits& all, std::size_t step) {
  gnss::PreciseOrbits out{
      .files = all.files, .interval_s = all.interval_s * static_cast<double>(step), .satellites = {}, .warnings = {}};
  GpsTime first = all.satellites.begin()->second.front().t;
  for (const auto& [sv, samples] : all.satellites) first = std::min(first, samples.front().t);
  for (const auto& [sv, samples] : all.satellites)
    for (const gnss::PreciseSample& sample : samples)
      if (std::llround((sample.t - first) / all.interval_s) % static_cast<std::int64_t>(step) == 0)
        out.satellites[sv].push_back(sample);
  return out;
}

/// Residuals of the recorded pseudoranges with satellites placed between the thinned samples. Clocks and orbits are
/// thinned together; of the scene nothing is predicted.
class ThinnedOrbits final : public Probe {
 public:
  ThinnedOrbits(const ProbeSetup& setup, std::unique_ptr<gnss::Constellation> orbits, RecordedAtmosphere atmosphere)
      : setup_(setup),
        epochs_(setup.recording->spread(setup.samples)),
        orbits_(std::move(orbits)),
        atmosphere_(std::move(atmosphere)) {}

  Result<ProbeRun> run() override {
    const HeapMeter heap;
    ProbeRun run;
    CpuAccount account;
    for (const RecordedEpoch* epoch : epochs_) {
      throw_if_cancelled();
      std::vector<RecordedSatellite> found;
      {
        const ChargeCpu charge(&account);
        found = recorded_satellites(*setup_.recording, *orbits_, *epoch->observed, epoch->p_A_E);
      }
      run.work += static_cast<std::int64_t>(found.size());
      run.samples.values.push_back(residuals(*epoch, found));
    }
    run.cpu_s = account.seconds();
    run.simulated_s = static_cast<double>(epochs_.size()) / setup_.config.gnss.rate_hz;
    run.memory_mb = heap.grown_mb();
    return run;
  }

 private:
  /// In the order of the epoch's satellites; NaN where the thinned samples place none.
  std::vector<double> residuals(const RecordedEpoch& epoch, const std::vector<RecordedSatellite>& found) const {
    std::vector<double> of_found;
    for (const RecordedSatellite& satellite : found)
      of_found.push_back(satellite.beyond_m(epoch.p_A_E) - atmosphere_.delay_m(epoch, satellite));
    take_out_clocks(found, of_found);
    std::vector<double> out(epoch.satellites.size(), kNaN);
    for (std::size_t i = 0; i < out.size(); ++i)
      for (std::size_t k = 0; k < found.size(); ++k)
        if (found[k].sv == epoch.satellites[i].sv) out[i] = of_found[k];
    return out;
  }

  ProbeSetup setup_;
  std::vector<const RecordedEpoch*> epochs_;
  std::unique_ptr<gnss::Constellation> orbits_;
  RecordedAtmosphere atmosphere_;
};

}  // namespace

Result<std::unique_ptr<Probe>> make_recorded_orbit_probe(const ProbeSetup& setup) {
  CANYON_TRY_STATUS(check_recording(setup));
  const gnss::PreciseOrbits& all = setup.recording->sp3;
  if (all.satellites.empty())
    return Error{.file = setup.recording->name, .key = "sp3", .what = "is missing", .expected = "precise orbits"};
  const double wanted_s = setup.own_number("sp3.interval_s");
  const auto step = static_cast<std::size_t>(std::llround(wanted_s / all.interval_s));
  if (step < 1 || std::abs(static_cast<double>(step) * all.interval_s - wanted_s) > 1e-6)
    return Error{.file = all.names(),
                 .what = "has a sample every " + std::to_string(std::lround(all.interval_s)) + " s",
                 .expected = "an interval that is a multiple of it"};
  gnss::PreciseOptions options;
  options.systems = setup.recording->config.systems;
  options.broadcast = &setup.recording->data.navigation;
  options.glonass_channels = setup.recording->data.observations.header.glonass_channels;
  CANYON_TRY(RecordedAtmosphere atmosphere, RecordedAtmosphere::make(setup, recorded_gnss(setup)));
  return std::unique_ptr<Probe>(
      std::make_unique<ThinnedOrbits>(setup, gnss::make_precise(thinned(all, step), options), std::move(atmosphere)));
}

}  // namespace canyon::study
