#pragma once

#include <memory>
#include <vector>

#include "canyon/lidar/registration/registration.h"
#include "canyon/scene/scene.h"
#include "canyon/study/registration_error/response/estimate_errors.h"
#include "canyon/study/registration_error/response/recorded_keyframes.h"

namespace canyon::study {

/// An error of the estimate: of a kind, along an axis, so large.
struct EstimateError {
  const ModelRow<EstimateErrorKind>* kind = nullptr;  ///< null: none
  std::size_t axis = 0;
  double size = 0.0;
};

/// What the mapper is given of keyframe k, k >= stretch.first: the true pose with the error, and the filter's own
/// covariances, which know nothing of it.
struct DisturbedKeyframe {
  NavEstimate estimate;
  RelativePose motion;  ///< of B since keyframe k - 1; of the stretch's first one, since itself
};
DisturbedKeyframe disturbed_keyframe(const RecordedKeyframes& recorded, const Stretch& stretch, std::size_t k,
                                     const EstimateError& error, std::uint64_t seed);

/// A recorded run, its clouds made ready for one method.
struct MethodClouds {
  lidar::RegistrationConfig config;
  std::vector<std::shared_ptr<const lidar::PreparedCloud>> clouds;  ///< by keyframe; empty where nothing is registered
  std::shared_ptr<const lidar::PreparedCloud> prior_map;            ///< nullptr: none
};
Result<MethodClouds> prepare_clouds(const RecordedKeyframes& recorded, lidar::RegistrationConfig config,
                                    const std::string& method);

/// Sums over the keyframes of a stretch.
struct PlacedSums {
  double keyframe_prior_m2 = 0.0, keyframe_registered_m2 = 0.0;  ///< squares of positions' errors
  double map_prior_m2 = 0.0, map_registered_m2 = 0.0;            ///< mean squares of scans' distances to surfaces
  double count = 0.0;
  double unaligned = 0.0;  ///< keyframes whose alignment gave nothing
  void operator+=(const PlacedSums& other);
};
/// The mission's mapper (mission/mapping/mapper.h) over the keyframes of the stretch, from its first on, each of them a
/// keyframe whatever the error. `points`: sampled_points() of each keyframe.
PlacedSums replay_mapper(const RecordedKeyframes& recorded, const std::vector<std::vector<Eigen::Vector3f>>& points,
                         const MethodClouds& method, const Pose& X_BL, const Stretch& stretch,
                         const EstimateError& error, std::uint64_t seed, const scene::Scene& scene);

}  // namespace canyon::study
