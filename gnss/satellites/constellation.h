#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/messages.h"
#include "core/time.h"

namespace canyon::gnss {

/// A satellite at an instant, as its navigation message tells it.
struct SatelliteState {
  Eigen::Vector3d p_E;      ///< antenna phase centre, in E of that same instant
  Eigen::Vector3d v_E;      ///< derivative of p_E in the rotating frame E, m/s
  double clock_s = 0.0;     ///< satellite clock minus GPS time for single-frequency L1: polynomial + relativity - TGD
  double clock_rate = 0.0;  ///< derivative of clock_s, s/s
};

/// Where the satellites are: broadcast ephemerides or a nominal constellation. Immutable and thread-safe.
class Constellation {
 public:
  virtual ~Constellation() = default;
  /// All satellites it may ever give, ascending.
  virtual const std::vector<SatelliteId>& satellites() const = 0;
  /// State at GPS time t; nullopt where the satellite is unhealthy or has no ephemeris valid at t.
  virtual std::optional<SatelliteState> state(SatelliteId sv, GpsTime t) const = 0;
};

/// The 24 baseline slots of the GPS Standard Positioning Service Performance Standard (2001, table 3-1), A1..F4 =
/// G01..G24: circular orbits of 26559.7 km at 55 deg, nodes drifting by -0.03877 deg/day, perfect clocks. Two
/// revolutions per turn of the Earth under the node, so that the published ground tracks repeat and the constellation
/// is good for any date.
std::unique_ptr<Constellation> make_nominal_gps();

}  // namespace canyon::gnss
