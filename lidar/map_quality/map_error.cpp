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

constexpr std::size_t kChunk = 1024;
/// Points whose nearest surfaces are held at a time: more than twice the map itself, if it were of all.
constexpr std::size_t kBlock = 128 * kChunk;
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

Sums measure(std::span<MapPoint> points, std::span<const scene::NearestSurface> surfaces, const scene::Scene& scene,
             double cap_m) {
  Sums sums;
  for (std::size_t i = 0; i < points.size(); ++i) {
    MapPoint& point = points[i];
    const scene::NearestSurface& nearest = surfaces[i];
    const bool found = nearest.triangle != scene::Hit::kMiss && nearest.distance_m < cap_m;
    const double distance_m = found ? nearest.distance_m : cap_m;
    point.error_m = static_cast<float>(distance_m);
    sums.squared += distance_m * distance_m;
    if (!found) {
      ++sums.capped;
    } else if (is_level_ground_or_roof(scene, nearest.triangle)) {
      const double up_m = static_cast<double>(point.p_W.z()) - nearest.point_W.z();
      sums.up += up_m;
      sums.up_squared += up_m * up_m;
      ++sums.up_points;
    }
  }
  return sums;
}

/// The sums of a block, chunk by chunk.
void measure_block(std::span<MapPoint> points, const scene::Scene& scene, double cap_m, std::span<Sums> chunks) {
  std::vector<Eigen::Vector3f> places;
  places.reserve(points.size());
  for (const MapPoint& point : points) places.push_back(point.p_W);
  const auto surfaces = scene::nearest_surfaces(scene, places, cap_m);
  parallel_for(points.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    chunks[begin / kChunk] =
        measure(points.subspan(begin, end - begin), std::span(surfaces).subspan(begin, end - begin), scene, cap_m);
  });
}

}  // namespace

MapQuality evaluate_map(std::span<MapPoint> points, const scene::SceneAt& scene, double cap_m) {
  CANYON_CHECK(cap_m > 0, "cap_m = ", cap_m);
  MapQuality quality;
  quality.points = static_cast<std::int64_t>(points.size());
  if (points.empty()) return quality;
  std::vector<Sums> chunks((points.size() + kChunk - 1) / kChunk);
  for (std::size_t first = 0; first < points.size(); first += kBlock)
    measure_block(points.subspan(first, std::min(kBlock, points.size() - first)), scene.scene(), cap_m,
                  std::span(chunks).subspan(first / kChunk));
  Sums total;
  for (const Sums& s : chunks) {
    total.squared += s.squared;
    total.up += s.up;
    total.up_squared += s.up_squared;
    total.up_points += s.up_points;
    total.capped += s.capped;
  }
  const auto n = static_cast<double>(points.size());
  quality.map_error_rms_m = std::sqrt(total.squared / n);
  quality.capped_points = total.capped;
  quality.up_points = total.up_points;
  if (total.up_points > 0) {
    const auto up_n = static_cast<double>(total.up_points);
    quality.map_error_up_rms_m = std::sqrt(total.up_squared / up_n);
    quality.map_error_up_mean_m = total.up / up_n;
  }
  std::vector<float> errors;
  errors.reserve(points.size());
  for (const MapPoint& point : points) errors.push_back(point.error_m);
  const std::size_t rank = (95 * points.size() + 99) / 100 - 1;
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(rank), errors.end());
  quality.map_error_p95_m = errors[rank];
  return quality;
}

}  // namespace canyon::lidar
