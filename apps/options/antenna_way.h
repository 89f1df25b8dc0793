#pragma once

#include <string>

#include "canyon/apps/options/gnss_setup.h"
#include "canyon/gnss/sensor/simulation/drive.h"

namespace canyon::apps {

/// Options that say where an antenna is, and for how long.
struct AntennaWayOptions {
  std::string at, trajectory;
  double duration_s = 0.0, rate_hz = 1.0;
};
void declare_antenna_way(Arguments& arguments, AntennaWayOptions& options);

/// A receiver that has a scene to be in and a way through it.
struct PlacedReceiver {
  GnssSetup setup;
  gnss::Drive drive;

  GpsTime end() const { return drive.start + drive.duration_s; }
};
Result<PlacedReceiver> place_receiver(const AntennaWayOptions& options, const GnssSetupOptions& setup);

/// Terrain hides the sky from an antenna below it; where the place was typed in, that is a mistake.
Status check_above_ground(const scene::Scene& scene, const Eigen::Vector3d& p_A_W, const std::string& option);

}  // namespace canyon::apps
