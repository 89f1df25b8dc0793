#pragma once

#include <string>
#include <vector>

#include "canyon/gnss/sensor/sensor.h"

namespace canyon::gnss {

/// What a receiver that stands still sees of the sky at one instant.
struct SkyEpoch {
  double t_s = 0.0;  ///< after the start
  GnssOutput output;
};

/// Every `step_s` from the start to `duration_s` after it.
std::vector<SkyEpoch> follow_sky(GnssSensor& sensor, const GnssConfig& config, GpsTime start, double duration_s,
                                 double step_s, const Eigen::Vector3d& p_A_W, const scene::SceneAt& scene);

/// C/N0 of a satellite, dB-Hz; NaN where it is not tracked.
double cn0_of(const GnssOutput& output, SatelliteId sv);

/// One row per satellite and epoch; one row per epoch.
std::string sky_satellites_csv(const std::vector<SkyEpoch>& epochs);
std::string sky_dop_csv(const std::vector<SkyEpoch>& epochs);

}  // namespace canyon::gnss
