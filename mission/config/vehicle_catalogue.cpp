#include "canyon/mission/config/vehicle_catalogue.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "canyon/core/config/named_file.h"
#include "canyon/core/config/text.h"
#include "canyon/core/process/embedded.h"
#include "canyon/mission/motion/vehicle_config.h"

namespace canyon::mission {
namespace {

constexpr std::string_view kVehicleFolder = "mission/vehicles/";
constexpr std::string_view kVehicleSuffix = ".toml";
constexpr std::string_view kOriginSuffix = "_source";

/// Keys of [vehicle] that are a mission's, not the vehicle's.
constexpr const char* kOfMission[] = {"preset", "start_m", "start_heading_deg", "roughness"};

bool holds(const std::vector<std::string>& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

std::vector<std::string> keys_of(const VisitFunction& fields) {
  std::vector<std::string> keys;
  const auto json = nlohmann::ordered_json::parse(fields_as_json(fields));
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  return keys;
}

/// Keys of the rows of a table, or of one of them.
template <class Make>
std::vector<std::string> own_keys(ModelTable<Make> rows, const std::string& name = "") {
  ModelParameters own;
  for (const auto& row : rows)
    if (row.parameters != nullptr && (name.empty() || name == row.name)) row.parameters(own);
  return keys_of([&own](FieldVisitor& f) { own.visit_all(f); });
}

const std::string* text_of(const ConfigNode& node, const std::string& key) {
  const ConfigNode* found = node.find(key);
  return found == nullptr ? nullptr : std::get_if<std::string>(&found->value_);
}

/// What a sheet may hold, and of that what it must.
struct Figures {
  std::vector<std::string> all, needed, of_others;
};

template <class Make>
void take_table(const ConfigNode& sheet, const char* key, ModelTable<Make> rows, Figures& out) {
  const std::string* name = text_of(sheet, key);
  const std::vector<std::string> chosen = name == nullptr ? std::vector<std::string>{} : own_keys(rows, *name);
  for (const std::string& own : own_keys(rows)) (holds(chosen, own) ? out.needed : out.of_others).push_back(own);
}

Figures figures_of(const ConfigNode& sheet) {
  Figures out;
  take_table(sheet, "model", plan_models(), out);
  take_table(sheet, "steering", steering_actuators(), out);
  take_table(sheet, "drive", drive_actuators(), out);
  VehicleConfig config;
  for (const std::string& key : keys_of([&config](FieldVisitor& f) { visit(f, config); })) {
    if (std::find(std::begin(kOfMission), std::end(kOfMission), key) != std::end(kOfMission)) continue;
    out.all.push_back(key);
    if (!holds(out.of_others, key) && !holds(out.needed, key)) out.needed.push_back(key);
  }
  return out;
}

Status check_figures(const ConfigNode& sheet, const Figures& figures) {
  for (const auto& [key, node] : *sheet.table()) {
    if (key == "name" || key == "description") continue;
    std::string figure = key;
    const bool source = key.size() > kOriginSuffix.size() && key.ends_with(kOriginSuffix);
    if (source) figure.resize(key.size() - kOriginSuffix.size());
    if (!holds(figures.all, figure)) {
      const std::string nearest = nearest_word(figure, figures.all);
      return node.error(key, "is not a figure of a vehicle",
                        nearest.empty() ? "a key of [vehicle] that describes one"
                                        : "\"" + nearest + (source ? std::string(kOriginSuffix) : "") + "\"?");
    }
    if (holds(figures.of_others, figure))
      return node.error(key, "is not of the model or the actuators that this vehicle has", "it left out");
  }
  std::vector<std::string> missing;
  for (const char* key : {"name", "description"})
    if (text_of(sheet, key) == nullptr) missing.emplace_back(key);
  for (const std::string& key : figures.needed) {
    if (sheet.find(key) == nullptr) missing.push_back(key);
    const std::string source = key + std::string(kOriginSuffix);
    const std::string* text = text_of(sheet, source);
    if (text == nullptr || text->empty()) missing.push_back(source);
  }
  if (missing.empty()) return Ok{};
  std::string what = "is missing";
  if (missing.size() > 1) what += ", and so are " + plain_list({missing.begin() + 1, missing.end()});
  return sheet.error(missing.front(), what, "every figure of a vehicle, each with its source or \"assumed\"");
}

Result<VehicleSheet> sheet_of(const ConfigNode& sheet) {
  const Figures figures = figures_of(sheet);
  VehicleSheet out;
  out.figures.value_ = ConfigNode::Table{};
  out.figures.file_ = sheet.file_;
  out.figures.line_ = sheet.line_;
  auto& table = std::get<ConfigNode::Table>(out.figures.value_);
  for (const std::string& key : figures.all) {
    if (const ConfigNode* node = sheet.find(key)) table.emplace(key, *node);
    if (const std::string* source = text_of(sheet, key + std::string(kOriginSuffix)))
      out.sources.emplace_back(key, *source);
  }
  VehicleConfig config;
  CANYON_TRY_STATUS(read_config(&out.figures, "", config));  // an unknown model first: what it needs depends on it
  CANYON_TRY_STATUS(check_figures(sheet, figures));
  out.name = *text_of(sheet, "name");
  out.description = *text_of(sheet, "description");
  return out;
}

}  // namespace

std::vector<std::string> vehicle_names() {
  std::vector<std::string> names;
  for (const std::string_view key : embedded_files(kVehicleFolder))
    names.emplace_back(key.substr(kVehicleFolder.size(), key.size() - kVehicleFolder.size() - kVehicleSuffix.size()));
  return names;
}

Result<VehicleSheet> parse_vehicle(std::string_view toml, const std::string& file_name) {
  CANYON_TRY(const ConfigNode node, ConfigNode::parse(toml, file_name));
  return sheet_of(node);
}

Result<VehicleSheet> load_vehicle(const std::string& vehicle) {
  if (vehicle.ends_with(kVehicleSuffix)) {
    CANYON_TRY(const ConfigNode node, ConfigNode::load(vehicle));
    return sheet_of(node);
  }
  const std::string key = std::string(kVehicleFolder) + vehicle + std::string(kVehicleSuffix);
  if (const auto text = embedded_file(key)) return parse_vehicle(*text, key);
  const std::vector<std::string> known = vehicle_names();
  const std::string nearest = nearest_word(vehicle, known);
  return Error{
      .file = "",
      .key = "vehicle.preset",
      .what = "no vehicle \"" + vehicle + "\" in the catalogue",
      .expected = nearest.empty() ? "one of " + plain_list(known) + ", or a .toml file" : "\"" + nearest + "\"?"};
}

Status lay_vehicle_below(ConfigNode& tree, const ConfigNode& over) {
  const ConfigNode* named = over.find("vehicle.preset");
  const auto* name = named == nullptr ? nullptr : std::get_if<std::string>(&named->value_);
  if (name == nullptr || name->empty()) return Ok{};
  const std::string vehicle = name->ends_with(kVehicleSuffix) ? path_as_named(*named, *name) : *name;
  const auto sheet = load_vehicle(vehicle);
  if (!sheet) return error_as_named(*named, "vehicle.preset", vehicle, sheet.error());
  ConfigNode below;
  below.value_ = ConfigNode::Table{{"vehicle", sheet->figures}};
  tree.overlay(below);
  return Ok{};
}

}  // namespace canyon::mission
