#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "canyon/core/result.h"

namespace canyon::lidar {

/// One laser of a spinning sensor, in the sensor's frame L (x forward, y left, z up along the spin axis). The beam
/// leaves from a point fixed to the turning head.
struct Beam {
  double elevation_rad = 0.0;       ///< above L's x-y plane
  double azimuth_offset_rad = 0.0;  ///< clockwise seen from above, from the direction of the head
  double origin_up_m = 0.0;         ///< where the beam leaves: along the spin axis,
  double firing_s = 0.0;            ///< after the start of the firing cycle
  double origin_out_m = 0.0;        ///< from the axis in the direction of the head,
  double origin_left_m = 0.0;       ///< and to the left of that direction
};

/// A pattern that does not repeat: the head turns (clockwise seen from above) at head_hz, and the elevation of laser k
/// of n is middle + half * sin(2 pi (swing_hz t + k / n)), t since the first scan began. Lasers fire in turn.
struct Rosette {
  double points_per_s = 0.0;
  double head_hz = 0.0, swing_hz = 0.0;
  double elevation_min_rad = 0.0, elevation_max_rad = 0.0;
};

/// Where the beams of a sensor point and when they fire. Tables are CSV files in lidar/beams, each with its source:
/// comment lines (#), then `cycle_us,VALUE`, then the header
/// `laser,elevation_deg,azimuth_offset_deg,origin_up_mm,firing_us`, which `,origin_out_mm,origin_left_mm` may follow,
/// then one line per laser, numbered from 0. A rosette is the line `rosette` and then one line `key,value` each of
/// lasers, points_per_s, head_hz, swing_hz, elevation_min_deg, elevation_max_deg.
struct BeamTable {
  std::string name;
  double cycle_s = 0.0;  ///< shortest time from one firing cycle to the next; 0 = any
  std::vector<Beam> beams;
  std::optional<Rosette> rosette;  ///< then of the beams only the firing times count

  /// The latest firing time of any beam.
  double last_firing_s() const;
};

/// Errors name the file, the line and the field.
Result<BeamTable> parse_beam_table(std::string_view csv, const std::string& file_name);

/// A built-in table by its name ("vlp16"), the user's own by a path that ends in .csv, or a generic one,
/// "grid:LASERS:MIN_DEG:MAX_DEG": elevations evenly spaced from MIN to MAX, all from one point and at one instant.
Result<BeamTable> load_beam_table(const std::string& name_or_path);

/// Names of the built-in tables, sorted.
std::vector<std::string> builtin_beam_tables();

}  // namespace canyon::lidar
