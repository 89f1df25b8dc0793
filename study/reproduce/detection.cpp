#include "canyon/study/reproduce/detection.h"

#include <algorithm>
#include <cmath>

#include "canyon/mission/autonomy/reference.h"
#include "canyon/mission/run.h"
#include "canyon/study/reproduce/detections.h"

namespace canyon::study {
namespace {

/// The autonomy of the configuration, and beside it a perception whose grid lies where the pose puts it.
class Watch final : public mission::Autonomy {
 public:
  Watch(const mission::MissionConfig& config, const mission::PreparedMission& mission, const Tape& tape,
        Detections& found)
      : autonomy_(mission::make_autonomy(config.autonomy, mission.prior, mission.start)),
        perception_(made_perception(config.autonomy, mission.prior.vehicle)),
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
    found_.add(held_ranges(perception_->blocked().all(), X_OB.p.head<2>(), yaw_pitch_roll(X_OB.R).yaw_rad),
               true_ranges(scene_, tape_.nodes[node].motion.X_WB));
  }
  bool looks() const override { return true; }
  DriveCommand drive(const NavEstimate& estimate) override { return autonomy_->drive(estimate); }
  mission::AutonomyState state() const override { return autonomy_->state(); }
  int next_waypoint() const override { return autonomy_->next_waypoint(); }

 private:
  /// The autonomy's own, where it has one that is of the table.
  static std::unique_ptr<mission::Perception> made_perception(const mission::AutonomyConfig& autonomy,
                                                              const mission::KnownVehicle& vehicle) {
    ModelChoice<mission::perceptions> choice("ground_grid");
    if (autonomy.model.name == "reference")
      choice = autonomy.model.own.get<mission::ReferenceParameters>().perception.model;
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

}  // namespace

Result<SeenAndPlanned> seen_and_planned(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                                        const Tape& tape) {
  Detections found, with_truth;
  CANYON_TRY(const auto asked, commands_of(config, mission, tape, false, found));
  CANYON_TRY(const auto on_truth, commands_of(config, mission, tape, true, with_truth));
  const CommandDifference difference = command_difference(asked, on_truth, config.vehicle.wheelbase_m);
  return SeenAndPlanned{.phantom_share = found.phantom_share(),
                        .missed_share = found.missed_share(),
                        .range_rms_m = found.range_rms_m(),
                        .steering_rms_deg = difference.steering_rms_deg,
                        .speed_rms_m_s = difference.speed_rms_m_s};
}

}  // namespace canyon::study
