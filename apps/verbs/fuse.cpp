#include <cstdio>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/answers/fusion.h"
#include "canyon/apps/line/verb.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"
#include "canyon/study/fuse/files.h"
#include "canyon/study/fuse/replay.h"

namespace canyon::apps {

namespace {

struct Options {
  CommonOptions common;
  study::FuseFiles files;
  std::string config, outage, results, run, out;
  bool force = false;
};

Status write_output(const Options& options, const study::FuseInputs& inputs, const study::Fused& run) {
  if (options.out.empty()) return Ok{};
  CANYON_TRY(auto staged, StagedDirectory::create(options.out, options.force));
  CANYON_TRY_STATUS(study::write_fused(inputs, run, staged.staging_path()));
  if (!run.errors.empty()) CANYON_TRY_STATUS(write_text_file(staged.staging_path() + "/errors.svg", fused_svg(run)));
  return staged.commit();
}

/// The inputs and what is to be done with them: of the logs that are named, or of a run that recorded its own.
Result<study::RecordedRun> read(const Options& options) {
  std::optional<study::OutagePlan> outages;
  if (!options.outage.empty()) {
    CANYON_TRY(outages, study::parse_outage_plan(options.outage, "--outage"));
  }
  CANYON_TRY(const study::FuseConfig config, study::read_fuse_config(options.config));
  study::RecordedRun out;
  if (!options.results.empty()) {
    CANYON_TRY(out, study::read_recorded_run(options.results, options.run));
    if (config.file.find("fusion") != nullptr) out.plan.filter = config.fusion;
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
  CANYON_TRY(const auto recorded, read(options));
  const study::FuseInputs& inputs = recorded.inputs;
  CANYON_TRY(const auto fused, study::fuse(inputs, recorded.plan));
  CANYON_TRY_STATUS(write_output(options, inputs, fused));
  if (options.common.json)
    std::printf("%s\n", json_text(study::fuse_json(inputs, fused)).c_str());
  else
    print_fused(inputs, fused);
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
  arguments.option("--truth", files.truth,
                   "reference to compare with, and to start from: KF-GINS text, TUM, CSV with named columns");
  arguments.option("--config", options->config,
                   "TOML with [fusion], [imu], [gnss], [odometer], [truth], [start], [score], [output]; keys in "
                   "docs/fuse.md");
  arguments.option("--outage", options->outage,
                   "LENGTH,EVERY,FIRST in seconds: fixes are withheld for LENGTH after FIRST from the log's beginning "
                   "(or FIRST seconds of week) and then again EVERY");
  arguments.option("--results", options->results,
                   "instead of logs, a results directory of runs with [run] record_filter_input = true: the run's own "
                   "filter, or that of --config, on what it was given");
  arguments.option("--run", options->run, "name of the run in --results, such as high");
  arguments.option("--out", options->out,
                   "directory for nav.csv, estimate.nav, .tum and .kml, innovations.csv, errors.csv, errors.svg and "
                   "summary.json");
  arguments.flag("--force", options->force,
                 "replace the directory if it exists; only one that canyon wrote, or an empty one");
  return [options]() -> Result<int> {
    const bool logs = !options->files.imu.empty() && !options->files.gnss.empty();
    if (options->results.empty() ? !logs : options->run.empty() || !options->files.imu.empty())
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
