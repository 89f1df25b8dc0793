#pragma once

#include <string>
#include <vector>

#include "canyon/core/earth/earth.h"
#include "canyon/core/earth/gravity.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/result.h"
#include "canyon/core/time.h"

namespace canyon {

/// A reference solution of inertial navigation at an instant, in our own frames: of the IMU U (forward, left, up) in E.
struct NavigationRecord {
  GpsTime t;
  Pose X_EU;
  Eigen::Vector3d v_EU_E = Eigen::Vector3d::Constant(0.0);  ///< NaN where the file has none
};

/// Attitude of U in E from that of forward-right-down in north-east-down (ZYX: heading, pitch nose up, roll right side
/// down), and back. At a pole, north is along the meridian of `at`; looking straight up or down all turning about the
/// vertical is heading.
Eigen::Quaterniond attitude_from_ned(const Geodetic& at, double roll_rad, double pitch_rad, double heading_rad);
struct NedAttitude {
  double roll_rad, pitch_rad, heading_rad;  ///< heading in [0, 2 pi)
};
NedAttitude ned_attitude(const Geodetic& at, const Eigen::Quaterniond& R_EU);

struct NavigationFile {
  std::vector<NavigationRecord> records;
  std::string gravity;   ///< what a comment `# gravity NAME` states, whether there is such a model or not; else empty
  int gravity_line = 0;  ///< where it stands
};

/// Reads the KF-GINS text format, `week sow lat lon h vN vE vD roll pitch heading` (degrees, metres, m/s), columns
/// apart by blanks or commas; or CSV whose header names `sow` or `t_s`, `lat_deg`, `lon_deg`, `h_m`, `roll_deg`,
/// `pitch_deg`, `yaw_deg` or `heading_deg` and, if it has them, `gps_week`, `vn`, `ve`, `vd` (or `vn_m_s`, ...). Angles
/// are those of forward-right-down in north-east-down. Without a week it is 0. Times must increase; errors name the
/// line.
Result<NavigationFile> read_navigation_file(const std::string& path);
/// In the KF-GINS text format; a comment at the top names the columns, and the gravity if `gravity` is not empty.
Status write_navigation_file(const std::string& path, const NavigationFile& file);

}  // namespace canyon
