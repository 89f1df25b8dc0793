// Whole runs as those hear them who take part: what comes when, in what order, and what they are told.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/fusion/verdict/run_evidence.h"
#include "canyon/lidar/scanner.h"
#include "canyon/mission/stress/runs/heard_run.h"
#include "canyon/mission/stress/runs/subjects.h"

namespace canyon::mission {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Looks;

/// Straight on, or in a bend.
HeardRun::Says driving_at(double speed_m_s, double curvature_1_m) {
  return {.drives = [=](int) { return DriveCommand{.speed_m_s = speed_m_s, .curvature_1_m = curvature_1_m}; }};
}

const KinematicState& node_of(const HeardRun& run, GpsTime t) {
  const auto k = static_cast<std::size_t>((t.ns - run.record.start.ns + 5'000'000) / 10'000'000);
  return run.nodes.at(k).motion;
}

/// Each task at its own ticks, as often as its rate says; at equal times IMU, odometer, barometer, magnetometer, fix,
/// scan, question, row. What falls between two samples of the IMU waits for the next one and comes then, in turn, but
/// for questions, which are answered at once on the last estimate. A scan comes first when all of it was fired after
/// the start. Exact.
StressFigure in_order(double latency_s) {
  const double lidar_hz = 10.0;
  const std::string keys =
      "[time]\nlimit_s = 2\n[run]\nepoch_rate_hz = 13\n[imu]\nrate_hz = 100\n[gnss]\nrate_hz = 7\n[autonomy]\n"
      "rate_hz = 33\n[odometer]\nrate_hz = 23\n[barometer]\nrate_hz = 9\n[magnetometer]\nrate_hz = 20\n"
      "[fusion]\nmeasurements = [\"position\", \"odometer\", \"barometer\", \"magnetometer\"]\n[lidar]\nlatency_s = " +
      stress::text(latency_s) + "\n";
  const auto run = heard_run(keys, driving_at(3.0, 0.0));
  const std::vector<std::pair<Heard, double>> rates_hz = {
      {Heard::kImu, 100.0}, {Heard::kOdometer, 23.0}, {Heard::kBarometer, 9.0}, {Heard::kMagnetometer, 20.0},
      {Heard::kFix, 7.0},   {Heard::kSeen, lidar_hz}, {Heard::kAsked, 33.0},    {Heard::kEpoch, 13.0}};
  struct Tick {
    std::int64_t ns;
    std::size_t task;
  };
  std::vector<Tick> ticks;
  for (std::size_t i = 0; i < rates_hz.size(); ++i)
    for (int k = 1; k <= static_cast<int>(std::floor(2.0 * rates_hz[i].second + 1e-9)); ++k)
      ticks.push_back({std::llround(1e9 * k / rates_hz[i].second), i});
  std::stable_sort(ticks.begin(), ticks.end(),
                   [](const Tick& a, const Tick& b) { return a.ns != b.ns ? a.ns < b.ns : a.task < b.task; });
  std::vector<std::pair<Heard, std::int64_t>> expected;
  std::deque<std::pair<Heard, std::int64_t>> waiting;
  std::int64_t last_imu = 0;
  for (const Tick& tick : ticks) {
    const Heard what = rates_hz[tick.task].first;
    const auto comes = [&](Heard of) {
      if (tick.ns == last_imu) {
        expected.emplace_back(of, tick.ns);
      } else {
        waiting.emplace_back(of, tick.ns);
      }
    };
    if (what == Heard::kImu) {
      last_imu = tick.ns;
      expected.emplace_back(what, tick.ns);
      for (; !waiting.empty(); waiting.pop_front()) expected.push_back(waiting.front());
    } else if (what == Heard::kOdometer) {
      expected.emplace_back(what, tick.ns), comes(Heard::kCounted);
    } else if (what == Heard::kBarometer || what == Heard::kMagnetometer) {
      expected.emplace_back(what, tick.ns);
    } else if (what == Heard::kAsked) {
      expected.emplace_back(what, last_imu);
    } else if (what != Heard::kSeen || 1e-9 * static_cast<double>(tick.ns) >= 1.0 / lidar_hz + latency_s - 1e-9) {
      comes(what);
    }
  }
  StressFigure out;
  out.figure += run->events.size() == expected.size() ? 0.0 : 1.0;
  for (std::size_t k = 0; k < std::min(run->events.size(), expected.size()); ++k) {
    const HeardEvent& found = run->events[k];
    const bool same = found.what == expected[k].first && found.t.ns - run->record.start.ns == expected[k].second;
    out.figure += same ? 0.0 : 1.0;
  }
  const auto counted = [&](const char* name, Heard what) {
    const auto n = std::count_if(expected.begin(), expected.end(), [&](const auto& e) { return e.first == what; });
    out.figure += run->record.counters.at(name) == n ? 0.0 : 1.0;
  };
  counted("imu_samples", Heard::kImu), counted("odometer_samples", Heard::kOdometer);
  counted("barometer_samples", Heard::kBarometer), counted("magnetometer_samples", Heard::kMagnetometer);
  counted("gnss_epochs", Heard::kFix), counted("lidar_scans", Heard::kSeen);
  return out;
}

/// Between two samples of the IMU the estimate is where its velocity brings it, and so is what is told of a scan. With
/// fixes of 0.1 mm it is the truth to five of their three axes' sigmas, and half of 3 m/s^2 over 10 ms squared; the
/// truth between nodes by their chord, an eighth of that.
StressFigure between_samples() {
  Looks looks;
  const auto run = heard_run(
      "[time]\nlimit_s = 2\n[run]\ninitial_attitude_error_deg = [0, 0, 0]\n[imu]\nrate_hz = 50\n[gnss]\nrate_hz = 9\n"
      "white_sigma_m = 1e-4\nwhite_sigma_up_m = 1e-4\nlever_arm_m = [0.4, -0.3, 1.5]\n[autonomy]\nrate_hz = 64\n"
      "[fusion]\ninitial_position_sigma_m = 1e-4\ninitial_velocity_sigma_m_s = 1e-3\n"
      "[lidar]\nmount_m = [0.4, 0.2, 1.7]\nmount_yaw_pitch_roll_deg = [20, 3, -2]\n",
      driving_at(4.0, 0.02));
  const double estimated_m = 5.0 * std::sqrt(3.0) * 1e-4, pushed_m = 0.5 * 3.0 * 0.02 * 0.02;
  looks.right(run->asked.size() == 128 && run->scans.size() == 20);
  for (std::size_t k = 0; k < run->asked.size(); ++k) {
    const std::int64_t ns = std::llround(1e9 * static_cast<double>(k + 1) / 64.0);
    const auto at = static_cast<std::size_t>(ns / 10'000'000);
    const double share = static_cast<double>(ns - static_cast<std::int64_t>(at) * 10'000'000) / 1e7;
    const Vector3d a = run->nodes.at(at).motion.X_WB.p, b = run->nodes.at(share > 0.0 ? at + 1 : at).motion.X_WB.p;
    looks.near((run->asked[k].X_WB.p - (a + share * (b - a))).norm(), 0.0, estimated_m + 1.25 * pushed_m);
  }
  const Pose X_BL = lidar::sensor_in_body(run->config.lidar);
  for (std::size_t k = 0; k < run->scans.size(); ++k) {
    const Pose X_WL = run->seen[k].X_WB * X_BL;
    looks.near((run->seen_from[k].p - X_WL.p).norm() + run->seen_from[k].R.angularDistance(X_WL.R), 0.0, 1e-7);
    looks.near((run->seen[k].X_WB.p - node_of(*run, run->scans[k].t).X_WB.p).norm(), 0.0, estimated_m);
    looks.right(run->scans[k].points.size() > 200);
    // Deskewed onto level ground, on which the vehicle stands: single precision of 100 m, a chord's height of the turn,
    // and how the body leans.
    double highest = -kInfinity;
    for (const LidarPoint& p : run->scans[k].points)
      highest = worse(highest, (run->seen_from[k] *
                                Vector3d(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)))
                                   .z());
    looks.near(highest - node_of(*run, run->scans[k].t).X_WB.p.z(), 0.0, 0.2);
  }
  for (const GnssRow& row : run->fixes) {
    if (row.fix.t.ns % 10'000'000 != run->record.start.ns % 10'000'000) continue;
    const KinematicState& truth = node_of(*run, row.fix.t);
    const Eigen::Matrix3d R = truth.X_WB.R.toRotationMatrix();
    const Vector3d lever(0.4, -0.3, 1.5), v = truth.v_WB_W + R * truth.w_WB_B.cross(lever);
    looks.near((run->record.frame.R_EW().transpose() * row.truth.v_A_E - v).norm(), 0.0, 1e-9);
    looks.right(truth.w_WB_B.norm() > 0.01 || truth.t - run->record.start < 1.0);
  }
  return looks.figure();
}

/// On true poses errors are laid over what the autonomy is told: a drift in one direction, steps each in another from
/// the first on, and a heading clockwise; velocities and rows know nothing of them. Roundings of 300 m.
StressFigure told_runs() {
  Looks looks;
  const auto run = heard_run(
      "[time]\nlimit_s = 2\n[run]\ntruth_as_pose = true\ntold_step_m = 2\ntold_step_every_s = 0.7\n"
      "told_drift_m_s = 0.3\ntold_heading_deg = 20\n[gnss]\nwhite_sigma_m = 0.01\n[autonomy]\nrate_hz = 100\n",
      driving_at(3.0, 0.03));
  const double rounded = 64.0 * kEpsilon * 300.0;
  looks.right(run->asked.size() == 200);
  Vector3d drift = Vector3d::Zero(), step = Vector3d::Zero();
  const Eigen::Quaterniond clockwise(Eigen::AngleAxisd(-20.0 * kPi / 180.0, Vector3d::UnitZ()));
  const auto told = [&](const NavEstimate& estimate, std::size_t k) {
    const KinematicState& truth = run->nodes.at(k).motion;
    const double t = 0.01 * static_cast<double>(k);
    looks.right(estimate.t == truth.t);
    looks.near((estimate.v_WB_W - truth.v_WB_W).norm(), 0.0, rounded);
    looks.near(estimate.X_WB.R.angularDistance(clockwise * truth.X_WB.R), 0.0, 1e-7);
    return std::pair<double, Vector3d>(t, estimate.X_WB.p - truth.X_WB.p);
  };
  int steps = 0;
  for (std::size_t k = 1; k <= run->asked.size(); ++k) {
    const auto [t, off] = told(run->asked[k - 1], k);
    looks.near(off.z(), 0.0, rounded);
    if (k == 1) drift = off / t, looks.near(drift.norm(), 0.3, 1e3 * rounded);
    if (k < 70) {
      looks.near((off - t * drift).norm(), 0.0, 200.0 * rounded);
      continue;
    }
    const Vector3d now = off - t * drift;
    looks.near(now.norm(), 2.0, 200.0 * rounded);
    if (k == 70 || k == 140) looks.right((now - step).norm() > 1e-3), step = now, ++steps;
    looks.near((now - step).norm(), 0.0, 400.0 * rounded);
  }
  looks.right(steps == 2);
  for (std::size_t k = 0; k < run->seen.size(); ++k) {
    const auto [t, off] = told(run->seen[k], 10 * (k + 1));
    looks.near((off - t * drift).norm(), t < 0.695 ? 0.0 : 2.0, 200.0 * rounded);
  }
  for (const NavRow& row : run->rows)
    looks.near((row.estimate.X_WB.p - row.X_WB_true.p).norm(), 0.0, 5.0 * std::sqrt(3.0) * 0.02);
  return looks.figure();
}

/// Heights alone are true, and an offset is in what is told as in rows, in which the filter's own height stays.
StressFigure told_heights() {
  Looks looks;
  const auto run = heard_run(
      "[time]\nlimit_s = 1\n[run]\ntruth_as_height = true\nestimate_up_offset_m = 0.75\n[gnss]\nwhite_sigma_up_m = 5\n"
      "[fusion]\ninitial_position_sigma_m = 5\n[autonomy]\nrate_hz = 100\n",
      driving_at(3.0, 0.0));
  for (std::size_t k = 1; k <= run->asked.size(); ++k)
    looks.near(run->asked[k - 1].X_WB.p.z() - run->nodes.at(k).motion.X_WB.p.z(), 0.75, 64.0 * kEpsilon * 300.0);
  looks.right(run->asked.size() == 100);
  double off_m = 0.0;
  for (const NavRow& row : run->rows) off_m += std::abs(row.estimate.X_WB.p.z() - row.X_WB_true.p.z() - 0.75);
  looks.right(off_m > 0.1);
  return looks.figure();
}

/// Rows: the command that was asked for last, the waypoint headed for, where it starts; and the verdict's numbers, made
/// again of the rows: errors by axis with the covariance turned into east, north and up, fixes against where the
/// antenna was. Rounding of places on Earth, 1e-9 m, of errors of centimetres and more.
StressFigure rows_and_verdict() {
  Looks looks;
  HeardRun::Says says;
  says.drives = [](int n) { return DriveCommand{.speed_m_s = 2.0 + 0.01 * n, .curvature_1_m = 0.02}; };
  says.next_waypoint = 1;
  const auto run = heard_run(
      "[time]\nlimit_s = 3\n[run]\nepoch_rate_hz = 10\ninitial_attitude_error_deg = [0.3, 0.2, 2]\n[gnss]\n"
      "white_sigma_m = 0.4\nwhite_sigma_up_m = 0.8\n[fusion]\ninitial_position_sigma_m = 0.3\n"
      "initial_attitude_sigma_deg_heading = 2\n[autonomy]\nrate_hz = 20\n",
      says);
  looks.right(run->rows.size() == 30 && run->given.size() == 60);
  fusion::RunEvidence again;
  for (std::size_t k = 0; k < run->rows.size(); ++k) {
    const NavRow& row = run->rows[k];
    looks.near(row.command.speed_m_s, run->given[2 * k + 1].speed_m_s, 1e-12);
    looks.right(row.waypoint == 2 && row.state == AutonomyState::kDriving);
    const KinematicState& truth = node_of(*run, row.t);
    const Eigen::Matrix3d R = row.estimate.X_WB.R.toRotationMatrix();
    const Eigen::Matrix3d P = row.estimate.pose_covariance.bottomRightCorner<3, 3>();
    again.error(row.t, {.attitude_rad = so3_log(truth.X_WB.R.conjugate() * row.estimate.X_WB.R),
                        .attitude_covariance = row.estimate.pose_covariance.topLeftCorner<3, 3>(),
                        .position_enu_m = row.estimate.X_WB.p - truth.X_WB.p,
                        .position_covariance = R * P * R.transpose(),
                        .velocity_enu_m_s = row.estimate.v_WB_W - truth.v_WB_W,
                        .velocity_covariance = row.estimate.velocity_covariance_W});
  }
  const auto &found = run->record.verdict.axes, expected = again.numbers().axes;
  looks.right(found.size() == expected.size() && found.size() >= 9);
  for (std::size_t i = 0; i < std::min(found.size(), expected.size()); ++i) {
    looks.near(found[i].rms / expected[i].rms, 1.0, 1e-6);
    looks.near(found[i].claimed / expected[i].claimed, 1.0, 1e-9);
  }
  double squares = 0.0;
  for (const GnssRow& row : run->fixes)
    squares += (row.fix.p_A_E - run->record.frame.to_E(row.p_A_W_true)).squaredNorm();
  const double count = 3.0 * static_cast<double>(run->fixes.size());
  looks.right(run->record.verdict.fixes.has_value() && run->fixes.size() == 15);
  if (run->record.verdict.fixes) {
    looks.near(run->record.verdict.fixes->rms_m / std::sqrt(squares / count), 1.0, 1e-7);
    looks.near(run->record.verdict.fixes->claimed_m, std::sqrt((2.0 * 0.16 + 0.64) / 3.0), 1e-9);
  }
  // The start's attitude is off by the draw of its own stream.
  const Vector3d sigma_deg(0.3, 0.2, 2.0);
  const RandomStream draws(static_cast<std::uint64_t>(run->config.run.seed), "mission.initial_attitude");
  const Vector3d off = draws.normal3(0).cwiseProduct(sigma_deg) * (kPi / 180.0);
  looks.near((so3_log(run->nodes[0].motion.X_WB.R.conjugate() * run->record.initial_X_WB.R) - off).norm(), 0.0, 1e-14);
  looks.near(run->record.simulated_s, 3.0, 1e-9), looks.right(run->nodes.size() == 301);
  looks.near(run->record.distance_m, run->nodes.back().distance_m, 1e-12);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> heard_run_cases() {
  StressRows rows;
  rows.of(
      {StressGroup::kStiff, "what comes when in a run, at rates that do not fit",
       "a reading used before the filter is there, a task of equal times out of turn, a scan begun before the start",
       "the list of all events, written out: exact", "events"});
  for (const double latency_s : {0.0, 0.05})
    rows.add("heard/in_order_at_latency_" + stress::text(latency_s) + "_s", [=] { return in_order(latency_s); });
  rows.of({.group = StressGroup::kData,
           .mechanism = "what those who take part in a run are told",
           .why = "an estimate of another time, an error laid over the wrong pose, a covariance in another frame",
           .expected = "the truth at that time, closed forms of what is laid over it, numbers made again of rows",
           .unit = "of the bound",
           .loose = "some bounds are those of roundings of the farthest place"});
  rows.add("heard/between_samples", between_samples)
      .add("heard/told_errors", told_runs)
      .add("heard/told_heights", told_heights)
      .add("heard/rows_and_verdict", rows_and_verdict);
  return rows.take();
}

}  // namespace canyon::mission
