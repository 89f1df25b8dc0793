#include "canyon/study/results/summary.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/math/median.h"
#include "canyon/mission/recorder/estimate_error.h"

namespace canyon::study {

ErrorStatistics error_statistics(std::vector<double> x) {
  ErrorStatistics out;
  if (x.empty()) return out;
  double sum = 0.0;
  for (double& v : x) {
    v = std::abs(v);
    sum += v * v;
  }
  std::sort(x.begin(), x.end());
  const auto n = static_cast<double>(x.size());
  out.rms = std::sqrt(sum / n);
  out.p95 = x[static_cast<std::size_t>(std::ceil(0.95 * n)) - 1];
  out.max = x.back();
  return out;
}

namespace {

void summarize_navigation(const mission::RunRecord& record, RunSummary& out) {
  std::vector<double> total, east, north, up, roll, pitch, yaw;
  for (const mission::NavRow& row : record.nav) {
    const mission::EstimateError error = mission::estimate_error(row);
    total.push_back(error.position_W_m.norm());
    east.push_back(error.position_W_m.x());
    north.push_back(error.position_W_m.y());
    up.push_back(error.position_W_m.z());
    roll.push_back(error.attitude_deg.x());
    pitch.push_back(error.attitude_deg.y());
    yaw.push_back(error.attitude_deg.z());
  }
  out.position_m = error_statistics(std::move(total));
  out.east_m = error_statistics(std::move(east));
  out.north_m = error_statistics(std::move(north));
  out.up_m = error_statistics(std::move(up));
  out.roll_rms_deg = error_statistics(std::move(roll)).rms;
  out.pitch_rms_deg = error_statistics(std::move(pitch)).rms;
  out.yaw_rms_deg = error_statistics(std::move(yaw)).rms;
}

void summarize_gnss(const mission::RunRecord& record, const LocalFrame& frame, RunSummary& out) {
  std::vector<double> gdop, pdop, fix_error;
  double satellites = 0.0;
  std::int64_t tracked = 0, nlos = 0, multipath = 0;
  int dop_jumps = 0;
  bool has_dop = false, had_fix = false, first = true;
  double last_gdop = kNaN;
  for (const mission::GnssRow& row : record.gnss_rows) {
    const bool fixed = row.fix.status != FixStatus::kNone;
    ++out.fixes_due;
    if (fixed) {
      fix_error.push_back((frame.to_W(row.fix.p_A_E) - row.p_A_W_true).norm());
      satellites += row.fix.satellites;
    } else {
      ++out.fixes_lost;
    }
    if (fixed && std::isfinite(row.fix.dop.gdop)) {
      gdop.push_back(row.fix.dop.gdop);
      pdop.push_back(row.fix.dop.pdop);
      has_dop = true;
    }
    const bool dop_step = fixed && had_fix && std::abs(row.fix.dop.gdop - last_gdop) > kDopJump;
    if (!first && (fixed != had_fix || dop_step)) ++dop_jumps;
    first = false;
    had_fix = fixed;
    last_gdop = row.fix.dop.gdop;
    for (const GnssObservationTruth& satellite : row.truth.satellites) {
      if (!satellite.tracked) continue;
      ++tracked;
      nlos += satellite.line_of_sight ? 0 : 1;
      multipath += satellite.line_of_sight && satellite.reflections > 0 ? 1 : 0;
    }
  }
  out.gdop_median = median(gdop);
  out.pdop_median = median(std::move(pdop));
  if (has_dop) out.gdop_max = *std::max_element(gdop.begin(), gdop.end());
  if (record.forms_pseudoranges()) {
    out.dop_jumps = dop_jumps;
    if (!fix_error.empty()) out.satellites_mean = satellites / static_cast<double>(fix_error.size());
  }
  if (tracked > 0) {
    out.nlos_share = static_cast<double>(nlos) / static_cast<double>(tracked);
    out.multipath_share = static_cast<double>(multipath) / static_cast<double>(tracked);
  }
  out.fix_error_rms_m = error_statistics(std::move(fix_error)).rms;
}

void summarize_registration(const mission::RunRecord& record, RunSummary& out) {
  std::vector<double> prior, registered;
  int tried = 0, converged = 0;
  for (const mission::KeyframeRow& row : record.keyframes) {
    prior.push_back((row.X_WL_prior.p - row.X_WL_true.p).norm());
    registered.push_back((row.X_WL_registered.p - row.X_WL_true.p).norm());
    tried += row.status ? 1 : 0;
    converged += row.status == lidar::RegistrationStatus::kConverged ? 1 : 0;
  }
  out.keyframes = static_cast<int>(record.keyframes.size());
  out.registration_prior_rms_m = error_statistics(std::move(prior)).rms;
  out.prior_map = record.prior_quality;
  if (!record.registers()) return;
  out.keyframes_registered = tried;
  out.keyframes_converged = converged;
  out.registration_rms_m = error_statistics(std::move(registered)).rms;
  out.registered_map = record.registered_quality;
}

}  // namespace

std::optional<TwoByTwo> two_by_two(const std::vector<RunSummary>& runs) {
  const auto pure = [](const RunSummary& run) { return run.gnss == run.imu; };
  const auto first = std::find_if(runs.begin(), runs.end(), pure);
  const auto second =
      std::find_if(first, runs.end(), [&](const RunSummary& run) { return pure(run) && run.gnss != first->gnss; });
  if (second == runs.end()) return std::nullopt;
  TwoByTwo out{{first->gnss, second->gnss}, {}};
  for (std::size_t g = 0; g < 2; ++g)
    for (std::size_t i = 0; i < 2; ++i) {
      const auto found = std::find_if(runs.begin(), runs.end(), [&](const RunSummary& run) {
        return run.gnss == out.levels[g] && run.imu == out.levels[i];
      });
      if (found == runs.end()) return std::nullopt;
      out.runs[g][i] = &*found;
    }
  return out;
}

RunSummary summarize(const mission::RunRecord& record) {
  RunSummary out;
  out.name = record.name;
  out.gnss = record.gnss;
  out.imu = record.imu;
  out.outcome = record.outcome;
  out.open_loop = record.open_loop;
  out.failure = record.failure;
  out.waypoints = record.waypoints;
  for (const mission::WaypointScore& waypoint : record.waypoints) {
    out.waypoints_reached += waypoint.reached ? 1 : 0;
    out.mission_waypoints_reached += waypoint.reached && waypoint.mission ? 1 : 0;
  }
  out.duration_s = record.simulated_s;
  out.distance_m = record.distance_m;
  summarize_navigation(record, out);
  summarize_gnss(record, record.frame, out);
  summarize_registration(record, out);
  out.counters = record.counters;
  out.wall_s = record.wall_s;
  out.cpu_s = record.clock.total_s();
  for (std::size_t part = 0; part < static_cast<std::size_t>(mission::Part::kCount); ++part)
    out.cpu_parts_s.emplace_back(mission::name(static_cast<mission::Part>(part)),
                                 record.clock.cpu_s(static_cast<mission::Part>(part)));
  return out;
}

}  // namespace canyon::study
