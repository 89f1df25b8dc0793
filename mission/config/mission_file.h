#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "canyon/core/config/config.h"
#include "canyon/core/result.h"
#include "canyon/core/time.h"
#include "canyon/mission/config/mission_config.h"
#include "canyon/scene/scene.h"

namespace canyon::mission {

inline constexpr const char* kDefaultMission = "vicksburg";

/// Whether the built-in mission is meant where a mission file is asked for: by its name, or by none. A file of that
/// very name is ./vicksburg.
inline bool is_built_in(const std::string& path) {
  return path.empty() || path == kDefaultMission;
}

/// A mission as the user states it: one description, and fidelities that override parts of it.
///
/// Layers, later ones win: the base mission (`base = "vicksburg"`, a built-in), the built-in fidelity, the user's
/// sections, the user's [fidelity.NAME], options of the command line. A layer that names a receiver (gnss.receiver)
/// has that receiver's figures just below it (gnss/sensor/receiver_catalogue.h). So a user's `[gnss] rate_hz = 5` holds
/// for every fidelity. A fidelity that is not built in is laid over the one that its key `base` names, over `high`
/// without it. What the runs of a comparison share (scene, time, seed, name, start, waypoints) cannot differ between
/// fidelities. All fidelities of the user's file are read and checked at once, whichever will be used.
class MissionFile {
 public:
  /// Reads a mission file, or the built-in mission (is_built_in).
  static Result<MissionFile> load(const std::string& path);
  static Result<MissionFile> parse(std::string_view toml, const std::string& file_name);

  /// An option of the command line: value for a dotted key, for example "run.seed".
  void set_option(const std::string& key, ConfigNode value, const std::string& option);

  /// Several of them, as a tree.
  void lay_over(const ConfigNode& options);

  /// Built-in fidelities and the user's own.
  std::vector<std::string> fidelities() const;
  /// That each name is one of fidelities() and none is given twice; `option` is named in the error.
  Status check_fidelities(const std::vector<std::string>& names, const std::string& option) const;
  Result<MissionConfig> resolve(const std::string& fidelity) const;
  /// Sensors of two fidelities mixed: GNSS (and all else, the LIDAR too) of `gnss`, IMU and initial alignment of `imu`.
  Result<MissionConfig> resolve_mixed(const std::string& gnss, const std::string& imu) const;

  /// Points an Error without a place at the line where its key was set for a run (as resolve_mixed), or at the file. Of
  /// several keys that contradict one another ("gnss.rate_hz, imu.rate_hz") it becomes that of the one that the user
  /// wrote, else of the first.
  Error locate(Error error, const std::string& gnss, const std::string& imu) const;
  Error locate(Error error, const std::string& fidelity) const { return locate(std::move(error), fidelity, fidelity); }

 private:
  static Result<MissionFile> from_tree(ConfigNode tree, const std::string& file_name);
  Status check_user_fidelities() const;
  /// The fidelities that one is made of, from the built-in one it starts from to itself.
  Result<std::vector<std::string>> ancestry(const std::string& fidelity) const;
  /// A part of what the user wrote, what its keys begin with in the file, and which it holds for: those of the IMU, the
  /// others, or both.
  struct Layer {
    std::string prefix;
    const ConfigNode* tree;
    bool imu, others;
    const ConfigNode* find(const std::string& key) const;
  };
  /// What the user wrote that holds for a run; what wins comes first.
  std::vector<Layer> written(const std::string& gnss, const std::string& imu) const;
  Result<ConfigNode> resolved_tree(const std::string& fidelity) const;

  std::string file_;
  ConfigNode base_, builtin_fidelities_, user_, options_;
};

/// A file that a mission names, as it was read.
struct InputFile {
  std::string path;
  std::string sha256;
};

/// A mission that has been checked and can be driven: its scene, route and limits.
struct PreparedMission {
  std::shared_ptr<const scene::Scene> scene;
  GpsTime start;
  scene::Traffic traffic;  ///< what moves in the scene, by the time since the start
  PriorKnowledge prior;
  double nominal_s = 0.0;
  double time_limit_s =
      0.0;  ///< of [success] limit_factor and [time] limit_s the shorter: when a run ends at the latest
  std::vector<InputFile> files;
  std::vector<std::string> warnings;  ///< about the scene's files
};

/// Scenes by configuration, so that the runs of a comparison share one.
class SceneCache {
 public:
  Result<std::shared_ptr<const scene::Scene>> get(const scene::SceneConfig& config);
  /// What a user should know of a scene that get() has given.
  std::vector<std::string> warnings(const scene::SceneConfig& config) const;

 private:
  struct Made {
    std::shared_ptr<const scene::Scene> scene;
    std::vector<std::string> warnings;
  };
  std::map<std::string, Made> scenes_;
};

/// [time] start; an Error for its key.
Result<GpsTime> start_time(const MissionConfig& config);

/// Reads every file that is named, builds the scene and every sensor once, and checks what can be checked before any
/// time is spent: no contradictions between keys (mission/config/consistency.h), places that can be stood at, reached
/// and seen from (mission/config/place_checks.h). Errors name the key; MissionFile::locate adds file and line.
Result<PreparedMission> prepare(const MissionConfig& config, SceneCache& scenes);

}  // namespace canyon::mission
