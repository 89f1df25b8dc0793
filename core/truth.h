#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/messages.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/time.h"

/// Truth records: what only recorder and scorer may see. Each runs parallel to a message, with the same index.
namespace canyon {

/// Rigid-body kinematics of B in W at an instant. W is fixed to the Earth.
struct KinematicState {
  GpsTime t;
  Pose X_WB;
  Eigen::Vector3d v_WB_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d a_WB_W = Eigen::Vector3d::Zero();      ///< derivative of v_WB_W, m/s^2
  Eigen::Vector3d w_WB_B = Eigen::Vector3d::Zero();      ///< rad/s
  Eigen::Vector3d alpha_WB_B = Eigen::Vector3d::Zero();  ///< derivative of w_WB_B, rad/s^2
};

/// True errors of one GnssObservation. What the receiver corrected is left out of them; the corrected pseudorange is
/// range_m + receiver clock + all errors marked (*).
struct GnssObservationTruth {
  SatelliteId sv;
  double elevation_rad = 0.0;
  double azimuth_rad = 0.0;          ///< from true north, clockwise
  bool line_of_sight = true;         ///< direct path free
  bool tracked = true;               ///< the receiver has a measurement of it
  int reflections = 0;               ///< specular paths found within the cut-off
  int diffractions = 0;              ///< paths found that bend around an edge
  double range_m = 0.0;              ///< geometric range of the direct path
  double range_rate_m_s = 0.0;       ///< its derivative
  double multipath_m = 0.0;          ///< (*) error from reflected or NLOS-only reception
  double ionosphere_m = 0.0;         ///< (*) residual after the receiver's correction
  double troposphere_m = 0.0;        ///< (*) residual after the receiver's correction
  double ephemeris_m = 0.0;          ///< (*) orbit and satellite clock, residual
  double noise_m = 0.0;              ///< (*) thermal code noise; of the combination, where two frequencies are combined
  double base_m = 0.0;               ///< (*) the base station's own error, and of a simulated one what is left of its
                                     ///< clock, the same for all satellites, in a differential correction
  double phase_centre_m = 0.0;       ///< (*) offset and variation of the antenna's phase centre
  double ionosphere_delay_m = 0.0;   ///< what acts on the pseudorange, before correction
  double troposphere_delay_m = 0.0;  ///< the same
  double carrier_multipath_m = 0.0;  ///< error of the carrier range from reflected or NLOS-only reception
  double range_rate_multipath_m_s = 0.0;  ///< error of the range rate that the Doppler tells, from the same
  double ambiguity_cycles = 0.0;          ///< whole cycles in the carrier phase
};

/// True facts of one GNSS epoch.
struct GnssTruth {
  GpsTime t;
  Eigen::Vector3d p_A_E = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_A_E = Eigen::Vector3d::Zero();
  double receiver_clock_m = 0.0;
  double receiver_clock_rate_m_s = 0.0;
  std::vector<GnssObservationTruth> satellites;  ///< above the mask, tracked or not
};

/// True facts of one OdometerSample.
struct OdometerTruth {
  GpsTime t;
  double distance_m = 0.0;  ///< of the wheel's contact point over ground along B's x over the interval
  double slip = 0.0;        ///< part of the wheel's turning that moved nothing, mean over the interval
  double scale_error = 0.0;
};

/// True facts of one BarometerSample.
struct BarometerTruth {
  GpsTime t;
  double pressure_pa = 0.0;  ///< of the standard atmosphere at the true height
  double drift_pa = 0.0;     ///< weather and sensor
};

/// True facts of one MagnetometerSample.
struct MagnetometerTruth {
  GpsTime t;
  Eigen::Vector3d field_U_t = Eigen::Vector3d::Zero();  ///< the Earth's, tesla
};

/// True facts of one LIDAR return; same index as LidarScan::points.
struct LidarPointTruth {
  float range_m = 0;
  float cos_incidence = 0;
  std::uint16_t material = 0;  ///< index into the scene's materials
  std::uint32_t object = 0;    ///< index into the scene's objects
};

}  // namespace canyon
