#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/messages.h"
#include "canyon/core/result.h"

namespace canyon::gnss {

/// Calibration of an antenna at one frequency.
struct AntennaPattern {
  /// Phase centre from the reference point, m. Receiver antennas: north, east, up. Satellites: body axes, z to the
  /// Earth, y along the solar panels.
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();
  double zenith_first_deg = 0.0, zenith_step_deg = 5.0;  ///< of the columns; for satellites the nadir angle
  double azimuth_step_deg = 0.0;                         ///< 0 = the pattern does not depend on azimuth
  std::vector<double> no_azimuth_m;                      ///< mean over azimuth, one value per zenith angle
  std::vector<std::vector<double>> by_azimuth_m;         ///< rows 0, step, ..., 360 deg; empty without azimuths

  /// Variation of the phase centre, m, linear in both angles; the nearest column outside their range. 0 if there is no
  /// pattern at all. Added to the range like the projection of -offset.
  double variation_m(double zenith_rad, double azimuth_rad = 0.0) const;
};

struct Antenna {
  std::string type;               ///< "BLOCK IIR-M", or receiver antenna and radome "TRM29659.00     NONE"
  std::optional<SatelliteId> sv;  ///< of satellite antennas
  std::optional<GpsTime> valid_from, valid_to;     ///< of satellite antennas
  std::map<std::string, AntennaPattern> patterns;  ///< by RINEX system and band: "G01", "G02", "R01", "E05", ...

  const AntennaPattern* pattern(const std::string& frequency) const;
};

struct AntexFile {
  std::string name;
  std::vector<Antenna> antennas;
  std::vector<std::string> warnings;

  /// The antenna that flew as that satellite at t; nullptr if none.
  const Antenna* satellite(SatelliteId sv, GpsTime t) const;
  /// A receiver antenna by its IGS name with radome; the same without radome (NONE) if that one is not calibrated.
  const Antenna* receiver(const std::string& type) const;
};

/// Reads ANTEX 1.3 or 1.4, plain or gzip. A damaged antenna is skipped with a warning that names its line; errors with
/// file and line: not ANTEX, no antenna.
Result<AntexFile> read_antex_file(const std::string& path);
Result<AntexFile> parse_antex_file(std::string_view text, const std::string& file_name);

/// Phase centre of the ionosphere-free combination that precise clocks refer to (precise_clock_bands()), from the
/// satellite's centre of mass, in E. Attitude: nominal yaw steering, z to the Earth's centre, y perpendicular to the
/// Sun (Bar-Sever 1996), as IGS products assume outside eclipses. A missing second frequency counts as equal to the
/// first; zero without any.
Eigen::Vector3d satellite_offset_E(const Antenna& antenna, const Eigen::Vector3d& p_E, GpsTime t);

}  // namespace canyon::gnss
