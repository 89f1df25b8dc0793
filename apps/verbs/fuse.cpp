#include <cstdio>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/answers/fusion.h"
#include "canyon/apps/line/verb.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"
#include "canyon/report/html_report.h"
#include "canyon/study/fuse/files.h"
#include "canyon/study/fuse/replay.h"

namespace canyon::apps {

namespace {

struct Options {
  CommonOptions common;
  study::FuseFiles files;
  std::string config, outage, smoother, results, run, out;
  bool force = false;
};

Status write_output(const Options& options, const study::FuseInputs& inputs, const study::Fused& run,
                    const study::FuseSmoothed* smoothed) {
  if (options.out.empty()) return Ok{};
  CANYON_TRY(auto staged, StagedDirectory::create(options.out, options.force));
  const std::string& folder = staged.staging_path();
  CANYON_TRY_STATUS(study::write_fused(inputs, run, smoothed, folder));
  if (!run.errors.empty()) CANYON_TRY_STATUS(write_text_file(folder + "/errors.svg", fused_svg(run)));
  CANYON_TRY_STATUS(report::write_html_report(folder, folder + "/report.html"));
  return staged.commit();
}

/// The inputs and what is to be done with them: of the logs that are named, or of a run that recorded its own.
Result<study::RecordedRun> read(const Options& options, const study::FuseConfig& config) {
  std::optional<study::OutagePlan> outages;
  if (!options.outage.empty()) {
    CANYON_TRY(outages, study::parse_outage_plan(options.outage, "--outage"));
  }
  study::RecordedRun out;
  if (!options.results.empty()) {
    CANYON_TRY(out, study::read_recorded_run(options.results, options.run));
    CANYON_TRY_STATUS(study::take_config(config, out));
    out.plan.outages = outages;
    return out;
  }
  std::vector<std::string> warnings;
  if (!config.imu.sensor_given)
    warnings.push_back("no [imu] sensor and no figures in --config: taken for an " + config.imu.sensor);
  const auto warn = [&warnings](const std::string& line) { warnings.push_back(line); };
  CANYON_TRY(out.inputs, study::read_fuse_inputs(options.files, config, warn));
  CANYON_TRY(out.plan, study::plan_fuse(out.inputs, config, outages));
  print_warnings(warnings);  // a mistake is one line
  return out;
}

Result<int> run(const Options& options) {
  set_threads(options.common.threads);
  CANYON_TRY(const study::FuseConfig config, study::read_fuse_config(options.config));
  CANYON_TRY(auto recorded, read(options, config));
  const study::FuseInputs& inputs = recorded.inputs;
  recorded.plan.keep_segments = !options.smoother.empty();
  if (recorded.plan.keep_segments) CANYON_TRY_STATUS(study::check_smoother(options.smoother, recorded.plan.filter));
  CANYON_TRY(const auto fused, study::fuse(inputs, recorded.plan));
  std::optional<study::FuseSmoothed> smoothed;
  if (recorded.plan.keep_segments) {
    CANYON_TRY(smoothed, study::smooth(options.smoother, config.smoother.own, inputs, recorded.plan, fused));
  }
  const study::FuseSmoothed* beside = smoothed ? &*smoothed : nullptr;
  CANYON_TRY_STATUS(write_output(options, inputs, fused, beside));
  if (options.common.json)
    std::printf("%s\n", json_text(study::fuse_json(inputs, fused, beside)).c_str());
  else
    print_fused(inputs, fused, beside);
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_common(arguments, options->common);
  study::FuseFiles& files = options->files;
  arguments.option("--imu", files.imu, "IMU log: CSV of rates or increments with units in its header, or KF-GINS text");
  arguments.option(
      "--gnss", files.gnss,
      "fixes: positions of gnss solve, KF-GINS text, RTKLIB .pos, CSV with named columns; with --nav RINEX");
  arguments.option("--nav", files.navigation, "RINEX navigation files; --gnss then holds observations");
  arguments.option("--odometer", files.odometer, "CSV of t_s (or sow) and speed_m_s or ticks");
  arguments.option("--heading", files.heading, "CSV of t_s (or sow), heading_deg and sigma_deg, of two antennas");
  arguments.option("--poses", files.poses,
                   "poses in a map that was there before: CSV with named columns of places, attitudes and 1-sigmas, "
                   "TUM or KF-GINS text");
  arguments.option("--truth", files.truth,
                   "reference to compare with, and to start from: KF-GINS text, TUM, CSV with named columns");
  arguments.option("--config", options->config,
                   "TOML with [fusion], [imu], [gnss], [odometer], [heading], [poses], [truth], [start], [timeline], "
                   "[smoother], [score], [output]; keys in "
                   "docs/fuse.md");
  arguments.option("--outage", options->outage,
                   "LENGTH,EVERY,FIRST in seconds: fixes are withheld for LENGTH after FIRST from the log's beginning "
                   "(or FIRST seconds of week) and then again EVERY");
  arguments.option("--smoother", options->smoother,
                   "beside the filter's estimate one of the whole run, of what came later too: none, rts, batch_graph "
                   "or fixed_lag_graph; keys under [smoother]");
  arguments.option("--results", options->results,
                   "instead of logs, a results directory of runs with [run] record_filter_input = true: the run's own "
                   "filter, or that of --config, on what it was given");
  arguments.option("--run", options->run, "name of the run in --results, such as high");
  arguments.option("--out", options->out,
                   "directory for report.html, nav.csv, estimate.nav, .tum and .kml, innovations.csv, errors.csv, "
                   "errors.svg, smoothed.* and summary.json");
  arguments.flag("--force", options->force,
                 "replace the directory if it exists; only one that canyon wrote, or an empty one");
  return [options]() -> Result<int> {
    const study::FuseFiles& given = options->files;
    const bool of_run = !options->results.empty() || !options->run.empty();
    if (of_run && !(given.imu + given.gnss + given.odometer + given.heading + given.poses + given.truth).empty())
      return Error{"", 0, "command line", "logs beside --results", "one or the other"};
    if (of_run ? options->results.empty() || options->run.empty() : given.imu.empty() || given.gnss.empty())
      return Error{"", 0, "command line", "no logs given",
                   "--imu FILE and --gnss FILE, or --results DIR and --run NAME"};
    return run(*options);
  };
}

}  // namespace

Verb fuse_verb() {
  return {"fuse", "the filter on recorded IMU and GNSS, and how far it is off",
          "canyon fuse --imu imu.txt --gnss gnss.txt --truth truth.nav --config drive.toml --outage 30,75,150",
          declare};
}

}  // namespace canyon::apps
