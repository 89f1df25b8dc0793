#include "canyon/mission/mapping/keyframes.h"

#include <utility>

#include "canyon/core/check.h"

namespace canyon::mission {
namespace {

// A scan is a megabyte, and one more makes nobody wait less.
constexpr std::size_t kMostWaiting = 2;

}  // namespace

Keyframes::Keyframes(const MissionConfig& config, std::unique_ptr<lidar::Registration> registration,
                     std::shared_ptr<const lidar::PreparedCloud> prior_map, ScoredMaps::Wanted maps,
                     const Boundaries& boundaries, PartClock& clock, Recorder& recorder)
    : X_BL_(lidar::sensor_in_body(config.lidar)),
      at_once_(takes_registered_poses(config)),
      boundaries_(boundaries),
      clock_(clock),
      recorder_(recorder),
      mapper_(config.registration, std::move(registration), X_BL_, std::move(prior_map)),
      maps_(config.run, maps, clock),
      work_(kMostWaiting) {}

Status Keyframes::take(Scan scan) {
  mapper_.choose(scan.estimate);
  const Pose X_WL_true = scan.X_WB_true * X_BL_;
  const Pose X_LL_true = std::exchange(last_X_WL_true_, X_WL_true).inverse() * X_WL_true;
  work_.add([this, X_LL_true, scan = std::move(scan)] { place(scan, X_LL_true); });
  if (at_once_) work_.wait();
  return hand_on();
}

void Keyframes::place(const Scan& scan, const Pose& X_LL_true) {
  auto row = placed_row(scan, X_LL_true);
  const std::lock_guard lock(mutex_);
  placed_.push_back({scan, std::move(row)});
}

Result<KeyframeRow> Keyframes::placed_row(const Scan& scan, const Pose& X_LL_true) {
  const Keyframe& keyframe = clock_.charge(Part::kRegistration, [&]() -> const Keyframe& {
    return mapper_.place(*scan.deskewed, scan.estimate, scan.motion);
  });
  CANYON_TRY_STATUS(boundaries_.check(keyframe));
  KeyframeRow row{.t = keyframe.t,
                  .points = keyframe.points,
                  .X_WL_true = scan.X_WB_true * X_BL_,
                  .X_WL_prior = keyframe.X_WL_prior,
                  .X_WL_registered = keyframe.X_WL_registered,
                  .status = keyframe.status,
                  .iterations = keyframe.iterations,
                  .rms_m = keyframe.rms_m,
                  .overlap = keyframe.overlap,
                  .open = keyframe.open,
                  .map_status = keyframe.map_status,
                  .prior_covariance = keyframe.prior_covariance,
                  .covariance = keyframe.covariance,
                  .placed = keyframe.placed,
                  .alone = keyframe.alone,
                  .X_LL_true = X_LL_true};
  CANYON_TRY_STATUS(boundaries_.check(row));
  maps_.add(*scan.deskewed, keyframe);
  if (at_once_) last_ = keyframe;
  return row;
}

Status Keyframes::hand_on() {
  std::vector<Placed> placed;
  {
    const std::lock_guard lock(mutex_);
    placed.swap(placed_);
  }
  for (const Placed& each : placed) {
    if (!each.row) return each.row.error();
    CANYON_TRY_STATUS(recorder_.keyframe(*each.row));
    const Scan& scan = each.scan;
    CANYON_TRY_STATUS(
        recorder_.keyframe_input({*scan.deskewed, scan.estimate, scan.motion, scan.X_WB_true, scan.distance_m}));
  }
  return Ok{};
}

Status Keyframes::complete() {
  work_.wait();
  return hand_on();
}

Status Keyframes::score_maps(const scene::SceneAt& scene, RunRecord& record) {
  return maps_.finish(scene, boundaries_, record, recorder_);
}

const Keyframe& Keyframes::last() const {
  CANYON_CHECK(at_once_, "a keyframe may not have been placed yet");
  return last_;
}

const Pose& Keyframes::correction() const {
  CANYON_CHECK(at_once_, "a keyframe may not have been placed yet");
  return mapper_.correction();
}

}  // namespace canyon::mission
