#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "canyon/core/result.h"
#include "canyon/gnss/products/antex_file.h"
#include "canyon/gnss/products/clock_file.h"
#include "canyon/gnss/satellites/constellation.h"
#include "canyon/gnss/satellites/navigation_data.h"

namespace canyon::gnss {

/// One satellite at one epoch of an SP3 file.
struct PreciseSample {
  GpsTime t;
  Eigen::Vector3d p_E;                 ///< of the centre of mass (IGS products), in E
  double clock_s = kNaN;               ///< without the periodic relativity, which users add; NaN where not known
  bool clock_event = false;            ///< the clock jumped between the epoch before and this one
  bool manoeuvre = false;              ///< of the orbit, between the epoch before and this one
  std::optional<Eigen::Vector3d> v_E;  ///< m/s in E, where the file has velocities
};

/// What SP3 files say, of one or several of them joined. Samples ascend in time, one per epoch.
struct PreciseOrbits {
  std::vector<std::string> files;
  double interval_s = 0.0;  ///< between epochs; the longest of several files
  std::map<SatelliteId, std::vector<PreciseSample>> satellites;
  std::vector<std::string> warnings;  ///< damaged lines that were skipped, `file:line: what`

  std::string names() const;
  /// Joins another file; where both have an epoch of a satellite, the sample with a clock counts, else the first given.
  void append(PreciseOrbits other);
};

/// Reads SP3-a, -b, -c or -d, plain or gzip. Times in GPS, Galileo, QZSS, BeiDou time, UTC, GLONASS time or TAI become
/// GPS time. Positions that are 0 and clocks of 999999.999999 are left out. Other satellites than those of GnssSystem
/// are skipped. Errors with file and line: not SP3, damaged header, no position; a damaged or truncated body is warned
/// of.
Result<PreciseOrbits> read_sp3_file(const std::string& path);
Result<PreciseOrbits> read_sp3_files(const std::vector<std::string>& paths);
Result<PreciseOrbits> parse_sp3_file(std::string_view text, const std::string& file_name);

/// What precise orbits are completed with.
struct PreciseOptions {
  std::string systems = "GRECJ";
  /// Clocks of a RINEX clock file instead of those of the SP3 file.
  const ClockFile* clocks = nullptr;
  /// Satellite antennas: from the centre of mass to the phase centre of the ionosphere-free combination of the clocks.
  /// Without them p_E is the centre of mass, and ranges are too long by up to 2.7 m.
  const AntexFile* antennas = nullptr;
  /// Broadcast group delays, which single-frequency users need with any clock (without them they are 0), and GLONASS's
  /// frequency numbers.
  const NavigationData* broadcast = nullptr;
  /// GLONASS frequency numbers by slot, as an observation file's header tells them; they come before those of
  /// `broadcast`, and those before the public plan.
  std::map<int, int> glonass_channels = {};
};

/// Interpolated precise orbits and clocks.
///
/// Positions: polynomial of degree 9 (Neville) through the ten samples nearest to t, in the frame that does not turn
/// with the Earth and coincides with E at t; velocity is its derivative. Clocks: linear between the two samples around
/// t, then the periodic relativity -2 p.v / c^2 is added. No state further than half an interval outside a run of
/// samples, where a run ends at a missing epoch or a manoeuvre; runs of fewer than ten samples are not used; no state
/// where either clock around t is unknown, or jumped.
/// The objects of `options` are read here and need not outlive the call.
std::unique_ptr<Constellation> make_precise(const PreciseOrbits& orbits, const PreciseOptions& options = {});

}  // namespace canyon::gnss
