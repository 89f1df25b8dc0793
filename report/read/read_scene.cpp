#include <cmath>

#include <nlohmann/json.hpp>

#include "canyon/report/read/read_results.h"

namespace canyon::report {
namespace {

/// Numbers of a list that must all be defined.
Eigen::VectorXd defined_numbers(const JsonNode& node, std::size_t size, const JsonFields& owner,
                                const std::string& path) {
  const std::vector<double> values = json_numbers(node, size, owner.file(), path, owner.error());
  Eigen::VectorXd out(static_cast<Eigen::Index>(size));
  for (std::size_t i = 0; i < size; ++i) {
    if (!owner.error() && !std::isfinite(values[i])) {
      owner.error() = owner.file().mistake(node, path, "null in a list of numbers", "numbers");
    }
    out[static_cast<Eigen::Index>(i)] = values[i];
  }
  return out;
}

Eigen::Vector2d corner(const JsonFields& extent, std::string_view key) {
  if (!extent.has(key)) extent.fail(nullptr, key, "missing", "a list of 3 numbers");
  if (!extent.has(key)) return Eigen::Vector2d::Zero();
  return defined_numbers(*extent.find(key), 3, extent, extent.path_of(key)).head<2>();
}

Eigen::Vector2d required_point(const JsonFields& f, std::string_view key) {
  if (!f.has(key)) f.fail(nullptr, key, "missing", "a list of 2 numbers");
  if (!f.has(key)) return Eigen::Vector2d::Zero();
  return defined_numbers(*f.find(key), 2, f, f.path_of(key));
}

}  // namespace

Status read_scene_drawing(std::string_view json, const std::string& file, SceneDrawing& drawing) {
  CANYON_TRY(const JsonFile tree, JsonFile::parse(json, file));
  std::optional<Error> error;
  const JsonFields fields(&tree.root(), tree, {}, error);
  if (!fields.has("extent_m")) fields.fail(nullptr, "extent_m", "missing", "an object with min and max");
  const JsonFields extent = fields.object("extent_m");
  drawing.min_W = corner(extent, "min");
  drawing.max_W = corner(extent, "max");
  if (!error && !((drawing.max_W - drawing.min_W).minCoeff() > 0)) {
    fields.fail(fields.find("extent_m"), "extent_m", "max is not above min", "a rectangle");
  }
  for (const auto& [node, path] : fields.list("buildings")) {
    const JsonFields f(node, tree, path, error);
    Building building{f.text("name"), f.number("base_m"), f.required_number("height_m"), {}};
    for (const auto& [corner_node, corner_path] : f.list("footprint", true)) {
      building.footprint_W.emplace_back(defined_numbers(*corner_node, 2, f, corner_path));
    }
    drawing.buildings.push_back(std::move(building));
  }
  for (const auto& [node, path] : fields.list("streets")) {
    const JsonFields f(node, tree, path, error);
    drawing.streets.push_back({required_point(f, "a"), required_point(f, "b"), f.required_number("width_m")});
  }
  for (const auto& [node, path] : fields.list("trees")) {
    const Eigen::Vector3d v = defined_numbers(*node, 3, fields, path);
    drawing.trees.push_back({v.head<2>(), v.z()});
  }
  for (const auto& [node, path] : fields.list("vehicles")) {
    drawing.vehicles.emplace_back(defined_numbers(*node, 2, fields, path));
  }
  if (error) return *error;
  return Ok{};
}

}  // namespace canyon::report
