#include "canyon/mission/mapping/scored_maps.h"

#include <string>

#include "canyon/core/process/free_memory.h"
#include "canyon/lidar/map_quality/map_error.h"

namespace canyon::mission {
namespace {

// A store that grows leaves holes of its smaller sizes, as large together as itself.
constexpr int kKeyframesToTidy = 64;

}  // namespace

ScoredMaps::ScoredMaps(const RunConfig& config, Wanted wanted, PartClock& clock)
    : range2_m2_(static_cast<float>(config.map_range_m * config.map_range_m)), clock_(clock) {
  if (wanted.by_filter) prior_.emplace(config.map_leaf_m);
  if (wanted.registered) registered_.emplace(config.map_leaf_m);
}

void ScoredMaps::add(const LidarScan& deskewed, const Keyframe& keyframe) {
  if (!prior_ && !registered_) return;
  if (++keyframes_ % kKeyframesToTidy == 0) give_back_free_memory();
  clock_.charge(Part::kScoring, [&] {
    if (prior_) add(deskewed, keyframe.X_WL_prior, *prior_);
    if (registered_) add(deskewed, keyframe.X_WL_registered, *registered_);
  });
}

void ScoredMaps::add(const LidarScan& deskewed, const Pose& X_WL, lidar::VoxelMap& map) {
  const Eigen::Matrix3d R = X_WL.R.toRotationMatrix();
  placed_.clear();
  for (const LidarPoint& point : deskewed.points) {
    const Eigen::Vector3f p_L(point.x, point.y, point.z);
    if (p_L.squaredNorm() > range2_m2_) continue;
    placed_.push_back({(R * p_L.cast<double>() + X_WL.p).cast<float>(), point.intensity});
  }
  map.insert(placed_);
}

Status ScoredMaps::finish(const scene::SceneAt& scene, const Boundaries& boundaries, RunRecord& record,
                          Recorder& recorder) {
  std::int64_t out_of_reach = 0;
  const auto finish_one = [&](std::optional<lidar::VoxelMap>& map, MapKind kind, lidar::MapQuality& quality) -> Status {
    if (!map) return Ok{};
    out_of_reach += map->out_of_reach();
    lidar::MapCloud points = std::move(*map).take();
    map.reset();
    give_back_free_memory();
    const auto score = clock_.charge(Part::kScoring, [&] { return lidar::evaluate_map(points, scene); });
    quality = score.quality;
    CANYON_TRY_STATUS(boundaries.check(points, record.simulated_s));
    return recorder.map(kind, points, score.error_m);
  };
  CANYON_TRY_STATUS(finish_one(prior_, MapKind::kPrior, record.prior_quality));
  CANYON_TRY_STATUS(finish_one(registered_, MapKind::kRegistered, record.registered_quality));
  give_back_free_memory();
  record.counters["map_cells_prior"] = record.prior_quality.points;
  record.counters["map_cells_registered"] = record.registered_quality.points;
  if (out_of_reach > 0)
    record.warnings.push_back(std::to_string(out_of_reach) + " map points lay too far out for voxels of map_leaf_m");
  return Ok{};
}

}  // namespace canyon::mission
