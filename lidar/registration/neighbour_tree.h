#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace canyon::lidar {

/// A k-d tree over points, for exact nearest neighbours within a radius. Deterministic: equal distances go to the lower
/// index. Immutable after construction; queries are thread-safe.
class NeighbourTree {
 public:
  struct Neighbour {
    float squared_m;
    std::uint32_t index;
    bool operator<(const Neighbour& o) const {
      return squared_m < o.squared_m || (squared_m == o.squared_m && index < o.index);
    }
  };

  /// Points must be finite; there may be none.
  explicit NeighbourTree(std::span<const Eigen::Vector3f> points);

  /// The up to out.size() points nearest to `query` and closer than radius_m, nearest first; returns how many.
  /// out must not be empty; the query must be finite.
  std::size_t nearest(const Eigen::Vector3f& query, float radius_m, std::span<Neighbour> out) const;

 private:
  struct Entry {
    float p[3];
    std::uint32_t index;
  };
  /// Inner node: `low` is the largest coordinate of the left side along `axis`, `high` the smallest of the right; the
  /// left child follows its parent. Leaf (axis kLeaf): entries [begin, end).
  struct Node {
    std::uint32_t axis;
    std::uint32_t right_or_end;
    union {
      std::uint32_t begin;
      float low;
    };
    float high;
  };
  class Search;
  void build(std::uint32_t begin, std::uint32_t end);

  std::vector<Entry> entries_;  // in the order of the leaves
  std::vector<Node> nodes_;
};

}  // namespace canyon::lidar
