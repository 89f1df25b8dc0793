#include <cstdio>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/options/gnss_setup.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"
#include "canyon/gnss/antenna_height.h"
#include "canyon/report/html_report.h"
#include "canyon/study/drive_check/drive_check.h"

namespace canyon::apps {

namespace {

struct Options {
  GnssSetupOptions setup;
  gnss::RecordedFiles files;
  std::string truth, solver;
  double from_sow = 0.0, to_sow = 604800.0;
  int draws = 1;
};

Result<std::vector<StampedPlace>> reference(const Options& options) {
  CANYON_TRY(auto places, read_places(options.truth));
  for (const StampedPlace& place : places)
    CANYON_TRY_STATUS(gnss::check_antenna_height(place.p_E, {.file = options.truth, .line = place.line}));
  return places;
}

Result<int> run(const Options& options) {
  set_threads(options.setup.common.threads);
  OutputSet outputs(options.setup.force);
  CANYON_TRY(const StagedDirectory* const folder, outputs.directory(options.setup.out));
  gnss::SinglePointConfig solver;
  if (!options.solver.empty()) {
    CANYON_TRY(solver, gnss::read_single_point_config(options.solver));
  }
  CANYON_TRY(const auto places, reference(options));
  CANYON_TRY(GnssSetup setup, gnss_setup(options.setup, geodetic_from_ecef(places.front().p_E)));
  solver.systems = setup.config.satellites.systems;
  gnss::RecordedFiles files = options.files;
  files.navigation = options.setup.nav;
  CANYON_TRY(const auto data, gnss::read_recorded_data(files, solver));
  const study::DriveCheckInputs inputs{.data = data,
                                       .reference = places,
                                       .reference_name = options.truth,
                                       .scene_name = setup.scene_name,
                                       .scene = *setup.scene,
                                       .receiver = setup.config,
                                       .solver = solver,
                                       .seed = setup.seed,
                                       .draws = options.draws,
                                       .from_sow = options.from_sow,
                                       .to_sow = options.to_sow};
  CANYON_TRY(const study::DriveCheck check, study::check_drive(inputs));
  const Json json = study::drive_check_json(check);
  if (folder != nullptr) {
    CANYON_TRY_STATUS(write_text_file(folder->staging_path() + "/signals.csv", study::drive_signals_csv(check)));
    CANYON_TRY_STATUS(write_text_file(folder->staging_path() + "/summary.json", json_text(json, 2) + "\n"));
    CANYON_TRY_STATUS(report::write_html_report(folder->staging_path(), folder->staging_path() + "/report.html"));
  }
  CANYON_TRY_STATUS(outputs.commit());
  print_warnings(data.warnings);
  print_warnings(data.observations.warnings);
  print_warnings(check.warnings);
  if (options.setup.common.json)
    std::printf("%s\n", json_text(json).c_str());
  else
    std::printf("%s", study::drive_check_text(check).c_str());
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_gnss_setup(arguments, options->setup, "none");
  arguments.option("--obs", options->files.observations, "RINEX observations of the drive").required();
  arguments
      .option("--truth", options->truth,
              "reference antenna over time: CSV of gps_week,sow and lat_deg,lon_deg,h_m or x_m,y_m,z_m")
      .required();
  arguments.option("--sp3", options->files.sp3, "precise orbits and clocks (SP3) for the recorded ranges");
  arguments.option("--antex", options->files.antex, "satellite antennas (ANTEX) for the SP3 files");
  arguments.option("--config", options->solver, "options of the solution of both (TOML), as of gnss solve");
  arguments
      .option("--draws", options->draws,
              "simulations, each of another street's clutter and of the next seed; from two on signals are scored")
      .default_shown()
      .within(1, 1000);
  arguments.option("--from-sow", options->from_sow, "second of the GPS week at which the stretch begins")
      .within(0.0, 604800.0);
  arguments.option("--to-sow", options->to_sow, "and ends").within(0.0, 604800.0);
  return [options]() -> Result<int> {
    if (options->setup.nav.empty())
      return Error{"", 0, "command line", "no navigation file given", "--nav FILE of the day of the drive"};
    return run(*options);
  };
}

}  // namespace

Verb gnss_drive_check_verb() {
  return {"gnss drive-check", "a recorded drive against its simulation",
          "canyon gnss drive-check --obs drive.obs --nav brdc.16n brdc.16g --systems GR --truth truth.csv --scene "
          "city.toml",
          declare};
}

}  // namespace canyon::apps
