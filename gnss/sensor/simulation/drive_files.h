#pragma once

#include <string>
#include <vector>

#include "canyon/core/earth/geoid.h"
#include "canyon/gnss/sensor/satellite_source.h"
#include "canyon/gnss/sensor/simulation/drive.h"

namespace canyon::gnss {

/// The files of a drive, filled epoch by epoch.
class DriveFiles {
 public:
  /// `undulation_m`: of the scene, 0 where it has none; then the geoid's at each place.
  explicit DriveFiles(double undulation_m) : undulation_m_(undulation_m) {}

  void add(const GnssOutput& output);
  /// What was measured, with the bands that occur in each system. An Error if nothing was received; `name`: of the
  /// file.
  Result<std::string> rinex_observations(const Drive& drive, const SatelliteSource& source,
                                         const std::string& name) const;
  const std::string& nmea() const { return nmea_; }
  const std::string& fixes_csv() const { return fixes_; }
  const std::string& satellites_csv() const { return satellites_; }

 private:
  std::string nmea_of(const GnssOutput& output);
  void add_fix(const GnssOutput& output);
  void add_satellites(const GnssOutput& output);

  double undulation_m_;
  Geoid geoid_;
  std::vector<GnssEpoch> epochs_;
  std::string nmea_;
  std::string fixes_ =
      "gps_week,sow,status,satellites,gdop,pdop,hdop,vdop,x_m,y_m,z_m,true_x_m,true_y_m,true_z_m,error_e_m,error_n_m,"
      "error_u_m\n";
  std::string satellites_ =
      "gps_week,sow,satellite,elevation_deg,azimuth_deg,line_of_sight,tracked,reflections,pseudorange_m,doppler_hz,"
      "carrier_phase_cycles,cn0_dbhz,range_m,multipath_m,ionosphere_m,troposphere_m,ephemeris_m,noise_m\n";
};

/// RINEX navigation of the satellites simulated; `warnings` gets those that it cannot describe.
Result<std::string> rinex_navigation(const SatelliteSource& source, const std::string& systems, GpsTime start,
                                     GpsTime end, std::vector<std::string>& warnings);

}  // namespace canyon::gnss
