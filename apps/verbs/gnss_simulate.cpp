#include <cstdio>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/answers/single_point.h"
#include "canyon/apps/options/antenna_way.h"
#include "canyon/apps/options/gnss_errors.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/json.h"
#include "canyon/core/output/printed.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/gnss/sensor/simulation/drive_files.h"

namespace canyon::apps {

namespace {

struct Options {
  GnssSetupOptions setup;
  AntennaWayOptions way;
  std::string errors = "all", nmea, rinex_obs, rinex_nav;
};

void tell(const Options& options, const gnss::DriveTotals& totals, const GnssSetup& setup) {
  if (options.setup.common.json) {
    Json json{{"epochs", totals.epochs},
              {"fixes", totals.fixes},
              {"satellites_mean", or_null(totals.satellites_mean())},
              {"nlos_share", or_null(totals.nlos_share())},
              {"gdop_median", or_null(totals.gdop_median())},
              {"rms_3d_m", or_null(totals.rms_m())},
              {"h50_m", or_null(totals.horizontal_percentile_m(0.50))},
              {"h95_m", or_null(totals.horizontal_percentile_m(0.95))}};
    if (totals.reported.count() > 0) add_reported(json, totals.reported);
    std::printf("%s\n", json_text(json).c_str());
    return;
  }
  std::printf("%lld epochs from %s GPS time, scene: %s\n", static_cast<long long>(totals.epochs),
              setup.start.iso().c_str(), setup.scene_name.c_str());
  std::printf("  satellites tracked, mean   %8.2f\n", totals.satellites_mean());
  std::printf("  NLOS share of tracked, %%   %8.1f\n", 100.0 * totals.nlos_share());
  std::printf("  epochs with a fix          %8lld\n", static_cast<long long>(totals.fixes));
  std::printf("  GDOP, median               %8.2f\n", totals.gdop_median());
  std::printf("  3-D error, RMS, m          %8.3f\n", totals.rms_m());
  std::printf("  horizontal 50 and 95 %%, m  %8.3f %8.3f\n", totals.horizontal_percentile_m(0.50),
              totals.horizontal_percentile_m(0.95));
}

Result<int> run(const Options& options) {
  set_threads(options.setup.common.threads);
  CANYON_TRY(PlacedReceiver receiver, place_receiver(options.way, options.setup));
  auto& [setup, drive] = receiver;
  CANYON_TRY_STATUS(keep_errors(options.errors, setup.config));
  setup.config.rate_hz = drive.rate_hz;
  CANYON_TRY(const auto sensor, make_gnss_sensor(setup.config, setup.seed, drive.start, receiver.end(), *setup.scene));

  OutputSet outputs(options.setup.force);
  CANYON_TRY(const StagedDirectory* const folder, outputs.directory(options.setup.out));
  CANYON_TRY(StagedFile* const rinex_obs, outputs.file(options.rinex_obs));
  CANYON_TRY(StagedFile* const rinex_nav, outputs.file(options.rinex_nav));
  CANYON_TRY(StagedFile* const nmea, outputs.file(options.nmea));
  CANYON_TRY(const auto source, make_satellite_source(setup.config.satellites, drive.start, receiver.end()));
  Progress progress("simulating", static_cast<double>(drive.epochs()), !options.setup.common.json);
  gnss::DriveFiles files(setup.scene->parts().undulation_m);
  CANYON_TRY(const gnss::DriveTotals totals,
             gnss::simulate_drive(drive, *sensor, *setup.scene, [&](const gnss::GnssOutput& output) {
               files.add(output);
               progress.advance(1.0);
             }));

  print_warnings(sensor->warnings());
  if (totals.below_ground > 0)
    print_warning(
        printed("%s: the antenna is below the ground of the scene in %lld of %lld epochs, by up to %.2f m, "
                "and receives nothing there; heights are ellipsoidal",
                drive.path_name.c_str(), static_cast<long long>(totals.below_ground),
                static_cast<long long>(totals.epochs), totals.deepest_m));
  if (folder != nullptr) {
    CANYON_TRY_STATUS(write_text_file(folder->staging_path() + "/fixes.csv", files.fixes_csv()));
    CANYON_TRY_STATUS(write_text_file(folder->staging_path() + "/satellites.csv", files.satellites_csv()));
  }
  if (rinex_obs != nullptr) {
    CANYON_TRY(const std::string text, files.rinex_observations(drive, source, options.rinex_obs));
    CANYON_TRY_STATUS(rinex_obs->write(text));
  }
  if (rinex_nav != nullptr) {
    std::vector<std::string> warnings;
    const auto text = rinex_navigation(source, setup.config.satellites.systems, drive.start, receiver.end(), warnings);
    print_warnings(warnings);
    if (!text) return text.error();
    CANYON_TRY_STATUS(rinex_nav->write(*text));
  }
  if (nmea != nullptr) CANYON_TRY_STATUS(nmea->write(files.nmea()));
  CANYON_TRY_STATUS(outputs.commit());
  tell(options, totals, setup);
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_gnss_setup(arguments, options->setup, "none");
  declare_antenna_way(arguments, options->way);
  arguments
      .option("--errors", options->errors,
              "all, none, or a list of: ionosphere,troposphere,ephemeris,receiver_clock,multipath,noise,base_station")
      .default_shown();
  arguments.option("--rinex-obs", options->rinex_obs, "RINEX 3.04 observation file to write");
  arguments.option("--rinex-nav", options->rinex_nav,
                   "RINEX 3.04 navigation file to write, of the satellites simulated");
  arguments.option("--nmea", options->nmea, "NMEA 0183 log to write: GGA, RMC, GSA, GSV");
  return [options]() -> Result<int> {
    if (options->way.at.empty() && options->way.trajectory.empty())
      return Error{"", 0, "command line", "no place given", "--at LAT,LON,H or --trajectory FILE"};
    return run(*options);
  };
}

}  // namespace

Verb gnss_simulate_verb() {
  return {"gnss simulate", "measurements at a point or along a way, as RINEX, NMEA and CSV",
          "canyon gnss simulate --at 32.35,-90.88,60 --duration 3600 --rate 1 --nmea log.nmea --out out", declare};
}

}  // namespace canyon::apps
