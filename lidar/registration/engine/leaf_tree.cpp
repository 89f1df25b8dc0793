#include "canyon/lidar/registration/engine/leaf_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "canyon/core/check.h"
#include "canyon/core/math/key_select.h"

namespace canyon::lidar {
namespace {

constexpr float kPadding_m = 1e18f;  // its square is finite in single precision
// Sums of squares are rounded; a border must not hide a point that lies on it.
constexpr float kBorder = 1.000001f;
constexpr int kDeepest = 32;

/// Four numbers at once: what g++ and clang make of vectors on any machine.
using Four = float __attribute__((vector_size(16)));
using FourSigns = std::int32_t __attribute__((vector_size(16)));

Four four_of(const float* from) {
  Four v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
/// Bit k: sign k.
std::uint32_t bits_of(FourSigns signs) {
#ifdef __SSE2__
  return static_cast<std::uint32_t>(__builtin_ia32_movmskps(reinterpret_cast<Four>(signs)));
#else
  std::uint32_t bits = 0;
  for (int k = 0; k < 4; ++k) bits |= signs[k] != 0 ? 1U << k : 0U;
  return bits;
#endif
}

/// A number that sorts by the coordinate, equal ones by the point.
std::uint64_t key_of(float coordinate, std::uint32_t point) {
  const auto bits = std::bit_cast<std::uint32_t>(coordinate);
  const std::uint32_t sorting = (bits >> 31) != 0 ? ~bits : bits | 0x80000000U;
  return static_cast<std::uint64_t>(sorting) << 32 | point;
}
std::uint32_t point_of(std::uint64_t key) {
  return static_cast<std::uint32_t>(key);
}

/// Splits the points in halves along their widest axis until leaves are left. A key's point is known at any time.
struct Builder {
  const std::vector<Four>& places;
  std::vector<std::uint64_t>& keys;
  std::vector<std::uint64_t>& scratch;
  std::vector<float>& split;
  std::vector<std::uint8_t>& axis;
  std::vector<std::uint32_t>& leaf_begin;
  std::uint32_t leaves;

  std::uint8_t widest(std::uint32_t begin, std::uint32_t end) const {
    Four low = places[point_of(keys[begin])], high = low;
    for (std::uint32_t i = begin + 1; i < end; ++i) {
      const Four p = places[point_of(keys[i])];
      low = p < low ? p : low;
      high = p > high ? p : high;
    }
    std::uint8_t out = 0;
    for (std::uint8_t a = 1; a < 3; ++a) {
      if (high[a] - low[a] > high[out] - low[out]) out = a;
    }
    return out;
  }

  void build(std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
    if (node >= leaves) {
      leaf_begin[node - leaves] = begin;
      std::sort(keys.begin() + begin, keys.begin() + end,
                [](std::uint64_t a, std::uint64_t b) { return point_of(a) < point_of(b); });
      return;
    }
    const std::uint8_t along = widest(begin, end);
    const std::uint32_t middle = begin + (end - begin) / 2;
    for (std::uint32_t i = begin; i < end; ++i) {
      const std::uint32_t point = point_of(keys[i]);
      keys[i] = key_of(places[point][along], point);
    }
    select_key(std::span(keys).subspan(begin, end - begin), middle - begin, scratch);
    axis[node] = along;
    split[node] = places[point_of(keys[middle])][along];
    build(2 * node, begin, middle);
    build(2 * node + 1, middle, end);
  }
};

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
  /// Bit k: that of place k is below the limit.
  std::uint32_t below(float limit) const { return bits_of(first < limit) | bits_of(second < limit) << 4; }
  void put(float* squared_m) const {
    std::memcpy(squared_m, &first, sizeof first);
    std::memcpy(squared_m + 4, &second, sizeof second);
  }
};

/// As many bits, of a bucket.
std::uint32_t first_of(std::uint32_t count) {
  return (1U << count) - 1U;
}

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
  std::vector<Four> places(points.size());
  std::vector<std::uint64_t> keys(points.size()), scratch(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    CANYON_CHECK(points[i].allFinite(), "point ", i, ": ", points[i].transpose());
    places[i] = Four{points[i].x(), points[i].y(), points[i].z(), 0.0F};
    keys[i] = i;
  }
  const auto n = static_cast<std::uint32_t>(points.size());
  leaves_ = std::bit_ceil((n + kBucket - 1) / kBucket);
  split_.resize(leaves_);
  axis_.resize(leaves_);
  leaf_begin_.resize(leaves_ + 1);
  leaf_begin_[leaves_] = n;
  Builder{places, keys, scratch, split_, axis_, leaf_begin_, leaves_}.build(1, 0, n);
  x_.assign(n + kBucket, kPadding_m);
  y_.assign(n + kBucket, kPadding_m);
  z_.assign(n + kBucket, kPadding_m);
  order_.resize(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    order_[i] = point_of(keys[i]);
    const Four place = places[order_[i]];
    x_[i] = place[0];
    y_[i] = place[1];
    z_[i] = place[2];
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
    std::uint32_t nearer = bucket.below(best);
    if (nearer == 0) return;
    float squared_m[kBucket];
    bucket.put(squared_m);
    for (; nearer != 0; nearer &= nearer - 1) {
      const auto k = static_cast<std::uint32_t>(std::countr_zero(nearer));
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
    std::uint32_t nearer = bucket.below(others) & first_of(end - begin);
    if (nearer == 0) return;
    float squared_m[kBucket];
    bucket.put(squared_m);
    for (; nearer != 0; nearer &= nearer - 1) {
      const auto k = static_cast<std::uint32_t>(std::countr_zero(nearer));
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
    std::uint32_t nearer = bucket.below(limit) & first_of(end - begin);
    if (nearer == 0) return;
    float squared_m[kBucket];
    bucket.put(squared_m);
    for (; nearer != 0; nearer &= nearer - 1) {
      const auto k = static_cast<std::uint32_t>(std::countr_zero(nearer));
      if (squared_m[k] < limit) limit = list.take(rank_of(squared_m[k], begin + k), out.size(), limit);
    }
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
      std::uint32_t nearer = bucket.below(limit[i]) & first_of(end - begin);
      if (nearer == 0) continue;
      float squared_m[kBucket];
      bucket.put(squared_m);
      for (; nearer != 0; nearer &= nearer - 1) {
        const auto k = static_cast<std::uint32_t>(std::countr_zero(nearer));
        if (squared_m[k] < limit[i]) limit[i] = lists[i].take(rank_of(squared_m[k], begin + k), most, limit[i]);
      }
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
