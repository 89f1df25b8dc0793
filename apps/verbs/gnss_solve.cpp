#include <cmath>
#include <cstdio>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/line/json.h"
#include "canyon/apps/line/verb.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/place_files.h"
#include "canyon/core/process/parallel.h"
#include "canyon/gnss/antenna_height.h"
#include "canyon/gnss/products/antex_file.h"
#include "canyon/gnss/products/ionex_file.h"
#include "canyon/gnss/products/precise_orbits.h"
#include "canyon/gnss/rinex/navigation/navigation_file.h"
#include "canyon/gnss/rinex/observation/observation_file.h"
#include "canyon/gnss/single_point/position_statistics.h"
#include "canyon/gnss/single_point/single_point.h"
#include "canyon/gnss/single_point/solution_file.h"

namespace canyon::apps {

namespace {

struct Options {
  CommonOptions common;
  std::string observations, config, systems, truth_ecef, truth, out;
  std::string antex, ionex;
  std::vector<std::string> navigation, sp3;
  std::optional<double> mask_deg;
  bool force = false;
};

Result<gnss::SinglePointConfig> configuration(const Options& options) {
  gnss::SinglePointConfig config;
  if (!options.config.empty()) {
    CANYON_TRY(config, gnss::read_single_point_config(options.config));
  }
  if (!options.systems.empty()) config.systems = options.systems;
  if (options.mask_deg) config.mask_deg = *options.mask_deg;
  CANYON_TRY_STATUS(gnss::check_systems(config.systems, options.systems.empty() ? "systems" : "--systems"));
  return config;
}

Result<Eigen::Vector3d> parse_ecef(const std::string& text) {
  Eigen::Vector3d p_E;
  int used = 0;
  if (std::sscanf(text.c_str(), "%lf,%lf,%lf%n", &p_E.x(), &p_E.y(), &p_E.z(), &used) != 3 ||
      used != static_cast<int>(text.size()) || !p_E.allFinite())
    return Error{"--truth-ecef", 0, "", "\"" + text + "\"", "X,Y,Z of a place on the Earth, metres"};
  CANYON_TRY_STATUS(gnss::check_antenna_height(p_E, {.file = "--truth-ecef"}));
  return p_E;
}

Result<gnss::Truth> truth_of(const Options& options) {
  if (!options.truth_ecef.empty()) {
    CANYON_TRY(const Eigen::Vector3d p_E, parse_ecef(options.truth_ecef));
    return gnss::Truth([p_E](GpsTime) { return std::optional(gnss::TruePlace{p_E, Eigen::Vector3d::Zero().eval()}); });
  }
  if (options.truth.empty()) return gnss::Truth([](GpsTime) { return std::optional<gnss::TruePlace>(); });
  CANYON_TRY(auto places, read_places(options.truth));
  for (const StampedPlace& place : places)
    CANYON_TRY_STATUS(gnss::check_antenna_height(place.p_E, {.file = options.truth, .line = place.line}));
  const auto path = std::make_shared<PlacePath>(std::move(places));
  return gnss::Truth([path](GpsTime t) -> std::optional<gnss::TruePlace> {
    const auto state = path->at(t);
    if (!state) return std::nullopt;
    return gnss::TruePlace{state->p_E, state->v_E};
  });
}

Json summary_json(const gnss::SinglePointResult& result, const gnss::PositionStatistics& s,
                  const gnss::ObservationFile& file, const gnss::NavigationData& navigation) {
  Json json{{"epochs", s.epochs},
            {"solved", s.solved},
            {"compared", s.compared},
            {"mean_e_m", or_null(s.mean_enu_m.x())},
            {"mean_n_m", or_null(s.mean_enu_m.y())},
            {"mean_u_m", or_null(s.mean_enu_m.z())},
            {"std_e_m", or_null(s.std_enu_m.x())},
            {"std_n_m", or_null(s.std_enu_m.y())},
            {"std_u_m", or_null(s.std_enu_m.z())},
            {"h50_m", or_null(s.h50_m)},
            {"h95_m", or_null(s.h95_m)},
            {"v95_m", or_null(s.v95_m)},
            {"rms_3d_m", or_null(s.rms_3d_m)},
            {"velocity_rms_e_m_s", or_null(s.velocity_rms_enu_m_s.x())},
            {"velocity_rms_n_m_s", or_null(s.velocity_rms_enu_m_s.y())},
            {"velocity_rms_u_m_s", or_null(s.velocity_rms_enu_m_s.z())},
            {"damaged_records", file.damaged},
            {"other_system_satellites", file.other_system_satellites},
            {"warnings", result.warnings.size() + file.warnings.size()}};
  json["skipped_navigation_records"] = Json::object();
  for (const auto& [kind, count] : navigation.skipped_records) json["skipped_navigation_records"][kind] = count;
  json["unsolved"] = Json::object();
  for (const auto& [reason, count] : result.reasons) json["unsolved"][reason] = count;
  return json;
}

void tell(const gnss::SinglePointResult& result, const gnss::PositionStatistics& s, const gnss::ObservationFile& file,
          const gnss::NavigationData& navigation) {
  std::printf("%s: %d epochs from %s GPS time, %d solved\n", file.name.c_str(), s.epochs,
              file.epochs.front().t.iso(0).c_str(), s.solved);
  for (const auto& [reason, count] : result.reasons) std::printf("  %6d without: %s\n", count, reason.c_str());
  if (file.other_system_satellites > 0)
    std::printf("  %6d observations of satellites of other systems, not used\n", file.other_system_satellites);
  if (const std::string skipped = navigation.skipped(); !skipped.empty())
    std::printf("  navigation records not used: %s\n", skipped.c_str());
  if (s.compared == 0) return;
  std::printf("  error, m     mean     std\n");
  const char* axes[] = {"east", "north", "up"};
  for (int i = 0; i < 3; ++i) std::printf("  %-7s  %8.3f %7.3f\n", axes[i], s.mean_enu_m[i], s.std_enu_m[i]);
  std::printf("  horizontal 50 %% %.3f, 95 %% %.3f; vertical 95 %% %.3f; 3-D RMS %.3f m\n", s.h50_m, s.h95_m, s.v95_m,
              s.rms_3d_m);
}

Status write_folder(const std::string& path, const gnss::SinglePointResult& result, const Json& json) {
  CANYON_TRY_STATUS(write_text_file(path + "/positions.csv", gnss::solution_csv(result)));
  return write_text_file(path + "/summary.json", json.dump(2) + "\n");
}

/// Broadcast orbits and clocks, or precise ones with the broadcast group delays and GLONASS's channels.
Result<std::unique_ptr<gnss::Constellation>> satellites(const Options& options, const gnss::SinglePointConfig& config,
                                                        const gnss::NavigationData& navigation,
                                                        const gnss::ObservationHeader& header,
                                                        std::vector<std::string>& warnings) {
  if (options.sp3.empty()) {
    gnss::BroadcastOptions broadcast;
    broadcast.systems = config.systems;
    if (config.ephemeris == "transmitted") broadcast.choice = gnss::EphemerisChoice::kTransmitted;
    return gnss::make_broadcast(navigation, broadcast);
  }
  CANYON_TRY(const auto orbits, gnss::read_sp3_files(options.sp3));
  warnings.insert(warnings.end(), orbits.warnings.begin(), orbits.warnings.end());
  gnss::PreciseOptions precise;
  precise.systems = config.systems;
  precise.broadcast = &navigation;
  precise.glonass_channels = header.glonass_channels;
  std::optional<gnss::AntexFile> antennas;
  if (!options.antex.empty()) {
    CANYON_TRY(antennas, gnss::read_antex_file(options.antex));
    precise.antennas = &*antennas;
  } else {
    warnings.push_back(orbits.names() +
                       ": without --antex its positions are taken as those of the antennas; IGS products give the "
                       "centre of mass, and ranges err by metres");
  }
  return gnss::make_precise(orbits, precise);
}

Result<int> run(const Options& options) {
  set_threads(options.common.threads);
  OutputSet outputs(options.force);
  const bool table_alone = options.out.ends_with(".csv");
  CANYON_TRY(StagedFile* const table, outputs.file(table_alone ? options.out : ""));
  CANYON_TRY(const StagedDirectory* const folder, outputs.directory(table_alone ? "" : options.out));
  CANYON_TRY(const auto config, configuration(options));
  CANYON_TRY(const auto truth, truth_of(options));
  CANYON_TRY(const auto navigation, gnss::read_navigation_files(options.navigation));
  CANYON_TRY(const auto file, gnss::read_observation_file(options.observations));
  std::vector<std::string> warnings = navigation.warnings;
  CANYON_TRY(const auto constellation, satellites(options, config, navigation, file.header, warnings));
  std::optional<gnss::IonexMaps> maps;
  if (!options.ionex.empty()) {
    CANYON_TRY(maps, gnss::read_ionex_file(options.ionex));
    warnings.insert(warnings.end(), maps->warnings.begin(), maps->warnings.end());
  }
  CANYON_TRY(const auto result,
             gnss::solve_observations(file, {*constellation, navigation, maps ? &*maps : nullptr}, config));

  std::vector<GnssFix> fixes;
  for (const auto& e : result.epochs) fixes.push_back(e.fix);
  const auto statistics = gnss::position_statistics(fixes, truth);
  const auto json = summary_json(result, statistics, file, navigation);
  if (table != nullptr) CANYON_TRY_STATUS(table->write(gnss::solution_csv(result)));
  if (folder != nullptr) CANYON_TRY_STATUS(write_folder(folder->staging_path(), result, json));
  CANYON_TRY_STATUS(outputs.commit());
  warnings.insert(warnings.end(), file.warnings.begin(), file.warnings.end());
  warnings.insert(warnings.end(), result.warnings.begin(), result.warnings.end());
  for (const auto& warning : warnings) std::fprintf(stderr, "warning: %s\n", warning.c_str());
  if (options.common.json)
    std::printf("%s\n", json.dump().c_str());
  else
    tell(result, statistics, file, navigation);
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_common(arguments, options->common);
  arguments.option("--obs", options->observations, "RINEX 2, 3 or 4 observations; also gzipped or Hatanaka-compressed")
      .required();
  arguments.option("--nav", options->navigation, "RINEX navigation files of the same day").required();
  arguments.option("--sp3", options->sp3, "precise orbits and clocks (SP3) instead of the broadcast ones");
  arguments.option("--antex", options->antex,
                   "satellite antennas (ANTEX), for SP3 files whose positions are those of the centre of mass");
  arguments.option("--ionex", options->ionex, "ionosphere maps (IONEX), for ionosphere = \"ionex\" in --config");
  arguments.option("--systems", options->systems, "satellite systems by their letters, of GRECJ; default GREC");
  arguments.option("--mask", options->mask_deg, "elevation mask, degrees").within(-10.0, 89.0);
  arguments.option("--config", options->config,
                   "options of the solution (TOML), such as examples/rtklib_equivalent.toml");
  const auto ecef =
      arguments.option("--truth-ecef", options->truth_ecef, "X,Y,Z of the antenna, in the frame of the orbits");
  arguments
      .option("--truth", options->truth,
              "true antenna over time: CSV of gps_week,sow and lat_deg,lon_deg,h_m or x_m,y_m,z_m")
      .excludes(ecef);
  arguments.option("--out", options->out, "positions per epoch: a file NAME.csv, or a directory");
  arguments.flag("--force", options->force,
                 "replace the file if it exists, or the directory: only one that canyon wrote, or an empty one");
  return [options]() -> Result<int> { return run(*options); };
}

}  // namespace

Verb gnss_solve_verb() {
  return {"gnss solve", "positions from recorded observations",
          "canyon gnss solve --obs usno0200.05o --nav brdc0200.05n --systems G --truth-ecef "
          "1112189.770,-4842955.030,3985352.263 --out positions.csv",
          declare};
}

}  // namespace canyon::apps
