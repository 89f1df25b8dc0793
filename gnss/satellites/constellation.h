#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/messages.h"
#include "canyon/core/time.h"

namespace canyon::gnss {

/// A satellite at an instant, as its navigation message tells it.
struct SatelliteState {
  Eigen::Vector3d p_E;      ///< antenna phase centre, in E of that same instant
  Eigen::Vector3d v_E;      ///< derivative of p_E in the rotating frame E, m/s
  double clock_s = 0.0;     ///< satellite clock minus GPS time with relativity, for the signals it was determined with
  double clock_rate = 0.0;  ///< derivative of clock_s, s/s
  /// By RINEX band digit (1 = L1 / E1 / G1 / B1C, 2 = L2 / G2 / B1I, 5 = L5 / E5a / B2a, ...): what a user of that band
  /// alone subtracts from clock_s: TGD, BGD, ISC. 0 where the message does not tell.
  std::array<double, 10> group_delay_s{};
  double accuracy_m = kNaN;   ///< 1-sigma of the range that the message announces (URA, SISA); NaN where it does not
  int frequency_channel = 0;  ///< GLONASS FDMA: -7..6, kUnknownChannel where nobody tells; 0 otherwise
  /// Bit b: the message does not tell the delay of band b, and group_delay_s has that of a band close by.
  unsigned borrowed_delay_bands = 0;

  /// Clock for a user of one band alone.
  double clock_of_band_s(int band) const { return clock_s - group_delay_s.at(static_cast<std::size_t>(band)); }
};

/// Where the satellites are: broadcast ephemerides or a nominal constellation. Immutable and thread-safe.
class Constellation {
 public:
  virtual ~Constellation() = default;
  /// All satellites it may ever give, ascending.
  virtual const std::vector<SatelliteId>& satellites() const = 0;
  /// State at GPS time t; nullopt where the satellite is unhealthy or has no ephemeris valid at t.
  virtual std::optional<SatelliteState> state(SatelliteId sv, GpsTime t) const = 0;
  /// The same for a signal that left at t and arrives when the receiver's clock reads `received`: where a satellite has
  /// several records, that reading chooses among them, for all satellites of an epoch alike, as a receiver's does.
  virtual std::optional<SatelliteState> state_received(SatelliteId sv, GpsTime t, GpsTime received) const {
    static_cast<void>(received);
    return state(sv, t);
  }
};

/// The 24 baseline slots of the GPS Standard Positioning Service Performance Standard (2001, table 3-1), A1..F4 =
/// G01..G24: circular orbits of 26559.7 km at 55 deg, nodes drifting by -0.03877 deg/day, perfect clocks. Two
/// revolutions per turn of the Earth under the node, so that the published ground tracks repeat and the constellation
/// is good for any date.
std::unique_ptr<Constellation> make_nominal_gps();

/// Nominal constellations without any file, of the systems of these RINEX letters (G R E C J; others throw): GPS as
/// above; Galileo and GLONASS Walker 24/3/1 (GLONASS's with the waves that the Earth's flattening makes); BeiDou-3 with
/// 24 MEO, 3 IGSO and 3 GEO; QZSS with 3 inclined satellites and one GEO (gnss/tables/nominal_orbits.csv, with
/// sources). Ground tracks repeat, clocks are perfect, GLONASS has its channels.
std::unique_ptr<Constellation> make_nominal(const std::string& systems);

}  // namespace canyon::gnss
