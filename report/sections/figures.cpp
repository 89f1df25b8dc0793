#include "canyon/report/sections/figures.h"

#include <array>
#include <cmath>

#include "canyon/core/messages.h"
#include "canyon/report/draw/format.h"

namespace canyon::report {
namespace {

using enum FigureRow::Kind;
constexpr std::string_view kDeg = "\xC2\xB0";
constexpr double kMapErrorCap_m = 5;  // docs/results.md

constexpr std::array kRows{
    FigureRow{"Mission", "waypoints_reached", "waypoints reached", "", kCount, ""},
    FigureRow{"Mission", "mission_waypoints_reached", "mission waypoints reached", "", kCount, ""},
    FigureRow{"Mission", "duration_s", "duration", "s", kQuantity, ""},
    FigureRow{"Mission", "distance_m", "distance driven", "m", kQuantity, ""},

    FigureRow{"Position error", "position_error_rms_m", "3-D, RMS", "m", kQuantity,
              "filter\xE2\x80\x99s estimate against truth"},
    FigureRow{"Position error", "position_error_p95_m", "3-D, 95 %", "m", kQuantity, ""},
    FigureRow{"Position error", "position_error_max_m", "3-D, largest", "m", kQuantity, ""},
    FigureRow{"Position error", "position_error_e_rms_m", "east, RMS", "m", kQuantity, ""},
    FigureRow{"Position error", "position_error_e_p95_m", "east, 95 %", "m", kQuantity, ""},
    FigureRow{"Position error", "position_error_e_max_m", "east, largest", "m", kQuantity, ""},
    FigureRow{"Position error", "position_error_n_rms_m", "north, RMS", "m", kQuantity, ""},
    FigureRow{"Position error", "position_error_n_p95_m", "north, 95 %", "m", kQuantity, ""},
    FigureRow{"Position error", "position_error_n_max_m", "north, largest", "m", kQuantity, ""},
    FigureRow{"Position error", "position_error_up_rms_m", "up, RMS", "m", kQuantity, ""},
    FigureRow{"Position error", "position_error_up_p95_m", "up, 95 %", "m", kQuantity, ""},
    FigureRow{"Position error", "position_error_up_max_m", "up, largest", "m", kQuantity, ""},

    FigureRow{"Attitude error", "attitude_error_roll_rms_deg", "roll, RMS", kDeg, kQuantity, ""},
    FigureRow{"Attitude error", "attitude_error_pitch_rms_deg", "pitch, RMS", kDeg, kQuantity, ""},
    FigureRow{"Attitude error", "attitude_error_yaw_rms_deg", "yaw, RMS", kDeg, kQuantity, ""},

    FigureRow{"Satellites", "fixes_due", "fixes due", "", kCount, ""},
    FigureRow{"Satellites", "fixes_lost", "fixes lost", "", kCount, "due epochs without a solution"},
    FigureRow{"Satellites", "fix_error_rms_m", "fix error, 3-D, RMS", "m", kQuantity,
              "receiver\xE2\x80\x99s fix against truth"},
    FigureRow{"Satellites", "gdop_median", "GDOP, median", "", kQuantity, "over solved epochs"},
    FigureRow{"Satellites", "gdop_max", "GDOP, largest", "", kQuantity, ""},
    FigureRow{"Satellites", "pdop_median", "PDOP, median", "", kQuantity, ""},
    FigureRow{"Satellites", "dop_jumps", "DOP jumps", "", kCount,
              "epoch to epoch |\xCE\x94GDOP| > 2, or between fix and no fix"},
    FigureRow{"Satellites", "satellites_mean", "satellites used, mean", "", kQuantity, ""},
    FigureRow{"Satellites", "nlos_share", "NLOS share", "%", kShare, "tracked satellites whose direct path is blocked"},
    FigureRow{"Satellites", "multipath_share", "multipath share", "%", kShare,
              "tracked satellites received directly and by reflection"},

    FigureRow{"Registration and map", "keyframes", "keyframes", "", kCount, ""},
    FigureRow{"Registration and map", "keyframes_registered", "keyframes registered", "", kCount,
              "aligned with those before; all but the first"},
    FigureRow{"Registration and map", "keyframes_converged", "of them converged", "", kCount, ""},
    FigureRow{"Registration and map", "registration_error_prior_rms_m", "keyframe error, prior, RMS", "m", kQuantity,
              "placed by the filter alone"},
    FigureRow{"Registration and map", "registration_error_rms_m", "keyframe error, registered, RMS", "m", kQuantity,
              ""},
    FigureRow{"Registration and map", "map_error_prior_rms_m", "map error, prior, RMS", "m", kQuantity,
              "map points to the nearest true surface"},
    FigureRow{"Registration and map", "map_error_rms_m", "map error, registered, RMS", "m", kQuantity, ""},
    FigureRow{"Registration and map", "map_error_p95_prior_m", "map error, prior, 95 %", "m", kQuantity, "",
              kMapErrorCap_m},
    FigureRow{"Registration and map", "map_error_p95_m", "map error, registered, 95 %", "m", kQuantity, "",
              kMapErrorCap_m},
    FigureRow{"Registration and map", "map_error_up_prior_rms_m", "map error up, prior, RMS", "m", kQuantity, ""},
    FigureRow{"Registration and map", "map_error_up_rms_m", "map error up, registered, RMS", "m", kQuantity, ""},
    FigureRow{"Registration and map", "map_points", "map points", "", kCount, ""},
    FigureRow{"Registration and map", "map_points_capped_prior", "of them capped, prior", "", kCount, ""},
    FigureRow{"Registration and map", "map_points_capped", "of them capped, registered", "", kCount, ""},

    FigureRow{"Cost", "timing.real_time_factor", "real-time factor", "", kQuantity,
              "simulated seconds per second of wall time"},
    FigureRow{"Cost", "timing.wall_s", "wall time", "s", kQuantity, ""},
    FigureRow{"Cost", "timing.cpu_s", "CPU time", "s", kQuantity, "its parts: see Cost"},
    FigureRow{"Cost", "timing.cpu_per_simulated_s", "CPU time per simulated second", "s", kQuantity,
              "fair also to a run that ended early"},
};

}  // namespace

std::span<const FigureRow> figure_rows() {
  return kRows;
}

namespace {

/// A number that all runs agree on, "2 to 5 m" where they do not, or the words where no run says it.
std::string agreed(const Results& results, double SuccessRules::*rule, std::string (*show)(double),
                   const std::string& unknown) {
  double low = kNaN, high = kNaN;
  for (const Run& run : results.runs) {
    low = std::fmin(low, run.rules.*rule);
    high = std::fmax(high, run.rules.*rule);
  }
  if (!std::isfinite(low)) return unknown;
  return low == high ? show(low) : show(low) + " to " + show(high);
}

/// As it was configured, not as it was measured: 3 m, not 3.00 m.
std::string metres(double v) {
  return fixed(v, 3) + "\xC2\xA0m";
}
std::string seconds(double v) {
  return fixed(v, 3) + "\xC2\xA0s";
}

}  // namespace

std::string figure_meaning(const FigureRow& row, const Results& results) {
  const std::string cap = metres(kMapErrorCap_m);
  if (row.key == "mission_waypoints_reached")
    return "on truth within " + agreed(results, &SuccessRules::waypoint_radius_m, metres, "the radius asked for") +
           ", with a stop of " + agreed(results, &SuccessRules::stop_s, seconds, "the length asked for");
  if (row.key == "map_error_p95_prior_m") return "points farther than " + cap + " from any surface count as " + cap;
  if (row.key == "map_points_capped_prior") return "no true surface nearer than " + cap;
  return std::string(row.meaning);
}

double figure_value(const Run& run, const FigureRow& row) {
  if (row.key == "timing.real_time_factor") return run.real_time_factor;
  if (row.key == "timing.wall_s") return run.wall_s;
  if (row.key == "timing.cpu_s") return run.cpu_s;
  if (row.key == "timing.cpu_per_simulated_s") {
    const double duration_s = run.figure("duration_s");
    return duration_s > 0 ? run.cpu_s / duration_s : kNaN;
  }
  return run.figure(row.key);
}

bool is_known_figure(std::string_view key) {
  for (const FigureRow& row : kRows) {
    if (row.key == key) return true;
  }
  return false;
}

}  // namespace canyon::report
