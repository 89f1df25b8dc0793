#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace canyon::gnss {

/// Directions about which waves are looked for, by columns: wave s comes from near axis v if v . s reaches `least`. The
/// axes may have any length.
struct WaveAxes {
  std::vector<float> x, y, z, least;

  std::size_t size() const { return x.size(); }
  void clear() { resize(0); }
  void resize(std::size_t count) {
    for (auto* of : {&x, &y, &z, &least}) of->resize(count);
  }
  /// `length`: no less than the axis's.
  void add(const Eigen::Vector3d& axis, double length, double at_least) {
    x.push_back(static_cast<float>(axis.x()));
    y.push_back(static_cast<float>(axis.y()));
    z.push_back(static_cast<float>(axis.z()));
    least.push_back(static_cast<float>(at_least - kRounding * length));
  }

  /// What single precision may take off v . s, as a share of the axis's length: each of the inputs and each of five
  /// operations rounds by 2^-24 of no more than that, and `least` twice more.
  static constexpr double kRounding = 2e-6;
};

struct AxisAndWave {
  std::uint32_t axis, wave;
};

/// The waves of an epoch in single precision, for a test that nearly all pairs fail.
class NearWaves {
 public:
  void fill(std::span<const Eigen::Vector3d> directions_W);
  /// All pairs of a wave and an axis that it comes from near, and few others; by axis, then by wave. Replaces what is
  /// in `out`.
  void find(const WaveAxes& axes, std::vector<AxisAndWave>& out) const;

 private:
  std::vector<float> x_, y_, z_;
};

}  // namespace canyon::gnss
