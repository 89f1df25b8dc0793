#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/lidar/registration/prepared_cloud.h"
#include "canyon/lidar/registration/registration.h"

/// Clouds of walls for the own methods, and who registers them.
namespace canyon::lidar::testing {

using Points = std::vector<Eigen::Vector3f>;
inline constexpr const char* kOwnMethods[] = {"point_to_plane", "gicp", "vgicp"};

inline std::unique_ptr<Registration> own_method(const std::string& name, double leaf_m = 0.5) {
  RegistrationConfig config;
  config.method.name = name;
  config.method.own.get<MatchingParameters>().leaf_m = leaf_m;
  config.method.own.get<MatchingParameters>().max_iterations = 50;
  return *make_registration(config);
}

/// Points of rectangles with 1 cm of noise across. `number` chooses the noise.
class Walls {
 public:
  explicit Walls(std::uint64_t number) : draws_(number, "test.walls") {}
  Walls& add(const Eigen::Vector3d& corner, const Eigen::Vector3d& u, const Eigen::Vector3d& v, int n) {
    const Eigen::Vector3d normal = u.cross(v).normalized();
    for (int k = 0; k < n; ++k, ++drawn_)
      points_.push_back((corner + draws_.uniform(0, 1, 0, drawn_) * u + draws_.uniform(0, 1, 1, drawn_) * v +
                         0.01 * draws_.normal(2, drawn_) * normal)
                            .cast<float>());
    return *this;
  }
  Points take() { return std::move(points_); }

 private:
  RandomStream draws_;
  std::uint64_t drawn_ = 0;
  Points points_;
};

inline Points closed_room(std::uint64_t number) {
  return Walls(number)
      .add({-8, -6, -2}, {16, 0, 0}, {0, 12, 0}, 6000)
      .add({-8, -6, -2}, {16, 0, 0}, {0, 0, 4}, 3000)
      .add({-8, 6, -2}, {16, 0, 0}, {0, 0, 4}, 3000)
      .add({-8, -6, -2}, {0, 12, 0}, {0, 0, 4}, 3000)
      .add({8, -6, -2}, {0, 12, 0}, {0, 0, 4}, 3000)
      .add({2, 1, -2}, {1.5, 0, 0}, {0, 0, 3}, 600)
      .take();
}
inline Points long_corridor(std::uint64_t number) {
  return Walls(number)
      .add({-40, -3, -2}, {80, 0, 0}, {0, 6, 0}, 12000)
      .add({-40, -3, -2}, {80, 0, 0}, {0, 0, 4}, 8000)
      .add({-40, 3, -2}, {80, 0, 0}, {0, 0, 4}, 8000)
      .take();
}
inline Points level_ground(std::uint64_t number) {
  return Walls(number).add({-20, -20, -2}, {40, 0, 0}, {0, 40, 0}, 16000).take();
}

/// Covariance of xi: of each axis of a shift and of a rotation.
inline Matrix6d law(double sigma_m, double sigma_deg) {
  Matrix6d P = Matrix6d::Zero();
  P.diagonal() << Eigen::Vector3d::Constant(std::pow(sigma_deg * kDegree, 2)),
      Eigen::Vector3d::Constant(sigma_m * sigma_m);
  return P;
}

inline Pose offset(double x, double y, double z, double yaw_deg) {
  return {so3_exp({0, 0, yaw_deg * kDegree}), {x, y, z}};
}

inline RegistrationResult place(const Registration& method, const Points& source, const Points& target,
                                const PosePrior& prior) {
  const auto s = method.prepare(source);
  const Registration::Placed placed{method.prepare(target), Pose{}};
  return method.align_with_prior(*s, {&placed, 1}, prior);
}

/// A pose that is finite where the prior was; a covariance that is finite as a whole or NaN as a whole.
inline void expect_promise(const RegistrationResult& r, const Pose& prior, const std::string& what) {
  EXPECT_TRUE(r.X_TS.matrix().allFinite() || !prior.matrix().allFinite()) << what;
  EXPECT_TRUE(r.covariance.allFinite() || r.covariance.array().isNaN().all()) << what;
  EXPECT_TRUE(r.status != RegistrationStatus::kConverged || r.covariance.allFinite()) << what;
}

}  // namespace canyon::lidar::testing
