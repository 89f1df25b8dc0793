#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/messages.h"
#include "canyon/core/result.h"
#include "canyon/gnss/rinex/observation/observation_code.h"

namespace canyon::gnss {

/// Codes of each system, in the order of the values; by GnssSystem.
using ObservationCodes = std::array<std::vector<ObservationCode>, 6>;

/// One number of an observation file.
struct ObservationValue {
  double value = kNaN;            ///< m, cycles, Hz or dB-Hz by the kind of its code; NaN = missing
  std::uint8_t loss_of_lock = 0;  ///< LLI digit: bit 0 = lock lost since the last epoch, cycle slip possible
  std::uint8_t strength = 0;      ///< signal strength 1..9, 0 = not given
  bool missing() const { return value != value; }
};

struct SatelliteObservations {
  SatelliteId sv;
  std::vector<ObservationValue> values;  ///< by the epoch's codes of its system; what is not there is missing
};

struct ObservationEpoch {
  GpsTime t;                         ///< time of reception by the receiver's clock, in GPS time whatever the file's
  int line = 0;                      ///< of its epoch line
  bool after_power_failure = false;  ///< event flag 1
  double clock_offset_s = kNaN;      ///< receiver clock, if the file gives one
  std::size_t code_set = 0;          ///< index into ObservationFile::code_sets
  std::vector<SatelliteObservations> satellites;
};

/// What stands between epochs: event flags 2 to 5.
struct ObservationEvent {
  enum class Kind : std::uint8_t { kMoving = 2, kNewSite = 3, kHeader = 4, kExternal = 5 };
  Kind kind = Kind::kHeader;
  int line = 0;
  std::optional<GpsTime> t;
};

struct ObservationHeader {
  double version = 0.0;
  char system = 'G';  ///< G R E C J S, M = mixed
  std::string marker_name, receiver, antenna;
  std::optional<Eigen::Vector3d> approx_position_E;  ///< of the marker, as the header says: good to metres at best
  std::optional<double> interval_s;
  std::string time_system = "GPS";      ///< of the file: GPS, GLO, GAL, QZS, BDT; epochs are converted when read
  std::map<int, int> glonass_channels;  ///< frequency number by slot
  std::optional<int> leap_seconds;
};

/// A RINEX observation file.
struct ObservationFile {
  std::string name;  ///< as given, for messages
  ObservationHeader header;
  std::vector<ObservationCodes> code_sets;  ///< the header's, then one more for each change inside the file
  std::vector<ObservationEpoch> epochs;     ///< in file order
  std::vector<ObservationEvent> events;
  int other_system_satellites = 0;    ///< of systems that Canyon does not know, skipped
  int damaged = 0;                    ///< epochs, satellites and values that were skipped
  std::vector<std::string> warnings;  ///< about them, `file:line: what`

  /// The codes that an epoch's satellites of a system have.
  const std::vector<ObservationCode>& codes(const ObservationEpoch& epoch, GnssSystem system) const {
    return code_sets[epoch.code_set][static_cast<std::size_t>(system)];
  }
};

/// Reads a RINEX 2, 3 or 4 observation file: plain, gzip, Hatanaka-compressed (CRINEX 1 and 3), or both.
///
/// Codes of RINEX 2 are given as RINEX 3 has them. Values that are blank or 0.0 are missing. Numbers that do not parse
/// or are cut off, epochs that cannot be read, or that do not stand in the order of time with most of those around
/// them, and satellites that an epoch has already are skipped with a warning that names their line (of the file as it
/// is stored, compressed or not). Errors, each with file and line: empty, not RINEX, wrong
/// version or type, no end of header, no codes, no epoch at all. Survives arbitrary bytes.
Result<ObservationFile> read_observation_file(const std::string& path);
Result<ObservationFile> parse_observation_file(std::string_view text, const std::string& file_name);

}  // namespace canyon::gnss
