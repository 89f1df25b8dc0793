// Whole short missions on flat streets, with sensors that do not err.
#include <cmath>
#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/lidar/scanner.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/mission/recorder/estimate_error.h"
#include "canyon/mission/recorder/recorder.h"
#include "canyon/mission/run.h"
#include "canyon/mission/stress/open_street.h"
#include "canyon/mission/stress/subjects.h"

namespace canyon::mission {
namespace {

using Eigen::Vector2d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Worst;

struct Rows : Recorder {
  std::vector<NavRow> rows;
  std::vector<TapeNode> nodes;
  std::vector<GnssRow> fixes;
  std::vector<KeyframeRow> keyframes;
  std::vector<ImuSample> samples;
  Status imu(const ImuSample& sample) override {
    samples.push_back(sample);
    return Ok{};
  }
  Status gnss(const GnssRow& row) override {
    fixes.push_back(row);
    return Ok{};
  }
  Status keyframe(const KeyframeRow& row) override {
    keyframes.push_back(row);
    return Ok{};
  }
  Status epoch(const NavRow& row) override {
    rows.push_back(row);
    return Ok{};
  }
  Status node(const TapeNode& node) override {
    nodes.push_back(node);
    return Ok{};
  }
};

struct DrivenMission {
  MissionConfig config;
  PreparedMission mission;
  RunRecord record;
  Rows rows;
};

std::unique_ptr<DrivenMission> driven(const std::string& fidelity, const std::string& more) {
  static SceneCache scenes;
  auto out = std::make_unique<DrivenMission>();
  auto file = MissionFile::parse(kOpenStreet, "open.toml");
  CANYON_CHECK(file.ok(), file.ok() ? "" : file.error().str());
  auto config = file->resolve(fidelity);
  CANYON_CHECK(config.ok(), config.ok() ? "" : config.error().str());
  out->config = *config;
  const auto tree = ConfigNode::parse(more, "more.toml");
  CANYON_CHECK(tree && read_config(&*tree, "", out->config).ok(), more);
  auto mission = prepare(out->config, scenes);
  CANYON_CHECK(mission.ok(), mission.ok() ? "" : mission.error().str());
  out->mission = *std::move(mission);
  auto record =
      run_mission(out->config, out->mission, nullptr, {.tape = nullptr, .recorder = &out->rows, .autonomy = nullptr});
  CANYON_CHECK(record.ok(), record.ok() ? "" : record.error().str());
  out->record = *std::move(record);
  return out;
}

/// With an ideal unit and fixes of a centimetre, which are about as many as there are states, the estimate stays within
/// five of a fix's three axes' sigmas; attitude within what a centimetre over a second's way of 5 m/s turns. The way is
/// the route's but for its ends; each row is the run's own interval after the last one; and the map of flat ground lies
/// on it, as far as height and tilt over 100 m let it.
StressFigure estimate_follows(const std::string& fidelity) {
  const auto drive = driven(fidelity, "");
  Worst worst;
  if (drive->rows.rows.size() < 50 || !drive->record.outcome) return {kInfinity, 1.0};
  worst.look(*drive->record.outcome == Outcome::kSuccess ? 0.0 : kInfinity, 1.0);
  GpsTime before = drive->record.start;
  for (const NavRow& row : drive->rows.rows) {
    const EstimateError error = estimate_error(row);
    worst.look(error.position_W_m.norm(), 5.0 * 0.01 * std::sqrt(3.0));
    worst.look(error.attitude_deg.norm(), 5.0 * 0.01 * std::sqrt(3.0) + 5.0 * 0.01 / 5.0 / kDegree);
    worst.look(row.estimate.t > before ? 0.0 : kInfinity, 1.0);
    before = row.estimate.t;
  }
  const double route_m = drive->mission.prior.route.length_m();
  // It halts within its waypoint's radius, and drives some centimetres beside the centre line.
  worst.look(drive->record.distance_m - route_m, drive->config.success.waypoint_radius_m + 0.02 * route_m);
  worst.look(drive->record.waypoints.at(0).reached ? 0.0 : kInfinity, 1.0);
  worst.look(drive->record.simulated_s - static_cast<double>(drive->rows.nodes.size() - 1) * 0.01, 0.011);
  if (drive->record.prior_quality.points > 0)
    worst.look(drive->record.prior_quality.map_error_rms_m, 5.0 * 0.01 + 100.0 * 5.0 * 0.01 * kDegree);
  return worst.figure();
}

/// The true motion: each node's velocity and rate are those of the poses on either side of it, by central differences
/// over 20 ms. What a jerk of 20 m/s^3 at starts makes of it, j h^2 / 6 and one step's kink of the acceleration.
StressFigure motion_is_smooth() {
  const auto drive = driven("low", "");
  const auto& nodes = drive->rows.nodes;
  if (nodes.size() < 500) return {kInfinity, 1.0};
  Worst worst;
  for (std::size_t k = 1; k + 1 < nodes.size(); ++k) {
    const KinematicState &a = nodes[k - 1].motion, &b = nodes[k].motion, &c = nodes[k + 1].motion;
    worst.look((c.X_WB.p - a.X_WB.p - 0.02 * b.v_WB_W).norm(), 0.01 * 0.01 * 10.0);
    worst.look(so3_log(a.X_WB.R.conjugate() * c.X_WB.R).norm() - 0.02 * b.w_WB_B.norm(), 0.01 * 0.01 * 10.0);
    worst.look((b.t - a.t) - 0.01, 1e-9);
    worst.look(std::hypot(b.v_WB_W.x(), b.v_WB_W.y()) <= drive->config.vehicle.max_speed_m_s + 1e-6 ? 0.0 : kInfinity,
               1.0);
  }
  return worst.figure();
}

/// The same mission once more, the same bits; with another seed other fixes, and the start the same.
StressFigure again() {
  const auto one = driven("low", ""), two = driven("low", ""), other = driven("low", "[run]\nseed = 77");
  int wrong = one->rows.rows.size() == two->rows.rows.size() ? 0 : 1;
  for (std::size_t k = 0; k < std::min(one->rows.rows.size(), two->rows.rows.size()); ++k)
    wrong += one->rows.rows[k].estimate.X_WB.p == two->rows.rows[k].estimate.X_WB.p &&
                     one->rows.rows[k].X_WB_true.p == two->rows.rows[k].X_WB_true.p
                 ? 0
                 : 1;
  wrong += other->rows.rows.size() > 20 && other->rows.rows[20].estimate.X_WB.p != one->rows.rows[20].estimate.X_WB.p &&
                   (other->rows.nodes[0].motion.X_WB.p - one->rows.nodes[0].motion.X_WB.p).norm() == 0.0
               ? 0
               : 1;
  return {1.0 * wrong, 0.0};
}

/// What a run records of each thing at its own time: rows of the true node there, antennas at their lever arm,
/// keyframes where the sensor is and what lies between them, one after another as far as is asked for; as many of each
/// as its rate says. Nodes are at whole hundredths of a second: nothing lies between them.
StressFigure recorded_as_driven() {
  const auto drive =
      driven("low", "[gnss]\nlever_arm_m = [0.4, -0.3, 1.5]\n[lidar]\nmount_yaw_pitch_roll_deg = [20, 2, -1]");
  const Rows& rows = drive->rows;
  const MissionConfig& config = drive->config;
  if (rows.nodes.size() < 500 || rows.fixes.size() < 20 || rows.keyframes.size() < 5) return {kInfinity, 1.0};
  Worst worst;
  const auto right = [&](bool holds) { worst.look(holds ? 0.0 : kInfinity, 1.0); };
  const GpsTime start = drive->record.start;
  const auto node_at = [&](GpsTime t) -> const KinematicState& {
    const auto k = static_cast<std::size_t>(std::lround((t - start) / 0.01));
    return rows.nodes.at(k < rows.nodes.size() ? k : rows.nodes.size() - 1).motion;
  };
  const double seconds = rows.nodes.back().motion.t - start;
  const auto count = [&](std::size_t found, double hz) {
    right(std::abs(static_cast<double>(found) - seconds * hz) <= 1.01);
  };
  count(rows.rows.size(), config.run.epoch_rate_hz), count(rows.fixes.size(), 5.0);
  count(rows.samples.size(), config.imu.rate_hz);
  for (const NavRow& row : rows.rows) {
    const KinematicState& truth = node_at(row.t);
    worst.look((row.X_WB_true.p - truth.X_WB.p).norm(), 1e-9);
    worst.look(row.X_WB_true.R.angularDistance(truth.X_WB.R), 1e-7);
    worst.look(row.true_speed_m_s - std::hypot(truth.v_WB_W.x(), truth.v_WB_W.y()), 1e-9);
    right(row.waypoint == 1 || (row.waypoint == 2 && row.state == AutonomyState::kDone));
  }
  for (const GnssRow& row : rows.fixes) {
    worst.look((row.p_A_W_true - node_at(row.fix.t).X_WB * config.gnss.lever_arm_m).norm(), 1e-9);
    // Six of a centimetre's three axes.
    worst.look((drive->record.frame.to_W(row.fix.p_A_E) - row.p_A_W_true).norm(), 0.06 * std::sqrt(3.0));
    right(!row.withheld && row.update.accepted);
  }
  const Pose X_BL = lidar::sensor_in_body(config.lidar);
  for (std::size_t k = 0; k < rows.keyframes.size(); ++k) {
    const KeyframeRow& row = rows.keyframes[k];
    const Pose X_WL = node_at(row.t).X_WB * X_BL;
    worst.look((row.X_WL_true.p - X_WL.p).norm(), 1e-9), worst.look((row.X_WL_prior.p - X_WL.p).norm(), 0.15);
    right(row.points > 100);
    if (k == 0) continue;
    const Pose between = rows.keyframes[k - 1].X_WL_true.inverse() * row.X_WL_true;
    worst.look((row.X_LL_true.p - between.p).norm(), 1e-9);
    worst.look(row.X_LL_true.R.angularDistance(between.R), 1e-7);
    right(between.p.norm() > config.registration.keyframe_distance_m - 0.3 ||
          between.R.angularDistance(Eigen::Quaterniond::Identity()) >
              (config.registration.keyframe_angle_deg - 1.0) * kDegree);
  }
  return worst.figure();
}

/// The same run with a coupling cut: up to that time it is the same to the bit, from then on no fix reaches the filter,
/// or no scan the map, and neither the other; a height that is added is in every row, and in no other coordinate of the
/// first.
StressFigure couplings_cut() {
  const auto whole = driven("low", ""), fixes = driven("low", "[run]\nwithhold_fixes_after_s = 3.0"),
             scans = driven("low", "[run]\nwithhold_scans_after_s = 3.0"),
             lifted = driven("low", "[run]\nestimate_up_offset_m = 2.5");
  Worst worst;
  const auto right = [&](bool holds) { worst.look(holds ? 0.0 : kInfinity, 1.0); };
  const GpsTime start = whole->record.start;
  const auto same_until = [&](const DrivenMission& other, double seconds) {
    std::size_t k = 0;
    for (; k < whole->rows.rows.size() && whole->rows.rows[k].t - start < seconds - 1e-9; ++k)
      right(k < other.rows.rows.size() && other.rows.rows[k].estimate.X_WB.p == whole->rows.rows[k].estimate.X_WB.p &&
            other.rows.rows[k].X_WB_true.p == whole->rows.rows[k].X_WB_true.p);
    right(k > 10);
  };
  same_until(*fixes, 3.0), same_until(*scans, 3.0);
  int withheld = 0;
  for (const GnssRow& row : fixes->rows.fixes) {
    right(row.withheld == (row.fix.t - start >= 3.0 - 1e-9) && row.update.accepted != row.withheld);
    withheld += row.withheld ? 1 : 0;
  }
  right(withheld > 10 && fixes->rows.keyframes.size() > 4);
  for (const GnssRow& row : scans->rows.fixes) right(!row.withheld);
  std::size_t before = 0;
  for (const KeyframeRow& row : whole->rows.keyframes) before += row.t - start < 3.0 - 1e-9 ? 1 : 0;
  right(scans->rows.keyframes.size() == before && before > 0);
  // A vehicle that is shown nothing any more stands.
  right(scans->rows.rows.back().true_speed_m_s < 0.1 && scans->record.distance_m < whole->record.distance_m - 5.0);
  for (const NavRow& row : lifted->rows.rows) worst.look(row.estimate.X_WB.p.z() - row.X_WB_true.p.z() - 2.5, 0.1);
  const auto &a = lifted->rows.rows.at(0).estimate.X_WB.p, &b = whole->rows.rows.at(0).estimate.X_WB.p;
  worst.look((a - b - Eigen::Vector3d(0, 0, 2.5)).norm(), 1e-12);
  return worst.figure();
}

}  // namespace

std::vector<StressCase> drive_cases() {
  const StressMechanism whole{StressGroup::kData, "a whole short mission with sensors that do not err",
                              "a task at another's time, a lever arm, a stamp, a frame: the estimate lags or leans",
                              "within 5 sigma of a centimetre's fixes; the route's length; a map on flat ground",
                              "of the bound"};
  const StressMechanism smooth{StressGroup::kStiff, "the true motion of a mission", "a rate that is not its poses'",
                               "central differences over two steps, to the start's kink", "of the bound"};
  const StressMechanism same{StressGroup::kLong, "a mission driven again", "a state that outlives a run",
                             "the same bits, and other ones of another seed", "differences"};
  StressRows rows;
  rows.of(whole).add("drives/estimate_follows_at_low", [] { return estimate_follows("low"); });
  rows.of(smooth).add("drives/motion_is_smooth", motion_is_smooth);
  rows.of(same).add("drives/again", again);
  rows.of(whole).add("drives/recorded_as_driven", recorded_as_driven);
  rows.of({StressGroup::kData, "a mission with a coupling cut", "a fix or a scan too many, or the other kind cut too",
           "the same to the bit until then, and from then on without", "of the bound"});
  rows.add("drives/couplings_cut", couplings_cut);
  return rows.take();
}

}  // namespace canyon::mission
