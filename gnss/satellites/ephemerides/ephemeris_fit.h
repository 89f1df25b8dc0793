#pragma once

#include <optional>

#include "canyon/gnss/satellites/navigation_data.h"

namespace canyon::gnss {

/// A broadcast record fitted to an orbit, and how well it follows it.
struct FittedEphemeris {
  KeplerEphemeris ephemeris;
  double rms_m = 0.0, max_m = 0.0;  ///< 3-D, over the fit interval
};

/// The same of a GLONASS state vector.
struct FittedStateVector {
  GlonassEphemeris ephemeris;
  double rms_m = 0.0, max_m = 0.0;
};

/// Fits one record to any constellation (nominal, precise) as a control segment does: least squares of the fifteen
/// Keplerian parameters to positions every 5 min over [toe - 2 h, toe + 2 h] (as much of it as the constellation knows;
/// at least two hours), clock by a straight line. GPS, QZSS, Galileo and BeiDou, whose geostationary satellites get D2
/// messages; nullopt for others and where there is too little to fit. Of a nominal orbit nothing but rounding is left,
/// of a real one some centimetres to decimetres.
std::optional<FittedEphemeris> fit_ephemeris(const Constellation& constellation, SatelliteId sv, GpsTime toe);

/// Fits position, velocity and the constant acceleration of a GLONASS record to positions every 90 s over [t_b - 7.5
/// min, t_b + 7.5 min] (at least ten minutes), clock by a straight line. Of a nominal orbit less than 1 cm is left.
/// nullopt for satellites of other systems, without a known channel, and where there is too little to fit.
std::optional<FittedStateVector> fit_state_vector(const Constellation& constellation, SatelliteId sv, GpsTime t_b);

/// Records for these satellites over [start, end], with a message type each system broadcasts: every two hours, of
/// GLONASS every quarter of an hour of UTC; leap seconds filled in.
NavigationData fit_navigation_data(const Constellation& constellation, const std::vector<SatelliteId>& satellites,
                                   GpsTime start, GpsTime end);

}  // namespace canyon::gnss
