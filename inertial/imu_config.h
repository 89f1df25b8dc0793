#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/config/config.h"

namespace canyon::inertial {

/// [imu] of a mission file.
struct ImuConfig {
  std::string sensor = "high_grade_mems";  ///< entry of inertial/catalogue
  std::string gyroscope;                   ///< entry whose gyroscope goes with a sensor that is an accelerometer alone
  std::string errors = "datasheet";        ///< row of inertial/error_chain
  std::vector<std::string> leave_out;      ///< links of the error chain that are switched off
  double rate_hz = 100.0;
  Eigen::Vector3d lever_arm_m{0.0, 0.0, 0.4};  ///< U in B
  double mounting_error_deg = 0.0;             ///< 1-sigma of each angle between the axes of U and B; 0: parallel
  std::vector<double> temperature_times_s;     ///< profile of the unit's temperature; empty: as its figures hold
  std::vector<double> temperatures_c;
  Eigen::Vector3d vibration_m_s2 = Eigen::Vector3d::Zero();  ///< RMS of vibration too fast for the samples
};
void visit(FieldVisitor& f, ImuConfig& c);

}  // namespace canyon::inertial
