#include <cstdio>
#include <filesystem>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/options/mission_options.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/report/reproduce/reproduce_page.h"
#include "canyon/study/reproduce/parts.h"

namespace canyon::apps {

namespace {

struct Options {
  MissionOptions mission;
  std::int64_t draws = 20, missions = 0;
};

/// That of the mission: the built-in one's is the paper's own day and hour.
Result<study::PaperSky> sky_of(const mission::MissionFile& file) {
  CANYON_TRY(const mission::MissionConfig config, file.resolve("paper"));
  study::PaperSky sky;
  sky.satellites = config.gnss.satellites;
  const auto start = GpsTime::parse(config.time.start, "");
  if (!start) {
    Error error = start.error();
    error.key = "time.start";
    return file.locate(error, "paper", "paper");
  }
  sky.start = *start;
  return sky;
}

/// Files and systems of a receiver's satellites, for the head of the page.
std::string told_satellites(const gnss::SatelliteSourceConfig& c) {
  std::string files = c.nav_file;
  for (const std::string& file : c.nav_files) files += (files.empty() ? "" : ", ") + file;
  if (!c.almanac_file.empty()) files += (files.empty() ? "" : ", ") + ("almanac " + c.almanac_file);
  return (files.empty() ? "the built-in constellation" : files) + ", systems " + c.systems;
}

Result<study::Reproduction> reproduce(const Options& options, const mission::MissionFile& file,
                                      const std::string& scratch) {
  CANYON_TRY(const study::PaperSky sky, sky_of(file));
  study::Reproduction all;
  all.ephemeris = told_satellites(sky.satellites);
  if (options.missions > 0) {
    CANYON_TRY(const mission::MissionConfig high, file.resolve("high"));
    const std::string of_high = told_satellites(high.gnss.satellites);
    if (of_high != all.ephemeris) all.ephemeris += " (high: " + of_high + ")";
  }
  all.start = sky.start.iso(0);
  all.draws = options.draws;
  all.missions = options.missions;
  CANYON_TRY(auto table_1, study::range_error_part(sky));
  CANYON_TRY(auto inertial, study::inertial_parts(options.draws));
  CANYON_TRY(auto table_2, study::receiver_scatter_part(sky, options.draws));
  all.parts.push_back(std::move(table_1));
  for (auto& part : inertial) all.parts.push_back(std::move(part));
  all.parts.push_back(std::move(table_2));
  if (options.missions == 0) return all;
  CANYON_TRY(auto missions, study::mission_parts(file, options.missions, scratch, !options.mission.common.json));
  for (auto& part : missions) all.parts.push_back(std::move(part));
  return all;
}

Result<int> run(const Options& options) {
  set_threads(options.mission.common.threads);
  CANYON_TRY(const auto file, load_mission(options.mission));
  CANYON_TRY_STATUS(file.check_fidelities({"low", "paper", "high"}, "the paper's fidelities"));
  const std::string out = options.mission.out.empty() ? free_name("results/reproduce") : options.mission.out;
  CANYON_TRY(auto directory, StagedDirectory::create(out, options.mission.force));
  CANYON_TRY(const study::Reproduction all, reproduce(options, file, directory.staging_path()));
  auto json = study::reproduction_json(all);
  const std::string summary = directory.staging_path() + "/summary.json";
  CANYON_TRY_STATUS(write_text_file(summary, json_text(json, 2) + "\n"));
  CANYON_TRY_STATUS(write_text_file(directory.staging_path() + "/paper.csv", study::reproduction_csv(all)));
  CANYON_TRY(const std::string page, report::reproduce_page(summary));
  CANYON_TRY_STATUS(write_text_file(directory.staging_path() + "/report.html", page));
  throw_if_cancelled();
  CANYON_TRY_STATUS(directory.commit());
  if (options.mission.common.json) {
    json["results_dir"] = directory.final_path();
    std::printf("%s\n", json_text(json).c_str());
    return 0;
  }
  const auto place = std::filesystem::absolute(directory.final_path()).lexically_normal();
  std::printf("%s\nResults: %s\nReport:  %s\n", study::reproduction_table(all).c_str(), place.c_str(),
              (place / "report.html").c_str());
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_mission_options(arguments, options->mission);
  arguments.option("--draws", options->draws, "seeds of the resting units, and starts of the receivers at rest")
      .default_shown()
      .within(std::int64_t{1}, std::int64_t{1000});
  arguments
      .option("--missions", options->missions,
              "drives the mission too, at three fidelities, alone and on its route, with so many seeds: minutes each")
      .default_shown()
      .within(std::int64_t{0}, std::int64_t{10'000});
  return [options] { return run(*options); };
}

}  // namespace

Verb reproduce_verb() {
  return {"reproduce", "every table and figure of Durst & Goodin 2012 beside ours, as printed and as corrected",
          "canyon reproduce --missions 2 --out paper", declare};
}

}  // namespace canyon::apps
