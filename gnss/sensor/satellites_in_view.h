#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/time.h"
#include "canyon/gnss/satellites/constellation.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/sky_view.h"

namespace canyon::gnss {

/// A satellite above the mask, as it is seen from the antenna.
struct Sight {
  SatelliteId sv;
  Transmission signal;
  SkyView view;
  Eigen::Vector3d direction_W;  ///< towards it, unit

  double carrier_hz(int band) const;
};

/// Finds the satellites above an elevation mask, epoch after epoch. One that is far below it is not looked for again
/// before it can have risen, which is most of the sky's.
class SatellitesInView {
 public:
  SatellitesInView(std::shared_ptr<const Constellation> constellation, const LocalFrame& frame, double mask_rad)
      : constellation_(std::move(constellation)), frame_(frame), mask_rad_(mask_rad) {}

  /// From an antenna at p_A_E whose horizon that is, at GPS time t, which it takes to be receiver_t.
  std::vector<Sight> at(GpsTime t, GpsTime receiver_t, const Eigen::Vector3d& p_A_E, const Horizon& horizon);

 private:
  /// One that was last seen below the mask.
  struct Below {
    GpsTime t;
    Eigen::Vector3d p_A_E;
    double by_rad, speed_m_s, range_m;  ///< under the mask; in E; from the antenna

    bool still(GpsTime now, const Eigen::Vector3d& p_E) const;
  };

  std::shared_ptr<const Constellation> constellation_;
  LocalFrame frame_;
  double mask_rad_;
  std::map<SatelliteId, Below> below_;
};

}  // namespace canyon::gnss
