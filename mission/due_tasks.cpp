#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "canyon/core/config/text.h"
#include "canyon/core/units.h"
#include "canyon/lidar/deskew.h"
#include "canyon/mission/mission_run.h"
#include "canyon/mission/recorder/estimate_error.h"

// What is due within a master step.
namespace canyon::mission {

NavEstimate MissionRun::estimate(GpsTime t) const {
  NavEstimate estimate = localizer_.estimate();
  estimate.X_WB.p += (t - localizer_.at()) * estimate.v_WB_W;  // between two IMU samples
  if (truth_as_pose_) {
    const KinematicState truth = truth_at(t);
    estimate.t = t;
    estimate.X_WB = truth.X_WB;
    estimate.v_WB_W = truth.v_WB_W;
  } else if (truth_as_height_) {
    estimate.X_WB.p.z() = truth_at(t).X_WB.p.z();
  }
  estimate.X_WB.p.z() += config_.run.estimate_up_offset_m;
  return estimate;
}

NavEstimate MissionRun::as_told(NavEstimate estimate) const {
  if (config_.autonomy.map == MapPose::kRegistered) estimate.X_WB = keyframes_.correction() * estimate.X_WB;
  told_errors_.lay_over(estimate);
  return estimate;
}

Status MissionRun::perform(const Due& due) {
  switch (due.task) {
    case Task::kImu:
      return take_imu(due);
    case Task::kOdometer:
      return take_odometer(due);
    case Task::kBarometer:
      return take_barometer(due);
    case Task::kMagnetometer:
      return take_magnetometer(due);
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
  const ImuSample sample =
      clock_.charge(Part::kImu, [&] { return imu_->sample(due.k, motion_, localizer_.at(), due.t); });
  CANYON_TRY_STATUS(boundaries_.check(sample));
  ++record_.counters["imu_samples"];
  CANYON_TRY_STATUS(recorder_.imu(sample));
  CANYON_TRY_STATUS(localizer_.take(sample, due.t));
  motion_.forget_before(aiding_.needs_from(due.t));
  follow_correction();
  estimated_motion_.append({due.t, estimate(due.t).X_WB});
  return Ok{};
}

/// A correction is not motion: what is buffered moves with it.
void MissionRun::follow_correction() {
  const auto correction = localizer_.take_correction();
  if (correction && deskewing_ != lidar::Deskewing::kEstimate) estimated_motion_.move(*correction);
}

Status MissionRun::take_gnss(const Due& due) {
  const KinematicState truth = truth_at(due.t);
  const Eigen::Vector3d lever = config_.gnss.lever_arm_m;
  const Eigen::Vector3d p_A_W = truth.X_WB * lever;
  const Eigen::Vector3d v_A_W = truth.v_WB_W + truth.X_WB.R * truth.w_WB_B.cross(lever);
  gnss_->leave_out(corridor_.at(truth.t - mission_.start, truth.X_WB));
  if (corridor_.left()) gnss_->leave_out(gnss::RangeOmissions{});
  gnss::GnssOutput output =
      clock_.charge(Part::kGnss, [&] { return gnss_->measure(due.k, truth.t, p_A_W, v_A_W, scene_); });
  CANYON_TRY_STATUS(boundaries_.check(output));
  if (later_) later_->gnss->measure(due.k, truth.t, p_A_W, v_A_W, scene_);

  GnssRow row;
  row.fix = output.fix;
  row.p_A_W_true = p_A_W;
  row.range_gain = output.range_gain;
  if (fusion::measures_with(config_.fusion, "ranges")) row.epoch = output.epoch;
  const auto withhold_s = config_.run.withhold_fixes_after_s;
  row.withheld = withhold_s && truth.t - mission_.start >= *withhold_s;
  for (const GnssObservationTruth& satellite : output.truth.satellites) {
    double cn0 = kNaN;
    for (const GnssObservation& observation : output.epoch.observations)
      if (observation.sv == satellite.sv) cn0 = observation.cn0_dbhz;
    row.cn0_dbhz.push_back(cn0);
  }
  row.truth = std::move(output.truth);
  row.has_satellites = gnss_->has_satellites();
  fixes_.push_back(std::move(row));
  return localizer_.once_at(due.t, [this] { return use_fix(); });
}

Status MissionRun::use_fix() {
  GnssRow& row = fixes_.front();
  if (!row.withheld) {
    CANYON_TRY(row.update, localizer_.update(row.fix));
    if (row.fix.status != FixStatus::kNone)
      evidence_.fix(row.fix.t, row.fix.p_A_E - record_.frame.to_E(row.p_A_W_true), row.fix.covariance_E);
    if (!row.epoch.observations.empty()) CANYON_TRY_STATUS(localizer_.update(row.epoch));
    follow_correction();
    CANYON_TRY_STATUS(boundaries_.check(localizer_.estimate()));
  }
  return record_fix();
}

Status MissionRun::record_fix() {
  CANYON_TRY_STATUS(boundaries_.check(fixes_.front()));
  CANYON_TRY_STATUS(recorder_.gnss(fixes_.front()));
  fixes_.pop_front();
  return Ok{};
}

Status MissionRun::take_scan(const Due& due) {
  const double reach_s = scanner_->reach_s(due.k);
  forget_motion_before(std::min(due.t, localizer_.at()) - reach_s);  // scans may wait for it
  constexpr double kSameInstant_s = 1e-9;
  if (due.t - mission_.start < reach_s - kSameInstant_s) return Ok{};  // it began before the vehicle did
  const auto withhold_s = config_.run.withhold_scans_after_s;
  if (withhold_s && due.t - mission_.start >= *withhold_s) return Ok{};
  if (!scan_is_wanted(due.t)) return Ok{};

  clock_.charge(Part::kLidar, [&] { fire(due, fired_); });
  CANYON_TRY_STATUS(boundaries_.check(fired_));
  ++record_.counters["lidar_scans"];
  if (!open_loop_) clock_.charge(Part::kScoring, [&] { scorer_.scan(due.t, fired_.truth); });
  return localizer_.once_at(due.t, [this, scan = std::move(fired_.scan)]() mutable {
    Status used = use_scan(scan);
    fired_.scan = std::move(scan);  // its memory, for the next one
    return used;
  });
}

void MissionRun::fire(const Due& due, lidar::LidarOutput& output) {
  lidar::Scanner::InstancesAt moving;
  if (!mission_.traffic.empty())
    moving = [&](double after_s) { return mission_.traffic.at(due.t - mission_.start + after_s); };
  const auto kept = omissions_.unkept_rays ? answers_.keeps : std::nullopt;
  const auto room = kept ? kept_room(*kept, due.t) : std::nullopt;
  scanner_->keep(room ? &*room : nullptr);
  scanner_->scan(due.k, due.t, true_motion_, scene_, moving, output);
  if (!room || static_cast<int>(output.scan.points.size()) >= kept->enough) return;
  scanner_->keep(nullptr);  // so few that it matters how many
  scanner_->scan(due.k, due.t, true_motion_, scene_, moving, output);
}

namespace {

/// By how much B's z axis is turned, and B's origin moved, between a stamp and any pose of the revolution before it.
/// Between poses it is interpolated: a tenth more covers that.
std::pair<double, double> unsteadiness(const Trajectory& motion, const Pose& X_WB, GpsTime from) {
  double turned_rad = 0.0, moved_m = 0.0;
  for (const StampedPose& pose : motion.poses()) {
    if (pose.t - from < -0.1) continue;
    const Eigen::Vector3d up = X_WB.R.conjugate() * (pose.X_WB.R * Eigen::Vector3d::UnitZ());
    turned_rad = std::max(turned_rad, std::atan2(up.head<2>().norm(), up.z()));
    moved_m = std::max(moved_m, (pose.X_WB.p - X_WB.p).norm());
  }
  return {1.1 * turned_rad + 1e-3, 1.1 * moved_m + 0.01};
}

}  // namespace

/// None where the filter has not come to t, as what the deskewing will believe is not known yet, and where it will drop
/// returns of its own at the run's beginning.
std::optional<lidar::KeptRoom> MissionRun::kept_room(const KeptReturns& kept, GpsTime t) {
  if (localizer_.at() != t) return std::nullopt;
  if (deskewing_ == lidar::Deskewing::kNone) return std::nullopt;
  const Trajectory& motion = deskewing_ == lidar::Deskewing::kTruth ? true_motion_ : estimated_motion_;
  const double period_s = 1.0 / config_.lidar.rate_hz;
  if (motion.poses().front().t - t > -period_s) return std::nullopt;
  const Pose believed = estimate(t).X_WB;
  const auto [turned_rad, moved_m] = unsteadiness(motion, believed, t + -period_s);
  const double height_m = std::max(std::abs(kept.low_m), std::abs(kept.high_m));
  const double tilt_cos = (believed.R * Eigen::Vector3d::UnitZ()).z();
  lidar::KeptRoom room{.low_m = kept.low_m, .high_m = kept.high_m, .turned_rad = turned_rad, .moved_m = moved_m};
  if (!(tilt_cos > 0.5)) return std::nullopt;
  // The square's corner, level in W: at most so far along the tilted ground plane, and up or down from it.
  room.reach_m = (std::sqrt(2.0) * kept.half_size_m + height_m) / tilt_cos + height_m;

  const KinematicState truth = truth_at(t);
  corridor_.at(t - mission_.start, truth.X_WB);
  const PlannedPlace* place = corridor_.place();
  if (place == nullptr) return room;
  const auto [truly_turned_rad, truly_moved_m] = unsteadiness(true_motion_, truth.X_WB, t + -period_s);
  const double cos_tilt = (truth.X_WB.R * Eigen::Vector3d::UnitZ()).z();
  // A shot climbs in W by its rise in B less the tilt, the ground by its slope at most, from under the vehicle on.
  constexpr double kSuspension_m = 0.5;
  const double tilt_rad = std::acos(std::min(1.0, cos_tilt)) + truly_turned_rad;
  room.clear_m = place->around.clear_m - truly_moved_m;
  room.ground_rise = place->around.ground_slope + tilt_rad + 10.0 * config_.lidar.angle_noise_deg * kDegree;
  room.above_ground_m = (truth.X_WB * X_BL_.p).z() - truth.X_WB.p.z() - kSuspension_m - truly_moved_m -
                        place->around.ground_slope * X_BL_.p.norm();
  return room;
}

void MissionRun::forget_motion_before(GpsTime t) {
  true_motion_.forget_before(t);
  estimated_motion_.forget_before(t);
}

/// An autonomy that does not look leaves the map, which takes keyframes only. Whether a scan becomes one is known
/// before it is made, if the filter has come there.
bool MissionRun::scan_is_wanted(GpsTime t) const {
  return (answers_.looks && !omissions_.autonomy) ||
         (!omissions_.keyframes && (localizer_.at() != t || keyframes_.wants(estimate(t))));
}

LidarScan MissionRun::deskew(const LidarScan& scan, const NavEstimate& now) const {
  if (deskewing_ == lidar::Deskewing::kNone) return lidar::not_deskewed(scan);
  const Trajectory& motion = deskewing_ == lidar::Deskewing::kTruth ? true_motion_ : estimated_motion_;
  if (motion.poses().back().t >= scan.t) return lidar::deskew(scan, motion, X_BL_);
  Trajectory to_now = motion;  // where the filter was divided the buffer ends before the scan
  to_now.append({scan.t, now.X_WB});
  return lidar::deskew(scan, to_now, X_BL_);
}

Status MissionRun::use_scan(const LidarScan& scan) {
  const NavEstimate now = estimate(scan.t);
  const auto deskewed =
      clock_.charge(Part::kLidar, [&] { return std::make_shared<const LidarScan>(deskew(scan, now)); });
  record_.counters["lidar_returns"] += static_cast<std::int64_t>(deskewed->points.size());

  if (!omissions_.keyframes && !deskewed->points.empty()) CANYON_TRY_STATUS(map_scan(deskewed, now));

  if (omissions_.autonomy) return Ok{};
  const NavEstimate seen = as_told(estimate(scan.t));
  clock_.charge(Part::kAutonomy, [&] { ask([&] { autonomy_->see(*deskewed, seen.X_WB * X_BL_, seen); }); });
  return Ok{};
}

void MissionRun::ask(const std::function<void()>& call) {
  if (autonomy_lost_) return;
  auto wrong = watch_.ask(call);
  Answers answers;
  const auto take_answers = [&] {
    answers = {autonomy_->state(), autonomy_->next_waypoint(), autonomy_->looks(), autonomy_->keeps()};
  };
  if (!wrong) wrong = watch_.ask(take_answers);
  if (!wrong) answers_ = answers;
  if (wrong) lose_autonomy(*wrong);
}

/// Where the true motion is given that is no outcome: the run goes on without it.
void MissionRun::lose_autonomy(const std::string& why) {
  autonomy_lost_ = true;
  answers_.looks = false;
  if (open_loop_) {
    record_.warnings.push_back("the autonomy was not asked any more after " + number_text(elapsed_s()) + " s: " + why);
  } else {
    scorer_.autonomy_fault(source_->now().motion, why);
  }
}

void MissionRun::abandon_autonomy() {
  lose_autonomy(watch_.overtime());
}

Status MissionRun::ask_autonomy(const Due& due) {
  if (omissions_.autonomy) return Ok{};
  const NavEstimate seen = as_told(estimate(due.t));
  DriveCommand command = command_;
  clock_.charge(Part::kAutonomy, [&] { ask([&] { command = autonomy_->drive(seen); }); });
  if (autonomy_lost_) return Ok{};
  if (is_finite(command)) {
    command_ = command;
  } else if (!open_loop_) {
    char what[96];
    std::snprintf(what, sizeof what, "its command was %.1f m/s, %.1f 1/m", command.speed_m_s, command.curvature_1_m);
    scorer_.autonomy_fault(truth_at(due.t), what);
  }
  return Ok{};
}

void MissionRun::compare(const NavRow& row, const Eigen::Vector3d& v_WB_W_true) {
  const EstimateError error = estimate_error(row);
  const Eigen::Matrix3d R_WB = row.estimate.X_WB.R.toRotationMatrix();
  const Matrix6d& P = row.estimate.pose_covariance;
  evidence_.error(row.t, {.attitude_rad = error.attitude_deg * kDegree,
                          .attitude_covariance = P.topLeftCorner<3, 3>(),
                          .position_enu_m = error.position_W_m,
                          .position_covariance = R_WB * P.bottomRightCorner<3, 3>() * R_WB.transpose(),
                          .velocity_enu_m_s = row.estimate.v_WB_W - v_WB_W_true,
                          .velocity_covariance = row.estimate.velocity_covariance_W});
  localizer_.look();
}

Status MissionRun::record_epoch(const Due& due) {
  const KinematicState truth = truth_at(due.t);
  NavRow row{due.t,          truth.X_WB,       truth.v_WB_W.head<2>().norm(), {}, command_, answers_.next_waypoint + 1,
             answers_.state, scorer_.phantom()};
  return localizer_.once_at(due.t, [this, row, v_WB_W_true = truth.v_WB_W]() mutable -> Status {
    row.estimate = localizer_.estimate();
    if (config_.run.record_covariance) row.covariance = localizer_.body_covariance();
    row.estimate.X_WB.p.z() += config_.run.estimate_up_offset_m;
    CANYON_TRY_STATUS(boundaries_.check(row));
    clock_.charge(Part::kScoring, [&] { compare(row, v_WB_W_true); });
    return recorder_.epoch(row);
  });
}

/// What an alignment begins from.
RelativePose MissionRun::motion_since_keyframe(GpsTime scan_t, const NavEstimate& now) const {
  RelativePose motion = localizer_.motion();
  if (config_.run.truth_as_guess) {
    motion.X_TS = last_keyframe_X_WB_.inverse() * true_motion_.at(scan_t).value();
  } else if (truth_as_pose_) {
    motion.X_TS = last_keyframe_X_WB_.inverse() * now.X_WB;
  }
  return motion;
}

Status MissionRun::map_scan(const std::shared_ptr<const LidarScan>& deskewed, const NavEstimate& now) {
  if (!keyframes_.wants(now)) return Ok{};
  const RelativePose motion = motion_since_keyframe(deskewed->t, now);
  const Pose X_WB_true = true_motion_.at(deskewed->t).value();
  if (lidar::registers(config_.registration)) localizer_.begin_motion();
  last_keyframe_X_WB_ = config_.run.truth_as_guess ? X_WB_true : now.X_WB;
  CANYON_TRY_STATUS(keyframes_.take({deskewed, now, motion, X_WB_true, source_->now().distance_m}));
  if (fusion::measures_with(config_.fusion, "map_pose") && keyframes_.last().in_map) {
    CANYON_TRY_STATUS(localizer_.update(*keyframes_.last().in_map));
    follow_correction();
  }
  return fusion::measures_with(config_.fusion, "relative_pose") ? aid_by_map() : Ok{};
}

/// The motion between two keyframes tells the filter nothing that it has told the map: what a keyframe's pose in the
/// map is would come back to it as new.
Status MissionRun::aid_by_map() {
  if (keyframes_.last().aligned) {
    CANYON_TRY_STATUS(localizer_.update(*keyframes_.last().aligned));
    follow_correction();
  }
  localizer_.take_clone();
  return Ok{};
}

}  // namespace canyon::mission
