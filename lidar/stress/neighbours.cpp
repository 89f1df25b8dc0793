// Neighbours and planes of a cloud's points: trees, prepared surfaces and cubes, against all points tried in turn.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/lidar/registration/engine/leaf_tree.h"
#include "canyon/lidar/registration/engine/surface_cloud.h"
#include "canyon/lidar/registration/engine/surface_target.h"
#include "canyon/lidar/registration/neighbour_tree.h"
#include "canyon/lidar/registration/prepared_cloud.h"
#include "canyon/lidar/stress/engine_pieces.h"
#include "canyon/lidar/stress/made_clouds.h"
#include "canyon/lidar/stress/subjects.h"

namespace canyon::lidar {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3f;
using made::drawn_cloud;
using stress::kInfinity;
using stress::Looks;

/// Neighbours from both trees against all points in turn: squares of distances to their rounding, in order.
StressFigure trees(int n) {
  Looks looks;
  const auto cloud = drawn_cloud(5, n, 20.0);
  const std::vector<Vector3f>& points = cloud->points;
  const LeafTree& leaves = *cloud->tree;
  const NeighbourTree tree(points);
  const RandomStream draws(6, "stress.trees");
  looks.right(leaves.size() == points.size());
  for (std::uint64_t k = 0; k < 200; ++k) {
    const Vector3f q(static_cast<float>(draws.uniform(-24, 24, 0, k)), static_cast<float>(draws.uniform(-24, 24, 1, k)),
                     static_cast<float>(draws.uniform(-9, 9, 2, k)));
    const auto reach = static_cast<float>(draws.uniform(0.5, 12.0, 3, k));
    std::vector<std::pair<float, std::uint32_t>> all;
    for (std::uint32_t i = 0; i < points.size(); ++i) all.emplace_back((points[i] - q).squaredNorm(), i);
    std::sort(all.begin(), all.end());
    const auto within = static_cast<std::size_t>(
        std::count_if(all.begin(), all.end(), [&](const auto& p) { return p.first < reach * reach; }));
    // Squared distances of up to 40 m in single precision.
    const double grain = 8.0 * stress::kHalfUlp * static_cast<double>(reach) * static_cast<double>(reach);
    std::array<LeafTree::Nearest, 9> near;
    const std::size_t count = leaves.nearest(q, reach * reach, near);
    looks.right(count == (within < 9 ? within : 9));
    std::array<NeighbourTree::Neighbour, 9> others;
    const std::size_t found = tree.nearest(q, reach, others);
    looks.right(found == count);
    for (std::size_t i = 0; i < count; ++i) {
      looks.near(static_cast<double>(near[i].squared_m), static_cast<double>(all[i].first), grain);
      looks.near(static_cast<double>(others[i].squared_m), static_cast<double>(all[i].first), grain);
      looks.near(static_cast<double>((leaves.point(near[i].at) - q).squaredNorm()), static_cast<double>(all[i].first),
                 grain);
    }
    const auto first = leaves.nearest(q, reach * reach);
    looks.right((first.at == LeafTree::kNone) == (within == 0));
    if (within > 0) looks.near(static_cast<double>(first.squared_m), static_cast<double>(all[0].first), grain);
    const auto from =
        leaves.nearest_from(q, reach * reach, static_cast<std::uint32_t>(static_cast<std::size_t>(k) % leaves.size()));
    looks.right((from.at == LeafTree::kNone) == (within == 0));
    if (within > 0) {
      looks.near(static_cast<double>(from.squared_m), static_cast<double>(all[0].first), grain);
      looks.right(points.size() < 2 || static_cast<double>(from.others_squared_m) <=
                                           static_cast<double>(all[1].first) * (1.0 + 8.0 * stress::kHalfUlp) + grain);
    }
  }
  // All of a leaf at once.
  std::size_t seen = 0;
  for (std::uint32_t leaf = 0; leaf < leaves.leaves(); ++leaf) {
    LeafTree::OfLeaf<5> of;
    leaves.nearest_of_leaf(leaf, 9.0f, of);
    for (std::uint32_t i = of.begin; i < of.end; ++i, ++seen) {
      std::vector<float> all;
      for (std::uint32_t k = 0; k < leaves.size(); ++k)
        all.push_back((leaves.point(k) - leaves.point(i)).squaredNorm());
      std::sort(all.begin(), all.end());
      const auto within =
          static_cast<std::size_t>(std::count_if(all.begin(), all.end(), [](float d) { return d < 9.0f; }));
      looks.right(of.count[i - of.begin] == (within < 5 ? within : 5));
      for (std::size_t k = 0; k < of.count[i - of.begin]; ++k)
        looks.near(static_cast<double>(of.nearest[i - of.begin][k].squared_m), static_cast<double>(all[k]),
                   8.0 * stress::kHalfUlp * 9.0);
    }
  }
  looks.right(seen == leaves.size());
  return looks.figure();
}

/// Thinned points are the means of their cubes, and each one's plane that of its 12 nearest within eight leaves: normal
/// and tilt from the scatter's eigenvalues. A plane that hardly is one has a normal that rounding turns, so only those
/// count whose two smaller values are apart by a fifth.
StressFigure prepared_surfaces() {
  Looks looks;
  made::Cloud raw = made::room(3);
  raw.resize(4000);
  raw.push_back(Vector3f::Zero());
  const double leaf = 0.5;
  const auto cloud = prepare_surfaces(raw, leaf);
  std::map<std::array<int, 3>, std::pair<Vector3d, int>> cubes;
  for (const Vector3f& p : raw) {
    if (p == Vector3f::Zero()) continue;
    std::array<int, 3> at{};
    for (std::size_t a = 0; a < 3; ++a)
      at[a] = static_cast<int>(std::floor(static_cast<double>(p[static_cast<int>(a)]) / leaf));
    auto& [sum, n] = cubes.try_emplace(at, Vector3d::Zero(), 0).first->second;
    sum += p.cast<double>(), ++n;
  }
  looks.right(cubes.size() == cloud->points.size());
  int planes = 0;
  for (std::size_t i = 0; i < cloud->points.size(); ++i) {
    const Vector3f& p = cloud->points[i];
    double nearest = kInfinity;
    for (const auto& [at, of] : cubes) nearest = std::min(nearest, (of.first / of.second - p.cast<double>()).norm());
    looks.near(nearest, 0.0, 4.0 * stress::kHalfUlp * 10.0);
    if (i % 7 != 0) continue;
    std::vector<std::pair<float, std::size_t>> all;
    for (std::size_t k = 0; k < cloud->points.size(); ++k) all.emplace_back((cloud->points[k] - p).squaredNorm(), k);
    std::sort(all.begin(), all.end());
    std::size_t n = 0;
    while (n < 12 && n < all.size() && all[n].first < 16.0f) ++n;
    if (n < 6 || (all.size() > n && all[n].first - all[n - 1].first < 1e-5f)) continue;
    Vector3d mean = Vector3d::Zero();
    for (std::size_t k = 0; k < n; ++k) mean += cloud->points[all[k].second].cast<double>() / static_cast<double>(n);
    Matrix3d S = Matrix3d::Zero();
    for (std::size_t k = 0; k < n; ++k) {
      const Vector3d d = cloud->points[all[k].second].cast<double>() - mean;
      S += d * d.transpose() / static_cast<double>(n);
    }
    const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(S);
    const Vector3d e = eigen.eigenvalues();
    if (e[1] < 0.11 * e[2] && e[1] > 0.09 * e[2]) continue;
    if (e[1] <= 0.09 * e[2]) {
      looks.right(cloud->normals[i].isZero(0.0f));
      continue;
    }
    if (e[0] > 0.8 * e[1]) continue;
    ++planes;
    const double turned = cloud->normals[i].cast<double>().cross(eigen.eigenvectors().col(0)).norm();
    looks.near(turned, 0.0, 64.0 * stress::kHalfUlp * e[1] / (e[1] - e[0]));
    const double tilt = e[0] / (static_cast<double>(n) - 3.0) / e[1];
    looks.near(static_cast<double>(cloud->tilt_variance[i]), tilt, 1e-5 * tilt + 1e-9);
  }
  looks.right(planes > 50);
  // Two of them in one frame: where both are in a cube of the frame, the later one's.
  const Pose moved{rotation_from({.yaw_rad = 0.5, .pitch_rad = 0.0, .roll_rad = 0.0}), {3.0, 1.0, 0.0}};
  const std::array<PlacedCloud, 2> placed{PlacedCloud{cloud.get(), Matrix3d::Identity(), Vector3d::Zero()},
                                          PlacedCloud{cloud.get(), moved.R.toRotationMatrix(), moved.p}};
  const auto both = unite_surfaces(placed, leaf);
  std::map<std::array<int, 3>, int> later;
  const auto cube = [&](const Vector3f& p) {
    std::array<int, 3> at{};
    for (std::size_t a = 0; a < 3; ++a)
      at[a] = static_cast<int>(std::floor(static_cast<double>(p[static_cast<int>(a)]) / leaf));
    return at;
  };
  std::size_t expected = cloud->points.size();
  for (const Vector3f& p : cloud->points) later[cube((placed[1].R * p.cast<double>() + placed[1].p).cast<float>())] = 1;
  for (const Vector3f& p : cloud->points) expected += later.count(cube(p)) == 0 ? 1 : 0;
  looks.right(both->points.size() == expected && both->normals.size() == expected);
  return looks.figure();
}

/// Means, averaged normals and the nearest of seven cubes, for a target of cubes.
StressFigure voxel_means() {
  Looks looks;
  const auto cloud = drawn_cloud(9, 3000, 6.0);
  const double voxel = 1.0;
  const auto target = voxel_target(*cloud, voxel);
  struct Sum {
    Vector3d p = Vector3d::Zero();
    Matrix3d nn = Matrix3d::Zero();
    double n = 0, planes = 0, tilt = 0;
  };
  std::map<std::array<int, 3>, Sum> cubes;
  const auto cube = [&](const Vector3f& p) {
    return std::array{static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y())),
                      static_cast<int>(std::floor(p.z()))};
  };
  for (std::size_t i = 0; i < cloud->points.size(); ++i) {
    Sum& s = cubes[cube(cloud->points[i])];
    const Vector3d n = cloud->normals[i].cast<double>();
    s.p += cloud->points[i].cast<double>(), s.nn += n * n.transpose(), s.n += 1, s.planes += n.isZero(0.0) ? 0 : 1;
    s.tilt += static_cast<double>(cloud->tilt_variance[i]);
  }
  looks.right(target->size() == cubes.size());
  const RandomStream draws(10, "stress.voxels");
  int met = 0;
  for (std::uint64_t k = 0; k < 400; ++k) {
    const Vector3f q(static_cast<float>(draws.uniform(-6.5, 6.5, 0, k)),
                     static_cast<float>(draws.uniform(-6.5, 6.5, 1, k)),
                     static_cast<float>(draws.uniform(-2.5, 2.5, 2, k)));
    const auto home = cube(q);
    double nearest = 0.9 * 0.9;
    const Sum* of = nullptr;
    for (const auto& d : {std::array{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}) {
      const auto there = cubes.find({home[0] + d[0], home[1] + d[1], home[2] + d[2]});
      if (there == cubes.end()) continue;
      const double square = (there->second.p / there->second.n - q.cast<double>()).squaredNorm();
      if (square < nearest) nearest = square, of = &there->second;
    }
    LastMatch last;
    target->find(q, 0.81f, last);
    looks.right((last.matched == LeafTree::kNone) == (of == nullptr));
    if (of == nullptr || last.matched == LeafTree::kNone) continue;
    ++met;
    looks.near((target->point(last.matched).cast<double>() - of->p / of->n).norm(), 0.0, 8.0 * stress::kHalfUlp * 7.0);
    if (of->planes == 0) continue;
    const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(of->nn / of->n);
    const Vector3d e = eigen.eigenvalues();
    looks.near(target->flat(last.matched), (1.0 - 1e-3) * (e[2] < 1.0 ? e[2] : 1.0), 1e-6);
    looks.near(static_cast<double>(target->tilt_variance(last.matched)), of->tilt / (of->planes * of->planes),
               1e-6 * of->tilt);
    if (e[2] - e[1] > 0.05)
      looks.near(target->normal(last.matched).cast<double>().cross(eigen.eigenvectors().col(2)).norm(), 0.0,
                 64.0 * stress::kHalfUlp / (e[2] - e[1]));
  }
  looks.right(met > 200);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> neighbour_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kData,
           .mechanism = "neighbours and planes of a cloud's points",
           .why = "a branch of a tree left out, a scatter about the wrong point, a cube's corner",
           .expected = "all points tried in turn: single precision",
           .unit = "of the bound"});
  for (const int n : {1, 2, 9, 100, 1500})
    rows.add("neighbours/trees_of_" + std::to_string(n), [n] { return trees(n); });
  rows.add("neighbours/prepared_surfaces", prepared_surfaces).add("neighbours/voxel_means", voxel_means);
  return rows.take();
}

}  // namespace canyon::lidar
