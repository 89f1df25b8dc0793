#include "canyon/gnss/sensor/satellites_in_view.h"

#include <cmath>

#include "canyon/core/units.h"
#include "canyon/gnss/signal.h"

namespace canyon::gnss {

double Sight::carrier_hz(int band) const {
  return gnss::carrier_hz(sv.system, band, signal.state.frequency_channel);
}

/// Whether it cannot have come above the mask. In E a satellite outside of the Earth is accelerated by less than
/// 13 m/s^2: gravity, at most 9.9, and what the turning frame adds at 7 km/s and 50,000 km. So bounds on its speed and
/// its range follow, and with them on how fast the line of sight turns. An antenna that is elsewhere sees it from
/// there, over another horizon. 1e-4 rad, 2 km of orbit, is left for a change of ephemerides; after a minute it is
/// looked for in any case.
bool SatellitesInView::Below::still(GpsTime now, const Eigen::Vector3d& p_E) const {
  constexpr double kAcceleration_m_s2 = 13.0, kChange_rad = 1e-4, kLongest_s = 60.0, kLeastEarth_m = 6.3e6;
  const double after_s = std::abs(now - t), moved_m = (p_E - p_A_E).norm();
  const double way_m = (speed_m_s + kAcceleration_m_s2 * after_s) * after_s;
  const double least_m = range_m - way_m - moved_m;
  if (after_s >= kLongest_s || !(least_m > way_m + moved_m)) return false;
  // An angle whose sine is x <= 1 is at most x pi / 2.
  const double turned_rad = 0.5 * kPi * (way_m + moved_m) / least_m + moved_m / kLeastEarth_m;
  return turned_rad + kChange_rad < by_rad;
}

std::vector<Sight> SatellitesInView::at(GpsTime t, GpsTime receiver_t, const Eigen::Vector3d& p_A_E,
                                        const Horizon& horizon) {
  std::vector<Sight> sights;
  for (const SatelliteId sv : constellation_->satellites()) {
    const auto below = below_.find(sv);
    if (below != below_.end() && below->second.still(t, p_A_E)) continue;
    const auto signal = transmission_to(*constellation_, sv, t, p_A_E, receiver_t);
    if (!signal) continue;
    const Eigen::Vector3d satellite_E = signal->p_E();
    const SkyView view = horizon.view(t, satellite_E);
    if (view.elevation_rad < mask_rad_) {
      below_.insert_or_assign(
          sv, Below{t, p_A_E, mask_rad_ - view.elevation_rad, signal->v_E().norm(), (satellite_E - p_A_E).norm()});
      continue;
    }
    sights.push_back({sv, *signal, view, frame_.R_EW().transpose() * (satellite_E - p_A_E).normalized()});
  }
  return sights;
}

}  // namespace canyon::gnss
