#include <algorithm>
#include <charconv>
#include <cmath>

#include "canyon/inertial/mems/mems_figures.h"
#include "canyon/study/tradeoff/probes/models.h"

namespace canyon::study {
namespace {

constexpr ModelRow<ProbeModel> kProbes[] = {
    {"pseudorange",
     {make_pseudorange_probe, "m", "epochs, rays and facets tested"},
     "every tracked satellite's pseudorange, at places all along the tape"},
    {"fix", {make_fix_probe, "m", "epochs, rays and facets tested", true}, "the fix, at places all along the tape"},
    {"fix_sequence",
     {make_fix_sequence_probe, "m", "epochs, rays and facets tested", true},
     "the fix, epoch after epoch"},
    {"orbit",
     {make_orbit_probe, "m", "states interpolated", true},
     "a satellite's position interpolated between samples of its orbit in closed form"},
    {"free_inertial",
     {make_free_inertial_probe, "m", "samples of the IMU and steps of the strapdown", true},
     "position after 10 s of free inertial navigation from the truth, all along the tape"},
    {"proof_mass",
     {make_proof_mass_probe, "1", "steps", true, 1e-13, true, proof_mass_order},
     "ringing of a proof mass of 5 kHz, Q = 2, over one period, as a part of its amplitude; steps in periods"},
    {"range", {make_range_probe, "m", "rays"}, "range of every beam's first return, by scans all along the tape"},
    {"object_range",
     // A range is kept in single precision: to 4e-6 m at 64 m.
     {make_object_range_probe, "m", "rays", false, 1e-5},
     "range of every beam's first return where both meet the same object, by scans all along the tape"},
    {"filter",
     {make_filter_probe, "m", "predictions and updates", true},
     "the filter's position on IMU and fixes of the tape's first minute, every second"},
    {"smooth_position",
     {make_smooth_position_probe, "m", "steps", true, 1e-8, true, position_order},
     "position on a smooth motion in closed form, without noise"},
    {"smooth_velocity",
     {make_smooth_velocity_probe, "m/s", "steps", true, 1e-9, true, velocity_order},
     "velocity on a smooth motion in closed form, without noise"},
    {"smooth_attitude",
     {make_smooth_attitude_probe, "rad", "steps", true, 1e-13, true, attitude_order},
     "attitude on a smooth motion in closed form, without noise"},
    {"keyframe",
     {make_keyframe_probe, "m", "points prepared and pairs matched", true},
     "position of a keyframe registered onto those before it, from a guess 0.3 m and 1 degree off"},
    {"mission_map",
     {make_mission_map_probe, "m", "all counters of the run", true},
     "points of the map to the nearest true surface, RMS, of a run in an open loop"},
    {"recorded_pseudorange",
     {make_recorded_pseudorange_probe, "m", "epochs, rays and facets tested", true},
     "recorded pseudoranges minus those of the model at the surveyed truth, less the clock (median of the epoch)"},
    {"recorded_strength",
     {make_recorded_strength_probe, "dB-Hz", "epochs, rays and facets tested", true},
     "recorded C/N0 minus that of the model at the surveyed truth, less the receiver's gain (median of the drive)"},
    {"recorded_fix",
     {make_recorded_fix_probe, "m", "ranges solved", true},
     "the fix that recorded pseudoranges give, against the surveyed truth"},
    {"recorded_orbit",
     {make_recorded_orbit_probe, "m", "states interpolated", true},
     "recorded pseudoranges minus ranges to satellites between samples of precise orbits, less the clock"},
};

}  // namespace

ModelTable<ProbeModel> probes() {
  return kProbes;
}

std::vector<ConfigKey> probe_keys() {
  std::vector<ConfigKey> keys;
  inertial::MemsFigures mems;
  for (ConfigKey& key : config_keys_of(mems))
    if (key.key == "integrator") keys.push_back({"mems." + key.key, key.value, key.choices});
  for (const char* key : {"mems.step_periods", "sp3.interval_s", "imu.summed_from_hz", "motion.step_s",
                          "filter.rate_hz", "strapdown.rate_hz"})
    keys.push_back({key, "", {}});
  return keys;
}

double ProbeSetup::own_number(const std::string& key) const {
  const auto found = own.find(key);
  if (found == own.end()) return kNaN;
  double value = kNaN;
  std::from_chars(found->second.data(), found->second.data() + found->second.size(), value);
  return value;
}

std::vector<std::int64_t> spread_ticks(const ProbeSetup& setup, double rate_hz, double margin_s) {
  const double first_s = margin_s, last_s = setup.tape.duration_s() - margin_s;
  std::vector<std::int64_t> ticks;
  for (std::size_t i = 0; i < setup.samples; ++i) {
    const double t_s =
        first_s + (last_s - first_s) * (static_cast<double>(i) + 0.5) / static_cast<double>(setup.samples);
    const auto tick = static_cast<std::int64_t>(std::floor(t_s * rate_hz));
    if (t_s >= first_s && tick > 0 && (ticks.empty() || tick > ticks.back())) ticks.push_back(tick);
  }
  return ticks;
}

}  // namespace canyon::study
