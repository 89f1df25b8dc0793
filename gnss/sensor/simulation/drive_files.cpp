#include "canyon/gnss/sensor/simulation/drive_files.h"

#include <cmath>
#include <map>
#include <set>

#include "canyon/core/fix_status.h"
#include "canyon/core/output/printed.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/gnss/nmea/nmea_writer.h"
#include "canyon/gnss/rinex/navigation/navigation_writer.h"
#include "canyon/gnss/rinex/navigation/simulated_navigation.h"
#include "canyon/gnss/rinex/observation/observation_writer.h"

namespace canyon::gnss {
namespace {

std::string field(double value, int decimals) {
  return std::isfinite(value) ? printed("%.*f", decimals, value) : std::string();
}

}  // namespace

void DriveFiles::add(const GnssOutput& output) {
  epochs_.push_back(output.epoch);
  nmea_ += nmea_of(output);
  add_fix(output);
  add_satellites(output);
}

std::string DriveFiles::nmea_of(const GnssOutput& output) {
  const double undulation_m =
      undulation_m_ != 0.0 ? undulation_m_ : geoid_.undulation_m(geodetic_from_ecef(output.truth.p_A_E));
  NmeaEpoch epoch{.fix = output.fix, .undulation_m = undulation_m, .satellites = {}};
  for (const GnssObservationTruth& s : output.truth.satellites) {
    NmeaSatellite satellite{s.sv, s.elevation_rad, s.azimuth_rad};
    for (const GnssObservation& o : output.epoch.observations)
      if (o.sv == s.sv) {
        satellite.cn0_dbhz = o.cn0_dbhz;
        satellite.used = o.used;
      }
    epoch.satellites.push_back(satellite);
  }
  return nmea_text(epoch);
}

void DriveFiles::add_fix(const GnssOutput& output) {
  const GnssFix& fix = output.fix;
  const Eigen::Vector3d& truth = output.truth.p_A_E;
  const Eigen::Vector3d error = rotation_E_from_enu(geodetic_from_ecef(truth)).transpose() * (fix.p_A_E - truth);
  fixes_ += printed("%d,%.9f,%s,%d", fix.t.week(), fix.t.sow_s(), fix_status_name(fix.status), fix.satellites);
  for (const double dop : {fix.dop.gdop, fix.dop.pdop, fix.dop.hdop, fix.dop.vdop}) fixes_ += "," + field(dop, 3);
  for (const Eigen::Vector3d& v : {fix.p_A_E, truth, error})
    for (int i = 0; i < 3; ++i) fixes_ += "," + field(v[i], 4);
  fixes_ += "\n";
}

void DriveFiles::add_satellites(const GnssOutput& output) {
  for (const GnssObservationTruth& s : output.truth.satellites) {
    GnssObservation measured;
    for (const GnssObservation& o : output.epoch.observations)
      if (o.sv == s.sv) measured = o;
    satellites_ += printed("%d,%.9f,%s,%.4f,%.4f,%d,%d,%d,", output.fix.t.week(), output.fix.t.sow_s(),
                           s.sv.str().c_str(), s.elevation_rad / kDegree, s.azimuth_rad / kDegree,
                           s.line_of_sight ? 1 : 0, s.tracked ? 1 : 0, s.reflections) +
                   field(measured.pseudorange_m, 4) + "," + field(measured.doppler_hz, 4) + "," +
                   field(measured.carrier_phase_cycles, 4) + "," + field(measured.cn0_dbhz, 2);
    for (const double error : {s.range_m, s.multipath_m, s.ionosphere_m, s.troposphere_m, s.ephemeris_m, s.noise_m})
      satellites_ += "," + field(s.tracked ? error : kNaN, 4);
    satellites_ += "\n";
  }
}

Result<std::string> DriveFiles::rinex_observations(const Drive& drive, const SatelliteSource& source,
                                                   const std::string& name) const {
  ObservationWriterOptions header;
  header.first = epochs_.front().t;
  header.interval_s = 1.0 / drive.rate_hz;
  // One that moves has no position to name.
  if (drive.stands()) header.approx_position_E = drive.path.at(drive.start)->p_E;
  std::map<GnssSystem, std::set<int>> bands;
  for (const GnssEpoch& epoch : epochs_) {
    throw_if_cancelled();
    for (const GnssObservation& o : epoch.observations) {
      bands[o.sv.system].insert(o.band);
      if (o.second.band != 0) bands[o.sv.system].insert(o.second.band);
      if (o.sv.system != GnssSystem::kGlonass) continue;
      if (const auto state = source.constellation->state(o.sv, epoch.t))
        header.glonass_channels[o.sv.prn] = state->frequency_channel;
    }
  }
  if (bands.empty()) return Error{name, 0, "", "nothing was received", "at least one satellite"};
  for (const auto& [system, digits] : bands)
    header.bands.emplace_back(system, std::vector<int>(digits.begin(), digits.end()));
  const ObservationWriter writer(header);
  std::string out = writer.header();
  for (const GnssEpoch& epoch : epochs_) {
    throw_if_cancelled();
    out += writer.epoch(epoch);
  }
  return out;
}

Result<std::string> rinex_navigation(const SatelliteSource& source, const std::string& systems, GpsTime start,
                                     GpsTime end, std::vector<std::string>& warnings) {
  CANYON_TRY(auto simulated, simulated_navigation(*source.constellation, source.navigation, systems, start, end));
  warnings.insert(warnings.end(), simulated.warnings.begin(), simulated.warnings.end());
  if (!simulated.data.klobuchar_at(GnssSystem::kGps, start))
    simulated.data.klobuchar.push_back({GnssSystem::kGps, start, source.klobuchar});
  return navigation_file_text(simulated.data);
}

}  // namespace canyon::gnss
