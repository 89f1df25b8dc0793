#pragma once

#include <cstdint>
#include <memory>

#include <Eigen/Core>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/lidar/registration/engine/leaf_tree.h"
#include "canyon/lidar/registration/prepared_cloud.h"

/// What the cases of the own registrations' engine share, piece by piece.
namespace canyon::lidar::made {

/// Drawn points with normals and tilts of their own, and a few without a plane.
inline std::shared_ptr<PreparedCloud> drawn_cloud(std::uint64_t number, int n, double half_m) {
  const RandomStream draws(number, "stress.engine");
  auto cloud = std::make_shared<PreparedCloud>();
  for (std::uint64_t k = 0; k < static_cast<std::uint64_t>(n); ++k) {
    cloud->points.emplace_back(static_cast<float>(draws.uniform(-half_m, half_m, 0, k)),
                               static_cast<float>(draws.uniform(-half_m, half_m, 1, k)),
                               static_cast<float>(draws.uniform(-0.3 * half_m, 0.3 * half_m, 2, k)));
    const Eigen::Vector3d normal =
        Eigen::Vector3d(draws.normal(3, k), draws.normal(4, k), draws.normal(5, k)).normalized();
    cloud->normals.push_back(k % 17 == 3 ? Eigen::Vector3f(0, 0, 0) : Eigen::Vector3f(normal.cast<float>()));
    cloud->tilt_variance.push_back(k % 17 == 3 ? 0.0f : static_cast<float>(draws.uniform(1e-5, 1e-3, 6, k)));
  }
  const auto tree = std::make_shared<LeafTree>(cloud->points);
  PreparedCloud ordered;
  for (const std::uint32_t k : tree->order()) {
    ordered.points.push_back(cloud->points[k]);
    ordered.normals.push_back(cloud->normals[k]);
    ordered.tilt_variance.push_back(cloud->tilt_variance[k]);
  }
  ordered.tree = tree;
  *cloud = ordered;
  return cloud;
}

/// A covariance drawn by this number, at least 0.1 in every direction.
inline Matrix6d drawn_positive(std::uint64_t number) {
  const RandomStream draws(number, "stress.positive");
  Matrix6d m;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) m(i, j) = draws.normal(static_cast<std::uint32_t>(i), static_cast<std::uint64_t>(j));
  return m * m.transpose() + 0.1 * Matrix6d::Identity();
}

/// Matrices of one size, to that share of the expected one's norm.
template <class A, class B>
void alike(stress::Looks& looks, const A& found, const B& expected, double share) {
  looks.near((found - expected).norm(), 0.0, share * (expected.norm() + 1e-12));
}

/// What the cases of poses and of pairs of them have in common.
inline StressMechanism said_of_a_pose() {
  return {.group = StressGroup::kData,
          .mechanism = "what a registration says of its pose",
          .why = "a turn that counts as metres, a factor of a variance on a sigma, a frame's shift the other way",
          .expected = "projections, formulas and adjoints written out: conditioning; a bootstrap to five deviations",
          .unit = "of the bound"};
}

}  // namespace canyon::lidar::made
