#include "canyon/study/registration_error/scan_error.h"

#include <algorithm>

#include "canyon/lidar/map_quality/map_error.h"
#include "canyon/scene/tracing/nearest_surfaces.h"

namespace canyon::study {
namespace {

/// The spread of distances to surfaces is about their size, so that 400 points tell their root mean square to 5 %.
constexpr std::size_t kSampledPoints = 400;

}  // namespace

std::vector<Eigen::Vector3f> sampled_points(const LidarScan& scan, double range_m) {
  std::vector<Eigen::Vector3f> near;
  const auto range2_m2 = static_cast<float>(range_m * range_m);
  for (const LidarPoint& point : scan.points) {
    const Eigen::Vector3f p_L(point.x, point.y, point.z);
    if (p_L.squaredNorm() <= range2_m2) near.push_back(p_L);
  }
  if (near.size() <= kSampledPoints) return near;
  std::vector<Eigen::Vector3f> out;
  for (std::size_t i = 0; i < kSampledPoints; ++i) out.push_back(near[i * near.size() / kSampledPoints]);
  return out;
}

double placed_error_m2(const std::vector<Eigen::Vector3f>& points_L, const Pose& X_WL, const scene::Scene& scene) {
  std::vector<Eigen::Vector3f> places;
  places.reserve(points_L.size());
  for (const Eigen::Vector3f& p_L : points_L) places.push_back((X_WL * p_L.cast<double>()).cast<float>());
  double sum_m2 = 0.0;
  for (const scene::NearestSurface& surface : scene::nearest_surfaces(scene, places, lidar::kMapErrorCap_m)) {
    const double distance_m = std::min(surface.distance_m, lidar::kMapErrorCap_m);
    sum_m2 += distance_m * distance_m;
  }
  return places.empty() ? kNaN : sum_m2 / static_cast<double>(places.size());
}

}  // namespace canyon::study
