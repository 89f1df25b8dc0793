#pragma once

#include <optional>

#include "canyon/gnss/satellites/constellation.h"

namespace canyon::gnss {

/// A signal between its transmission and its reception.
struct Transmission {
  GpsTime t;             ///< of transmission
  SatelliteState state;  ///< at t, in E of t
  double travel_s = 0.0;
  double range_m = 0.0;  ///< geometric, satellite at transmission to antenna at reception

  /// Satellite at transmission in E of the instant of reception (turned by the Earth's rotation under way: Sagnac).
  Eigen::Vector3d p_E() const;
  Eigen::Vector3d v_E() const;
};

/// A vector of E at transmission, expressed in E `travel_s` later.
Eigen::Vector3d turned_by_earth(const Eigen::Vector3d& v_E, double travel_s);

/// The signal that reaches p_E at GPS time t: light time and Earth rotation solved to below 1e-5 m. In vacuum.
/// `receiver_time`: what the receiver's clock reads then, which chooses the satellite's record (state_received()); t if
/// not given.
std::optional<Transmission> transmission_to(const Constellation& constellation, SatelliteId sv, GpsTime t,
                                            const Eigen::Vector3d& p_E,
                                            std::optional<GpsTime> receiver_time = std::nullopt);

/// What a receiver knows of the transmission: its own time of reception and the pseudorange give the satellite clock's
/// reading at transmission, whatever the receiver clock's error; the clock's own error is then removed.
struct ReceiverView {
  GpsTime t;
  SatelliteState state;
};
std::optional<ReceiverView> transmission_from_pseudorange(const Constellation& constellation, SatelliteId sv,
                                                          GpsTime receiver_time, double pseudorange_m);

}  // namespace canyon::gnss
