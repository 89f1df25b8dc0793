#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "canyon/core/config/config.h"

namespace canyon::mission {

/// A vehicle of the catalogue, mission/vehicles/NAME.toml: the keys of [vehicle] that say what a vehicle is and can do,
/// each with `KEY_source`, where that figure was read, or that it is assumed.
struct VehicleSheet {
  std::string name, description;
  ConfigNode figures;                                        ///< a table of keys of [vehicle], checked
  std::vector<std::pair<std::string, std::string>> sources;  ///< of each figure, by key
};

/// Names of the built-in vehicles, sorted.
std::vector<std::string> vehicle_names();

/// A built-in vehicle by name, or a file if `vehicle` ends in ".toml". Errors name the file; an unknown name is an
/// error of `vehicle.preset` that names the nearest. All figures and sources that are missing are told at once.
Result<VehicleSheet> load_vehicle(const std::string& vehicle);
Result<VehicleSheet> parse_vehicle(std::string_view toml, const std::string& file_name);

/// Lays on `tree` the figures of the vehicle that `over`, a mission's layer, names in vehicle.preset, if it does. What
/// stands beside the name is to be laid over them.
Status lay_vehicle_below(ConfigNode& tree, const ConfigNode& over);

}  // namespace canyon::mission
