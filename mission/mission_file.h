#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/config.h"
#include "core/result.h"
#include "core/time.h"
#include "mission/mission_config.h"
#include "scene/scene.h"

namespace canyon::mission {

inline constexpr const char* kDefaultMission = "vicksburg";

/// A mission as the user states it: one description, and fidelities that override parts of it.
///
/// Layers, later ones win: the base mission (`base = "vicksburg"`, a built-in), the built-in fidelity, the user's
/// sections, the user's [fidelity.NAME], options of the command line. So a user's `[gnss] rate_hz = 5` holds for every
/// fidelity.
class MissionFile {
 public:
  /// Reads a mission file; an empty path gives the built-in mission.
  static Result<MissionFile> load(const std::string& path);
  static Result<MissionFile> parse(std::string_view toml, const std::string& file_name);

  /// An option of the command line: value for a dotted key, for example "run.seed".
  void set_option(const std::string& key, ConfigNode value, const std::string& option);

  /// Built-in fidelities and the user's own.
  std::vector<std::string> fidelities() const;
  Result<MissionConfig> resolve(const std::string& fidelity) const;
  /// Sensors of two fidelities mixed: GNSS (and all else) of `gnss`, IMU and initial alignment of `imu`.
  Result<MissionConfig> resolve_mixed(const std::string& gnss, const std::string& imu) const;

  /// Points an Error without a place at the line where its key was set, or at the file.
  Error locate(Error error) const;

 private:
  static Result<MissionFile> from_tree(ConfigNode tree, const std::string& file_name);
  Result<ConfigNode> resolved_tree(const std::string& fidelity) const;

  std::string file_;
  ConfigNode base_, builtin_fidelities_, user_, options_;
};

/// A mission that has been checked and can be driven: its scene, route and limits.
struct PreparedMission {
  std::shared_ptr<const scene::Scene> scene;
  GpsTime start;
  PriorKnowledge prior;
  double nominal_s = 0.0;
  double time_limit_s = 0.0;
};

/// Scenes by configuration, so that the runs of a comparison share one.
class SceneCache {
 public:
  std::shared_ptr<const scene::Scene> get(const scene::CityConfig& config);

 private:
  std::map<std::string, std::shared_ptr<const scene::Scene>> scenes_;
};

/// Builds the scene and checks what needs it: start and waypoints inside the scene and outside buildings, observed
/// buildings known, rates that divide the IMU's. Errors name the key; MissionFile::locate adds file and line.
Result<PreparedMission> prepare(const MissionConfig& config, SceneCache& scenes);

/// Builds every sensor once and throws it away: finds an unreadable navigation file or an unknown catalogue entry
/// before any time is spent.
Status check_sensors(const MissionConfig& config, const PreparedMission& mission);

}  // namespace canyon::mission
