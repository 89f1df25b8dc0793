#pragma once

#include <optional>

#include "gnss/satellites/navigation_data.h"

namespace canyon::gnss {

/// A broadcast record fitted to an orbit, and how well it follows it.
struct FittedEphemeris {
  KeplerEphemeris ephemeris;
  double rms_m = 0.0, max_m = 0.0;  ///< 3-D, over the fit interval
};

/// Fits one record to any constellation (nominal, precise) as a control segment does: least squares of the fifteen
/// Keplerian parameters to positions every 5 min over [toe - 2 h, toe + 2 h] (as much of it as the constellation knows;
/// at least two hours), clock by a straight line. GPS, QZSS, Galileo and BeiDou satellites off the geostationary belt
/// (their node is undefined); nullopt for others and where there is too little to fit. Of a nominal orbit nothing but
/// rounding is left, of a real one some centimetres to decimetres.
std::optional<FittedEphemeris> fit_ephemeris(const Constellation& constellation, SatelliteId sv, GpsTime toe);

/// Records every two hours for all satellites over [start, end], with a message type each system broadcasts; leap
/// seconds filled in.
NavigationData fit_navigation_data(const Constellation& constellation, GpsTime start, GpsTime end);

}  // namespace canyon::gnss
