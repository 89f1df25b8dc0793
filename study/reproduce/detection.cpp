#include "canyon/study/reproduce/detection.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/units.h"
#include "canyon/mission/autonomy/perception/perception.h"
#include "canyon/mission/run.h"

namespace canyon::study {
namespace {

constexpr double kReach_m = 20.0;   // a direction in which nothing is nearer is free
constexpr double kSame_m = 1.0;     // a thing held and a thing that stands are one within this
constexpr double kBeside_m = 0.2;   // from a direction to the middle of a cell that lies in it
constexpr double kNearest_m = 3.0;  // the vehicle's own body
constexpr int kDirections = 41;     // 2 degrees apart

double direction_rad(int k) {
  return (2.0 * k - (kDirections - 1)) * kDegree;
}

/// Ranges to the first thing by direction, from B; kReach_m where there is none.
using Ranges = std::vector<double>;

struct Detections {
  int directions = 0, phantoms = 0, things = 0, missed = 0, both = 0;
  double squares_m2 = 0.0;

  void add(const Ranges& held, const Ranges& truly) {
    for (std::size_t k = 0; k < held.size(); ++k) {
      ++directions;
      const bool thing = truly[k] < kReach_m;
      things += thing ? 1 : 0;
      phantoms += held[k] < truly[k] - kSame_m ? 1 : 0;
      missed += thing && held[k] > truly[k] + kSame_m ? 1 : 0;
      if (!thing || held[k] >= kReach_m) continue;
      ++both;
      squares_m2 += std::pow(held[k] - truly[k], 2);
    }
  }
};

Ranges held_by(const mission::Perception& perception, const Eigen::Vector2d& p, double yaw_rad) {
  Ranges out(kDirections, kReach_m);
  for (const Eigen::Vector2d& cell : perception.blocked().all()) {
    const Eigen::Vector2d d = cell - p;
    const double range_m = d.norm();
    if (range_m < kNearest_m || range_m >= kReach_m) continue;
    const double off_rad = std::remainder(std::atan2(d.y(), d.x()) - yaw_rad, 2.0 * kPi);
    for (int k = 0; k < kDirections; ++k) {
      double& nearest = out[static_cast<std::size_t>(k)];
      if (std::abs(off_rad - direction_rad(k)) * range_m < kBeside_m) nearest = std::min(nearest, range_m);
    }
  }
  return out;
}

Ranges true_ranges(const scene::SceneAt& scene, const Pose& X_WB) {
  Ranges out(kDirections, kReach_m);
  const double yaw_rad = yaw_pitch_roll(X_WB.R).yaw_rad;
  for (int k = 0; k < kDirections; ++k) {
    const double at = yaw_rad + direction_rad(k);
    const Eigen::Vector3d direction(std::cos(at), std::sin(at), 0.0);
    double& nearest = out[static_cast<std::size_t>(k)];
    for (const double height_m : {0.6, 1.2, 1.8}) {
      const Eigen::Vector3d from = X_WB.p + kNearest_m * direction + Eigen::Vector3d(0.0, 0.0, height_m);
      const scene::Hit hit = scene.trace({from, direction.cast<float>(), static_cast<float>(kReach_m - kNearest_m)});
      if (!hit.hit() || scene.object(scene.surface(hit.triangle).object).kind == scene::ObjectKind::kTerrain) continue;
      nearest = std::min(nearest, kNearest_m + hit.range_m);
    }
  }
  return out;
}

/// The autonomy of the configuration, and beside it a perception whose grid lies where the pose puts it.
class Watch final : public mission::Autonomy {
 public:
  Watch(const mission::MissionConfig& config, const mission::PreparedMission& mission, const Tape& tape,
        Detections& found)
      : autonomy_(mission::make_autonomy(config.autonomy, mission.prior, mission.start)),
        perception_(made_perception(mission.prior.vehicle)),
        scene_(*mission.scene),
        tape_(tape),
        start_(mission.start),
        found_(found) {}

  void see(const LidarScan& scan, const Pose& X_WL, const NavEstimate& estimate) override {
    autonomy_->see(scan, X_WL, estimate);
    const Pose X_OB{estimate.X_WB.R, {estimate.X_WB.p.x(), estimate.X_WB.p.y(), 0.0}};
    const Pose X_OL{X_WL.R, X_WL.p - estimate.X_WB.p + X_OB.p};
    const double t_s = scan.t - start_;
    if (!perception_->see(scan, X_OL, X_OB, t_s) || t_s < next_s_) return;
    next_s_ = t_s + 1.0;
    const double step_s = tape_.duration_s() / static_cast<double>(tape_.nodes.size() - 1);
    const auto node = std::min(tape_.nodes.size() - 1, static_cast<std::size_t>(std::lround(t_s / step_s)));
    found_.add(held_by(*perception_, X_OB.p.head<2>(), yaw_pitch_roll(X_OB.R).yaw_rad),
               true_ranges(scene_, tape_.nodes[node].motion.X_WB));
  }
  bool looks() const override { return true; }
  DriveCommand drive(const NavEstimate& estimate) override { return autonomy_->drive(estimate); }
  mission::AutonomyState state() const override { return autonomy_->state(); }
  int next_waypoint() const override { return autonomy_->next_waypoint(); }

 private:
  static std::unique_ptr<mission::Perception> made_perception(const mission::KnownVehicle& vehicle) {
    const ModelChoice<mission::perceptions> choice("ground_grid");
    return model_row(mission::perceptions(), choice.name).make(choice.own, vehicle);
  }

  std::unique_ptr<mission::Autonomy> autonomy_;
  std::unique_ptr<mission::Perception> perception_;
  scene::SceneAt scene_;
  const Tape& tape_;
  GpsTime start_;
  Detections& found_;
  double next_s_ = 0.0;
};

/// What was asked for, row by row.
class Commands final : public mission::Recorder {
 public:
  Status epoch(const mission::NavRow& row) override {
    rows_.push_back(row.command);
    return Ok{};
  }
  const std::vector<DriveCommand>& rows() const { return rows_; }

 private:
  std::vector<DriveCommand> rows_;
};

Result<std::vector<DriveCommand>> commands_of(mission::MissionConfig config, const mission::PreparedMission& mission,
                                              const Tape& tape, bool truth, Detections& found) {
  config.run.truth_as_pose = truth;
  config.run.record_tape = false;
  mission::Omissions unread;  // nobody looks at maps
  unread.maps = true;
  unread.keyframes = unread.registration = !mission::takes_registered_poses(config);
  Commands commands;
  mission::RunParts parts;
  parts.tape = &tape;
  parts.recorder = &commands;
  parts.autonomy = std::make_unique<Watch>(config, mission, tape, found);
  parts.omissions = &unread;
  CANYON_TRY_STATUS(mission::run_mission(mission::without(config, unread), mission, nullptr, std::move(parts)));
  return commands.rows();
}

double share(int part, int whole) {
  return whole > 0 ? static_cast<double>(part) / whole : kNaN;
}

}  // namespace

Result<SeenAndPlanned> seen_and_planned(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                                        const Tape& tape) {
  Detections found, with_truth;
  CANYON_TRY(const auto asked, commands_of(config, mission, tape, false, found));
  CANYON_TRY(const auto on_truth, commands_of(config, mission, tape, true, with_truth));
  SeenAndPlanned out;
  out.phantom_share = share(found.phantoms, found.directions);
  out.missed_share = share(found.missed, found.things);
  if (found.both > 0) out.range_rms_m = std::sqrt(found.squares_m2 / found.both);
  const std::size_t rows = std::min(asked.size(), on_truth.size());
  double steering2 = 0.0, speed2 = 0.0;
  const double wheelbase_m = config.vehicle.wheelbase_m;
  for (std::size_t i = 0; i < rows; ++i) {
    const auto angle = [&](const DriveCommand& c) { return std::atan(c.curvature_1_m * wheelbase_m) / kDegree; };
    steering2 += std::pow(angle(asked[i]) - angle(on_truth[i]), 2);
    speed2 += std::pow(asked[i].speed_m_s - on_truth[i].speed_m_s, 2);
  }
  if (rows > 0) {
    out.steering_rms_deg = std::sqrt(steering2 / static_cast<double>(rows));
    out.speed_rms_m_s = std::sqrt(speed2 / static_cast<double>(rows));
  }
  return out;
}

}  // namespace canyon::study
