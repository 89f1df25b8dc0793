#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/gnss/rinex/observation/observation_code.h"

namespace canyon::gnss {

/// What the header of an observation file says.
struct ObservationWriterOptions {
  std::string marker = "CANYON";
  GpsTime first{};  ///< first epoch, as the receiver tags it
  std::optional<double> interval_s{};
  std::optional<Eigen::Vector3d> approx_position_E{};  ///< zeros are written where it is not known or the antenna moves
  std::vector<std::pair<GnssSystem, std::vector<int>>> bands{};  ///< of each system, the RINEX digits of its bands
  std::map<int, int> glonass_channels{};                         ///< by slot
};

/// Writes RINEX 3.04 observations as text, epoch by epoch: C, L, D and S of each band. Time system GPS.
///
///     ObservationWriter writer({.first = t0, .bands = {{GnssSystem::kGps, {1, 2}}, {GnssSystem::kGalileo, {1}}}});
///     file << writer.header();
///     for (...) file << writer.epoch(epoch);
class ObservationWriter {
 public:
  /// Every system at most once, with at least one band that it has; else throws.
  explicit ObservationWriter(ObservationWriterOptions options);

  std::string header() const;
  /// The epoch line and one line per satellite. Satellites of systems without bands are left out; what is NaN, or does
  /// not fit its field, is blank. A slipped phase has bit 0 of its loss-of-lock indicator set.
  std::string epoch(const GnssEpoch& epoch) const;

  /// The code that a band's signal is written under: G 1C 2L 5Q, R 1C 2C, E 1C 5Q 6C 7Q 8Q, C 1P 2I 5P 6I 7I,
  /// J 1C 2L 5Q, S 1C 5I.
  static ObservationCode code(char kind, GnssSystem system, int band);

 private:
  ObservationWriterOptions options_;
};

}  // namespace canyon::gnss
