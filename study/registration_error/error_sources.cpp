#include "canyon/study/registration_error/error_sources.h"

#include "canyon/core/check.h"

namespace canyon::study {
namespace {

/// Also what the receiver believes of the ionosphere: a correction of what is not there would be an error of its own.
constexpr const char* kExactRanges = R"(
[gnss]
ionosphere = "none"
ionosphere_correction = "none"
troposphere = "none"
ephemeris_error = "none"
thermal_noise_scale = 0.0
base_error_scale = 0.0
ionosphere_gradient_mm_per_km = 0.0
troposphere_gradient_mm_per_km = 0.0
antenna_phase_centre = false
isotropic_min_m = 0.0
isotropic_max_m = 0.0
white_sigma_m = 0.0
white_sigma_up_m = 0.0
count_noise_max_m = 0.0
count_noise_min_m = 0.0
)";

constexpr const char* kExactBeam = R"(
[lidar]
model = "single_ray"
detector = "ideal"
see_through = "nothing"
range_noise_m = 0.0
range_bias_m = 0.0
angle_noise_deg = 0.0
range_quantum_m = 0.0
crosstalk = 0.0
weather = {rain_mm_h = 0.0, fog_visibility_m = 0.0, snow_mm_h = 0.0, dust_visibility_m = 0.0}
)";

constexpr const char* kMultipath = "multipath_nlos";

void lay_over(const std::string& toml, mission::MissionConfig& config) {
  const auto tree = ConfigNode::parse(toml, "error_sources");
  CANYON_CHECK(tree.ok(), tree.error().str());
  const Status status = read_config(&*tree, "", config);
  CANYON_CHECK(status.ok(), status.error().str());
}

}  // namespace

const std::vector<ErrorSource>& error_sources() {
  static const std::vector<ErrorSource> sources{
      {kMultipath, "multipath of all satellites, and satellites received without direct path",
       "[gnss]\nmultipath_scale = 0.0\n"},
      {"geometry", "satellites hidden or too weak: dilution, outages, and what the receiver then decides",
       "[gnss]\nhidden_signals = \"in_sight\"\n"},
      {"ranges", "atmosphere, orbit, satellite clock, base station and receiver noise", kExactRanges},
      {"imu", "errors of the inertial sensor, and how askew it sits",
       "[imu]\nerrors = \"none\"\nmounting_error_deg = 0.0\n"},
      {"initial_attitude", "error of the attitude that the filter starts with",
       "[run]\ninitial_attitude_error_deg = [0.0, 0.0, 0.0]\n"},
      {"time_offset", "time stamps of scans that are late", "[lidar]\nlatency_s = 0.0\n"},
      {"deskewing", "motion within a sweep as the filter predicts it, against the true one",
       "[lidar]\ndeskew = \"truth\"\n"},
      {"beam", "noise, bias and steps of ranges, width of the beam, weather, receiver", kExactBeam},
      {"guess", "the motion since the last keyframe that an alignment begins from", "[run]\ntruth_as_guess = true\n"},
  };
  return sources;
}

mission::MissionConfig without_sources(const mission::MissionConfig& config, std::uint32_t removed,
                                       HiddenRemoval hidden) {
  mission::MissionConfig out = config;
  const auto& sources = error_sources();
  // In their order: under a clear sky nothing is hidden that could be dropped.
  for (std::size_t i = 0; i < sources.size(); ++i) {
    if ((removed >> i & 1u) == 0) continue;
    lay_over(sources[i].without, out);
    if (sources[i].name == std::string(kMultipath) && hidden == HiddenRemoval::kDropped)
      lay_over("[gnss]\nhidden_signals = \"dropped\"\n", out);
  }
  // Where registration is off there is no guess.
  if (!lidar::registers(config.registration)) out.run.truth_as_guess = config.run.truth_as_guess;
  return out;
}

std::string configuration_text(const mission::MissionConfig& config) {
  mission::MissionConfig c = config;
  return fields_as_json([&c](FieldVisitor& f) { visit(f, c); });
}

std::string gnss_text(const mission::MissionConfig& config) {
  gnss::GnssConfig c = config.gnss;
  return std::to_string(config.run.seed) + fields_as_json([&c](FieldVisitor& f) { visit(f, c); });
}

}  // namespace canyon::study
