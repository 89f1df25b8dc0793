#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace canyon::lidar {

/// A balanced k-d tree whose points stand in the order of its leaves, coordinate by coordinate, so that a leaf is one
/// stretch of memory. Whoever takes its order for the points' other columns needs no indirection. Queries are exact up
/// to the rounding of squared distances in single precision, deterministic and thread-safe.
class LeafTree {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  struct Nearest {
    float squared_m = std::numeric_limits<float>::infinity();
    std::uint32_t at = kNone;  ///< place in the tree's order
  };

  LeafTree() = default;
  /// Points must be finite; there may be none.
  explicit LeafTree(std::span<const Eigen::Vector3f> points);

  std::size_t size() const { return order_.size(); }
  /// order()[k]: which of the points given stands at place k.
  const std::vector<std::uint32_t>& order() const { return order_; }
  Eigen::Vector3f point(std::size_t at) const { return {x_[at], y_[at], z_[at]}; }

  /// The point nearest to `query` and closer than sqrt(squared_limit); kNone where there is none. The query must be
  /// finite.
  Nearest nearest(const Eigen::Vector3f& query, float squared_limit) const;
  /// The up to out.size() nearest, closer than sqrt(squared_limit), nearest first (equal distances: lower place first);
  /// returns how many.
  std::size_t nearest(const Eigen::Vector3f& query, float squared_limit, std::span<Nearest> out) const;

 private:
  template <class Take>
  void visit(const float* query, const float& limit, const Take& take) const;

  std::vector<float> x_, y_, z_;  // a leaf's length longer than there are points
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> leaf_begin_;  // one more than there are leaves
  std::vector<float> split_;               // of inner node k, children 2 k and 2 k + 1; the root is 1
  std::vector<std::uint8_t> axis_;
  std::uint32_t leaves_ = 0;
};

}  // namespace canyon::lidar
