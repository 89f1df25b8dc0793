#include "canyon/mission/run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <functional>
#include <string>

#include "canyon/core/motion/true_motion.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/lidar/deskew.h"
#include "canyon/lidar/registration/voxel_map.h"
#include "canyon/mission/boundaries.h"
#include "canyon/mission/mapper.h"
#include "canyon/mission/motion/motion_source.h"
#include "canyon/mission/motion/schedule.h"

namespace canyon::mission {

namespace {

/// Takes the first share (0 to 1) of an IMU sample off it: rate and force count as constant over the sample.
ImuSample take_share(ImuSample& sample, double share) {
  ImuSample first = sample;
  first.dt_s *= share;
  first.dtheta_U *= share;
  first.dv_U *= share;
  sample.dt_s -= first.dt_s;
  sample.dtheta_U -= first.dtheta_U;
  sample.dv_U -= first.dv_U;
  first.t = sample.t - sample.dt_s;
  return first;
}

/// The whole of one run while it happens; step() and perform() read as the order of events.
class MissionRun {
 public:
  static Result<std::unique_ptr<MissionRun>> make(const MissionConfig& config, const PreparedMission& mission,
                                                  RunParts given, PartClock& clock);

  /// One master step: true motion, then what is due within it. False once the run has ended.
  Result<bool> step();
  Result<RunRecord> finish();
  double elapsed_s() const { return source_->now().motion.t - mission_.start; }

 private:
  struct Parts {
    std::unique_ptr<MotionSource> source;
    std::unique_ptr<gnss::GnssSensor> gnss;
    std::unique_ptr<inertial::ImuModel> imu;
    ImuNoise imu_noise;  ///< that the filter is told
    std::unique_ptr<lidar::Scanner> scanner;
    std::unique_ptr<lidar::Registration> registration;
    std::unique_ptr<Autonomy> autonomy;
    bool open_loop = false;
  };
  MissionRun(const MissionConfig& config, const PreparedMission& mission, Parts parts, PartClock& clock);

  Status perform(const Due& due);
  Status take_imu(const Due& due);
  Status take_gnss(const Due& due);
  Status take_scan(const Due& due);
  Status ask_autonomy(const Due& due);
  Status record_epoch(const Due& due);
  bool score();

  /// Does `work` once the filter has come to t: at once, or within the IMU sample that covers t, which is then divided.
  Status once_filter_is_at(GpsTime t, std::function<Status()> work);
  Status predict(const ImuSample& sample, GpsTime t);
  Status use_fix(std::size_t row);
  Status use_scan(const LidarScan& scan);
  void add_keyframe(const LidarScan& deskewed, const Keyframe& keyframe, const Pose& X_WB_true);
  void place_traffic(GpsTime t);
  KinematicState truth_at(GpsTime t) const { return motion_.at(t); }
  /// What is handed on as the estimate at t.
  NavEstimate estimate(GpsTime t) const;
  NavEstimate with_correction(NavEstimate estimate) const;

  const MissionConfig config_;
  const PreparedMission& mission_;
  PartClock& clock_;
  const bool open_loop_;
  Boundaries boundaries_;
  scene::SceneAt scene_;
  std::unique_ptr<MotionSource> source_;
  std::unique_ptr<gnss::GnssSensor> gnss_;
  std::unique_ptr<inertial::ImuModel> imu_;
  std::unique_ptr<lidar::Scanner> scanner_;
  fusion::ErrorStateFilter filter_;
  Mapper mapper_;
  std::unique_ptr<Autonomy> autonomy_;
  Scorer scorer_;
  Schedule schedule_;
  Pose X_BL_;

  DriveCommand command_;
  TrueMotion motion_;                          // from the last IMU sample or sweep on
  Trajectory true_motion_, estimated_motion_;  // buffers of one revolution, at master steps and at IMU samples
  GpsTime filter_at_;  ///< time of the last IMU sample, or of the part of one, that it has taken in
  struct Waiting {
    GpsTime t;
    std::function<Status()> work;
  };
  std::deque<Waiting> waiting_;  // for the filter to come to t
  lidar::VoxelMap prior_map_, registered_map_;
  RunRecord record_;
};

MissionRun::MissionRun(const MissionConfig& config, const PreparedMission& mission, Parts parts, PartClock& clock)
    : config_(config),
      mission_(mission),
      clock_(clock),
      open_loop_(parts.open_loop),
      boundaries_(mission.start),
      scene_(*mission.scene),
      source_(std::move(parts.source)),
      gnss_(std::move(parts.gnss)),
      imu_(std::move(parts.imu)),
      scanner_(std::move(parts.scanner)),
      filter_(config.fusion, parts.imu_noise, mission.scene->frame(), config.imu.lever_arm_m, config.gnss.lever_arm_m),
      mapper_(config.registration, std::move(parts.registration), lidar::sensor_in_body(config.lidar)),
      autonomy_(std::move(parts.autonomy)),
      scorer_(config, mission, scene_),
      schedule_(mission.start, {config.imu.rate_hz, config.gnss.rate_hz, config.lidar.rate_hz, config.autonomy.rate_hz,
                                config.run.epoch_rate_hz}),
      X_BL_(lidar::sensor_in_body(config.lidar)),
      filter_at_(mission.start),
      prior_map_(config.run.map_leaf_m),
      registered_map_(config.run.map_leaf_m) {
  record_.config = config;
  record_.files = mission.files;
  record_.frame = mission.scene->frame();
  record_.start = mission.start;
  record_.open_loop = open_loop_;

  // The filter starts at the truth, but for its attitude: the seeded error of the alignment.
  const KinematicState& truth = source_->now().motion;
  const RandomStream stream(static_cast<std::uint64_t>(config.run.seed), "mission.initial_attitude");
  const Eigen::Vector3d error = stream.normal3(0).cwiseProduct(config.run.initial_attitude_error_deg) * kDegree;
  Pose start = truth.X_WB;
  start.R = (start.R * so3_exp(error)).normalized();
  filter_.initialize(mission.start, start, truth.v_WB_W);
  motion_.append(truth);
  true_motion_.append({mission.start, truth.X_WB});
  estimated_motion_.append({mission.start, estimate(mission.start).X_WB});
  record_.tape.push_back(source_->now());
}

Result<std::unique_ptr<MissionRun>> MissionRun::make(const MissionConfig& config, const PreparedMission& mission,
                                                     RunParts given, PartClock& clock) {
  const Tape* tape = given.tape;
  const auto seed = static_cast<std::uint64_t>(config.run.seed);
  const GpsTime end = mission.start + (tape != nullptr ? tape->duration_s() : mission.time_limit_s);
  Parts parts;
  parts.source = tape != nullptr ? make_taped_motion(*tape, mission.start)
                                 : make_driven_motion(config.vehicle, *mission.scene, seed, mission.start);
  CANYON_TRY(parts.gnss, gnss::make_gnss_sensor(config.gnss, seed, mission.start, end, *mission.scene));
  CANYON_TRY(parts.imu, inertial::make_imu(config.imu, seed, mission.scene->frame()));
  CANYON_TRY(parts.imu_noise, noise_told_to_filter(config));
  CANYON_TRY(parts.scanner, lidar::make_scanner(config.lidar, seed));
  CANYON_TRY(parts.registration, lidar::make_registration(config.registration));
  parts.autonomy =
      given.autonomy ? std::move(given.autonomy) : make_autonomy(config.autonomy, mission.prior, mission.start);
  parts.open_loop = tape != nullptr;
  return std::unique_ptr<MissionRun>(new MissionRun(config, mission, std::move(parts), clock));
}

NavEstimate MissionRun::estimate(GpsTime t) const {
  NavEstimate estimate = filter_.estimate();
  estimate.X_WB.p += (t - filter_at_) * estimate.v_WB_W;  // between two IMU samples
  if (config_.run.truth_as_pose) {
    const KinematicState truth = truth_at(t);
    estimate.t = t;
    estimate.X_WB = truth.X_WB;
    estimate.v_WB_W = truth.v_WB_W;
  }
  estimate.X_WB.p.z() += config_.run.estimate_up_offset_m;
  return estimate;
}

NavEstimate MissionRun::with_correction(NavEstimate estimate) const {
  if (config_.autonomy.map == "registered") estimate.X_WB = mapper_.correction() * estimate.X_WB;
  return estimate;
}

void MissionRun::place_traffic(GpsTime t) {
  if (!mission_.traffic.empty()) scene_.set_instances(mission_.traffic.at(t - mission_.start));
}

Result<bool> MissionRun::step() {
  const TapeNode& node = clock_.charge(Part::kVehicle, [&]() -> const TapeNode& { return source_->advance(command_); });
  CANYON_TRY_STATUS(boundaries_.check(node.motion));
  motion_.append(node.motion);
  true_motion_.append({node.motion.t, node.motion.X_WB});
  if (config_.run.record_tape) record_.tape.push_back(node);
  while (const auto due = schedule_.next(node.motion.t)) {
    place_traffic(due->t);
    CANYON_TRY_STATUS(perform(*due));
    if (scorer_.failure()) return false;  // the autonomy's fault
  }
  place_traffic(node.motion.t);
  return score();
}

Status MissionRun::perform(const Due& due) {
  switch (due.task) {
    case Task::kImu:
      return take_imu(due);
    case Task::kGnss:
      return take_gnss(due);
    case Task::kLidar:
      return take_scan(due);
    case Task::kAutonomy:
      return ask_autonomy(due);
    case Task::kEpoch:
      return record_epoch(due);
    case Task::kCount:
      break;
  }
  return Ok{};
}

Status MissionRun::take_imu(const Due& due) {
  ImuSample rest = clock_.charge(Part::kImu, [&] { return imu_->sample(due.k, motion_, filter_at_, due.t); });
  CANYON_TRY_STATUS(boundaries_.check(rest));
  ++record_.counters["imu_samples"];
  while (!waiting_.empty()) {
    const Waiting next = std::move(waiting_.front());
    waiting_.pop_front();
    if (next.t > filter_at_)
      CANYON_TRY_STATUS(predict(take_share(rest, (next.t - filter_at_) / (due.t - filter_at_)), next.t));
    CANYON_TRY_STATUS(next.work());
  }
  CANYON_TRY_STATUS(predict(rest, due.t));
  motion_.forget_before(due.t);
  estimated_motion_.append({due.t, estimate(due.t).X_WB});
  return Ok{};
}

Status MissionRun::predict(const ImuSample& sample, GpsTime t) {
  clock_.charge(Part::kFilter, [&] { filter_.predict(sample); });
  filter_at_ = t;
  return boundaries_.check(filter_.estimate());
}

Status MissionRun::once_filter_is_at(GpsTime t, std::function<Status()> work) {
  if (filter_at_ == t) return work();
  waiting_.push_back({t, std::move(work)});
  return Ok{};
}

Status MissionRun::take_gnss(const Due& due) {
  const KinematicState truth = truth_at(due.t);
  const Eigen::Vector3d lever = config_.gnss.lever_arm_m;
  const Eigen::Vector3d p_A_W = truth.X_WB * lever;
  const Eigen::Vector3d v_A_W = truth.v_WB_W + truth.X_WB.R * truth.w_WB_B.cross(lever);
  gnss::GnssOutput output =
      clock_.charge(Part::kGnss, [&] { return gnss_->measure(due.k, truth.t, p_A_W, v_A_W, scene_); });
  CANYON_TRY_STATUS(boundaries_.check(output));

  GnssRow row;
  row.fix = output.fix;
  row.p_A_W_true = p_A_W;
  const double withhold = config_.run.withhold_fixes_after_s;
  row.withheld = withhold >= 0.0 && truth.t - mission_.start >= withhold;
  for (const GnssObservationTruth& satellite : output.truth.satellites) {
    double cn0 = kNaN;
    for (const GnssObservation& observation : output.epoch.observations)
      if (observation.sv == satellite.sv) cn0 = observation.cn0_dbhz;
    row.cn0_dbhz.push_back(cn0);
  }
  row.truth = std::move(output.truth);
  record_.gnss_rows.push_back(std::move(row));
  const std::size_t i = record_.gnss_rows.size() - 1;
  return once_filter_is_at(due.t, [this, i] { return use_fix(i); });
}

Status MissionRun::use_fix(std::size_t i) {
  GnssRow& row = record_.gnss_rows[i];
  if (row.withheld) return Ok{};
  const Pose before = filter_.estimate().X_WB;
  row.update = clock_.charge(Part::kFilter, [&] { return filter_.update(row.fix); });
  // A correction is not motion: what is buffered moves with it.
  if (row.update.accepted) estimated_motion_.move(filter_.estimate().X_WB * before.inverse());
  return boundaries_.check(filter_.estimate());
}

Status MissionRun::take_scan(const Due& due) {
  const double period = 1.0 / config_.lidar.rate_hz;
  true_motion_.forget_before(due.t - period);
  estimated_motion_.forget_before(due.t - period);
  const double withhold = config_.run.withhold_scans_after_s;
  if (withhold >= 0.0 && due.t - mission_.start >= withhold) return Ok{};

  lidar::Scanner::InstancesAt moving;
  if (!mission_.traffic.empty())
    moving = [&](double after_s) { return mission_.traffic.at(due.t - mission_.start + after_s); };
  lidar::LidarOutput output;
  clock_.charge(Part::kLidar, [&] { scanner_->scan(due.k, due.t, true_motion_, scene_, moving, output); });
  CANYON_TRY_STATUS(boundaries_.check(output));
  return once_filter_is_at(due.t, [this, scan = std::move(output.scan)] { return use_scan(scan); });
}

Status MissionRun::use_scan(const LidarScan& scan) {
  const NavEstimate now = estimate(scan.t);
  const Trajectory& motion = config_.run.truth_as_pose ? true_motion_ : estimated_motion_;
  Trajectory to_now;  // where the filter was divided the buffer ends before the scan
  const bool short_of = motion.poses().back().t < scan.t;
  if (short_of) {
    to_now = motion;
    to_now.append({scan.t, now.X_WB});
  }
  const LidarScan deskewed =
      clock_.charge(Part::kLidar, [&] { return lidar::deskew(scan, short_of ? to_now : motion, X_BL_); });
  record_.counters["lidar_returns"] += static_cast<std::int64_t>(deskewed.points.size());

  const Keyframe* keyframe = nullptr;
  if (!deskewed.points.empty())
    keyframe = clock_.charge(Part::kRegistration, [&] { return mapper_.offer(deskewed, now); });
  if (keyframe != nullptr) {
    CANYON_TRY_STATUS(boundaries_.check(*keyframe));
    add_keyframe(deskewed, *keyframe, true_motion_.at(scan.t).value());
  }

  const NavEstimate seen = with_correction(now);
  clock_.charge(Part::kAutonomy, [&] { autonomy_->see(deskewed, seen.X_WB * X_BL_, seen); });
  return Ok{};
}

Status MissionRun::ask_autonomy(const Due& due) {
  const NavEstimate seen = with_correction(estimate(due.t));
  const DriveCommand command = clock_.charge(Part::kAutonomy, [&] { return autonomy_->drive(seen); });
  if (is_finite(command)) {
    command_ = command;
  } else if (!open_loop_) {
    scorer_.autonomy_fault(truth_at(due.t), command);
  }
  return Ok{};
}

Status MissionRun::record_epoch(const Due& due) {
  const KinematicState truth = truth_at(due.t);
  NavRow row{due.t,
             truth.X_WB,
             truth.v_WB_W.head<2>().norm(),
             {},
             command_,
             autonomy_->next_waypoint() + 1,
             autonomy_->state()};
  return once_filter_is_at(due.t, [this, row]() mutable -> Status {
    row.estimate = filter_.estimate();
    row.estimate.X_WB.p.z() += config_.run.estimate_up_offset_m;
    record_.nav.push_back(row);
    return Ok{};
  });
}

/// Whether the run goes on.
bool MissionRun::score() {
  if (open_loop_) {
    const double limit_s = config_.time.limit_s;
    return !source_->over() && (limit_s <= 0.0 || elapsed_s() < limit_s);
  }
  const TapeNode& node = source_->now();
  const AutonomyState state = autonomy_->state();
  const bool on_purpose = state == AutonomyState::kObserving || state == AutonomyState::kDone;
  const bool go_on = clock_.charge(
      Part::kScoring, [&] { return scorer_.step(node.motion, node.speed_m_s, source_->on_terrain(), on_purpose); });
  return go_on && state != AutonomyState::kDone;
}

void MissionRun::add_keyframe(const LidarScan& deskewed, const Keyframe& keyframe, const Pose& X_WB_true) {
  record_.keyframes.push_back({keyframe.t, keyframe.points, X_WB_true * X_BL_, keyframe.X_WL_prior,
                               keyframe.X_WL_registered, keyframe.status, keyframe.iterations, keyframe.rms_m});
  clock_.charge(Part::kScoring, [&] {
    const auto range2 = static_cast<float>(config_.run.map_range_m * config_.run.map_range_m);
    for (const LidarPoint& point : deskewed.points) {
      const Eigen::Vector3f p_L(point.x, point.y, point.z);
      if (p_L.squaredNorm() > range2) continue;
      prior_map_.insert({(keyframe.X_WL_prior * p_L.cast<double>()).cast<float>(), point.intensity, 0.0F});
      registered_map_.insert({(keyframe.X_WL_registered * p_L.cast<double>()).cast<float>(), point.intensity, 0.0F});
    }
  });
}

Result<RunRecord> MissionRun::finish() {
  if (!open_loop_) {
    scorer_.finish(source_->now().motion, autonomy_->state() == AutonomyState::kDone);
    record_.outcome = scorer_.outcome();
    record_.failure = scorer_.failure();
    record_.waypoints = scorer_.waypoints();
  }
  record_.simulated_s = elapsed_s();
  record_.distance_m = source_->now().distance_m;
  const std::int64_t out_of_reach = prior_map_.out_of_reach() + registered_map_.out_of_reach();
  clock_.charge(Part::kScoring, [&] {
    record_.prior_map = std::move(prior_map_).take();
    record_.registered_map = std::move(registered_map_).take();
    record_.prior_quality = lidar::evaluate_map(record_.prior_map, scene_);
    record_.registered_quality = lidar::evaluate_map(record_.registered_map, scene_);
  });
  record_.warnings = mission_.warnings;
  for (std::string& warning : gnss_->warnings()) record_.warnings.push_back(std::move(warning));
  if (out_of_reach > 0)
    record_.warnings.push_back(std::to_string(out_of_reach) + " map points lay too far out for voxels of map_leaf_m");
  const gnss::GnssCounters counters = gnss_->counters();
  record_.counters["gnss_epochs"] = counters.epochs;
  record_.counters["gnss_occlusion_rays"] = counters.occlusion_rays;
  record_.counters["gnss_facets_tested"] = counters.facets_tested;
  record_.counters["gnss_reflected_paths"] = counters.reflected_paths;
  record_.counters["lidar_rays"] = scanner_->rays();
  record_.counters["keyframes_registered"] =
      std::count_if(record_.keyframes.begin(), record_.keyframes.end(),
                    [](const KeyframeRow& row) { return row.status.has_value(); });
  CANYON_TRY_STATUS(boundaries_.check(record_));
  return std::move(record_);
}

Result<RunRecord> drive(const MissionConfig& config, const PreparedMission& mission, Progress* progress, RunParts given,
                        PartClock& clock) {
  CANYON_TRY(auto run, MissionRun::make(config, mission, std::move(given), clock));
  double reported_s = 0.0;
  for (bool go_on = true; go_on;) {
    CANYON_TRY(go_on, run->step());
    throw_if_cancelled();
    if (progress != nullptr && run->elapsed_s() - reported_s >= 1.0) {
      progress->advance(run->elapsed_s() - reported_s);
      reported_s = run->elapsed_s();
    }
  }
  return run->finish();
}

}  // namespace

Result<RunRecord> run_mission(const MissionConfig& config, const PreparedMission& mission, Progress* progress,
                              RunParts given) {
  const auto wall_start = std::chrono::steady_clock::now();
  PartClock clock;
  CANYON_TRY(RunRecord record,
             clock.charge(Part::kOther, [&] { return drive(config, mission, progress, std::move(given), clock); }));
  record.clock = clock;
  record.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start).count();
  return record;
}

}  // namespace canyon::mission
