#include "canyon/lidar/map_quality/map_error.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/check.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/units.h"
#include "canyon/scene/tracing/nearest_surfaces.h"

namespace canyon::lidar {
namespace {

constexpr std::size_t kErrorsChunk = 1024;
static_assert(MapCloud::kBlock % kErrorsChunk == 0);
const double kLevel = std::cos(30.0 * kDegree);

struct Sums {
  double squared = 0, up = 0, up_squared = 0;
  std::int64_t up_points = 0, capped = 0;
};

bool is_level_ground_or_roof(const scene::Scene& scene, std::uint32_t triangle) {
  const scene::Mesh& mesh = scene.mesh();
  if (scene.objects()[mesh.object[triangle]].kind == scene::ObjectKind::kTree) return false;
  const auto& [a, b, c] = mesh.triangles[triangle];
  const Eigen::Vector3d p = mesh.vertices[a].cast<double>();
  const Eigen::Vector3d normal = (mesh.vertices[b].cast<double>() - p).cross(mesh.vertices[c].cast<double>() - p);
  return std::abs(normal.z()) >= kLevel * normal.norm();
}

Sums measure(std::span<const MapPoint> points, std::span<const scene::NearestSurface> surfaces,
             const scene::Scene& scene, double cap_m, std::span<float> error_m) {
  Sums sums;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const scene::NearestSurface& nearest = surfaces[i];
    const bool found = nearest.triangle != scene::Hit::kMiss && nearest.distance_m < cap_m;
    const double distance_m = found ? nearest.distance_m : cap_m;
    error_m[i] = static_cast<float>(distance_m);
    sums.squared += distance_m * distance_m;
    if (!found) {
      ++sums.capped;
    } else if (is_level_ground_or_roof(scene, nearest.triangle)) {
      const double up_m = static_cast<double>(points[i].p_W.z()) - nearest.point_W.z();
      sums.up += up_m;
      sums.up_squared += up_m * up_m;
      ++sums.up_points;
    }
  }
  return sums;
}

/// The sums of a block, chunk by chunk.
void measure_block(std::span<const MapPoint> points, const scene::Scene& scene, double cap_m, std::span<Sums> chunks,
                   std::span<float> error_m) {
  std::vector<Eigen::Vector3f> places;
  places.reserve(points.size());
  for (const MapPoint& point : points) places.push_back(point.p_W);
  const auto surfaces = scene::nearest_surfaces(scene, places, cap_m);
  parallel_for(points.size(), kErrorsChunk, [&](std::size_t begin, std::size_t end) {
    const std::size_t n = end - begin;
    chunks[begin / kErrorsChunk] = measure(points.subspan(begin, n), std::span(surfaces).subspan(begin, n), scene,
                                           cap_m, error_m.subspan(begin, n));
  });
}

double p95(std::vector<float> errors) {
  const std::size_t rank = (95 * errors.size() + 99) / 100 - 1;
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(rank), errors.end());
  return errors[rank];
}

}  // namespace

MapScore evaluate_map(const MapCloud& cloud, const scene::SceneAt& scene, double cap_m) {
  CANYON_CHECK(cap_m > 0, "cap_m = ", cap_m);
  MapScore score;
  MapQuality& quality = score.quality;
  quality.points = static_cast<std::int64_t>(cloud.size());
  if (cloud.empty()) return score;
  score.error_m.resize(cloud.size());
  // The nearest surfaces of one block at a time: of all they would be more than twice the map itself.
  std::vector<Sums> chunks((cloud.size() + kErrorsChunk - 1) / kErrorsChunk);
  for (std::size_t k = 0; k < cloud.blocks(); ++k)
    measure_block(cloud.block(k), scene.scene(), cap_m,
                  std::span(chunks).subspan(k * (MapCloud::kBlock / kErrorsChunk)),
                  std::span(score.error_m).subspan(k * MapCloud::kBlock));
  Sums total;
  for (const Sums& s : chunks) {
    total.squared += s.squared;
    total.up += s.up;
    total.up_squared += s.up_squared;
    total.up_points += s.up_points;
    total.capped += s.capped;
  }
  const auto n = static_cast<double>(cloud.size());
  quality.map_error_rms_m = std::sqrt(total.squared / n);
  quality.capped_points = total.capped;
  quality.up_points = total.up_points;
  if (total.up_points > 0) {
    const auto up_n = static_cast<double>(total.up_points);
    quality.map_error_up_rms_m = std::sqrt(total.up_squared / up_n);
    quality.map_error_up_mean_m = total.up / up_n;
  }
  quality.map_error_p95_m = p95(score.error_m);
  return score;
}

}  // namespace canyon::lidar
