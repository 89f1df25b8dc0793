#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "canyon/apps/line/verb.h"
#include "canyon/core/earth/earth.h"
#include "canyon/gnss/sensor/gnss_config.h"
#include "canyon/scene/scene.h"

namespace canyon::apps {

/// Options shared by the verbs that simulate GNSS by itself.
struct GnssSetupOptions {
  CommonOptions common;
  std::string scene;  ///< a mission file, a scene file, "vicksburg", or "none"
  std::string fidelity = "high";
  std::vector<std::string> nav;
  std::string receiver, systems, start, out;
  std::int64_t seed = 1;
  bool force = false;
};
void declare_gnss_setup(Arguments& arguments, GnssSetupOptions& options, const char* default_scene);

/// What the options describe: a receiver's configuration, a scene to be in, a time to begin.
struct GnssSetup {
  gnss::GnssConfig config;
  std::uint64_t seed = 1;
  GpsTime start;
  std::shared_ptr<const scene::Scene> scene;
  std::string scene_name;
};
/// `place`: origin of the scene "none", which is open sky. The receiver is that of the fidelity, with the mission's own
/// [gnss] section over it.
Result<GnssSetup> gnss_setup(const GnssSetupOptions& options, const std::optional<Geodetic>& place);

/// Exactly `count` numbers with commas between them.
Result<std::vector<double>> parse_numbers(const std::string& text, std::size_t count, const std::string& option,
                                          const std::string& expected);
/// "32.35,-90.88,61.5": degrees north, degrees east, ellipsoidal height in metres, which gnss::check_antenna_height()
/// takes.
Result<Geodetic> parse_place(const std::string& text, const std::string& option);

}  // namespace canyon::apps
