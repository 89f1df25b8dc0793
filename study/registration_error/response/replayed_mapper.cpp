#include "canyon/study/registration_error/response/replayed_mapper.h"

#include <algorithm>
#include <utility>

#include "canyon/core/process/progress.h"
#include "canyon/mission/mapping/mapper.h"
#include "canyon/study/registration_error/forwarded_registration.h"
#include "canyon/study/registration_error/scan_error.h"

namespace canyon::study {
namespace {

/// A method whose clouds are ready: it hands them out in their order, from one of them on.
class ReadyClouds final : public ForwardedRegistration {
 public:
  ReadyClouds(std::unique_ptr<lidar::Registration> method, const MethodClouds& ready, std::size_t first)
      : ForwardedRegistration(std::move(method)), ready_(ready), next_(first) {}

  std::shared_ptr<const lidar::PreparedCloud> prepare(std::span<const Eigen::Vector3f>) const override {
    CANYON_CHECK(next_ < ready_.clouds.size(), "cloud ", next_, " of ", ready_.clouds.size());
    return ready_.clouds[next_++];
  }

 private:
  const MethodClouds& ready_;
  mutable std::size_t next_;  // one replay on one thread
};

Pose true_pose_at(const RecordedKeyframes& recorded, GpsTime t) {
  return recorded.motion.at(std::clamp(t, recorded.motion.first(), recorded.motion.last())).X_WB;
}

/// Level, of the heading at the place's beginning.
Eigen::Vector3d direction_at(const Pose& X_WB, std::size_t axis) {
  const Eigen::Quaterniond level = rotation_from({.yaw_rad = yaw_pitch_roll(X_WB.R).yaw_rad});
  return level * Eigen::Vector3d::Unit(static_cast<Eigen::Index>(axis));
}

Pose disturbed_pose(const RecordedKeyframes& recorded, const Stretch& stretch, std::size_t k,
                    const EstimateError& error, std::uint64_t seed) {
  const RecordedKeyframe& at = recorded.keyframes[k];
  if (error.kind == nullptr) return at.X_WB_true;
  const RecordedKeyframe& begin = recorded.keyframes[stretch.begin];
  return error.kind->make.lay({.t = at.t,
                               .X_WB_true = at.X_WB_true,
                               .true_pose = [&recorded](GpsTime t) { return true_pose_at(recorded, t); },
                               .since_s = at.t - begin.t,
                               .axis = error.axis,
                               .direction_W = direction_at(begin.X_WB_true, error.axis),
                               .size = error.size,
                               .seed = seed,
                               .keyframe = k});
}

/// Of a keyframe that was not registered: it is then measured once.
bool same_place(const Pose& a, const Pose& b) {
  return a.p == b.p && a.R.coeffs() == b.R.coeffs();
}

void add_placed(const mission::Keyframe& keyframe, const Pose& X_WL_true, const std::vector<Eigen::Vector3f>& points,
                const scene::Scene& scene, PlacedSums& sums) {
  sums.keyframe_prior_m2 += (keyframe.X_WL_prior.p - X_WL_true.p).squaredNorm();
  sums.keyframe_registered_m2 += (keyframe.X_WL_registered.p - X_WL_true.p).squaredNorm();
  const double prior_m2 = placed_error_m2(points, keyframe.X_WL_prior, scene);
  sums.map_prior_m2 += prior_m2;
  sums.map_registered_m2 += same_place(keyframe.X_WL_prior, keyframe.X_WL_registered)
                                ? prior_m2
                                : placed_error_m2(points, keyframe.X_WL_registered, scene);
  sums.count += 1.0;
  if (keyframe.status && *keyframe.status != lidar::RegistrationStatus::kConverged) sums.unaligned += 1.0;
}

}  // namespace

void PlacedSums::operator+=(const PlacedSums& other) {
  keyframe_prior_m2 += other.keyframe_prior_m2;
  keyframe_registered_m2 += other.keyframe_registered_m2;
  map_prior_m2 += other.map_prior_m2;
  map_registered_m2 += other.map_registered_m2;
  count += other.count;
  unaligned += other.unaligned;
}

DisturbedKeyframe disturbed_keyframe(const RecordedKeyframes& recorded, const Stretch& stretch, std::size_t k,
                                     const EstimateError& error, std::uint64_t seed) {
  const RecordedKeyframe& now = recorded.keyframes[k];
  const std::size_t before = k > stretch.first ? k - 1 : k;
  const RecordedKeyframe& last = recorded.keyframes[before];
  DisturbedKeyframe out;
  out.estimate.t = now.t;
  out.estimate.X_WB = disturbed_pose(recorded, stretch, k, error, seed);
  out.estimate.pose_covariance = now.pose_covariance;
  const bool predicted = error.kind != nullptr && error.kind->make.predicted;
  const Pose from = predicted ? disturbed_pose(recorded, stretch, before, error, seed) : last.X_WB_true;
  const Pose to = predicted ? out.estimate.X_WB : now.X_WB_true;
  out.motion = {.source = now.t, .target = last.t, .X_TS = from.inverse() * to, .covariance = now.motion_covariance};
  return out;
}

Result<MethodClouds> prepare_clouds(const RecordedKeyframes& recorded, lidar::RegistrationConfig config,
                                    const std::string& method) {
  MethodClouds out;
  out.config = std::move(config);
  out.config.method.name = method;
  out.config.keyframe_distance_m = 0.0;  // what was recorded is a keyframe, wherever an error puts it
  if (!lidar::registers(out.config)) return out;
  CANYON_TRY(const auto registration, lidar::make_registration(out.config));
  CANYON_TRY(out.prior_map, lidar::make_prior_map(out.config, *registration));
  for (const RecordedKeyframe& keyframe : recorded.keyframes) {
    throw_if_cancelled();
    std::vector<Eigen::Vector3f> points;
    points.reserve(keyframe.scan.points.size());
    for (const LidarPoint& point : keyframe.scan.points) points.emplace_back(point.x, point.y, point.z);
    out.clouds.push_back(registration->prepare(points));
  }
  return out;
}

PlacedSums replay_mapper(const RecordedKeyframes& recorded, const std::vector<std::vector<Eigen::Vector3f>>& points,
                         const MethodClouds& method, const Pose& X_BL, const Stretch& stretch,
                         const EstimateError& error, std::uint64_t seed, const scene::Scene& scene) {
  auto registration = lidar::make_registration(method.config);
  CANYON_CHECK(registration.ok(), "a method that made its clouds");
  mission::Mapper mapper(method.config, std::make_unique<ReadyClouds>(*std::move(registration), method, stretch.first),
                         X_BL, method.prior_map);
  PlacedSums sums;
  for (std::size_t k = stretch.first; k < stretch.end; ++k) {
    throw_if_cancelled();
    const DisturbedKeyframe given = disturbed_keyframe(recorded, stretch, k, error, seed);
    LidarScan ready;  // its points are prepared
    ready.t = recorded.keyframes[k].t;
    const mission::Keyframe* keyframe = mapper.offer(ready, given.estimate, given.motion);
    CANYON_CHECK(keyframe != nullptr, "keyframe ", k, " is none");
    if (k >= stretch.begin) add_placed(*keyframe, recorded.keyframes[k].X_WB_true * X_BL, points[k], scene, sums);
  }
  return sums;
}

}  // namespace canyon::study
