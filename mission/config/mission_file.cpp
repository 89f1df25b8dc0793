#include "canyon/mission/config/mission_file.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/config/text.h"
#include "canyon/core/process/embedded.h"
#include "canyon/core/units.h"
#include "canyon/gnss/sensor/receiver_catalogue.h"
#include "canyon/mission/config/vehicle_catalogue.h"

namespace canyon::mission {

namespace {

constexpr const char* kFidelityFile = "missions/fidelities.toml";
constexpr const char* kDefaultFidelityBase = "high";

std::string mission_key(const std::string& name) {
  return "missions/" + name + ".toml";
}

std::vector<std::string> builtin_missions() {
  std::vector<std::string> names;
  for (const std::string_view key : embedded_files("missions/")) {
    if (key == kFidelityFile) continue;
    std::string name(key.substr(std::string_view("missions/").size()));
    names.push_back(name.substr(0, name.size() - std::string(".toml").size()));
  }
  return names;
}

Result<ConfigNode> load_builtin(const std::string& key) {
  const auto text = embedded_file(key);
  CANYON_CHECK(text.has_value(), "no embedded file ", key);
  return ConfigNode::parse(*text, key);
}

std::vector<std::string> table_keys(const ConfigNode* node) {
  std::vector<std::string> keys;
  if (node != nullptr && node->table() != nullptr)
    for (const auto& [key, value] : *node->table()) keys.push_back(key);
  return keys;
}

constexpr const char* kPlainName = "a name of letters, digits, \"-\" and \"_\"";

/// Names of runs and missions become names of files.
bool is_plain_name(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  });
}

/// What one results directory has once, so that its runs must share it.
constexpr const char* kShared[] = {"scene",
                                   "time",
                                   "success",
                                   "run.name",
                                   "run.seed",
                                   "vehicle.start_m",
                                   "vehicle.start_heading_deg",
                                   "autonomy.waypoint"};

Status check_name(const ConfigNode& tree) {
  const ConfigNode* node = tree.find("run.name");
  const auto* name = node == nullptr ? nullptr : std::get_if<std::string>(&node->value_);
  if (name == nullptr || is_plain_name(*name)) return Ok{};  // another type is the reader's to refuse
  return node->error("run.name", "found \"" + *name + "\"", kPlainName);
}

/// The keys of "gnss.rate_hz, imu.rate_hz".
std::vector<std::string> listed(const std::string& keys) {
  std::vector<std::string> out;
  for (std::size_t from = 0, comma = 0; comma != std::string::npos; from = comma + 2) {
    comma = keys.find(", ", from);
    out.push_back(keys.substr(from, comma == std::string::npos ? comma : comma - from));
  }
  return out;
}

/// "autonomy" of "autonomy.waypoint[3]"; "" of "autonomy".
std::string parent(const std::string& key) {
  const auto dot = key.rfind('.');
  return dot == std::string::npos ? "" : key.substr(0, dot);
}

/// What a mixed run takes from the second fidelity.
constexpr const char* kInitialAttitude = "run.initial_attitude_error_deg";
bool is_of_imu(const std::string& key) {
  return key == "imu" || key.rfind("imu.", 0) == 0 || key == kInitialAttitude;
}

/// What is set at a key; of "autonomy.waypoint[3]" the third of the waypoints.
const ConfigNode* node_at(const ConfigNode& tree, const std::string& key) {
  const auto bracket = key.rfind('[');
  if (bracket == std::string::npos) return tree.find(key);
  const ConfigNode* node = tree.find(key.substr(0, bracket));
  const std::size_t item = std::stoul(key.substr(bracket + 1));
  if (node == nullptr || item == 0 || node->array() == nullptr || item > node->array()->size()) return node;
  return &(*node->array())[item - 1];
}

/// Lays `over`, a mission's layer, on `tree`, with the figures of the vehicle and the receiver that it names below it.
Status lay_with_presets(ConfigNode& tree, const ConfigNode& over) {
  CANYON_TRY_STATUS(lay_vehicle_below(tree, over));
  return gnss::lay_with_receiver(tree, over);
}

bool is_of_a_place(const std::string& key) {
  return key.starts_with("autonomy.waypoint") || key.starts_with("vehicle.start_m") || key.starts_with("scene.moving");
}

}  // namespace

Result<MissionFile> MissionFile::load(const std::string& path) {
  if (is_built_in(path))
    return parse("base = \"" + std::string(kDefaultMission) + "\"\n", mission_key(kDefaultMission));
  CANYON_TRY(ConfigNode tree, ConfigNode::load(path));
  return from_tree(std::move(tree), path);
}

Result<MissionFile> MissionFile::parse(std::string_view toml, const std::string& file_name) {
  CANYON_TRY(ConfigNode tree, ConfigNode::parse(toml, file_name));
  return from_tree(std::move(tree), file_name);
}

Result<MissionFile> MissionFile::from_tree(ConfigNode tree, const std::string& file_name) {
  MissionFile mission;
  mission.file_ = file_name;
  mission.user_ = std::move(tree);
  mission.base_.value_ = ConfigNode::Table{};
  mission.options_.value_ = ConfigNode::Table{};
  CANYON_TRY(mission.builtin_fidelities_, load_builtin(kFidelityFile));
  if (const ConfigNode* base = mission.user_.find("base")) {
    const auto* name = std::get_if<std::string>(&base->value_);
    const auto known = builtin_missions();
    if (name == nullptr || std::find(known.begin(), known.end(), *name) == known.end())
      return base->error("base", base->describe() + " is not a built-in mission", "one of " + plain_list(known));
    CANYON_TRY(mission.base_, load_builtin(mission_key(*name)));
    mission.user_.erase("base");
  }
  CANYON_TRY_STATUS(check_name(mission.user_));
  CANYON_TRY_STATUS(mission.check_user_fidelities());
  return mission;
}

Status MissionFile::check_user_fidelities() const {
  const ConfigNode* all = user_.find("fidelity");
  if (all == nullptr) return Ok{};
  if (all->table() == nullptr) return all->error("fidelity", "found " + all->describe(), "a table");
  for (const auto& [name, node] : *all->table()) {
    const std::string key = "fidelity." + name;
    if (!is_plain_name(name)) return node.error("fidelity", "found the name \"" + name + "\"", kPlainName);
    if (node.table() == nullptr) return node.error(key, "found " + node.describe(), "a table");
    const ConfigNode* base = node.find("base");
    if (base != nullptr && builtin_fidelities_.find(key) != nullptr)
      return base->error(key + ".base", "\"" + name + "\" is built in", "a base only for a fidelity of your own");
    for (const char* shared : kShared)
      if (const ConfigNode* own = node.find(shared))
        return own->error(key + "." + shared, "is shared by all runs", "it outside of [fidelity], for all of them");
    CANYON_TRY_STATUS(ancestry(name));
    const auto resolved = resolve(name);
    if (resolved) continue;
    Error error = resolved.error();
    const ConfigNode* written = node.find(error.key);
    if (written != nullptr && written->line_ == error.line) error.key = key + "." + error.key;
    return error;
  }
  return Ok{};
}

Result<std::vector<std::string>> MissionFile::ancestry(const std::string& fidelity) const {
  const auto known = fidelities();
  std::vector<std::string> names{fidelity};
  for (;;) {
    const std::string key = "fidelity." + names.front() + ".base";
    const ConfigNode* node = nullptr;
    for (const ConfigNode* tree : {&builtin_fidelities_, &base_, &user_})
      if (const ConfigNode* found = tree->find(key)) node = found;
    if (node == nullptr) {
      if (builtin_fidelities_.find("fidelity." + names.front()) != nullptr) return names;
      names.insert(names.begin(), kDefaultFidelityBase);
      continue;
    }
    const auto* name = std::get_if<std::string>(&node->value_);
    if (name == nullptr || std::find(known.begin(), known.end(), *name) == known.end())
      return node->error(key, node->describe() + " is not a fidelity", "one of " + plain_list(known));
    if (std::find(names.begin(), names.end(), *name) != names.end())
      return node->error(key, "\"" + *name + "\" is based on this fidelity in turn", "another one");
    names.insert(names.begin(), *name);
  }
}

void MissionFile::set_option(const std::string& key, ConfigNode value, const std::string& option) {
  options_.set(key, std::move(value), option);
}

void MissionFile::lay_over(const ConfigNode& options) {
  options_.overlay(options);
}

std::vector<std::string> MissionFile::fidelities() const {
  std::vector<std::string> names = table_keys(builtin_fidelities_.find("fidelity"));
  for (const ConfigNode* tree : {&base_, &user_})
    for (const auto& key : table_keys(tree->find("fidelity")))
      if (std::find(names.begin(), names.end(), key) == names.end()) names.push_back(key);
  return names;
}

Status MissionFile::check_fidelities(const std::vector<std::string>& names, const std::string& option) const {
  const auto known = fidelities();
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::find(known.begin(), known.end(), names[i]) == known.end()) {
      const std::string nearest = nearest_word(names[i], known);
      return Error{
          .file = option,
          .what = "\"" + names[i] + "\" is unknown",
          .expected = "one of " + plain_list(known) + (nearest.empty() ? "" : "; nearest is \"" + nearest + "\"")};
    }
    if (std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(i), names[i]) !=
        names.begin() + static_cast<std::ptrdiff_t>(i))
      return Error{.file = option, .what = "\"" + names[i] + "\" given twice", .expected = "each fidelity once"};
  }
  return Ok{};
}

Result<ConfigNode> MissionFile::resolved_tree(const std::string& fidelity) const {
  const auto known = fidelities();
  if (std::find(known.begin(), known.end(), fidelity) == known.end())
    return Error{.file = file_,
                 .key = "fidelity." + fidelity,
                 .what = "unknown fidelity",
                 .expected = "one of " + plain_list(known)};
  CANYON_TRY(const std::vector<std::string> lineage, ancestry(fidelity));
  ConfigNode tree;
  tree.value_ = ConfigNode::Table{};
  const auto lay_fidelity = [&](const ConfigNode& from) -> Status {
    for (const std::string& name : lineage)
      if (const ConfigNode* over = from.find("fidelity." + name)) CANYON_TRY_STATUS(lay_with_presets(tree, *over));
    return Ok{};
  };
  CANYON_TRY_STATUS(lay_with_presets(tree, base_));
  CANYON_TRY_STATUS(lay_fidelity(base_));
  CANYON_TRY_STATUS(lay_fidelity(builtin_fidelities_));
  CANYON_TRY_STATUS(lay_with_presets(tree, user_));
  CANYON_TRY_STATUS(lay_fidelity(user_));
  CANYON_TRY_STATUS(lay_with_presets(tree, options_));
  tree.erase("fidelity");
  tree.erase("base");
  return tree;
}

Result<MissionConfig> MissionFile::resolve(const std::string& fidelity) const {
  CANYON_TRY(const ConfigNode tree, resolved_tree(fidelity));
  MissionConfig config;
  if (const auto read = read_config(&tree, "", config); !read) return locate(read.error(), fidelity);
  return config;
}

Result<MissionConfig> MissionFile::resolve_mixed(const std::string& gnss, const std::string& imu) const {
  CANYON_TRY(MissionConfig config, resolve(gnss));
  CANYON_TRY(const MissionConfig other, resolve(imu));
  config.imu = other.imu;
  config.run.initial_attitude_error_deg = other.run.initial_attitude_error_deg;
  return config;
}

const ConfigNode* MissionFile::Layer::find(const std::string& key) const {
  return (is_of_imu(key) ? imu : others) ? node_at(*tree, key) : nullptr;
}

std::vector<MissionFile::Layer> MissionFile::written(const std::string& gnss, const std::string& imu) const {
  std::vector<Layer> layers{{"", &options_, true, true}};
  const auto add = [&](const std::string& fidelity, bool of_imu, bool of_others) {
    auto lineage = ancestry(fidelity);
    if (!lineage) return;
    for (auto name = lineage->rbegin(); name != lineage->rend(); ++name)
      if (const ConfigNode* own = user_.find("fidelity." + *name))
        layers.push_back({"fidelity." + *name + ".", own, of_imu, of_others});
  };
  add(gnss, gnss == imu, true);
  if (gnss != imu) add(imu, true, false);
  layers.push_back({"", &user_, true, true});
  return layers;
}

Error MissionFile::locate(Error error, const std::string& gnss, const std::string& imu) const {
  if (!error.file.empty()) return error;
  const std::vector<Layer> layers = written(gnss, imu);
  const std::vector<std::string> told = listed(error.key);
  error.key = told.front();
  for (auto layer = layers.rbegin(); layer != layers.rend(); ++layer)
    for (auto key = told.rbegin(); key != told.rend(); ++key)
      if (layer->find(*key) != nullptr) error.key = *key;
  const auto point_at = [&error](const ConfigNode& node) { error.file = node.file_, error.line = node.line_; };
  // Where was the key, or its nearest parent, set last?
  for (std::string key = error.key; !key.empty(); key = parent(key)) {
    for (const Layer& layer : layers)
      if (const ConfigNode* node = layer.find(key)) {
        point_at(*node);
        if (key == error.key) error.key = layer.prefix + key;
        return error;
      }
    // A place of the base mission's is not of who sets something else in its section.
    if (is_of_a_place(key) && node_at(base_, key) != nullptr) break;
  }
  for (std::string key = error.key; !key.empty(); key = parent(key))
    if (const ConfigNode* node = node_at(base_, key)) {
      point_at(*node);
      // What is right in the city that the base mission was made for is not in another one.
      if (const auto set = table_keys(options_.find("scene")); !set.empty() && is_of_a_place(key)) {
        error.what += " (inherited from " + error.file + "; scene." + set.front() + " makes it another city)";
      } else if (const ConfigNode* scene = user_.find("scene")) {
        error.what += " (inherited from " + error.file + "; this [scene] is another city)";
        point_at(*scene);
      }
      return error;
    }
  error.file = file_;
  return error;
}

}  // namespace canyon::mission
