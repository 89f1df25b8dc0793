#include "canyon/apps/options/gnss_setup.h"

#include <charconv>
#include <cmath>

#include "canyon/core/units.h"
#include "canyon/gnss/antenna_height.h"
#include "canyon/mission/config/mission_file.h"

namespace canyon::apps {

void declare_gnss_setup(Arguments& arguments, GnssSetupOptions& options, const char* default_scene) {
  declare_common(arguments, options.common);
  options.scene = default_scene;
  arguments
      .option("--scene", options.scene,
              "a mission file's scene, a scene file, \"vicksburg\" (built in) or \"none\" (open sky)")
      .default_shown();
  arguments
      .option("--fidelity", options.fidelity, "whose receiver: high, modern, paper, or one of the mission file's own")
      .default_shown();
  arguments.option("--receiver", options.receiver,
                   "receiver of the catalogue, or a TOML file of your own; default: the fidelity's");
  arguments.option("--nav", options.nav, "RINEX navigation files; without them the built-in constellation");
  arguments.option("--systems", options.systems,
                   "satellite systems received, letters of GRECJ; default: the fidelity's");
  arguments.option("--start", options.start, "first instant: ISO date (GPS time, or UTC with Z) or WEEK:SOW");
  arguments.option("--seed", options.seed, "seed of every random stream")
      .default_shown()
      .within(std::int64_t{0}, kLargestSeed);
  arguments.option("--out", options.out, "directory for the files; without it only the summary is printed");
  arguments.flag("--force", options.force,
                 "replace files that exist, and the directory: only one that canyon wrote, or an empty one");
}

Result<GnssSetup> gnss_setup(const GnssSetupOptions& options, const std::optional<Geodetic>& place) {
  const bool open_sky = options.scene == "none", built_in = options.scene == mission::kDefaultMission;
  const bool mission_file = options.scene.ends_with(".toml");
  CANYON_TRY(auto file, mission::MissionFile::load(mission_file ? options.scene : ""));
  if (!options.receiver.empty()) file.set_option("gnss.receiver", ConfigNode::of(options.receiver), "--receiver");
  if (!options.systems.empty()) file.set_option("gnss.systems", ConfigNode::of(options.systems), "--systems");
  if (!options.start.empty()) file.set_option("time.start", ConfigNode::of(options.start), "--start");
  CANYON_TRY_STATUS(file.check_fidelities({options.fidelity}, "--fidelity"));
  CANYON_TRY(mission::MissionConfig config, file.resolve(options.fidelity));
  if (!open_sky && !built_in && !mission_file) config.scene.from.file = options.scene;

  GnssSetup out;
  out.config = config.gnss;
  if (!options.nav.empty()) {
    out.config.satellites.nav_file.clear();
    out.config.satellites.nav_files = options.nav;
  }
  out.seed = static_cast<std::uint64_t>(options.seed);
  const auto start = mission::start_time(config);
  if (!start) return file.locate(start.error(), options.fidelity);
  out.start = *start;
  out.scene_name = open_sky ? "open sky" : built_in ? mission::kDefaultMission : options.scene;
  if (open_sky) {
    scene::SceneParts parts;
    parts.name = "none";
    parts.frame = LocalFrame(place.value_or(Geodetic{}));
    parts.materials = scene::builtin_materials();
    out.scene = std::make_shared<const scene::Scene>(std::move(parts));
  } else {
    mission::SceneCache scenes;
    CANYON_TRY(out.scene, scenes.get(config.scene));
  }
  return out;
}

Result<std::vector<double>> parse_numbers(const std::string& text, std::size_t count, const std::string& option,
                                          const std::string& expected) {
  std::vector<double> values(count);
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  for (std::size_t i = 0; i < count; ++i) {
    const auto [stop, error] = std::from_chars(at, end, values[i]);
    const bool separated = i + 1 < count ? stop != end && *stop == ',' : stop == end;
    if (error != std::errc() || !separated || !std::isfinite(values[i]))
      return Error{option, 0, "", "\"" + text + "\" cannot be read", expected};
    at = stop + 1;
  }
  return values;
}

Result<Geodetic> parse_place(const std::string& text, const std::string& option) {
  CANYON_TRY(const auto values, parse_numbers(text, 3, option, "LAT,LON,H: degrees, degrees, metres"));
  if (std::abs(values[0]) > 90.0 || std::abs(values[1]) > 360.0)
    return Error{option, 0, "", "\"" + text + "\" is not on the Earth",
                 "latitude -90..90, longitude -180..360 degrees"};
  const Geodetic place{values[0] * kDegree, values[1] * kDegree, values[2]};
  CANYON_TRY_STATUS(gnss::check_antenna_height(place.h_m, {.file = option}));
  return place;
}

}  // namespace canyon::apps
