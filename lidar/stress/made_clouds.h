#pragma once

#include <vector>

#include <Eigen/Core>

#include "canyon/core/random/random.h"

/// Clouds that the cases of registration are about: planes with 1 cm of noise, whose number chooses the noise.
namespace canyon::lidar::made {

using Cloud = std::vector<Eigen::Vector3f>;

class Surfaces {
 public:
  explicit Surfaces(std::uint64_t number) : draws_(number, "stress.registration") {}
  Surfaces& plane(const Eigen::Vector3d& corner, const Eigen::Vector3d& u, const Eigen::Vector3d& v, int n) {
    const Eigen::Vector3d normal = u.cross(v).normalized();
    for (int k = 0; k < n; ++k, ++drawn_)
      cloud_.push_back((corner + draws_.uniform(0, 1, 0, drawn_) * u + draws_.uniform(0, 1, 1, drawn_) * v +
                        0.01 * draws_.normal(2, drawn_) * normal)
                           .cast<float>());
    return *this;
  }
  Cloud take() { return std::move(cloud_); }

 private:
  RandomStream draws_;
  std::uint64_t drawn_ = 0;
  Cloud cloud_;
};

inline Cloud room(std::uint64_t number) {
  return Surfaces(number)
      .plane({-8, -6, -2}, {16, 0, 0}, {0, 12, 0}, 3000)
      .plane({-8, -6, -2}, {16, 0, 0}, {0, 0, 4}, 1500)
      .plane({-8, 6, -2}, {16, 0, 0}, {0, 0, 4}, 1500)
      .plane({-8, -6, -2}, {0, 12, 0}, {0, 0, 4}, 1500)
      .plane({8, -6, -2}, {0, 12, 0}, {0, 0, 4}, 1500)
      .take();
}
/// Open along x.
inline Cloud corridor(std::uint64_t number) {
  return Surfaces(number)
      .plane({-40, -3, -2}, {80, 0, 0}, {0, 6, 0}, 6000)
      .plane({-40, -3, -2}, {80, 0, 0}, {0, 0, 4}, 4000)
      .plane({-40, 3, -2}, {80, 0, 0}, {0, 0, 4}, 4000)
      .take();
}
inline Cloud level(std::uint64_t number) {
  return Surfaces(number).plane({-20, -20, -2}, {40, 0, 0}, {0, 40, 0}, 8000).take();
}
inline Cloud line() {
  Cloud out;
  for (int k = 0; k < 5000; ++k) out.emplace_back(0.02f * static_cast<float>(k), 1.0f, 0.5f);
  return out;
}

}  // namespace canyon::lidar::made
