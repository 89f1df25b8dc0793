// Whole short missions on flat streets, with sensors that do not err.
#include <cmath>
#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/mission/recorder/estimate_error.h"
#include "canyon/mission/recorder/recorder.h"
#include "canyon/mission/run.h"
#include "canyon/mission/stress/subjects.h"

namespace canyon::mission {
namespace {

using Eigen::Vector2d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Worst;

/// Up a street of the built-in city whose houses are left out, and round a corner of it.
constexpr const char* kMission = R"(
base = "vicksburg"
[run]
name = "open"
[scene]
empty = true
slope_percent = 0
hill_height_m = 0
terrain_cell_m = 10
[vehicle]
start_m = [213.9, 60.0]
start_heading_deg = 0.0
roughness = "none"
[imu]
errors = "none"
mounting_error_deg = 0
[gnss]
model = "truth_plus_white"
white_sigma_m = 0.01
white_sigma_up_m = 0.01
rate_hz = 5
[lidar]
azimuth_steps = 180
range_noise_m = 0
[fusion]
initial_position_sigma_m = 0.01
initial_velocity_sigma_m_s = 0.01
initial_attitude_sigma_deg_roll_pitch = 0.01
initial_attitude_sigma_deg_heading = 0.01
[registration]
method = "none"
[autonomy]
[[autonomy.waypoint]]
name = "crossing"
p_m = [213.9, 109.9]
)";

struct Rows : Recorder {
  std::vector<NavRow> rows;
  std::vector<TapeNode> nodes;
  Status epoch(const NavRow& row) override {
    rows.push_back(row);
    return Ok{};
  }
  Status node(const TapeNode& node) override {
    nodes.push_back(node);
    return Ok{};
  }
};

struct Driven {
  MissionConfig config;
  PreparedMission mission;
  RunRecord record;
  Rows rows;
};

std::unique_ptr<Driven> driven(const std::string& fidelity, const std::string& more) {
  static SceneCache scenes;
  auto out = std::make_unique<Driven>();
  auto file = MissionFile::parse(kMission, "open.toml");
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
  return rows.take();
}

}  // namespace canyon::mission
