#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "canyon/mission/recorder/run_record.h"
#include "canyon/study/results/run_statistics.h"
#include "canyon/study/statistics/interval.h"

namespace canyon::study {

/// The figures of one run, as the table, summary.json and --json give them (docs/results.md). NaN = undefined.
struct RunSummary {
  std::string name, gnss, imu;
  std::string filter;                       ///< the factor's level; empty: the fidelity's own
  std::optional<mission::Outcome> outcome;  ///< none in an open loop
  std::int64_t seed = 0;
  bool open_loop = false;  ///< neither outcome nor waypoints
  bool maps_made = true;   ///< not where a plan left them out
  std::optional<mission::Failure> failure;
  std::vector<mission::WaypointScore> waypoints;
  int waypoints_reached = 0, mission_waypoints_reached = 0;
  int believed_not_reached = 0;  ///< waypoints that the autonomy took for reached
  mission::Encounters::Numbers encounters;
  int needless_lane_departures = 0;
  double duration_s = 0, distance_m = 0;

  ErrorStatistics position_m, east_m, north_m, up_m;
  Interval position_rms_interval_m;  ///< of position_m.rms, by batch means of its square; none where those reach zero
  double roll_rms_deg = kNaN, pitch_rms_deg = kNaN, yaw_rms_deg = kNaN;

  double gdop_median = kNaN, gdop_max = kNaN, pdop_median = kNaN;
  std::optional<int> dop_jumps;  ///< none where the GNSS model knows no satellites
  double satellites_mean = kNaN, nlos_share = kNaN, multipath_share = kNaN, fix_error_rms_m = kNaN;
  int fixes_due = 0, fixes_lost = 0;

  double registration_rms_m = kNaN, registration_prior_rms_m = kNaN;
  std::optional<int> keyframes;                                  ///< none where a plan left them out
  std::optional<int> keyframes_registered, keyframes_converged;  ///< none where nothing is registered
  lidar::MapQuality prior_map, registered_map;

  /// On the run's filter, in words, the worst first; and the numbers behind it, if they are kept.
  std::vector<std::string> verdict;
  std::optional<fusion::VerdictNumbers> evidence;

  std::map<std::string, std::int64_t> counters;
  double wall_s = 0, cpu_s = 0;
  std::vector<std::pair<std::string, double>> cpu_parts_s;
  /// Per kilometre of the way; NaN without one.
  double per_km(int count) const { return distance_m > 0 ? 1000.0 * count / distance_m : kNaN; }
  double cpu_per_simulated_s() const { return duration_s > 0 ? cpu_s / duration_s : kNaN; }
  double real_time_factor() const { return wall_s > 0 ? duration_s / wall_s : kNaN; }
};

Result<RunSummary> summarize(const mission::RunRecord& record, const RunStatistics& statistics);

/// The four runs of a 2 x 2: GNSS and IMU of the first and the second fidelity compared, each with each.
struct TwoByTwo {
  std::string filter;                                    ///< of all four; empty: each fidelity's own
  std::array<std::string, 2> levels;                     ///< the first two fidelities, in the order asked for
  std::array<std::array<const RunSummary*, 2>, 2> runs;  ///< [level of the GNSS][level of the IMU]
};
/// One for each filter, in the order of the runs; none unless all four are among `runs`, which must outlive it.
std::vector<TwoByTwo> two_by_two(const std::vector<RunSummary>& runs);

}  // namespace canyon::study
