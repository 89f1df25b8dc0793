#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace canyon::lidar {

/// One laser of a spinning sensor, in the sensor's frame L (x forward, y left, z up along the spin axis).
struct Beam {
  double elevation_rad = 0.0;       ///< above L's x-y plane
  double azimuth_offset_rad = 0.0;  ///< clockwise seen from above, from the direction of the head
  double origin_up_m = 0.0;         ///< where the beam leaves, on L's z axis
  double firing_s = 0.0;            ///< after the start of the firing cycle
};

/// Where the beams of a sensor point and when they fire. Tables are CSV files in lidar/beams, each with its source:
/// comment lines (#), then `cycle_us,VALUE`, then the header
/// `laser,elevation_deg,azimuth_offset_deg,origin_up_mm,firing_us`, then one line per laser, numbered from 0.
struct BeamTable {
  std::string name;
  double cycle_s = 0.0;  ///< shortest time from one firing cycle to the next; 0 = any
  std::vector<Beam> beams;

  /// The latest firing time of any beam.
  double last_firing_s() const;
};

/// Errors name the file, the line and the field.
Result<BeamTable> parse_beam_table(std::string_view csv, const std::string& file_name);

/// A built-in table by its name ("vlp16"), or the user's own by a path that ends in .csv.
Result<BeamTable> load_beam_table(const std::string& name_or_path);

/// Names of the built-in tables, sorted.
std::vector<std::string> builtin_beam_tables();

}  // namespace canyon::lidar
