#include <algorithm>

#include "canyon/core/config/text.h"
#include "canyon/fusion/measurements/measurement.h"
#include "canyon/study/fuse/inputs.h"

namespace canyon::study {
namespace {

constexpr const char* kMeasurements = "fusion.measurements";

/// Rows that no message of another sensor is needed for, and those whose messages may be among the inputs.
constexpr std::string_view kFed[] = {"position", "velocity",  "non_holonomic", "standstill", "odometer",
                                     "heading",  "barometer", "magnetometer",  "map_pose",   "ranges"};

std::string quoted(const std::string& name) {
  return "\"" + name + "\"";
}

bool can_be_fed(std::string_view name) {
  return std::find(std::begin(kFed), std::end(kFed), name) != std::end(kFed);
}

std::string fed_rows() {
  return "one of " + quoted_list(std::vector<std::string>(std::begin(kFed), std::end(kFed)));
}

bool states_velocity(const GnssFix& fix) {
  return fix.velocity_covariance_E.allFinite();
}

/// Whether the inputs hold what the row is made of.
bool has_sensor(const FuseInputs& in, const std::string& name) {
  if (name == "velocity") return std::any_of(in.fixes.begin(), in.fixes.end(), states_velocity);
  if (name == "odometer") return !in.odometer.empty();
  if (name == "heading") return !in.heading.empty();
  if (name == "map_pose") return !in.poses.empty();
  if (name == "barometer") return !in.barometer.empty();
  if (name == "magnetometer") return !in.magnetometer.empty();
  if (name == "ranges") return !in.ranges.empty();
  return true;
}

Error without_sensor(const FuseInputs& in, const FuseConfig& config, const std::string& name,
                     const char* key = kMeasurements) {
  const bool of_run = !in.of_run.empty();
  if (name == "velocity")
    return at_key(config, key, "\"velocity\", but " + in.gnss_path + " has no velocity with a sigma",
                  of_run ? "a run whose receiver gives one"
                         : "columns vn,ve,vu,sd_vn,sd_ve,sd_vu, or gnss.velocity_sigma_enu_m_s");
  if (name == "ranges" && !of_run)
    return at_key(config, key, "\"ranges\", but " + in.gnss_path + " holds positions",
                  "RINEX observations, and --nav FILE");
  if (of_run)
    return at_key(config, key, quoted(name) + ", of which the run " + quoted(in.of_run) + " has no record",
                  "a run whose own filter measures with it");
  return at_key(config, key, quoted(name) + " without a log of one",
                name == "odometer"   ? "--odometer FILE"
                : name == "heading"  ? "--heading FILE"
                : name == "map_pose" ? "--poses FILE"
                                     : "--results of a run whose filter measures with it");
}

/// A log of headings or poses is given to be measured with.
Status check_taken(const FuseConfig& config, const char* option, const std::string& path, const char* row) {
  if (path.empty() || fusion::measures_with(config.fusion, row)) return Ok{};
  return Error{"", 0, option, path + ", but the filter does not measure with " + quoted(row),
               quoted(row) + " in fusion.measurements of --config"};
}

}  // namespace

Status check_fuse_filter(const FuseInputs& in, const FuseConfig& config) {
  if (const Status parts = fusion::check_parts(fusion::filter_parts(config.fusion)); !parts.ok()) {
    const Error& error = parts.error();
    return at_key(config, error.key, error.what, error.expected);
  }
  if (config.fusion.map_aiding) return at_key(config, "fusion.map_aiding", "nothing is registered here", "false");
  for (const std::string& name : config.fusion.measurements) {
    if (!can_be_fed(name))
      return at_key(config, kMeasurements, quoted(name) + ", for which canyon fuse has no messages", fed_rows());
    if (!has_sensor(in, name)) return without_sensor(in, config, name);
  }
  CANYON_TRY_STATUS(check_taken(config, "--heading", in.heading_path, "heading"));
  CANYON_TRY_STATUS(check_taken(config, "--poses", in.poses_path, "map_pose"));
  // What a set measures with is left out where there is none, but not its only word of the place.
  if (fusion::measures_with(config.fusion, "ranges") && !has_sensor(in, "ranges"))
    return without_sensor(in, config, "ranges", "fusion.filter");
  return Ok{};
}

}  // namespace canyon::study
