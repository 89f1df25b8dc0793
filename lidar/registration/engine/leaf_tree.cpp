#include "canyon/lidar/registration/engine/leaf_tree.h"

#include <algorithm>
#include <bit>

#include "canyon/core/check.h"

namespace canyon::lidar {
namespace {

constexpr std::uint32_t kBucket = 8;
constexpr float kPadding_m = 1e18f;  // its square is finite in single precision
// Sums of squares are rounded; a border must not hide a point that lies on it.
constexpr float kBorder = 1.000001f;
constexpr int kDeepest = 32;

struct Entry {
  float p[3];
  std::uint32_t index;
};

struct Builder {
  std::vector<Entry>& entries;
  std::vector<float>& split;
  std::vector<std::uint8_t>& axis;
  std::vector<std::uint32_t>& leaf_begin;
  std::uint32_t leaves;

  void build(std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
    if (node >= leaves) {
      leaf_begin[node - leaves] = begin;
      return;
    }
    float low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
    for (std::uint32_t i = begin; i < end; ++i) {
      for (int a = 0; a < 3; ++a) {
        low[a] = i == begin ? entries[i].p[a] : std::min(low[a], entries[i].p[a]);
        high[a] = i == begin ? entries[i].p[a] : std::max(high[a], entries[i].p[a]);
      }
    }
    std::uint8_t widest = 0;
    for (std::uint8_t a = 1; a < 3; ++a) {
      if (high[a] - low[a] > high[widest] - low[widest]) widest = a;
    }
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(entries.begin() + begin, entries.begin() + middle, entries.begin() + end,
                     [widest](const Entry& a, const Entry& b) {
                       return a.p[widest] < b.p[widest] || (a.p[widest] == b.p[widest] && a.index < b.index);
                     });
    axis[node] = widest;
    split[node] = entries[middle].p[widest];
    build(2 * node, begin, middle);
    build(2 * node + 1, middle, end);
  }
};

}  // namespace

LeafTree::LeafTree(std::span<const Eigen::Vector3f> points) {
  if (points.empty()) return;
  std::vector<Entry> entries(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    CANYON_CHECK(points[i].allFinite(), "point ", i, ": ", points[i].transpose());
    entries[i] = {{points[i].x(), points[i].y(), points[i].z()}, i};
  }
  const auto n = static_cast<std::uint32_t>(points.size());
  leaves_ = std::bit_ceil((n + kBucket - 1) / kBucket);
  split_.resize(leaves_);
  axis_.resize(leaves_);
  leaf_begin_.resize(leaves_ + 1);
  leaf_begin_[leaves_] = n;
  Builder{entries, split_, axis_, leaf_begin_, leaves_}.build(1, 0, n);
  x_.assign(n + kBucket, kPadding_m);
  y_.assign(n + kBucket, kPadding_m);
  z_.assign(n + kBucket, kPadding_m);
  order_.resize(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    x_[i] = entries[i].p[0];
    y_[i] = entries[i].p[1];
    z_[i] = entries[i].p[2];
    order_[i] = entries[i].index;
  }
}

/// Calls take(begin, end) with every leaf that may hold points closer than `limit`, which `take` may lower.
template <class Take>
void LeafTree::visit(const float* query, const float& limit, const Take& take) const {
  if (leaves_ == 0) return;
  struct Later {
    std::uint32_t node;
    float squared_m;
    float outside[3];  // how far the query lies outside of the node's box, by axis
  };
  Later later[kDeepest];
  int waiting = 0;
  std::uint32_t node = 1;
  float outside[3] = {0, 0, 0};
  for (;;) {
    while (node < leaves_) {
      const std::uint8_t a = axis_[node];
      const float beyond = query[a] - split_[node];
      const std::uint32_t right = beyond >= 0 ? 1 : 0;
      const float before = outside[a];
      outside[a] = beyond;
      const float there = outside[0] * outside[0] + outside[1] * outside[1] + outside[2] * outside[2];
      if (there < limit * kBorder)
        later[waiting++] = {2 * node + (1 - right), there, {outside[0], outside[1], outside[2]}};
      outside[a] = before;
      node = 2 * node + right;
    }
    take(leaf_begin_[node - leaves_], leaf_begin_[node - leaves_ + 1]);
    do {
      if (waiting == 0) return;
      --waiting;
    } while (!(later[waiting].squared_m < limit * kBorder));
    node = later[waiting].node;
    for (int a = 0; a < 3; ++a) outside[a] = later[waiting].outside[a];
  }
}

LeafTree::Nearest LeafTree::nearest(const Eigen::Vector3f& query, float squared_limit) const {
  const float q[3] = {query.x(), query.y(), query.z()};
  float best = squared_limit;
  std::uint32_t at = kNone;
  visit(q, best, [&](std::uint32_t begin, std::uint32_t) {
    // Always a whole bucket: what stands after a shorter leaf are points as well, or padding.
    float squared_m[kBucket];
    for (std::uint32_t k = 0; k < kBucket; ++k) {
      const float dx = x_[begin + k] - q[0], dy = y_[begin + k] - q[1], dz = z_[begin + k] - q[2];
      squared_m[k] = dx * dx + dy * dy + dz * dz;
    }
    for (std::uint32_t k = 0; k < kBucket; ++k) {
      if (squared_m[k] < best) {
        best = squared_m[k];
        at = begin + k;
      }
    }
  });
  return {best, at};
}

std::size_t LeafTree::nearest(const Eigen::Vector3f& query, float squared_limit, std::span<Nearest> out) const {
  CANYON_CHECK(!out.empty(), "no room for a neighbour");
  const float q[3] = {query.x(), query.y(), query.z()};
  float limit = squared_limit;
  std::size_t count = 0;
  visit(q, limit, [&](std::uint32_t begin, std::uint32_t end) {
    float squared_m[kBucket];
    for (std::uint32_t k = 0; k < kBucket; ++k) {
      const float dx = x_[begin + k] - q[0], dy = y_[begin + k] - q[1], dz = z_[begin + k] - q[2];
      squared_m[k] = dx * dx + dy * dy + dz * dz;
    }
    for (std::uint32_t k = 0; k < end - begin; ++k) {
      if (!(squared_m[k] < limit)) continue;
      const bool full = count == out.size();
      std::size_t i = full ? count - 1 : count++;
      const Nearest found{squared_m[k], begin + k};
      for (; i > 0 && (found.squared_m < out[i - 1].squared_m ||
                       (found.squared_m == out[i - 1].squared_m && found.at < out[i - 1].at));
           --i)
        out[i] = out[i - 1];
      out[i] = found;
      if (count == out.size()) limit = out[count - 1].squared_m;
    }
  });
  return count;
}

}  // namespace canyon::lidar
