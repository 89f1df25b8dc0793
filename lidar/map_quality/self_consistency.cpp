#include "canyon/lidar/map_quality/self_consistency.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "canyon/core/process/parallel.h"
#include "canyon/core/units.h"

namespace canyon::lidar {
namespace {

constexpr std::size_t kScatterChunk = 1024;
constexpr double kLeastVariance_m2 = 1e-6;

struct ScatterSums {
  double entropy = 0.0, plane_m2 = 0.0;
  std::int64_t points = 0;
};

Eigen::Matrix3d scatter(const PointGrid& map, const std::vector<std::uint32_t>& neighbours,
                        const Eigen::Vector3d& about) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const std::uint32_t k : neighbours) {
    const Eigen::Vector3d d = map.points()[k].cast<double>() - about;
    mean += d;
    second += d * d.transpose();
  }
  const auto n = static_cast<double>(neighbours.size());
  mean /= n;
  return second / n - mean * mean.transpose();
}

ScatterSums measure_consistency(const PointGrid& map, std::size_t begin, std::size_t end, double radius_m) {
  ScatterSums sums;
  std::vector<std::uint32_t> neighbours;
  for (std::size_t i = begin; i < end; ++i) {
    const Eigen::Vector3d p = map.points()[i].cast<double>();
    map.within(p, radius_m, neighbours);
    if (neighbours.size() < kFewestNeighbours) continue;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter(map, neighbours, p), Eigen::EigenvaluesOnly);
    const Eigen::Vector3d variances = solver.eigenvalues();
    for (int k = 0; k < 3; ++k)
      sums.entropy += 0.5 * std::log(2.0 * kPi * std::exp(1.0) * std::max(variances[k], kLeastVariance_m2));
    sums.plane_m2 += std::max(variances[0], 0.0);
    ++sums.points;
  }
  return sums;
}

}  // namespace

SelfConsistency self_consistency(const PointGrid& map, double radius_m) {
  const std::size_t n = map.points().size();
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
