#include "canyon/study/tradeoff/recorded/recorded_probe.h"

#include "canyon/core/math/median.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/sky_view.h"

namespace canyon::study {
namespace {

gnss::SkyView view_of(const RecordedEpoch& epoch, const RecordedSatellite& satellite) {
  gnss::SkyView view;
  view.t = epoch.t;
  view.receiver = geodetic_from_ecef(epoch.p_A_E);
  view.elevation_rad = satellite.elevation_rad;
  view.azimuth_rad = satellite.azimuth_rad;
  return view;
}

}  // namespace

Status check_recording(const ProbeSetup& setup) {
  if (setup.recording != nullptr) return Ok{};
  return Error{.file = "--recording", .what = "is not given", .expected = "the recording of a drive"};
}

gnss::GnssConfig recorded_gnss(const ProbeSetup& setup) {
  gnss::GnssConfig config = setup.config.gnss;
  const RecordingConfig& recording = setup.recording->config;
  config.mask_deg = recording.mask_deg;
  config.satellites.systems = recording.systems;
  config.satellites.nav_file.clear();
  config.satellites.nav_files = recording.navigation;
  config.satellites.almanac_file.clear();
  return config;
}

Result<std::unique_ptr<gnss::GnssSensor>> recorded_sensor(const ProbeSetup& setup, const gnss::GnssConfig& config) {
  const RecordedDrive& drive = *setup.recording;
  return gnss::make_gnss_sensor(config, static_cast<std::uint64_t>(setup.config.run.seed), drive.epochs.front().t,
                                drive.epochs.back().t, *drive.scene);
}

Result<RecordedAtmosphere> RecordedAtmosphere::make(const ProbeSetup& setup, const gnss::GnssConfig& config) {
  const RecordedDrive& drive = *setup.recording;
  const GpsTime first = drive.epochs.front().t, last = drive.epochs.back().t;
  std::vector<std::string> warnings;
  const auto klobuchar = drive.data.navigation.klobuchar_at(GnssSystem::kGps, first).value_or(gnss::kBuiltInKlobuchar);
  RecordedAtmosphere out;
  CANYON_TRY(out.ionosphere_,
             config.ionosphere.make("gnss.ionosphere", gnss::IonosphereSetup{klobuchar, first, last, &warnings}));
  CANYON_TRY(out.troposphere_, config.troposphere.make("gnss.troposphere"));
  return out;
}

double RecordedAtmosphere::ionosphere_m(const RecordedEpoch& epoch, const RecordedSatellite& satellite) const {
  const double from_l1 = gnss::kL1Hz / satellite.frequency_hz;
  return from_l1 * from_l1 * ionosphere_->delay_m(view_of(epoch, satellite));
}

double RecordedAtmosphere::delay_m(const RecordedEpoch& epoch, const RecordedSatellite& satellite) const {
  return ionosphere_m(epoch, satellite) + troposphere_->delay_m(view_of(epoch, satellite));
}

void take_out_clocks(const std::vector<RecordedSatellite>& satellites, std::vector<double>& residuals_m) {
  for (const GnssSystem system : {GnssSystem::kGps, GnssSystem::kGlonass, GnssSystem::kGalileo, GnssSystem::kBeidou,
                                  GnssSystem::kQzss, GnssSystem::kSbas}) {
    std::vector<double> own;
    for (std::size_t i = 0; i < satellites.size(); ++i)
      if (satellites[i].sv.system == system) own.push_back(residuals_m[i]);
    const double clock_m = median(own);
    for (std::size_t i = 0; i < satellites.size(); ++i)
      if (satellites[i].sv.system == system) residuals_m[i] -= clock_m;
  }
}

}  // namespace canyon::study
