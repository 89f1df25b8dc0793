#include "canyon/lidar/registration/neighbour_tree.h"

#include <algorithm>

#include "canyon/core/check.h"

namespace canyon::lidar {
namespace {

constexpr std::uint32_t kLeaf = 3;
constexpr std::uint32_t kBucket = 12;

}  // namespace

NeighbourTree::NeighbourTree(std::span<const Eigen::Vector3f> points) {
  entries_.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    CANYON_CHECK(points[i].allFinite(), "point ", i, ": ", points[i].transpose());
    entries_.push_back({{points[i].x(), points[i].y(), points[i].z()}, static_cast<std::uint32_t>(i)});
  }
  nodes_.reserve(points.size() / 3 + 1);
  build(0, static_cast<std::uint32_t>(entries_.size()));
}

void NeighbourTree::build(std::uint32_t begin, std::uint32_t end) {
  const auto node = nodes_.size();
  if (end - begin <= kBucket) {
    nodes_.push_back({.axis = kLeaf, .right_or_end = end, .begin = begin, .high = 0});
    return;
  }
  float low[3], high[3];
  for (int a = 0; a < 3; ++a) low[a] = high[a] = entries_[begin].p[a];
  for (std::uint32_t i = begin + 1; i < end; ++i) {
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], entries_[i].p[a]);
      high[a] = std::max(high[a], entries_[i].p[a]);
    }
  }
  std::uint32_t axis = 0;
  for (std::uint32_t a = 1; a < 3; ++a) {
    if (high[a] - low[a] > high[axis] - low[axis]) axis = a;
  }
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(entries_.begin() + begin, entries_.begin() + middle, entries_.begin() + end,
                   [axis](const Entry& a, const Entry& b) {
                     return a.p[axis] < b.p[axis] || (a.p[axis] == b.p[axis] && a.index < b.index);
                   });
  float largest_left = entries_[begin].p[axis];
  for (std::uint32_t i = begin + 1; i < middle; ++i) largest_left = std::max(largest_left, entries_[i].p[axis]);
  nodes_.push_back({.axis = axis, .right_or_end = 0, .low = largest_left, .high = entries_[middle].p[axis]});
  build(begin, middle);
  nodes_[node].right_or_end = static_cast<std::uint32_t>(nodes_.size());
  build(middle, end);
}

/// One query: the neighbours found so far, sorted, and how far away a point may still be.
class NeighbourTree::Search {
 public:
  Search(const NeighbourTree& tree, const Eigen::Vector3f& query, float radius_m, std::span<Neighbour> out)
      : tree_(tree), query_{query.x(), query.y(), query.z()}, limit_(radius_m * radius_m), out_(out) {}

  /// `outside[a]`: how far the query lies outside the node's box along axis a; `squared_m` the sum of their squares.
  void descend(std::uint32_t index, float squared_m) {
    const Node& node = tree_.nodes_[index];
    if (node.axis == kLeaf) {
      scan(node.begin, node.right_or_end);
      return;
    }
    const float q = query_[node.axis];
    const float from_left = q - node.low;
    const float from_right = node.high - q;
    const bool left_first = from_left < from_right;
    const float gap = std::max(0.0f, left_first ? from_right : from_left);
    descend(left_first ? index + 1 : node.right_or_end, squared_m);
    const float before = outside_[node.axis];
    const float farther = std::max(before, gap);
    const float there = squared_m - before * before + farther * farther;
    // Rounding of the running sum must not hide a point on the border.
    if (there > limit_ * 1.00001f) return;
    outside_[node.axis] = farther;
    descend(left_first ? node.right_or_end : index + 1, there);
    outside_[node.axis] = before;
  }

  std::size_t found() const { return count_; }

 private:
  void scan(std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = begin; i < end; ++i) {
      const Entry& entry = tree_.entries_[i];
      const float dx = entry.p[0] - query_[0];
      const float dy = entry.p[1] - query_[1];
      const float dz = entry.p[2] - query_[2];
      const float squared_m = dx * dx + dy * dy + dz * dz;
      if (squared_m > limit_) continue;
      insert({squared_m, entry.index});
    }
  }

  void insert(const Neighbour& neighbour) {
    const bool full = count_ == out_.size();
    if (full ? !(neighbour < out_[count_ - 1]) : neighbour.squared_m >= limit_) return;
    std::size_t i = full ? count_ - 1 : count_++;
    for (; i > 0 && neighbour < out_[i - 1]; --i) out_[i] = out_[i - 1];
    out_[i] = neighbour;
    if (count_ == out_.size()) limit_ = out_[count_ - 1].squared_m;
  }

  const NeighbourTree& tree_;
  float query_[3];
  float outside_[3] = {0, 0, 0};
  float limit_;
  std::span<Neighbour> out_;
  std::size_t count_ = 0;
};

std::size_t NeighbourTree::nearest(const Eigen::Vector3f& query, float radius_m, std::span<Neighbour> out) const {
  CANYON_CHECK(!out.empty() && query.allFinite(), "out.size() = ", out.size(), ", query ", query.transpose());
  Search search(*this, query, radius_m, out);
  search.descend(0, 0.0f);
  return search.found();
}

}  // namespace canyon::lidar
