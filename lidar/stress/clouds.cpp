// Voxels, search trees, maps and files of clouds: identical points, points far away, none.
#include <cmath>
#include <limits>

#include "canyon/core/check.h"
#include "canyon/core/output/printed.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress_rows.h"
#include "canyon/lidar/files/scan_files.h"
#include "canyon/lidar/map_quality/map_error.h"
#include "canyon/lidar/registration/neighbour_tree.h"
#include "canyon/lidar/registration/prepared_cloud.h"
#include "canyon/lidar/stress/subjects.h"
#include "canyon/lidar/voxels/voxel_index.h"
#include "canyon/lidar/voxels/voxel_map.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"

namespace canyon::lidar {
namespace {

constexpr float kBad = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

/// Voxels at the ends of their numbers: 2^20 to either side and none beyond, -0 and 0 one voxel, a rounding below 0
/// another; a number comes back. A figure counts what differs.
StressFigure voxels(double leaf_m) {
  VoxelIndex index(leaf_m);
  StressFigure out;
  const auto far_m = static_cast<float>(1048576.0 * leaf_m);
  for (const float x : {std::nextafter(far_m, kInf), 1.001f * far_m, 1e30f, kInf, kBad})
    for (const float sense : {1.0f, -1.0f}) out.figure += index.coordinates({0.0f, sense * x, 0.0f}) ? 1.0 : 0.0;
  const auto at = [&](float x, float y, float z) { return index.coordinates({x, y, z}); };
  for (const float sense : {1.0f, -1.0f}) {
    const auto edge = at(sense * 0.999f * far_m, 0.0f, -sense * 0.999f * far_m);
    if (!edge) return {1e9, 0.0};
    const std::uint32_t number = index.insert(*edge);
    out.figure += index.find(*edge) == number && index.insert(*edge) == number ? 0.0 : 1.0;
  }
  out.figure += at(0.0f, 0.0f, 0.0f) == at(-0.0f, -0.0f, -0.0f) ? 0.0 : 1.0;
  out.figure += at(-1e-30f, 0.0f, 0.0f) == std::optional(VoxelCoordinates(-1, 0, 0)) ? 0.0 : 1.0;
  out.figure += index.size() == 2 ? 0.0 : 1.0;
  return out;
}

/// A million voxels of a cube of a hundred, each once and numbered in the order of their coming.
StressFigure many_voxels() {
  VoxelIndex index(0.5);
  StressFigure out;
  std::uint32_t expected = 0;
  for (int round = 0; round < 2; ++round)
    for (int k = 0; k < 125000; ++k) {
      const VoxelCoordinates v(k % 50 - 25, k / 50 % 50 - 25, k / 2500 - 25);
      const std::uint32_t number = index.insert(v);
      out.figure += number == (round == 0 ? expected++ : static_cast<std::uint32_t>(k)) ? 0.0 : 1.0;
    }
  out.figure += std::abs(static_cast<double>(index.size()) - 125000.0);
  return out;
}

/// The nearest twenty by trying all; ties go to the lower index. A figure counts what differs, to the bit.
StressFigure neighbours(const std::vector<Eigen::Vector3f>& points, float radius_m) {
  const NeighbourTree tree(points);
  StressFigure out;
  std::array<NeighbourTree::Neighbour, 20> found;
  for (std::size_t q = 0; q < std::min<std::size_t>(points.size(), 60); ++q) {
    const Eigen::Vector3f query = points[q * 31 % points.size()];
    std::vector<NeighbourTree::Neighbour> all;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const float dx = points[i].x() - query.x(), dy = points[i].y() - query.y(), dz = points[i].z() - query.z();
      const float squared = dx * dx + dy * dy + dz * dz;
      if (squared < radius_m * radius_m) all.push_back({squared, i});
    }
    const std::size_t n = std::min<std::size_t>(all.size(), found.size());
    std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(n), all.end());
    const std::size_t count = tree.nearest(query, radius_m, found);
    out.figure += count == n ? 0.0 : 1.0;
    for (std::size_t k = 0; k < std::min(n, count); ++k) out.figure += found[k].index == all[k].index ? 0.0 : 1.0;
  }
  return out;
}

std::vector<Eigen::Vector3f> scattered(int n, float scale) {
  const RandomStream draws(3, "stress.clouds");
  std::vector<Eigen::Vector3f> out;
  for (std::uint64_t k = 0; k < static_cast<std::uint64_t>(n); ++k)
    out.emplace_back(scale * static_cast<float>(draws.uniform(-1, 1, 0, k)),
                     scale * static_cast<float>(draws.uniform(-1, 1, 1, k)),
                     scale * static_cast<float>(draws.uniform(-1, 1, 2, k)));
  return out;
}

/// Clouds that are hardly any become prepared ones of finite points and unit or no normals; a figure counts others.
StressFigure prepared() {
  StressFigure out;
  std::vector<std::vector<Eigen::Vector3f>> clouds{{},
                                                   {{1, 2, 3}},
                                                   {{1, 2, 3}, {1, 2, 3}},
                                                   std::vector<Eigen::Vector3f>(5000, {4, 5, 6}),
                                                   std::vector<Eigen::Vector3f>(5000, {0, 0, 0}),
                                                   std::vector<Eigen::Vector3f>(100, {kBad, 1, 1}),
                                                   std::vector<Eigen::Vector3f>(100, {1e30f, 1, kInf}),
                                                   scattered(2000, 1e5f),
                                                   scattered(2000, 1e-30f)};
  std::vector<Eigen::Vector3f> line, plane;
  for (int k = 0; k < 2000; ++k)
    line.emplace_back(0.01f * static_cast<float>(k), 0, 1),
        plane.emplace_back(0.5f * static_cast<float>(k % 40), 0.5f * static_cast<float>(k / 40), 1);
  clouds.push_back(line), clouds.push_back(plane);
  for (const auto& cloud : clouds) {
    const PreparedCloud p = prepare_cloud(cloud, 0.5);
    out.figure += p.points.size() == p.normals.size() && p.points.size() == p.tilt_variance.size() ? 0.0 : 1.0;
    for (std::size_t i = 0; i < p.points.size(); ++i) {
      const double length = p.normals[i].norm();
      out.figure += p.points[i].allFinite() && (length == 0.0 || std::abs(length - 1.0) < 1e-5) &&
                            p.tilt_variance[i] >= 0.0f && std::isfinite(p.tilt_variance[i])
                        ? 0.0
                        : 1.0;
    }
  }
  return out;
}

/// A map of points that are not finite or out of reach: only counted; the others once a voxel. A figure counts.
StressFigure maps() {
  VoxelMap map(0.5);
  StressFigure out;
  for (int k = 0; k < 1000; ++k) map.insert({.p_W = {0.1f, 0.2f, 0.3f}});
  for (const float bad : {kBad, kInf, -kInf, 1e9f}) map.insert({.p_W = {0.0f, bad, 0.0f}});
  out.figure += map.size() == 1 && map.out_of_reach() == 4 ? 0.0 : 1.0;
  return out;
}

/// Errors of a map over level ground: heights themselves up to the cap, the cap beyond, NaN of no points at all. Single
/// precision of 4 m: half a unit.
StressFigure map_errors() {
  scene::SceneParts parts;
  parts.name = "ground";
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("ground", scene::ObjectKind::kTerrain);
  mesh.quad({-100, -100, 0}, {100, -100, 0}, {100, 100, 0}, {-100, 100, 0}, mesh.material("asphalt"));
  const scene::Scene scene(std::move(parts));
  const scene::SceneAt now(scene);
  StressFigure out{0.0, 0x1p-24 * 4.0};
  MapCloud none;
  const MapQuality nothing = evaluate_map(none, now).quality;
  if (nothing.points != 0 || !std::isnan(nothing.map_error_rms_m) || !std::isnan(nothing.map_error_up_rms_m))
    out.figure = 1.0;
  MapCloud points;
  for (const float z : {0.0f, 1e-6f, -2.5f, 3.7f, 4.9f, 5.1f, 1e6f}) points.push_back({.p_W = {1.0f, 2.0f, z}});
  const auto [q, error_m] = evaluate_map(points, now);
  for (std::size_t i = 0; i < points.size(); ++i)
    take_worst(out, std::abs(error_m[i] - std::min(std::abs(static_cast<double>(points[i].p_W.z())), kMapErrorCap_m)));
  if (q.capped_points != 2 || q.points != 7) out.figure = 1.0;
  return out;
}

/// Files of no points have their header; of one point of each extreme, its bytes. A figure counts what is empty or
/// throws.
StressFigure files() {
  StressFigure out;
  const GpsTime t = GpsTime::from_week_sow(2048, 0.0);
  for (const CloudFormat& format : cloud_formats()) {
    std::vector<LidarPoint> points;
    const std::size_t bare = format.text(t, points).size();
    out.figure += bare > 50 ? 0.0 : 1.0;
    points.push_back(
        {.x = 1e5f, .y = -1e5f, .z = 1e-30f, .intensity = 2.0f, .time_s = -0.1f, .ring = 65535, .return_index = 255});
    points.push_back(
        {.x = -0.0f, .y = 0.0f, .z = 0.0f, .intensity = -1.0f, .time_s = 0.0f, .ring = 0, .return_index = 0});
    out.figure += format.text(t, points).size() > bare ? 0.0 : 1.0;
  }
  return out;
}

}  // namespace

std::vector<StressCase> cloud_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "voxels at the ends of their numbers",
           "21 bits that overflow into the next axis; 0 and -0.3 in one voxel",
           "none beyond 2^20, each other by its floor", "wrong"});
  for (const double leaf : {0.01, 0.5, 100.0}) {
    rows.add(printed("clouds/voxels_of_%g_m", leaf), [leaf] { return voxels(leaf); });
  }
  rows.add("clouds/voxels_by_the_hundred_thousand", many_voxels);
  rows.of({StressGroup::kGeometry, "nearest neighbours among equals, on a line, far apart",
           "a tree split without end; a tie that depends on the order of visits",
           "as by trying all, ties to the lower index", "differences"});
  rows.add("clouds/neighbours_of_20000_identical",
           [] {
             return neighbours(std::vector<Eigen::Vector3f>(20000, {1, 2, 3}), 1.0f);
           })
      .add("clouds/neighbours_on_a_line",
           [] {
             std::vector<Eigen::Vector3f> line;
             for (int k = 0; k < 5000; ++k) line.emplace_back(static_cast<float>(k / 2), 0, 0);
             return neighbours(line, 100.0f);
           })
      .add("clouds/neighbours_scattered", [] { return neighbours(scattered(5000, 10.0f), 3.0f); })
      .add("clouds/neighbours_within_1e30_m", [] { return neighbours(scattered(3000, 1e15f), 1e18f); })
      .add("clouds/neighbours_of_none_and_one", [] {
        StressFigure out = neighbours({{5, 5, 5}}, 1.0f);
        std::array<NeighbourTree::Neighbour, 1> one;
        out.figure += static_cast<double>(NeighbourTree({}).nearest({0, 0, 0}, 1e9f, one));
        return out;
      });
  rows.of({StressGroup::kData, "clouds that are hardly any",
           "a normal of a point's neighbours that are itself; a mean of NaN", "finite points, unit normals or none",
           "wrong"});
  rows.add("clouds/prepared", prepared).add("clouds/map_of_points_out_of_reach", maps);
  rows.of({StressGroup::kData, "map errors at their cap, and of no map",
           "0 / 0 of an empty map; an endless distance in the mean", "heights up to 5 m, NaN without points", "m"});
  rows.add("clouds/map_errors", map_errors);
  rows.of({StressGroup::kData, "files of no points and of extreme ones", "a count of -1, a ring beyond its byte",
           "a header, and more bytes for more points", "wrong"});
  rows.add("clouds/files", files);
  return rows.take();
}

}  // namespace canyon::lidar
