#include "canyon/lidar/registration/engine/leaf_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "canyon/core/check.h"

namespace canyon::lidar {
namespace {

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

/// Four numbers at once: what g++ and clang make of vectors on any machine.
using Four = float __attribute__((vector_size(16)));
using FourSigns = std::int32_t __attribute__((vector_size(16)));

Four four_of(const float* from) {
  Four v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
bool any(FourSigns signs) {
  std::uint64_t half[2];
  std::memcpy(half, &signs, sizeof half);
  return (half[0] | half[1]) != 0;
}

/// Squared distances of a whole bucket from a place. What stands after a shorter leaf are points as well, or padding.
struct Bucket {
  static_assert(LeafTree::kBucket == 8);
  Four first, second;

  Bucket(const float* x, const float* y, const float* z, float qx, float qy, float qz)
      : first(from(x, y, z, qx, qy, qz)), second(from(x + 4, y + 4, z + 4, qx, qy, qz)) {}
  static Four from(const float* x, const float* y, const float* z, float qx, float qy, float qz) {
    const Four dx = four_of(x) - qx, dy = four_of(y) - qy, dz = four_of(z) - qz;
    return dx * dx + dy * dy + dz * dz;
  }
  bool any_below(float limit) const { return any((first < limit) | (second < limit)); }
  void put(float* squared_m) const {
    std::memcpy(squared_m, &first, sizeof first);
    std::memcpy(squared_m + 4, &second, sizeof second);
  }
};

/// A neighbour as one number that sorts by distance, then place.
std::uint64_t rank_of(float squared_m, std::uint32_t at) {
  return static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(squared_m)) << 32 | at;
}
LeafTree::Nearest of_rank(std::uint64_t rank) {
  return {std::bit_cast<float>(static_cast<std::uint32_t>(rank >> 32)), static_cast<std::uint32_t>(rank)};
}

/// The nearest so far, at most `most` of them, in order.
struct RankedList {
  static constexpr std::size_t kMost = 32;
  std::array<std::uint64_t, kMost> ranks;
  std::size_t count = 0;

  /// Returns the new limit.
  float take(std::uint64_t rank, std::size_t most, float limit) {
    std::size_t i = count == most ? count - 1 : count++;
    for (; i > 0 && rank < ranks[i - 1]; --i) ranks[i] = ranks[i - 1];
    ranks[i] = rank;
    return count == most ? of_rank(ranks[count - 1]).squared_m : limit;
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

/// Calls take(begin, end) with every leaf that may hold points closer than `limit`, which `take` may lower, and left()
/// with the least squared distance of what is left out.
template <class Take, class Left>
void LeafTree::visit(const float* query, const float& limit, const Take& take, const Left& left) const {
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
      if (there < limit * kBorder) {
        later[waiting++] = {2 * node + (1 - right), there, {outside[0], outside[1], outside[2]}};
      } else {
        left(there);
      }
      outside[a] = before;
      node = 2 * node + right;
    }
    take(leaf_begin_[node - leaves_], leaf_begin_[node - leaves_ + 1]);
    for (;;) {
      if (waiting == 0) return;
      --waiting;
      if (later[waiting].squared_m < limit * kBorder) break;
      left(later[waiting].squared_m);
    }
    node = later[waiting].node;
    for (int a = 0; a < 3; ++a) outside[a] = later[waiting].outside[a];
  }
}

/// The same for a box: what is left out is farther than sqrt(limit) from all of it.
template <class Take>
void LeafTree::visit_box(const float* low, const float* high, const float* middle, const float& limit,
                         const Take& take) const {
  struct Later {
    std::uint32_t node;
    float squared_m;
    float outside[3];
  };
  Later later[kDeepest];
  int waiting = 0;
  std::uint32_t node = 1;
  float outside[3] = {0, 0, 0};
  for (;;) {
    while (node < leaves_) {
      const std::uint8_t a = axis_[node];
      const std::uint32_t right = middle[a] >= split_[node] ? 1 : 0;
      const float beyond = right != 0 ? low[a] - split_[node] : split_[node] - high[a], before = outside[a];
      outside[a] = std::max(before, beyond);
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
  const auto take = [&](std::uint32_t begin, std::uint32_t) {
    const Bucket bucket(&x_[begin], &y_[begin], &z_[begin], q[0], q[1], q[2]);
    if (!bucket.any_below(best)) return;
    float squared_m[kBucket];
    bucket.put(squared_m);
    for (std::uint32_t k = 0; k < kBucket; ++k) {
      if (squared_m[k] < best) {
        best = squared_m[k];
        at = begin + k;
      }
    }
  };
  visit(q, best, take, [](float) {});
  return {best, at};
}

LeafTree::NearestOfTwo LeafTree::nearest_from(const Eigen::Vector3f& query, float squared_limit,
                                              std::uint32_t first) const {
  const float q[3] = {query.x(), query.y(), query.z()};
  float best = squared_limit, others = std::numeric_limits<float>::infinity();
  std::uint32_t at = kNone;
  if (first != kNone) {
    const float dx = x_[first] - q[0], dy = y_[first] - q[1], dz = z_[first] - q[2];
    const float there = dx * dx + dy * dy + dz * dz;
    if (there < best) best = there, at = first;
  }
  const auto take = [&](std::uint32_t begin, std::uint32_t end) {
    const Bucket bucket(&x_[begin], &y_[begin], &z_[begin], q[0], q[1], q[2]);
    if (!bucket.any_below(others)) return;
    float squared_m[kBucket];
    bucket.put(squared_m);
    for (std::uint32_t k = 0; k < end - begin; ++k) {
      if (!(squared_m[k] < others)) continue;
      if (squared_m[k] < best) {
        if (at != kNone) others = best;
        best = squared_m[k];
        at = begin + k;
      } else if (begin + k != at) {
        others = squared_m[k];
      }
    }
  };
  visit(q, best, take, [&others](float squared_m) { others = std::min(others, squared_m); });
  NearestOfTwo out;
  out.squared_m = best;
  out.at = at;
  out.others_squared_m = others;
  return out;
}

std::size_t LeafTree::nearest(const Eigen::Vector3f& query, float squared_limit, std::span<Nearest> out) const {
  CANYON_CHECK(!out.empty() && out.size() <= RankedList::kMost, out.size(), " neighbours");
  const float q[3] = {query.x(), query.y(), query.z()};
  float limit = squared_limit;
  RankedList list;
  const auto take = [&](std::uint32_t begin, std::uint32_t end) {
    const Bucket bucket(&x_[begin], &y_[begin], &z_[begin], q[0], q[1], q[2]);
    if (!bucket.any_below(limit)) return;
    float squared_m[kBucket];
    bucket.put(squared_m);
    for (std::uint32_t k = 0; k < end - begin; ++k)
      if (squared_m[k] < limit) limit = list.take(rank_of(squared_m[k], begin + k), out.size(), limit);
  };
  visit(q, limit, take, [](float) {});
  for (std::size_t k = 0; k < list.count; ++k) out[k] = of_rank(list.ranks[k]);
  return list.count;
}

void LeafTree::nearest_of_leaf(std::uint32_t leaf, float squared_limit, std::size_t most, std::size_t* count,
                               Nearest* nearest) const {
  CANYON_CHECK(most <= RankedList::kMost, most, " neighbours");
  const std::uint32_t own_begin = leaf_begin_[leaf], own = leaf_begin_[leaf + 1] - own_begin;
  if (own == 0) return;
  const std::vector<float>* const columns[3] = {&x_, &y_, &z_};
  float low[3], high[3], middle[3], limit[kBucket];
  for (int a = 0; a < 3; ++a) {
    const float* const v = columns[a]->data() + own_begin;
    low[a] = *std::min_element(v, v + own);
    high[a] = *std::max_element(v, v + own);
    middle[a] = 0.5F * (low[a] + high[a]);
  }
  std::fill(limit, limit + own, squared_limit);
  float widest = squared_limit;
  std::array<RankedList, kBucket> lists;
  const auto take = [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = 0; i < own; ++i) {
      const Bucket bucket(&x_[begin], &y_[begin], &z_[begin], x_[own_begin + i], y_[own_begin + i], z_[own_begin + i]);
      if (!bucket.any_below(limit[i])) continue;
      float squared_m[kBucket];
      bucket.put(squared_m);
      for (std::uint32_t k = 0; k < end - begin; ++k)
        if (squared_m[k] < limit[i]) limit[i] = lists[i].take(rank_of(squared_m[k], begin + k), most, limit[i]);
    }
    widest = *std::max_element(limit, limit + own);
  };
  visit_box(low, high, middle, widest, take);
  for (std::uint32_t i = 0; i < own; ++i) {
    count[i] = lists[i].count;
    for (std::size_t k = 0; k < count[i]; ++k) nearest[i * most + k] = of_rank(lists[i].ranks[k]);
  }
}

}  // namespace canyon::lidar
