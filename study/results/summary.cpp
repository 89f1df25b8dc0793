#include "canyon/study/results/summary.h"

#include <algorithm>

namespace canyon::study {

namespace {

std::optional<TwoByTwo> with_filter(const std::string& filter, const std::vector<RunSummary>& runs) {
  const auto pure = [&](const RunSummary& run) { return run.filter == filter && run.gnss == run.imu; };
  const auto first = std::find_if(runs.begin(), runs.end(), pure);
  const auto second =
      std::find_if(first, runs.end(), [&](const RunSummary& run) { return pure(run) && run.gnss != first->gnss; });
  if (second == runs.end()) return std::nullopt;
  TwoByTwo out{filter, {first->gnss, second->gnss}, {}};
  for (std::size_t g = 0; g < 2; ++g)
    for (std::size_t i = 0; i < 2; ++i) {
      const auto found = std::find_if(runs.begin(), runs.end(), [&](const RunSummary& run) {
        return run.filter == filter && run.gnss == out.levels[g] && run.imu == out.levels[i];
      });
      if (found == runs.end()) return std::nullopt;
      out.runs[g][i] = &*found;
    }
  return out;
}

}  // namespace

std::vector<TwoByTwo> two_by_two(const std::vector<RunSummary>& runs) {
  std::vector<TwoByTwo> out;
  std::vector<std::string> seen;
  for (const RunSummary& run : runs) {
    if (std::find(seen.begin(), seen.end(), run.filter) != seen.end()) continue;
    seen.push_back(run.filter);
    if (auto square = with_filter(run.filter, runs)) out.push_back(*std::move(square));
  }
  return out;
}

Result<RunSummary> summarize(const mission::RunRecord& record, const RunStatistics& statistics) {
  RunSummary out;
  out.name = record.name;
  out.seed = record.config.run.seed;
  out.gnss = record.gnss;
  out.imu = record.imu;
  out.filter = record.filter;
  out.outcome = record.outcome;
  out.open_loop = record.open_loop;
  out.failure = record.failure;
  out.waypoints = record.waypoints;
  for (const mission::WaypointScore& waypoint : record.waypoints) {
    out.waypoints_reached += waypoint.reached ? 1 : 0;
    out.mission_waypoints_reached += waypoint.reached && waypoint.mission ? 1 : 0;
    out.believed_not_reached += waypoint.believed && !waypoint.reached ? 1 : 0;
  }
  out.encounters = record.encounters;
  out.needless_lane_departures = record.needless_lane_departures;
  out.duration_s = record.simulated_s;
  out.distance_m = record.distance_m;
  CANYON_TRY_STATUS(statistics.fill(out, record.registers()));
  out.maps_made = record.maps_made;
  if (!record.keyframes_made) out.keyframes.reset();
  out.prior_map = record.prior_quality;
  if (record.registers()) out.registered_map = record.registered_quality;
  out.verdict = fusion::verdict_lines(record.verdict);
  out.evidence = record.verdict;
  out.counters = record.counters;
  out.wall_s = record.wall_s;
  out.cpu_s = record.clock.total_s();
  for (std::size_t part = 0; part < static_cast<std::size_t>(mission::Part::kCount); ++part)
    out.cpu_parts_s.emplace_back(mission::name(static_cast<mission::Part>(part)),
                                 record.clock.cpu_s(static_cast<mission::Part>(part)));
  return out;
}

}  // namespace canyon::study
