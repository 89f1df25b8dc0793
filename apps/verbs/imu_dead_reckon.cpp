#include <cstdio>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/answers/dead_reckoning.h"
#include "canyon/apps/line/verb.h"
#include "canyon/apps/options/gnss_setup.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/units.h"
#include "canyon/study/dead_reckoning/files.h"

namespace canyon::apps {

namespace {

struct Options {
  CommonOptions common;
  std::string imu, columns, truth, initial, at_rest, axes = "flu", gravity, out;
  std::string integrator = "two_sample";
  double level_s = 10.0;
  bool force = false;
};

Result<study::Reference> reference_of(const Options& options, const NavigationFile& truth,
                                      const study::ImuRecording& recording) {
  if (!options.initial.empty()) {
    CANYON_TRY(const auto v, parse_numbers(options.initial, 9, "--initial",
                                           "LAT,LON,H,VN,VE,VD,ROLL,PITCH,HEADING: degrees, metres, m/s"));
    return study::reference_from_state({.place = {v[0] * kDegree, v[1] * kDegree, v[2]},
                                        .v_ned_m_s = {v[3], v[4], v[5]},
                                        .roll_rad = v[6] * kDegree,
                                        .pitch_rad = v[7] * kDegree,
                                        .heading_rad = v[8] * kDegree},
                                       recording);
  }
  if (options.at_rest.empty()) return study::reference_from_file(truth, options.truth, recording);
  CANYON_TRY(const auto v, parse_numbers(options.at_rest, 4, "--static", "LAT,LON,H,HEADING: degrees, metres"));
  return study::reference_at_rest({v[0] * kDegree, v[1] * kDegree, v[2]}, v[3] * kDegree, options.level_s, recording);
}

Status check_name(const std::string& option, const std::string& name, const std::vector<std::string>& known) {
  std::string list;
  for (const std::string& one : known) {
    if (one == name) return Ok{};
    list += (list.empty() ? "one of " : ", ") + one;
  }
  return Error{option, 0, "", "\"" + name + "\"", list};
}

Status write_output(const Options& options, const study::DeadReckoning& result) {
  if (options.out.empty()) return Ok{};
  CANYON_TRY(auto staged, StagedDirectory::create(options.out, options.force));
  const study::PlainIntegrals plain(result);
  CANYON_TRY_STATUS(study::write_dead_reckoning(result, plain, staged.staging_path()));
  CANYON_TRY_STATUS(write_text_file(staged.staging_path() + "/drift.svg", dead_reckoning_svg(result, plain)));
  return staged.commit();
}

Result<int> run(const Options& options) {
  CANYON_TRY_STATUS(check_name("--integrator", options.integrator, fusion::strapdown_names()));
  if (!options.gravity.empty()) CANYON_TRY_STATUS(check_name("--gravity", options.gravity, gravity_names()));
  CANYON_TRY_STATUS(check_name("--axes", options.axes, {"flu", "frd"}));
  set_threads(options.common.threads);
  NavigationFile truth;
  if (!options.truth.empty()) {
    CANYON_TRY(truth, read_navigation_file(options.truth));
  }
  const bool frd = options.axes == "frd";
  const study::ImuRecordingFormat format{.columns = options.columns,
                                         .forward_right_down = frd,
                                         .gps_week = truth.records.empty() ? 0 : truth.records.front().t.week()};
  CANYON_TRY(auto recording, study::read_imu_recording(options.imu, format, print_warning));
  CANYON_TRY(const study::Reference reference, reference_of(options, truth, recording));
  CANYON_TRY_STATUS(
      check_axes(recording, reference.initial, frd ? "--axes flu" : "forward-left-up axes, or --axes frd"));
  if (options.gravity.empty()) CANYON_TRY_STATUS(study::check_stated_gravity(truth, options.truth));
  const std::string gravity = !options.gravity.empty()     ? options.gravity
                              : !reference.gravity.empty() ? reference.gravity
                              : recording.kf_gins          ? "grs80_series"
                                                           : "wgs84";
  const auto result = study::dead_reckon(std::move(recording), reference, options.integrator, gravity);
  CANYON_TRY_STATUS(write_output(options, result));
  if (options.common.json)
    std::printf("%s\n", json_text(study::dead_reckoning_json(result)).c_str());
  else
    print_dead_reckoning(result);
  return 0;
}

std::string integrators_help() {
  std::string out = "strapdown model:";
  for (const fusion::StrapdownRow& row : fusion::strapdown_models())
    out += std::string("\n") + row.name + ", order " + std::to_string(static_cast<int>(*row.order)) + ": " + row.doc;
  return out;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_common(arguments, options->common);
  arguments
      .option("--imu", options->imu,
              "the log: CSV of rates (header t_s,gx_rad_s,...,az_m_s2; the mean over the interval that ends at t_s), "
              "or KF-GINS text of increments (sow, rad, m/s; forward-right-down)")
      .required();
  arguments.option("--columns", options->columns, "column names or layout of the log, as for imu allan");
  const auto truth = arguments.option("--truth", options->truth,
                                      "reference to start from and compare with: KF-GINS text, or CSV with "
                                      "sow,lat_deg,lon_deg,h_m,vn,ve,vd,roll_deg,pitch_deg,heading_deg");
  const auto initial =
      arguments.option("--initial", options->initial,
                       "LAT,LON,H,VN,VE,VD,ROLL,PITCH,HEADING at the log's first stamp: degrees, metres, m/s");
  const auto rest =
      arguments.option("--static", options->at_rest,
                       "LAT,LON,H,HEADING of a log at rest: levelled with its own first seconds, compared with "
                       "standing still");
  truth.excludes(initial).excludes(rest);
  initial.excludes(rest);
  arguments.option("--level", options->level_s, "seconds that --static takes for levelling")
      .default_shown()
      .within(0.0, 1e6);
  arguments.option("--integrator", options->integrator, integrators_help()).default_shown();
  arguments.option(
      "--gravity", options->gravity,
      "wgs84 or grs80_series; default: what the truth file states, else that of KF-GINS (grs80_series) for "
      "its text format and wgs84 for CSV");
  arguments.option("--axes", options->axes, "axes of a CSV log: flu (forward-left-up) or frd").default_shown();
  arguments.option("--out", options->out,
                   "directory for estimate.nav, heading.csv, drift.csv, drift.svg and summary.json");
  arguments.flag("--force", options->force,
                 "replace the directory if it exists; only one that canyon wrote, or an empty one");
  return [options]() -> Result<int> {
    if (options->truth.empty() && options->initial.empty() && options->at_rest.empty())
      return Error{"", 0, "command line", "no start given", "--truth FILE, --initial ... or --static ..."};
    return run(*options);
  };
}

}  // namespace

Verb imu_dead_reckon_verb() {
  return {"imu dead-reckon", "free inertial navigation on a log, and how it drifts",
          "canyon imu dead-reckon --imu imu.csv --truth truth.nav --out drift", declare};
}

}  // namespace canyon::apps
