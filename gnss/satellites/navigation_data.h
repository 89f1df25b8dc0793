#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "canyon/core/result.h"
#include "canyon/gnss/satellites/ephemerides/glonass_ephemeris.h"
#include "canyon/gnss/satellites/ephemerides/kepler_ephemeris.h"
#include "canyon/gnss/satellites/klobuchar_coefficients.h"

namespace canyon::gnss {

/// Klobuchar coefficients as one system broadcasts them.
struct BroadcastKlobuchar {
  GnssSystem system = GnssSystem::kGps;
  GpsTime t;  ///< of the message; of its file's first ephemeris where the record does not tell
  KlobucharCoefficients coefficients;
};

/// All that navigation files say, of one or several of them together, in the order given.
struct NavigationData {
  struct Source {
    std::string name;  ///< as given, for messages
    double version = 0.0;
  };
  std::vector<Source> files;
  std::vector<KeplerEphemeris> kepler;  ///< GPS, QZSS, Galileo, BeiDou; unhealthy ones included
  std::vector<GlonassEphemeris> glonass;
  std::vector<BroadcastKlobuchar> klobuchar;
  std::optional<int> leap_seconds;             ///< of the header; the conversion of times uses core/time.h's own table
  std::map<std::string, int> skipped_records;  ///< kinds that are not used, for example "EPH SBAS", and how many
  std::vector<std::string> warnings;           ///< damaged records that were skipped, `file:line: what`

  bool has_ephemeris() const { return !kepler.empty() || !glonass.empty(); }
  /// Names of the files, comma separated.
  std::string names() const;
  /// "12 EPH S SBAS, 3 STO G LNAV" of skipped_records; empty if there are none.
  std::string skipped() const;
  /// Appends another file's records.
  void append(NavigationData other);
  /// The last coefficients of that system given at or before t, else its first; nullopt if it has none.
  std::optional<KlobucharCoefficients> klobuchar_at(GnssSystem system, GpsTime t) const;
};

/// Which of a satellite's records is used at a time.
enum class EphemerisChoice {
  /// Toe nearest to t: the best orbit that the file knows, also for times before it was transmitted; of two equally
  /// near
  /// the later, which is then the one on the air. But of Galileo's, whose toe lies before the transmission, the last
  /// before t.
  kNearestToe,
  kTransmitted  ///< the newest that had been transmitted by t: what a receiver had then
};

struct BroadcastOptions {
  /// RINEX letters of the systems wanted: G R E C J. Throws on others; check_systems() is for what users type.
  std::string systems = "GRECJ";
  EphemerisChoice choice = EphemerisChoice::kNearestToe;
  /// In descending preference; a satellite is described by the first of these of which it has any record, so that one
  /// satellite's orbit never mixes messages of one system. By default what single-frequency users of the first band
  /// take: GPS and QZSS LNAV, Galileo I/NAV, BeiDou D1 / D2.
  std::vector<NavigationMessage> messages = {
      NavigationMessage::kLnav, NavigationMessage::kInav, NavigationMessage::kD1,     NavigationMessage::kD2,
      NavigationMessage::kFdma, NavigationMessage::kFnav, NavigationMessage::kBcnav1, NavigationMessage::kAlmanac};
};

/// Users' letters of systems: an Error for `key` unless each is one of G R E C J, none twice, and at least one.
Status check_systems(const std::string& letters, const std::string& key);

/// The records that make_broadcast() takes: of the systems wanted, one message per satellite. Written to a file they
/// show any reader the same satellites, whatever message it prefers.
NavigationData used_records(NavigationData data, const BroadcastOptions& options = {});

/// The constellation that the records describe. For each satellite and time one record is chosen (of several with the
/// same toe, the last given); it must be healthy and t within its validity, else there is no state.
std::unique_ptr<Constellation> make_broadcast(const NavigationData& data, const BroadcastOptions& options = {});

/// Several constellations as one; of satellites that more than one has, the first tells the state, also when it has
/// none.
std::unique_ptr<Constellation> make_merged(std::vector<std::unique_ptr<Constellation>> parts);

/// The span of the healthy records' validity must hold [start, end], and at no time in it may fewer than four
/// satellites of those systems have a valid ephemeris; else an Error for `key` that names the span covered.
Status check_coverage(const NavigationData& data, const std::string& systems, GpsTime start, GpsTime end,
                      const std::string& key);

}  // namespace canyon::gnss
