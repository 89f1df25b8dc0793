#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "canyon/core/motion/true_motion.h"
#include "canyon/fusion/error_state_filter.h"
#include "canyon/inertial/imu_model.h"
#include "canyon/lidar/deskew.h"
#include "canyon/lidar/scanner.h"
#include "canyon/mission/aiding.h"
#include "canyon/mission/autonomy/call_watch.h"
#include "canyon/mission/boundaries.h"
#include "canyon/mission/corridor_guard.h"
#include "canyon/mission/localizer.h"
#include "canyon/mission/mapping/keyframes.h"
#include "canyon/mission/motion/motion_source.h"
#include "canyon/mission/motion/schedule.h"
#include "canyon/mission/run.h"
#include "canyon/mission/told_errors.h"

namespace canyon::mission {

/// Sensors that take the place of others from some moment on. Until then the receiver measures beside the other one, as
/// it has a memory.
struct LaterSensors {
  double from_s = 0.0;
  std::uint64_t noise_seed = 0;
  bool truth_as_pose = false, truth_as_height = false;
  lidar::Deskewing deskewing;
  std::unique_ptr<gnss::GnssSensor> gnss;
  std::unique_ptr<inertial::ImuModel> imu;
  std::unique_ptr<lidar::Scanner> scanner;
};

/// The whole of one run while it happens; step() and perform() read as the order of events.
class MissionRun {
 public:
  static Result<std::unique_ptr<MissionRun>> make(const MissionConfig& config, const PreparedMission& mission,
                                                  RunParts given, PartClock& clock);

  /// One master step: true motion, then what is due within it. False once the run has ended.
  Result<bool> step();
  Result<RunRecord> finish();
  CallWatch& watch() { return watch_; }
  /// After watch().take_over(): the run ends where it is. It must not be destroyed afterwards: the call that never
  /// returned has the autonomy and its watch.
  void abandon_autonomy();
  double elapsed_s() const { return source_->now().motion.t - mission_.start; }

 private:
  struct Parts {
    std::unique_ptr<MotionSource> source;
    std::unique_ptr<gnss::GnssSensor> gnss;
    std::unique_ptr<inertial::ImuModel> imu;
    ImuNoise imu_noise;  ///< that the filter is told
    std::unique_ptr<lidar::Scanner> scanner;
    std::unique_ptr<lidar::Registration> registration;
    std::shared_ptr<const lidar::PreparedCloud> prior_map;
    std::unique_ptr<Autonomy> autonomy;
    bool open_loop = false;
    Recorder* recorder = nullptr;
    Omissions omissions;
    std::unique_ptr<LaterSensors> later;
  };
  MissionRun(const MissionConfig& config, const PreparedMission& mission, Parts parts, PartClock& clock);

  Status perform(const Due& due);
  Status take_imu(const Due& due);
  Status take_odometer(const Due& due);
  Status take_barometer(const Due& due);
  Status take_magnetometer(const Due& due);
  Status take_gnss(const Due& due);
  Status take_scan(const Due& due);
  Status ask_autonomy(const Due& due);
  Status record_epoch(const Due& due);
  bool score();
  void make_autonomy_once();
  /// Has something asked of the autonomy, and what it is asked after every call; nothing once it has failed.
  void ask(const std::function<void()>& call);
  void lose_autonomy(const std::string& why);

  void follow_correction();
  /// To recorder and filter; the counter's name, and the recorder's method for such readings.
  template <class Reading>
  Status hand_on(const Reading& reading, const char* counter, Status (Recorder::*keep)(const Reading&));
  Status use_fix();
  /// What is known of the filter's error at an epoch, to the evidence.
  void compare(const NavRow& row, const Eigen::Vector3d& v_WB_W_true);
  Status record_fix();
  bool scan_is_wanted(GpsTime t) const;
  void fire(const Due& due, lidar::LidarOutput& output);
  std::optional<lidar::KeptRoom> kept_room(const KeptReturns& kept, GpsTime t);
  void forget_motion_before(GpsTime t);
  LidarScan deskew(const LidarScan& scan, const NavEstimate& now) const;
  Status use_scan(const LidarScan& scan);
  Status map_scan(const std::shared_ptr<const LidarScan>& deskewed, const NavEstimate& now);
  RelativePose motion_since_keyframe(GpsTime scan_t, const NavEstimate& now) const;
  Status aid_by_map();
  void count_work();
  void place_traffic(GpsTime t);
  /// Takes what is another from some moment on, once it is there.
  void change_over();
  KinematicState truth_at(GpsTime t) const { return motion_.at(t); }
  /// What is handed on as the estimate at t.
  NavEstimate estimate(GpsTime t) const;
  /// What the autonomy is told of it.
  NavEstimate as_told(NavEstimate estimate) const;

  const MissionConfig config_;
  const PreparedMission& mission_;
  const PriorKnowledge prior_;  ///< of its own: an autonomy that never returns keeps it longer than the caller does
  PartClock& clock_;
  const bool open_loop_;
  lidar::Deskewing deskewing_;
  bool truth_as_pose_, truth_as_height_;
  Boundaries boundaries_;
  scene::SceneAt scene_;
  std::unique_ptr<MotionSource> source_;
  std::unique_ptr<gnss::GnssSensor> gnss_;
  std::unique_ptr<inertial::ImuModel> imu_;
  Aiding aiding_;
  std::unique_ptr<lidar::Scanner> scanner_;
  lidar::LidarOutput fired_;             ///< what it gave last; memory for the next
  std::unique_ptr<LaterSensors> later_;  // null: none, or in use already
  fusion::RunEvidence evidence_;
  Localizer localizer_;
  const Omissions omissions_;
  CorridorGuard corridor_;
  const ToldErrorDraws told_errors_;
  std::unique_ptr<Autonomy> autonomy_;
  CallWatch watch_;
  /// What it said of itself after the last call.
  struct Answers {
    AutonomyState state = AutonomyState::kDriving;
    int next_waypoint = 0;
    bool looks = true;
    std::optional<KeptReturns> keeps;
  };
  Answers answers_;
  bool asked_ = false, autonomy_lost_ = false;
  Scorer scorer_;
  Schedule schedule_;
  Pose X_BL_;
  Recorder nobody_;
  Recorder& recorder_;

  DriveCommand command_;
  TrueMotion motion_;                          // from the last IMU sample or sweep on
  Trajectory true_motion_, estimated_motion_;  // buffers of one revolution, at master steps and at IMU samples
  std::deque<GnssRow> fixes_;                  // measured, and not used yet
  Pose last_keyframe_X_WB_;                    // as estimated then; true with truth_as_guess
  RunRecord record_;
  Keyframes keyframes_;
};

}  // namespace canyon::mission
