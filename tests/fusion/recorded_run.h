#pragma once

#include <string>
#include <vector>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/messages.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/fusion/strapdown.h"

/// The recorded runs of the shared data, turned from NED and FRD into our frames at the door.
namespace canyon::testing {

struct ReferencePoint {
  GpsTime t;
  fusion::NavState state;  ///< of the IMU
  Eigen::Matrix3d R_E_ned = Eigen::Matrix3d::Identity();
};

struct RecordedRun {
  std::vector<ImuSample> imu;
  std::vector<GnssFix> fixes;
  std::vector<ReferencePoint> truth;
};

/// sim_leador_a15: `imu_file` is imu_ideal_100hz.f64, imu_a15_100hz.f32 or imu_adis16465_100hz.f32.
RecordedRun read_sim_leador(const std::string& imu_path, const std::string& gnss_path, const std::string& truth_path);
/// navego_synthetic: rates at 200 Hz; an increment is the mean of the rates at both ends of its interval, times dt.
RecordedRun read_navego(const std::string& imu_path, const std::string& gnss_path, const std::string& truth_path);

/// Rows of numbers after one header line.
std::vector<std::vector<double>> read_number_csv(const std::string& path);
/// Attitude R_EU for U forward-left-up from geodetic position and ZYX Euler angles of forward-right-down in NED.
Eigen::Quaterniond attitude_from_ned_frd(const Geodetic& at, double roll_rad, double pitch_rad, double yaw_rad);
Eigen::Matrix3d rotation_E_from_ned(const Geodetic& at);
/// A vector of forward-right-down in forward-left-up.
inline Eigen::Vector3d flu_from_frd(const Eigen::Vector3d& v) {
  return {v.x(), -v.y(), -v.z()};
}

}  // namespace canyon::testing
