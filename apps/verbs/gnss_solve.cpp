#include <cstdio>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/answers/single_point.h"
#include "canyon/apps/line/verb.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/files/place_files.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"
#include "canyon/gnss/antenna_height.h"
#include "canyon/gnss/single_point/solution_file.h"

namespace canyon::apps {

namespace {

struct Options {
  CommonOptions common;
  gnss::RecordedFiles files;
  std::string config, systems, truth_ecef, truth, compare, out, base_position;
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

Result<Eigen::Vector3d> parse_ecef(const std::string& text, const char* option) {
  Eigen::Vector3d p_E;
  int used = 0;
  if (std::sscanf(text.c_str(), "%lf,%lf,%lf%n", &p_E.x(), &p_E.y(), &p_E.z(), &used) != 3 ||
      used != static_cast<int>(text.size()) || !p_E.allFinite())
    return Error{option, 0, "", "\"" + text + "\"", "X,Y,Z of a place on the Earth, metres"};
  CANYON_TRY_STATUS(gnss::check_antenna_height(p_E, {.file = option}));
  return p_E;
}

Result<gnss::Truth> truth_of(const Options& options) {
  if (!options.truth_ecef.empty()) {
    CANYON_TRY(const Eigen::Vector3d p_E, parse_ecef(options.truth_ecef, "--truth-ecef"));
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

/// A base needs its place; a place needs a base.
Result<gnss::RecordedFiles> files_of(const Options& options) {
  gnss::RecordedFiles files = options.files;
  if (files.base.empty() != options.base_position.empty())
    return Error{files.base.empty() ? "--base-position" : "--base", 0, "", "stands alone",
                 "both, observations of the base and where it is"};
  if (!options.base_position.empty()) {
    CANYON_TRY(files.base_E, parse_ecef(options.base_position, "--base-position"));
  }
  return files;
}

Status write_folder(const std::string& path, const gnss::SinglePointResult& result, const Json& json) {
  CANYON_TRY_STATUS(write_text_file(path + "/positions.csv", gnss::solution_csv(result)));
  return write_text_file(path + "/summary.json", json_text(json, 2) + "\n");
}

Result<int> run(const Options& options) {
  set_threads(options.common.threads);
  OutputSet outputs(options.force);
  const bool table_alone = options.out.ends_with(".csv");
  CANYON_TRY(StagedFile* const table, outputs.file(table_alone ? options.out : ""));
  CANYON_TRY(const StagedDirectory* const folder, outputs.directory(table_alone ? "" : options.out));
  CANYON_TRY(const auto config, configuration(options));
  CANYON_TRY(const auto truth, truth_of(options));
  CANYON_TRY(const auto files, files_of(options));
  CANYON_TRY(const auto data, gnss::read_recorded_data(files, config));
  // Before the solution, which takes its time, so that a wrong file is told at once.
  std::optional<gnss::ReceiverLog> receiver;
  if (!options.compare.empty()) {
    CANYON_TRY(receiver, gnss::read_receiver_log(options.compare, data.observations.epochs.front().t));
  }
  CANYON_TRY(const auto result, gnss::solve_observations(data.observations, data.inputs(), config));

  std::vector<GnssFix> fixes;
  for (const auto& e : result.epochs) fixes.push_back(e.fix);
  SinglePointAnswer answer{data, result, gnss::position_statistics(fixes, truth), std::nullopt};
  if (receiver) {
    CANYON_TRY(answer.comparison, gnss::compare_with_receiver(fixes, *receiver));
  }
  const Json json = single_point_json(answer);
  if (table != nullptr) CANYON_TRY_STATUS(table->write(gnss::solution_csv(result)));
  if (folder != nullptr) CANYON_TRY_STATUS(write_folder(folder->staging_path(), result, json));
  CANYON_TRY_STATUS(outputs.commit());
  print_warnings(data.warnings);
  print_warnings(data.observations.warnings);
  print_warnings(result.warnings);
  if (answer.comparison) print_warnings(answer.comparison->warnings);
  if (options.common.json)
    std::printf("%s\n", json_text(json).c_str());
  else
    print_single_point(answer);
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_common(arguments, options->common);
  arguments
      .option("--obs", options->files.observations, "RINEX 2, 3 or 4 observations; also gzipped or Hatanaka-compressed")
      .required();
  arguments.option("--nav", options->files.navigation, "RINEX navigation files of the same day").required();
  arguments.option("--sp3", options->files.sp3, "precise orbits and clocks (SP3) instead of the broadcast ones");
  arguments.option("--antex", options->files.antex,
                   "satellite antennas (ANTEX), for SP3 files whose positions are those of the centre of mass");
  arguments.option("--ionex", options->files.ionex, "ionosphere maps (IONEX), for ionosphere = \"ionex\" in --config");
  arguments.option("--base", options->files.base,
                   "observations of a base near by: positions are differential (code, smoothed by carrier)");
  arguments.option("--base-position", options->base_position,
                   "X,Y,Z of the base's antenna, in the frame of the orbits");
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
  arguments.option("--compare", options->compare,
                   "NMEA log of the receiver that observed: how our positions differ from its own");
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
