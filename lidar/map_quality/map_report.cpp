#include "canyon/lidar/map_quality/map_report.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "canyon/core/check.h"
#include "canyon/core/process/parallel.h"
#include "canyon/lidar/map_quality/signed_distance.h"
#include "canyon/scene/tracing/nearest_surfaces.h"

namespace canyon::lidar {
namespace {

constexpr std::size_t kReportChunk = 1024;
constexpr double kLevelCosine = 0.8660254037844386;  // cosine of 30 degrees

/// Sums in the order of points, whatever the threads.
struct ErrorSums {
  std::int64_t points = 0;
  double squared = 0, up_squared = 0, across_squared = 0, signed_sum = 0;

  void add(const SurfaceOffset& o) {
    ++points;
    squared += o.distance_m * o.distance_m;
    up_squared += o.up_m() * o.up_m();
    across_squared += o.across_m() * o.across_m();
    signed_sum += o.distance_m;
  }
  MapErrors errors(std::string name) const {
    MapErrors out;
    out.name = std::move(name);
    out.points = points;
    if (points == 0) return out;
    const auto n = static_cast<double>(points);
    out.rms_m = std::sqrt(squared / n);
    out.up_rms_m = std::sqrt(up_squared / n);
    out.across_rms_m = std::sqrt(across_squared / n);
    out.signed_mean_m = signed_sum / n;
    return out;
  }
};

std::vector<WallPoint> offsets(std::span<const Eigen::Vector3f> map_W, const scene::Scene& scene, double cap_m) {
  const SignedDistance surfaces(scene);
  const std::vector<scene::NearestSurface> nearest = scene::nearest_surfaces(scene, map_W, cap_m);
  std::vector<WallPoint> out(map_W.size());
  parallel_for(map_W.size(), kReportChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      out[i] = {map_W[i], surfaces.at(map_W[i].cast<double>(), cap_m, nearest[i])};
  });
  return out;
}

/// Distance of each point to the nearest of the grid, capped.
std::vector<double> distances(std::span<const Eigen::Vector3f> points, const PointGrid& to, double cap_m) {
  std::vector<double> out(points.size());
  parallel_for(points.size(), kReportChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) out[i] = to.nearest_m(points[i].cast<double>(), cap_m);
  });
  return out;
}

bool is_level(const SurfaceOffset& o, const scene::Scene& scene) {
  return std::abs(o.normal_W.z()) >= kLevelCosine &&
         scene.objects()[scene.mesh().object[o.triangle]].kind != scene::ObjectKind::kTree;
}

void fill_errors(const std::vector<WallPoint>& points, const scene::Scene& scene, double cap_m, MapReport& out) {
  ErrorSums all, level;
  std::map<std::uint16_t, ErrorSums> materials;
  std::vector<double> sizes;
  double with_capped = 0.0;
  std::array<std::int64_t, 3> within{};
  for (const WallPoint& point : points) {
    const SurfaceOffset& o = point.offset;
    const double size = o.found ? std::abs(o.distance_m) : cap_m;
    sizes.push_back(size);
    with_capped += size * size;
    for (std::size_t k = 0; k < within.size(); ++k) within[k] += o.found && size <= kWithin_m[k];
    if (!o.found) {
      ++out.capped_points;
      continue;
    }
    all.add(o);
    materials[scene.mesh().material[o.triangle]].add(o);
    if (is_level(o, scene)) level.add(o);
  }
  out.all = all.errors("all");
  out.level_up_rms_m = level.errors("level").up_rms_m;
  for (const auto& [material, sums] : materials)
    out.by_material.push_back(sums.errors(scene.materials()[material].name));
  if (points.empty()) return;
  const auto n = static_cast<double>(points.size());
  out.all.rms_m = std::sqrt(with_capped / n);
  for (std::size_t k = 0; k < within.size(); ++k) out.accuracy[k] = static_cast<double>(within[k]) / n;
  const std::size_t rank = (95 * sizes.size() + 99) / 100 - 1;
  std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(rank), sizes.end());
  out.p95_m = sizes[rank];
}

/// Spans of ranges, m; the last is open.
constexpr std::array<double, 5> kRanges_m{0.0, 10.0, 20.0, 30.0, 40.0};

void fill_ranges(const std::vector<WallPoint>& points, std::span<const Eigen::Vector3f> map_W,
                 const std::vector<Eigen::Vector3f>& sensor_W, MapReport& out) {
  if (sensor_W.empty()) return;
  const std::vector<double> ranges = distances(map_W, PointGrid(sensor_W, kRanges_m[1]), 200.0);
  std::array<ErrorSums, kRanges_m.size()> sums;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto next = std::upper_bound(kRanges_m.begin(), kRanges_m.end(), ranges[i]);
    if (points[i].offset.found) sums[static_cast<std::size_t>(next - kRanges_m.begin()) - 1].add(points[i].offset);
  }
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const auto metres = [](double m) { return std::to_string(static_cast<int>(m)); };
    const std::string to = k + 1 < kRanges_m.size() ? " to " + metres(kRanges_m[k + 1]) + " m" : " m and more";
    out.by_range.push_back(sums[k].errors(metres(kRanges_m[k]) + to));
  }
}

void fill_completeness(const std::vector<WallPoint>& points, const PointGrid& map, const MapTruth& truth, double cap_m,
                       MapReport& out) {
  out.true_points = static_cast<std::int64_t>(truth.points_W.size());
  if (truth.points_W.empty() || points.empty()) return;
  const std::vector<double> to_map = distances(truth.points_W, map, cap_m);
  const auto n = static_cast<double>(to_map.size());
  double there = 0.0, back = 0.0;
  for (const double d : to_map) back += d;
  for (const WallPoint& p : points) there += p.offset.found ? std::abs(p.offset.distance_m) : cap_m;
  out.chamfer_m = there / static_cast<double>(points.size()) + back / n;
  for (std::size_t k = 0; k < kWithin_m.size(); ++k) {
    const auto near = std::count_if(to_map.begin(), to_map.end(), [k](double d) { return d <= kWithin_m[k]; });
    out.completeness[k] = static_cast<double>(near) / n;
    const double sum = out.accuracy[k] + out.completeness[k];
    out.f_score[k] = sum > 0.0 ? 2.0 * out.accuracy[k] * out.completeness[k] / sum : 0.0;
  }
}

}  // namespace

MapReport report_map(std::span<const Eigen::Vector3f> map_W, const scene::Scene& scene, const MapTruth& truth,
                     double cap_m, double neighbourhood_m) {
  CANYON_CHECK(cap_m > 0 && neighbourhood_m > 0, "cap_m = ", cap_m, ", neighbourhood_m = ", neighbourhood_m);
  MapReport out;
  out.points = static_cast<std::int64_t>(map_W.size());
  const std::vector<WallPoint> points = offsets(map_W, scene, cap_m);
  const PointGrid map(map_W, neighbourhood_m);
  fill_errors(points, scene, cap_m, out);
  fill_ranges(points, map_W, truth.sensor_W, out);
  fill_completeness(points, map, truth, cap_m, out);
  out.walls = wall_thickness(points, scene);
  out.consistency = self_consistency(map, neighbourhood_m);
  return out;
}

}  // namespace canyon::lidar
