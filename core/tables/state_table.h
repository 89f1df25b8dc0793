#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "canyon/core/model_table.h"
#include "canyon/core/result.h"
#include "canyon/core/tables/passed_over.h"
#include "canyon/core/time.h"

namespace canyon {

/// What a line of a solution file says: a place at an instant, and whatever else its columns hold. NaN: not there.
struct StateRow {
  GpsTime t;
  Eigen::Vector3d p;                    ///< in E, or in W where StateTable::local
  Eigen::Matrix3d p_covariance;         ///< in the same axes, m^2
  Eigen::Vector3d v;                    ///< in the same axes
  Eigen::Matrix3d v_covariance;         ///< m^2/s^2
  std::optional<Eigen::Quaterniond> R;  ///< of forward-left-up in the same axes
  Eigen::Vector3d attitude_sigma_rad;   ///< about forward, left, up
  bool solved = true;                   ///< false: the line says that there was no solution; p is NaN then
  bool offered = true;                  ///< false: a column `offered` says that it was withheld
  int quality = 0;  ///< as RTKLIB counts: 1 and 2 carrier phase, 4 differential, 5 single; 0: not said
  int line = 0;     ///< of the file
  GpsTime came;     ///< the latest time in the file up to it: its own, but of a row that is late
};

struct StateTable {
  std::vector<StateRow> rows;  ///< in order of time
  bool has_week = false;       ///< else the times are of GPS week 0
  bool local = false;          ///< places in a local frame W (east, north, up), and not on the Earth
  PassedOver passed_over;
  /// A time as the file has it: of week, or of the epoch where it names none.
  double stated_s(GpsTime t) const { return has_week ? t.sow_s() : t - GpsTime{}; }
};

/// Layouts of files of numbers without a header, told apart by how many there are on a line; makes the column names.
ModelTable<const char*> state_layouts();

/// Reads solutions and references: places, and if the file has them velocities, attitudes and how good they are.
///
/// Columns by name, in a header or in `columns`, separated by commas; units as core/tables/column_names.h spells them.
///   time      gps_week or week; sow, t or time (`t_ns`, ...), s. With nanoseconds to the digit
///   place     lat, lon, h (degrees, m above the ellipsoid); or x, y, z: in E, or nearer to their origin than 1000 km
///             in a local frame (east, north, up)
///   its sigma sd_n, sd_e, sd_d or sd_u; sigma_e, sigma_n, sigma_u; or covariances xx, xy, xz, yy, yz, zz in E
///   velocity  vn, ve, vd or vu; or vx, vy, vz in the axes of x, y, z; sd_vn, ...; vxx, ...
///   attitude  roll, pitch, yaw or heading: of forward-right-down in north-east-down; or qw, qx, qy, qz: of
///             forward-left-up in the axes of x, y, z; sd_roll, sd_pitch, sd_yaw or sd_heading, or sigma_roll, ...
///   beside    q (quality as RTKLIB counts), status (a word; `none`: no solution), offered (0: withheld)
/// Without a header: state_layouts(). RTKLIB's .pos files are known by their %-lines, times in GPST or UTC. Plain or
/// gzip.
///
/// Rows of a time that has been, and rows with numbers that are none, are passed over and counted; a row without a
/// place counts as not solved. With `late_s` above zero rows that are at most so much behind the latest before them are
/// kept, also of the same time; the one that comes first in the file stands first. Errors name the line: columns that
/// are missing, text that is no number.
Result<StateTable> read_state_table(const std::string& path, const std::string& columns = {}, double late_s = 0.0);

}  // namespace canyon
