#include "canyon/lidar/map_quality/self_consistency.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "canyon/core/check.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/units.h"

namespace canyon::lidar {
namespace {

constexpr std::size_t kScatterChunk = 64;  // cells
constexpr double kLeastVariance_m2 = 1e-6;
const double kOfUnitVariances = 1.5 * std::log(2.0 * kPi * std::exp(1.0));

struct ScatterSums {
  double entropy = 0.0, plane_m2 = 0.0;
  std::int64_t points = 0;
};

/// Moments of what lies near a point, about the point.
struct Moments {
  double count = 0, x = 0, y = 0, z = 0, xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  void add_within(std::span<const Eigen::Vector3f> points, const Eigen::Vector3f& p, double radius2_m2) {
    for (const Eigen::Vector3f& q : points) {
      const double dx = static_cast<double>(q.x()) - static_cast<double>(p.x()),
                   dy = static_cast<double>(q.y()) - static_cast<double>(p.y()),
                   dz = static_cast<double>(q.z()) - static_cast<double>(p.z());
      if (!(dx * dx + dy * dy + dz * dz <= radius2_m2)) continue;
      count += 1;
      x += dx, y += dy, z += dz;
      xx += dx * dx, xy += dx * dy, xz += dx * dz, yy += dy * dy, yz += dy * dz, zz += dz * dz;
    }
  }
  Eigen::Matrix3d scatter() const {
    const Eigen::Vector3d mean = Eigen::Vector3d(x, y, z) / count;
    Eigen::Matrix3d second;
    second << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    return second / count - mean * mean.transpose();
  }
};

ScatterSums measure_consistency(const PointGrid& map, std::size_t begin, std::size_t end, double radius_m) {
  ScatterSums sums;
  for (std::size_t cell = begin; cell < end; ++cell) {
    const auto around = map.around(cell);
    for (const Eigen::Vector3f& p : map.points_of(cell)) {
      Moments moments;
      for (const auto& points : around) moments.add_within(points, p, radius_m * radius_m);
      if (moments.count < kFewestNeighbours) continue;
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
      solver.computeDirect(moments.scatter(), Eigen::EigenvaluesOnly);
      const Eigen::Vector3d variances = solver.eigenvalues();
      sums.entropy += kOfUnitVariances + 0.5 * std::log(variances.cwiseMax(kLeastVariance_m2).prod());
      sums.plane_m2 += std::max(variances[0], 0.0);
      ++sums.points;
    }
  }
  return sums;
}

}  // namespace

SelfConsistency self_consistency(const PointGrid& map, double radius_m) {
  CANYON_CHECK(radius_m > 0 && radius_m <= map.cell_m(), "radius_m = ", radius_m, ", cells of ", map.cell_m());
  const std::size_t n = map.cells();
  std::vector<ScatterSums> chunks((n + kScatterChunk - 1) / kScatterChunk);
  parallel_for(n, kScatterChunk, [&](std::size_t begin, std::size_t end) {
    chunks[begin / kScatterChunk] = measure_consistency(map, begin, end, radius_m);
  });
  ScatterSums total;
  for (const ScatterSums& s : chunks) {
    total.entropy += s.entropy;
    total.plane_m2 += s.plane_m2;
    total.points += s.points;
  }
  SelfConsistency out;
  out.points = total.points;
  if (total.points == 0) return out;
  out.mean_map_entropy = total.entropy / static_cast<double>(total.points);
  out.mean_plane_variance_m2 = total.plane_m2 / static_cast<double>(total.points);
  return out;
}

}  // namespace canyon::lidar
