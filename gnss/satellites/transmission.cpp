#include "canyon/gnss/satellites/transmission.h"

#include <cmath>

#include "canyon/core/units.h"
#include "canyon/gnss/signal.h"

namespace canyon::gnss {

Eigen::Vector3d turned_by_earth(const Eigen::Vector3d& v_E, double travel_s) {
  const double angle = kGpsEarthRate * travel_s;
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v_E.x() + s * v_E.y(), -s * v_E.x() + c * v_E.y(), v_E.z()};
}

Eigen::Vector3d Transmission::p_E() const {
  return turned_by_earth(state.p_E, travel_s);
}
Eigen::Vector3d Transmission::v_E() const {
  return turned_by_earth(state.v_E, travel_s);
}

std::optional<Transmission> transmission_to(const Constellation& constellation, SatelliteId sv, GpsTime t,
                                            const Eigen::Vector3d& p_E, std::optional<GpsTime> receiver_time) {
  Transmission out;
  out.travel_s = 0.075;
  // The range rate is below 3e-6 of the speed of light, so every pass gains more than five digits.
  for (int pass = 0; pass < 3; ++pass) {
    out.t = t - out.travel_s;
    const auto state = constellation.state_received(sv, out.t, receiver_time.value_or(t));
    if (!state) return std::nullopt;
    out.state = *state;
    for (int turn = 0; turn < 2; ++turn) {
      out.range_m = (turned_by_earth(out.state.p_E, out.travel_s) - p_E).norm();
      out.travel_s = out.range_m / kSpeedOfLight;
    }
  }
  return out;
}

std::optional<ReceiverView> transmission_from_pseudorange(const Constellation& constellation, SatelliteId sv,
                                                          GpsTime receiver_time, double pseudorange_m) {
  const GpsTime satellite_reading = receiver_time - pseudorange_m / kSpeedOfLight;
  ReceiverView out{satellite_reading, {}};
  for (int pass = 0; pass < 2; ++pass) {
    const auto state = constellation.state_received(sv, out.t, receiver_time);
    if (!state) return std::nullopt;
    out.state = *state;
    out.t = satellite_reading - state->clock_s;
  }
  const auto state = constellation.state_received(sv, out.t, receiver_time);
  if (!state) return std::nullopt;
  out.state = *state;
  return out;
}

}  // namespace canyon::gnss
