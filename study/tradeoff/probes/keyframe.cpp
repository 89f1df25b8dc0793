#include <algorithm>
#include <cmath>

#include "canyon/core/process/cpu_time.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/lidar/deskew.h"
#include "canyon/lidar/registration/registration.h"
#include "canyon/study/tradeoff/probes/heap_meter.h"
#include "canyon/study/tradeoff/probes/models.h"
#include "canyon/study/tradeoff/probes/taped_scans.h"
#include "canyon/study/tradeoff/probes/true_tape.h"

namespace canyon::study {
namespace {

using lidar::Registration;

/// The same keyframes are scored whatever the submap: as many as the largest of the ladder go before.
constexpr std::size_t kBefore = 10;
constexpr double kGuess_m = 0.3, kGuess_rad = kDegree;

struct KeyframeScan {
  GpsTime t;
  Pose X_WL;  ///< true
  std::vector<Eigen::Vector3f> points;
};

/// Scans deskewed with the true motion, one each time the vehicle has gone keyframe_distance_m or turned
/// keyframe_angle_deg, as the mapper takes them.
Result<std::vector<KeyframeScan>> keyframes_of(const ProbeSetup& setup, std::size_t count) {
  const mission::MissionConfig& config = setup.config;
  CANYON_TRY(TapedScanner scanner, TapedScanner::make(setup, 0.01));
  const TrueMotion motion = true_motion(setup.tape, setup.mission.start);
  const Pose X_BL = lidar::sensor_in_body(config.lidar);
  std::vector<KeyframeScan> keyframes;
  lidar::LidarOutput output;
  const auto first = static_cast<std::int64_t>(std::ceil(scanner.margin_s() * config.lidar.rate_hz));
  for (std::int64_t k = first; keyframes.size() < count && scanner.time_of(k) <= motion.last(); ++k) {
    const Pose X_WL = motion.at(scanner.time_of(k)).X_WB * X_BL;
    if (!keyframes.empty()) {
      const Pose moved = keyframes.back().X_WL.inverse() * X_WL;
      if (moved.p.norm() < config.registration.keyframe_distance_m &&
          so3_log(moved.R).norm() < config.registration.keyframe_angle_deg * kDegree)
        continue;
    }
    throw_if_cancelled();
    const Trajectory poses = scanner.poses(motion, k);
    scanner.prepare(k);
    scanner.scan(k, poses, output);
    const LidarScan scan = lidar::deskew(output.scan, poses, X_BL);
    KeyframeScan keyframe{scanner.time_of(k), X_WL, {}};
    for (const LidarPoint& point : scan.points) keyframe.points.emplace_back(point.x, point.y, point.z);
    keyframes.push_back(std::move(keyframe));
  }
  return keyframes;
}

/// Each keyframe onto the `submap_keyframes` before it, which stand where they truly are: the error of one alignment,
/// not of a chain of them.
class KeyframeProbe final : public Probe {
 public:
  KeyframeProbe(const ProbeSetup& setup, std::vector<KeyframeScan> keyframes,
                std::unique_ptr<Registration> registration)
      : config_(setup.config), keyframes_(std::move(keyframes)), registration_(std::move(registration)) {}

  Result<ProbeRun> run() override {
    const HeapMeter heap;
    ProbeRun run;
    run.samples.dimension = 3;
    CpuAccount account;
    std::vector<std::shared_ptr<const lidar::PreparedCloud>> clouds;
    for (std::size_t i = 0; i < keyframes_.size(); ++i) {
      throw_if_cancelled();
      const bool scored = i >= kBefore;
      {
        const ChargeCpu charge(scored ? &account : nullptr);
        clouds.push_back(registration_->prepare(keyframes_[i].points));
      }
      if (!scored) continue;
      run.work += static_cast<std::int64_t>(keyframes_[i].points.size());
      run.samples.values.push_back(place(i, clouds, account, run.work));
    }
    run.cpu_s = account.seconds();
    run.simulated_s = keyframes_.back().t - keyframes_[kBefore - 1].t;
    run.memory_mb = heap.grown_mb();
    return run;
  }

 private:
  std::vector<double> place(std::size_t i, const std::vector<std::shared_ptr<const lidar::PreparedCloud>>& clouds,
                            CpuAccount& account, std::int64_t& work) const {
    const Pose X_LW = keyframes_[i - 1].X_WL.inverse();
    std::vector<Registration::Placed> targets;
    const auto submap = std::min(i, static_cast<std::size_t>(config_.registration.submap_keyframes));
    for (std::size_t j = i - submap; j < i; ++j) targets.push_back({clouds[j], X_LW * keyframes_[j].X_WL});
    const Pose truth = X_LW * keyframes_[i].X_WL;
    const RandomStream stream(static_cast<std::uint64_t>(config_.run.seed), "tradeoff.guess");
    Vector6d off;
    off << kGuess_rad * stream.direction(0, i), kGuess_m * stream.direction(1, i);
    const Pose guess = truth * Pose::exp(off);
    lidar::RegistrationResult result;
    {
      const ChargeCpu charge(&account);
      result = registration_->align(*clouds[i], targets, guess);
    }
    work += result.correspondences;
    const bool placed = result.status == lidar::RegistrationStatus::kConverged ||
                        result.status == lidar::RegistrationStatus::kNotConverged;
    const Eigen::Vector3d error = (placed ? result.X_TS.p : guess.p) - truth.p;
    return {error.x(), error.y(), error.z()};
  }

  const mission::MissionConfig config_;
  std::vector<KeyframeScan> keyframes_;
  std::unique_ptr<Registration> registration_;
};

}  // namespace

Result<std::unique_ptr<Probe>> make_keyframe_probe(const ProbeSetup& setup) {
  CANYON_TRY(auto registration, lidar::make_registration(setup.config.registration));
  CANYON_TRY(auto keyframes, keyframes_of(setup, kBefore + setup.samples));
  if (keyframes.size() < kBefore + 2)
    return Error{.key = "tape",
                 .what = "holds " + std::to_string(keyframes.size()) + " keyframes",
                 .expected = "at least " + std::to_string(kBefore + 2)};
  return std::unique_ptr<Probe>(std::make_unique<KeyframeProbe>(setup, std::move(keyframes), std::move(registration)));
}

}  // namespace canyon::study
