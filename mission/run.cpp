#include "canyon/mission/run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "canyon/core/process/parallel.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/mission/mission_run.h"

namespace canyon::mission {

namespace {

Schedule::Rates rates_of(const MissionConfig& config) {
  const AidingSensors sensors = aiding_sensors(config);
  return {config.imu.rate_hz,
          sensors.odometer ? config.odometer.rate_hz : 0.0,
          sensors.barometer ? config.barometer.rate_hz : 0.0,
          sensors.magnetometer ? config.magnetometer.rate_hz : 0.0,
          config.gnss.rate_hz,
          config.lidar.rate_hz,
          config.autonomy.rate_hz,
          config.run.epoch_rate_hz};
}

lidar::Deskewing deskewing_of(const MissionConfig& config) {
  return config.run.truth_as_pose ? lidar::Deskewing::kTruth : lidar::deskewing(config.lidar.deskew);
}

Result<std::unique_ptr<LaterSensors>> make_later(const LaterParts& later, const PreparedMission& mission, GpsTime end) {
  const MissionConfig& config = later.config;
  const auto seed = static_cast<std::uint64_t>(config.run.seed);
  auto sensors = std::make_unique<LaterSensors>();
  sensors->from_s = later.from_s;
  sensors->noise_seed = later.noise_seed;
  sensors->truth_as_pose = config.run.truth_as_pose;
  sensors->truth_as_height = config.run.truth_as_height;
  sensors->deskewing = deskewing_of(config);
  CANYON_TRY(sensors->gnss,
             gnss::make_gnss_sensor(config.gnss, seed, mission.start, end, *mission.scene, later.noise_seed));
  CANYON_TRY(sensors->imu, inertial::make_imu(config.imu, seed, mission.scene->frame(), later.noise_seed));
  CANYON_TRY(sensors->scanner, lidar::make_scanner(config.lidar, later.noise_seed));
  return sensors;
}

fusion::ErrorStateFilter filter_of(const MissionConfig& config, const PreparedMission& mission, const ImuNoise& noise,
                                   const Omissions& omissions) {
  fusion::ErrorStateFilter filter(config.fusion, noise, mission.scene->frame(), config.imu.lever_arm_m,
                                  config.gnss.lever_arm_m);
  filter.leave_out(omissions.strapdown);
  return filter;
}

ScoredMaps::Wanted wanted_maps(const MissionConfig& config, const Omissions& omissions) {
  return {.by_filter = !omissions.maps && !omissions.map_by_filter,
          .registered = !omissions.maps && lidar::registers(config.registration)};
}

}  // namespace

MissionRun::MissionRun(const MissionConfig& config, const PreparedMission& mission, Parts parts, PartClock& clock)
    : config_(config),
      mission_(mission),
      prior_(mission.prior),
      clock_(clock),
      open_loop_(parts.open_loop),
      deskewing_(deskewing_of(config)),
      truth_as_pose_(config.run.truth_as_pose),
      truth_as_height_(config.run.truth_as_height),
      boundaries_(mission.start),
      scene_(*mission.scene),
      source_(std::move(parts.source)),
      gnss_(std::move(parts.gnss)),
      imu_(std::move(parts.imu)),
      aiding_(aiding_sensors(config), config, *mission.scene, imu_->R_BU(), mission.start),
      scanner_(std::move(parts.scanner)),
      later_(std::move(parts.later)),
      localizer_(filter_of(config, mission, parts.imu_noise, parts.omissions), mission.start, boundaries_, clock),
      omissions_(std::move(parts.omissions)),
      corridor_(omissions_.corridor, omissions_.corridor_until_s),
      told_errors_(config.run.told, static_cast<std::uint64_t>(config.run.seed), mission.start),
      autonomy_(std::move(parts.autonomy)),
      watch_(config.autonomy.call_limit_s),
      scorer_(config, mission, scene_),
      schedule_(mission.start, rates_of(config)),
      X_BL_(lidar::sensor_in_body(config.lidar)),
      recorder_(parts.recorder != nullptr ? *parts.recorder : nobody_),
      keyframes_(config_, std::move(parts.registration), std::move(parts.prior_map), wanted_maps(config_, omissions_),
                 boundaries_, clock, recorder_) {
  CANYON_CHECK(open_loop_ || !omissions_.autonomy, "nobody drives");
  gnss_->leave_out(omissions_.ranges);
  record_.config = config;
  record_.files = mission.files;
  record_.frame = mission.scene->frame();
  record_.start = mission.start;
  record_.open_loop = open_loop_;
  record_.imu_R_BU = imu_->R_BU();
  record_.maps_made = !omissions_.maps;
  record_.keyframes_made = !omissions_.keyframes;

  // The filter starts at the truth, but for its attitude: the seeded error of the alignment.
  const KinematicState& truth = source_->now().motion;
  const RandomStream stream(static_cast<std::uint64_t>(config.run.seed), "mission.initial_attitude");
  const Eigen::Vector3d error = stream.normal3(0).cwiseProduct(config.run.initial_attitude_error_deg) * kDegree;
  Pose start = truth.X_WB;
  start.R = (start.R * so3_exp(error)).normalized();
  localizer_.initialize(start, truth.v_WB_W);
  localizer_.gather(evidence_);
  record_.initial_X_WB = start;
  record_.initial_v_WB_W = truth.v_WB_W;
  motion_.append(truth);
  true_motion_.append({mission.start, truth.X_WB});
  estimated_motion_.append({mission.start, estimate(mission.start).X_WB});
}

Result<std::unique_ptr<MissionRun>> MissionRun::make(const MissionConfig& config, const PreparedMission& mission,
                                                     RunParts given, PartClock& clock) {
  const Tape* tape = given.tape;
  const auto seed = static_cast<std::uint64_t>(config.run.seed);
  const GpsTime end = mission.start + (tape != nullptr ? tape->duration_s() : mission.time_limit_s);
  Parts parts;
  parts.source = tape != nullptr ? make_taped_motion(*tape, mission.start)
                                 : make_driven_motion(config.vehicle, *mission.scene, seed, mission.start);
  parts.gnss = std::move(given.receiver);
  if (parts.gnss == nullptr) {
    CANYON_TRY(parts.gnss, gnss::make_gnss_sensor(config.gnss, seed, mission.start, end, *mission.scene));
  }
  CANYON_TRY(parts.imu, inertial::make_imu(config.imu, seed, mission.scene->frame()));
  CANYON_TRY(parts.imu_noise, noise_told_to_filter(config));
  parts.scanner = std::move(given.scanner);
  if (parts.scanner == nullptr) {
    CANYON_TRY(parts.scanner, lidar::make_scanner(config.lidar, seed));
  }
  parts.registration = std::move(given.registration);
  if (parts.registration == nullptr) {
    CANYON_TRY(parts.registration, lidar::make_registration(config.registration));
  }
  CANYON_TRY(parts.prior_map, lidar::make_prior_map(config.registration, *parts.registration));
  parts.autonomy = std::move(given.autonomy);
  parts.open_loop = tape != nullptr;
  parts.recorder = given.recorder;
  if (given.omissions != nullptr) parts.omissions = *given.omissions;
  if (given.later != nullptr) {
    CANYON_TRY(parts.later, make_later(*given.later, mission, end));
  }
  std::unique_ptr<MissionRun> run(new MissionRun(config, mission, std::move(parts), clock));
  CANYON_TRY_STATUS(run->recorder_.node(run->source_->now()));
  return run;
}

void MissionRun::place_traffic(GpsTime t) {
  if (!mission_.traffic.empty()) scene_.set_instances(mission_.traffic.at(t - mission_.start));
}

void MissionRun::change_over() {
  constexpr double kSameInstant_s = 1e-9;
  if (!later_ || elapsed_s() < later_->from_s - kSameInstant_s) return;
  gnss_ = std::move(later_->gnss);
  imu_ = std::move(later_->imu);
  scanner_ = std::move(later_->scanner);
  aiding_.draw_anew(later_->noise_seed);
  deskewing_ = later_->deskewing;
  truth_as_pose_ = later_->truth_as_pose;
  truth_as_height_ = later_->truth_as_height;
  later_.reset();
}

Result<bool> MissionRun::step() {
  change_over();
  if (!asked_) ask([this] { make_autonomy_once(); });  // and what it says of itself before the first call
  asked_ = true;
  const TapeNode& node = clock_.charge(Part::kVehicle, [&]() -> const TapeNode& { return source_->advance(command_); });
  CANYON_TRY_STATUS(boundaries_.check(node.motion));
  motion_.append(node.motion);
  true_motion_.append({node.motion.t, node.motion.X_WB});
  CANYON_TRY_STATUS(recorder_.node(node));
  while (const auto due = schedule_.next(node.motion.t)) {
    place_traffic(due->t);
    CANYON_TRY_STATUS(perform(*due));
    if (scorer_.failure()) return false;  // the autonomy's fault
  }
  place_traffic(node.motion.t);
  return score();
}

/// Within a watched call: one may fail already while it is made.
void MissionRun::make_autonomy_once() {
  if (autonomy_ == nullptr) autonomy_ = make_autonomy(config_.autonomy, prior_, mission_.start);
}

/// Whether the run goes on.
bool MissionRun::score() {
  if (open_loop_) {
    const double limit_s = config_.time.limit_s;
    return !source_->over() && (limit_s <= 0.0 || elapsed_s() < limit_s);
  }
  const TapeNode& node = source_->now();
  const AutonomyState state = answers_.state;
  if (state == AutonomyState::kLost) {
    scorer_.lost(node.motion, as_told(estimate(node.motion.t)).X_WB.p);
    return false;
  }
  const bool on_purpose = state == AutonomyState::kObserving || state == AutonomyState::kDone;
  const bool go_on = clock_.charge(Part::kScoring, [&] {
    scorer_.follow(node.motion, node.speed_m_s, command_, state, answers_.next_waypoint);
    scorer_.follow_lane(node.motion, [&] { return as_told(estimate(node.motion.t)).X_WB.p; });
    return scorer_.step(node.motion, node.speed_m_s, source_->on_terrain(), on_purpose);
  });
  return go_on && state != AutonomyState::kDone;
}

Result<RunRecord> MissionRun::finish() {
  CANYON_TRY_STATUS(keyframes_.complete());
  if (!open_loop_) {
    scorer_.finish(source_->now().motion, answers_.state == AutonomyState::kDone);
    record_.outcome = scorer_.outcome();
    record_.failure = scorer_.failure();
    record_.waypoints = scorer_.waypoints();
    record_.encounters = scorer_.encounters();
    record_.needless_lane_departures = scorer_.needless_lane_departures();
  }
  while (!fixes_.empty()) CANYON_TRY_STATUS(record_fix());  // the filter did not come there any more
  record_.simulated_s = elapsed_s();
  record_.distance_m = source_->now().distance_m;
  CANYON_TRY_STATUS(boundaries_.check_end(record_.simulated_s, record_.distance_m));
  record_.verdict = evidence_.numbers();
  record_.warnings.insert(record_.warnings.begin(), mission_.warnings.begin(), mission_.warnings.end());
  for (std::string& warning : gnss_->warnings()) record_.warnings.push_back(std::move(warning));
  if (corridor_.left()) record_.warnings.push_back(*corridor_.left());
  CANYON_TRY_STATUS(keyframes_.score_maps(scene_, record_));
  CANYON_TRY_STATUS(recorder_.finish());
  count_work();
  return std::move(record_);
}

void MissionRun::count_work() {
  auto& counters = record_.counters;
  const gnss::GnssCounters gnss = gnss_->counters();
  counters["gnss_epochs"] = gnss.epochs;
  counters["gnss_path_searches"] = gnss.path_searches;
  counters["gnss_occlusion_rays"] = gnss.occlusion_rays;
  counters["gnss_facets_tested"] = gnss.facets_tested;
  counters["gnss_reflected_paths"] = gnss.reflected_paths;
  counters["gnss_diffracted_paths"] = gnss.diffracted_paths;
  counters["gnss_delays_computed"] = gnss.delays_computed;
  counters["gnss_epochs_in_full"] = gnss.epochs_in_full;
  counters["lidar_rays"] = scanner_->rays();
  for (const char* scans : {"lidar_scans", "lidar_returns"}) counters.try_emplace(scans, 0);
  counters["filter_predictions"] = localizer_.predictions();
  counters["filter_updates"] = localizer_.updates();
  const Mapper::Counters& mapper = keyframes_.counters();
  counters["keyframes_registered"] = mapper.alignments;
  counters["keyframes_in_prior_map"] = mapper.found_in_map;
  counters["registration_iterations"] = mapper.iterations;
  counters["registration_correspondences"] = mapper.correspondences;
  counters["pcl_objects"] = mapper.pcl_objects;
}

namespace {

/// The steps of a run, to its end.
Result<bool> drive(MissionRun& run, Progress* progress) {
  double reported_s = 0.0;
  for (bool go_on = true; go_on;) {
    CANYON_TRY(go_on, run.step());
    throw_if_cancelled();
    if (progress != nullptr && run.elapsed_s() - reported_s >= 1.0) {
      progress->advance(run.elapsed_s() - reported_s);
      reported_s = run.elapsed_s();
    }
  }
  return true;
}

/// Drives on a thread of its own, so that an autonomy which never returns holds up nobody: its run then ends where it
/// is, and the thread is left behind (CallWatch).
Result<RunRecord> drive_watched(std::unique_ptr<MissionRun> whole, Progress* progress, PartClock& clock) {
  MissionRun& run = *whole;
  std::mutex mutex;
  std::condition_variable changed;
  std::optional<Result<bool>> driven;
  std::exception_ptr thrown;
  std::thread driver([&] {
    const OwnRoom room;  // whoever waits here may be a worker of a loop over runs
    std::optional<Result<bool>> result;
    std::exception_ptr exception;
    try {
      result.emplace(clock.charge(Part::kOther, [&] { return drive(run, progress); }));
    } catch (...) {
      exception = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    driven = std::move(result);
    thrown = exception;
    changed.notify_one();
  });
  // Several times within the limit, as the watch has it.
  const std::chrono::duration<double> look(std::min(0.05, 0.1 * run.watch().limit_s()));
  std::unique_lock lock(mutex);
  while (!changed.wait_for(lock, look, [&] { return driven || thrown; })) {
    if (!run.watch().take_over()) continue;
    driver.detach();
    [[maybe_unused]] const MissionRun* left_behind = whole.release();
    run.abandon_autonomy();
    return run.finish();
  }
  lock.unlock();
  driver.join();
  if (thrown) std::rethrow_exception(thrown);
  if (!*driven) return driven->error();
  return run.finish();
}

}  // namespace

Result<RunRecord> run_mission(const MissionConfig& config, const PreparedMission& mission, Progress* progress,
                              RunParts given) {
  const auto wall_start = std::chrono::steady_clock::now();
  PartClock clock;
  const auto drive_it = [&]() -> Result<RunRecord> {
    CANYON_TRY(auto run, MissionRun::make(config, mission, std::move(given), clock));
    return drive_watched(std::move(run), progress, clock);
  };
  CANYON_TRY(RunRecord record, clock.charge(Part::kOther, drive_it));
  record.clock = clock;
  record.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start).count();
  return record;
}

}  // namespace canyon::mission
