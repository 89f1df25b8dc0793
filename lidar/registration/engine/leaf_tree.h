#pragma once

#include <array>
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
  /// The same, beginning with the point at place `first` (kNone: with none). Also how far all other points are at
  /// least, squared: of points nearby that leaves no other the nearest as long as they are not farther off than half of
  /// what the second is beyond the first.
  struct NearestOfTwo : Nearest {
    float others_squared_m = std::numeric_limits<float>::infinity();
  };
  NearestOfTwo nearest_from(const Eigen::Vector3f& query, float squared_limit, std::uint32_t first) const;
  /// The up to out.size() nearest, closer than sqrt(squared_limit), nearest first (equal distances: lower place first);
  /// returns how many.
  std::size_t nearest(const Eigen::Vector3f& query, float squared_limit, std::span<Nearest> out) const;

  /// The same of all points of a leaf at once, each among its own neighbours: of the point at place begin + i the first
  /// count[i] of nearest[i]. Neighbours look at the same leaves, so one search serves them.
  static constexpr std::uint32_t kBucket = 8;  ///< most points in a leaf
  template <std::size_t kMost>
  struct OfLeaf {
    std::uint32_t begin = 0, end = 0;
    std::array<std::size_t, kBucket> count{};
    std::array<std::array<Nearest, kMost>, kBucket> nearest;
  };
  std::uint32_t leaves() const { return size() == 0 ? 0 : leaves_; }
  template <std::size_t kMost>
  void nearest_of_leaf(std::uint32_t leaf, float squared_limit, OfLeaf<kMost>& out) const {
    out.begin = leaf_begin_[leaf];
    out.end = leaf_begin_[leaf + 1];
    out.count.fill(0);
    nearest_of_leaf(leaf, squared_limit, kMost, out.count.data(), out.nearest[0].data());
  }

 private:
  void nearest_of_leaf(std::uint32_t leaf, float squared_limit, std::size_t most, std::size_t* count,
                       Nearest* nearest) const;
  template <class Take, class Left>
  void visit(const float* query, const float& limit, const Take& take, const Left& left) const;
  template <class Take>
  void visit_box(const float* low, const float* high, const float* middle, const float& limit, const Take& take) const;

  std::vector<float> x_, y_, z_;  // a leaf's length longer than there are points
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> leaf_begin_;  // one more than there are leaves
  std::vector<float> split_;               // of inner node k, children 2 k and 2 k + 1; the root is 1
  std::vector<std::uint8_t> axis_;
  std::uint32_t leaves_ = 0;
};

}  // namespace canyon::lidar
