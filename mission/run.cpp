#include "mission/run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>

#include "core/random.h"
#include "core/units.h"
#include "lidar/deskew.h"
#include "lidar/voxel_map.h"
#include "mission/boundaries.h"
#include "mission/mapper.h"

namespace canyon::mission {

namespace {

/// The whole of one run while it happens; step() reads as the order of events.
class MissionRun {
 public:
  static Result<std::unique_ptr<MissionRun>> make(const MissionConfig& config, const PreparedMission& mission,
                                                  std::unique_ptr<Autonomy> autonomy, PartClock& clock);

  /// False once the run has ended.
  Result<bool> step();
  Result<RunRecord> finish();
  double elapsed_s() const { return vehicle_.state().t - mission_.start; }

 private:
  MissionRun(const MissionConfig& config, const PreparedMission& mission, std::unique_ptr<gnss::GnssSensor> gnss,
             std::unique_ptr<inertial::ImuModel> imu, std::unique_ptr<lidar::Scanner> scanner,
             std::unique_ptr<lidar::Registration> registration, std::unique_ptr<Autonomy> autonomy, PartClock& clock);

  Status receive_gnss();
  Status take_scan();
  void add_keyframe(const LidarScan& deskewed, const Keyframe& keyframe);
  NavEstimate estimate() const;

  const MissionConfig config_;
  const PreparedMission& mission_;
  PartClock& clock_;
  Boundaries boundaries_;
  scene::SceneAt scene_;
  Vehicle vehicle_;
  std::unique_ptr<gnss::GnssSensor> gnss_;
  std::unique_ptr<inertial::ImuModel> imu_;
  std::unique_ptr<lidar::Scanner> scanner_;
  fusion::ErrorStateFilter filter_;
  Mapper mapper_;
  std::unique_ptr<Autonomy> autonomy_;
  Scorer scorer_;
  Pose X_BL_;
  std::int64_t imu_per_gnss_, imu_per_scan_;

  std::int64_t k_ = 0;
  DriveCommand command_;
  Trajectory true_motion_, estimated_motion_;  // buffers of one revolution
  lidar::VoxelMap prior_map_, registered_map_;
  RunRecord record_;
};

MissionRun::MissionRun(const MissionConfig& config, const PreparedMission& mission,
                       std::unique_ptr<gnss::GnssSensor> gnss, std::unique_ptr<inertial::ImuModel> imu,
                       std::unique_ptr<lidar::Scanner> scanner, std::unique_ptr<lidar::Registration> registration,
                       std::unique_ptr<Autonomy> autonomy, PartClock& clock)
    : config_(config),
      mission_(mission),
      clock_(clock),
      boundaries_(mission.start),
      scene_(*mission.scene),
      vehicle_(config.vehicle, *mission.scene, static_cast<std::uint64_t>(config.run.seed), mission.start),
      gnss_(std::move(gnss)),
      imu_(std::move(imu)),
      scanner_(std::move(scanner)),
      filter_(config.fusion, imu_->noise(), mission.scene->frame(), config.imu.lever_arm_m, config.gnss.lever_arm_m),
      mapper_(config.registration, std::move(registration), lidar::sensor_in_body(config.lidar)),
      autonomy_(autonomy ? std::move(autonomy) : make_autonomy(config.autonomy, mission.prior, mission.start)),
      scorer_(config, mission, scene_),
      X_BL_(lidar::sensor_in_body(config.lidar)),
      imu_per_gnss_(std::llround(config.imu.rate_hz / config.gnss.rate_hz)),
      imu_per_scan_(std::llround(config.imu.rate_hz / config.lidar.rate_hz)),
      prior_map_(config.run.map_leaf_m),
      registered_map_(config.run.map_leaf_m) {
  record_.config = config;
  record_.files = mission.files;
  record_.frame = mission.scene->frame();
  record_.start = mission.start;

  // The filter starts at the truth, but for its attitude: the seeded error of the alignment.
  const KinematicState& truth = vehicle_.state();
  const RandomStream stream(static_cast<std::uint64_t>(config.run.seed), "mission.initial_attitude");
  const Eigen::Vector3d error = stream.normal3(0).cwiseProduct(config.run.initial_attitude_error_deg) * kDegree;
  Pose start = truth.X_WB;
  start.R = (start.R * so3_exp(error)).normalized();
  filter_.initialize(mission.start, start, truth.v_WB_W);
  true_motion_.append({mission.start, truth.X_WB});
  estimated_motion_.append({mission.start, estimate().X_WB});
}

Result<std::unique_ptr<MissionRun>> MissionRun::make(const MissionConfig& config, const PreparedMission& mission,
                                                     std::unique_ptr<Autonomy> autonomy, PartClock& clock) {
  const auto seed = static_cast<std::uint64_t>(config.run.seed);
  const GpsTime end = mission.start + mission.time_limit_s;
  CANYON_TRY(auto gnss, gnss::make_gnss_sensor(config.gnss, seed, mission.start, end, *mission.scene));
  CANYON_TRY(auto imu, inertial::make_imu(config.imu, seed, mission.scene->frame()));
  CANYON_TRY(auto scanner, lidar::make_scanner(config.lidar, seed));
  CANYON_TRY(auto registration, lidar::make_registration(config.registration));
  return std::unique_ptr<MissionRun>(new MissionRun(config, mission, std::move(gnss), std::move(imu),
                                                    std::move(scanner), std::move(registration), std::move(autonomy),
                                                    clock));
}

NavEstimate MissionRun::estimate() const {
  NavEstimate estimate = filter_.estimate();
  if (config_.run.truth_as_pose) {
    estimate.X_WB = vehicle_.state().X_WB;
    estimate.v_WB_W = vehicle_.state().v_WB_W;
  }
  estimate.X_WB.p.z() += config_.run.estimate_up_offset_m;
  return estimate;
}

Result<bool> MissionRun::step() {
  ++k_;
  const GpsTime t = tick(mission_.start, k_, config_.imu.rate_hz);
  if (!mission_.traffic.empty()) scene_.set_instances(mission_.traffic.at(t - mission_.start));

  const Vehicle::Step& nodes =
      clock_.charge(Part::kVehicle, [&]() -> const Vehicle::Step& { return vehicle_.advance(command_, t); });
  CANYON_TRY_STATUS(boundaries_.check(nodes));
  const ImuSample sample = clock_.charge(Part::kImu, [&] { return imu_->sample(k_, nodes); });
  CANYON_TRY_STATUS(boundaries_.check(sample));
  clock_.charge(Part::kFilter, [&] { filter_.predict(sample); });
  CANYON_TRY_STATUS(boundaries_.check(estimate()));
  if (k_ % imu_per_gnss_ == 0) CANYON_TRY_STATUS(receive_gnss());

  true_motion_.append({t, vehicle_.state().X_WB});
  estimated_motion_.append({t, estimate().X_WB});
  const bool scan_due = k_ % imu_per_scan_ == 0;
  if (scan_due) CANYON_TRY_STATUS(take_scan());

  NavEstimate seen = estimate();
  if (config_.autonomy.map == "registered") seen.X_WB = mapper_.correction() * seen.X_WB;
  command_ = clock_.charge(Part::kAutonomy, [&] { return autonomy_->drive(seen); });
  if (!is_finite(command_)) {
    scorer_.autonomy_fault(vehicle_.state(), command_);
    return false;
  }

  if (scan_due)
    record_.nav.push_back({t, vehicle_.state().X_WB, vehicle_.speed_m_s(), estimate(), command_,
                           autonomy_->next_waypoint() + 1, autonomy_->state()});
  const AutonomyState state = autonomy_->state();
  const bool on_purpose = state == AutonomyState::kObserving || state == AutonomyState::kDone;
  const bool go_on = clock_.charge(Part::kScoring, [&] {
    return scorer_.step(vehicle_.state(), vehicle_.speed_m_s(), vehicle_.on_terrain(), on_purpose);
  });
  return go_on && state != AutonomyState::kDone;
}

Status MissionRun::receive_gnss() {
  const KinematicState& truth = vehicle_.state();
  const Eigen::Vector3d lever = config_.gnss.lever_arm_m;
  const Eigen::Vector3d p_A_W = truth.X_WB * lever;
  const Eigen::Vector3d v_A_W = truth.v_WB_W + truth.X_WB.R * truth.w_WB_B.cross(lever);
  gnss::GnssOutput output =
      clock_.charge(Part::kGnss, [&] { return gnss_->measure(k_ / imu_per_gnss_, truth.t, p_A_W, v_A_W, scene_); });
  CANYON_TRY_STATUS(boundaries_.check(output));

  GnssRow row;
  row.fix = output.fix;
  row.p_A_W_true = p_A_W;
  const double withhold = config_.run.withhold_fixes_after_s;
  row.withheld = withhold >= 0.0 && truth.t - mission_.start >= withhold;
  if (!row.withheld) {
    row.update = clock_.charge(Part::kFilter, [&] { return filter_.update(output.fix); });
    CANYON_TRY_STATUS(boundaries_.check(estimate()));
  }
  for (const GnssObservationTruth& satellite : output.truth.satellites) {
    double cn0 = kNaN;
    for (const GnssObservation& observation : output.epoch.observations)
      if (observation.sv == satellite.sv) cn0 = observation.cn0_dbhz;
    row.cn0_dbhz.push_back(cn0);
  }
  row.truth = std::move(output.truth);
  record_.gnss_rows.push_back(std::move(row));
  return Ok{};
}

Status MissionRun::take_scan() {
  const GpsTime t = vehicle_.state().t;
  const double period = 1.0 / config_.lidar.rate_hz;
  true_motion_.forget_before(t - period);
  estimated_motion_.forget_before(t - period);
  const double withhold = config_.run.withhold_scans_after_s;
  if (withhold >= 0.0 && t - mission_.start >= withhold) return Ok{};
  const NavEstimate now = estimate();

  lidar::Scanner::InstancesAt moving;
  if (!mission_.traffic.empty())
    moving = [&](double after_s) { return mission_.traffic.at(t - mission_.start + after_s); };
  lidar::LidarOutput output;
  clock_.charge(Part::kLidar, [&] { scanner_->scan(k_ / imu_per_scan_, t, true_motion_, scene_, moving, output); });
  CANYON_TRY_STATUS(boundaries_.check(output));
  const LidarScan deskewed =
      clock_.charge(Part::kLidar, [&] { return lidar::deskew(output.scan, estimated_motion_, X_BL_); });
  record_.counters["lidar_returns"] += static_cast<std::int64_t>(deskewed.points.size());

  const Keyframe* keyframe = nullptr;
  if (!deskewed.points.empty())
    keyframe = clock_.charge(Part::kRegistration, [&] { return mapper_.offer(deskewed, now); });
  if (keyframe != nullptr) {
    CANYON_TRY_STATUS(boundaries_.check(*keyframe));
    add_keyframe(deskewed, *keyframe);
  }

  NavEstimate seen = now;
  if (config_.autonomy.map == "registered") seen.X_WB = mapper_.correction() * seen.X_WB;
  clock_.charge(Part::kAutonomy, [&] { autonomy_->see(deskewed, seen.X_WB * X_BL_, seen); });
  return Ok{};
}

void MissionRun::add_keyframe(const LidarScan& deskewed, const Keyframe& keyframe) {
  record_.keyframes.push_back({keyframe.t, keyframe.points, vehicle_.state().X_WB * X_BL_, keyframe.X_WL_prior,
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
  scorer_.finish(vehicle_.state(), autonomy_->state() == AutonomyState::kDone);
  record_.outcome = scorer_.outcome();
  record_.failure = scorer_.failure();
  record_.waypoints = scorer_.waypoints();
  record_.simulated_s = elapsed_s();
  record_.distance_m = vehicle_.distance_m();
  const std::int64_t out_of_reach = prior_map_.out_of_reach() + registered_map_.out_of_reach();
  clock_.charge(Part::kScoring, [&] {
    record_.prior_map = std::move(prior_map_).take();
    record_.registered_map = std::move(registered_map_).take();
    record_.prior_quality = lidar::evaluate_map(record_.prior_map, scene_);
    record_.registered_quality = lidar::evaluate_map(record_.registered_map, scene_);
  });
  record_.warnings = gnss_->warnings();
  if (out_of_reach > 0)
    record_.warnings.push_back(std::to_string(out_of_reach) + " map points lay too far out for voxels of map_leaf_m");
  const gnss::GnssCounters counters = gnss_->counters();
  record_.counters["imu_samples"] = k_;
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

Result<RunRecord> drive(const MissionConfig& config, const PreparedMission& mission, Progress* progress,
                        std::unique_ptr<Autonomy> autonomy, PartClock& clock) {
  CANYON_TRY(auto run, MissionRun::make(config, mission, std::move(autonomy), clock));
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
                              std::unique_ptr<Autonomy> autonomy) {
  const auto wall_start = std::chrono::steady_clock::now();
  PartClock clock;
  CANYON_TRY(RunRecord record,
             clock.charge(Part::kOther, [&] { return drive(config, mission, progress, std::move(autonomy), clock); }));
  record.clock = clock;
  record.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start).count();
  return record;
}

}  // namespace canyon::mission
