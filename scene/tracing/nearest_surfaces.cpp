#include "canyon/scene/tracing/nearest_surfaces.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "canyon/core/check.h"
#include "canyon/core/process/parallel.h"
#include "canyon/scene/surfaces/triangle.h"

namespace canyon::scene {
namespace {

constexpr double kBlock_m = 1.0;  // points of one such cube share a search
constexpr std::size_t kBlocksAtOnce = 64;
constexpr std::uint32_t kLeaf = 4;
// Bounds are compared with room for rounding: what is as near as another must not be left out.
constexpr double kRoom = 1.0 + 1e-9;

struct Box {
  Eigen::Vector3f low = Eigen::Vector3f::Constant(std::numeric_limits<float>::infinity()), high = -low;

  void add(const Eigen::Vector3f& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  void add(const Box& box) {
    low = low.cwiseMin(box.low);
    high = high.cwiseMax(box.high);
  }
  double squared_distance(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d outside =
        (low.cast<double>() - p).cwiseMax(p - high.cast<double>()).cwiseMax(Eigen::Vector3d::Zero());
    return outside.squaredNorm();
  }
};

Box box_of(const Mesh& mesh, std::uint32_t triangle) {
  Box box;
  for (const std::uint32_t v : mesh.triangles[triangle]) box.add(mesh.vertices[v]);
  return box;
}

/// Boxes of triangles in a tree; children of node k are k + 1 and `second`.
class TriangleTree {
 public:
  TriangleTree(const Mesh& mesh, const Box& reach) : mesh_(mesh) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const Box box = box_of(mesh, t);
      if ((box.low.array() <= reach.high.array()).all() && (box.high.array() >= reach.low.array()).all())
        members_.push_back({box, 0.5F * (box.low + box.high), t});
    }
    if (!members_.empty()) build(0, static_cast<std::uint32_t>(members_.size()));
  }

  bool empty() const { return members_.empty(); }

  /// Calls take(triangle) for those whose box is within limit() of p, near ones rather earlier.
  template <class Limit, class Take>
  void visit(const Eigen::Vector3d& p, const Limit& limit, const Take& take) const {
    std::uint32_t waiting[128];
    int count = 0;
    waiting[count++] = 0;
    while (count > 0) {
      const std::uint32_t k = waiting[--count];
      const Node& node = nodes_[k];
      const double most = limit() * kRoom;
      if (node.box.squared_distance(p) > most * most) continue;
      if (node.second == 0) {
        for (std::uint32_t i = node.begin; i < node.end; ++i) take(members_[i].triangle);
        continue;
      }
      const bool first_nearer = nodes_[k + 1].box.squared_distance(p) <= nodes_[node.second].box.squared_distance(p);
      waiting[count++] = first_nearer ? node.second : k + 1;
      waiting[count++] = first_nearer ? k + 1 : node.second;
    }
  }

 private:
  struct Member {
    Box box;
    Eigen::Vector3f middle;
    std::uint32_t triangle;
  };
  struct Node {
    Box box;
    std::uint32_t begin, end, second = 0;
  };

  void build(std::uint32_t begin, std::uint32_t end) {
    const std::size_t k = nodes_.size();
    nodes_.push_back({{}, begin, end});
    Box middles;
    for (std::uint32_t i = begin; i < end; ++i) {
      nodes_[k].box.add(members_[i].box);
      middles.add(members_[i].middle);
    }
    if (end - begin <= kLeaf) return;
    Eigen::Index widest = 0;
    (middles.high - middles.low).maxCoeff(&widest);
    const std::uint32_t half = begin + (end - begin) / 2;
    std::nth_element(members_.begin() + begin, members_.begin() + half, members_.begin() + end,
                     [widest](const Member& a, const Member& b) {
                       return a.middle[widest] < b.middle[widest] ||
                              (a.middle[widest] == b.middle[widest] && a.triangle < b.triangle);
                     });
    build(begin, half);
    nodes_[k].second = static_cast<std::uint32_t>(nodes_.size());
    build(half, end);
  }

  const Mesh& mesh_;
  std::vector<Member> members_;
  std::vector<Node> nodes_;
};

/// What may be nearest to a point of a block.
struct Candidate {
  double from_middle_m;
  std::uint32_t index;
  Triangle triangle;
};

class BlockSearch {
 public:
  BlockSearch(const Mesh& mesh, const TriangleTree& tree, double max_m) : mesh_(mesh), tree_(tree), max_m_(max_m) {}

  void search(std::span<const Eigen::Vector3f> points, std::span<const std::uint32_t> block,
              std::vector<NearestSurface>& out) {
    Box box;
    for (const std::uint32_t i : block) box.add(points[i]);
    const Eigen::Vector3d middle = 0.5 * (box.low.cast<double>() + box.high.cast<double>());
    double radius_m = 0.0;
    for (const std::uint32_t i : block) radius_m = std::max(radius_m, (points[i].cast<double>() - middle).norm());
    gather(middle, radius_m);
    for (const std::uint32_t i : block) out[i] = nearest(points[i].cast<double>(), middle);
  }

 private:
  double distance_m(std::uint32_t triangle, const Eigen::Vector3d& p) const {
    return (Triangle::of(mesh_, triangle).closest_point(p) - p).norm();
  }

  /// Of a point at r <= radius from the middle the nearest triangle is within d + r, d that of the middle: within d + 2
  /// r of the middle.
  void gather(const Eigen::Vector3d& middle, double radius_m) {
    candidates_.clear();
    double nearest_m = max_m_ + radius_m;
    tree_.visit(
        middle, [&nearest_m] { return nearest_m; },
        [&](std::uint32_t t) { nearest_m = std::min(nearest_m, distance_m(t, middle)); });
    const double reach_m = std::min(nearest_m + 2.0 * radius_m, max_m_ + radius_m) * kRoom;
    tree_.visit(
        middle, [reach_m] { return reach_m; },
        [&](std::uint32_t t) {
          const double from_middle_m = distance_m(t, middle);
          if (from_middle_m <= reach_m * kRoom) candidates_.push_back({from_middle_m, t, Triangle::of(mesh_, t)});
        });
    std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
      return a.from_middle_m < b.from_middle_m || (a.from_middle_m == b.from_middle_m && a.index < b.index);
    });
  }

  NearestSurface nearest(const Eigen::Vector3d& p, const Eigen::Vector3d& middle) const {
    const double off_m = (p - middle).norm();
    NearestSurface best;
    best.distance_m = max_m_;
    for (const Candidate& c : candidates_) {
      if (c.from_middle_m - off_m > best.distance_m * kRoom) break;
      const Eigen::Vector3d point = c.triangle.closest_point(p);
      const double d = (point - p).norm();
      if (d < best.distance_m || (d == best.distance_m && c.index < best.triangle)) best = {d, point, c.index};
    }
    return best.triangle == Hit::kMiss ? NearestSurface{} : best;
  }

  const Mesh& mesh_;
  const TriangleTree& tree_;
  double max_m_;
  std::vector<Candidate> candidates_;
};

/// Indices of the points block by block, and where each block begins; one more at the end.
struct Blocks {
  std::vector<std::uint32_t> order, begin;

  explicit Blocks(std::span<const Eigen::Vector3f> points) : order(points.size()) {
    using Key = std::uint64_t;
    std::vector<std::pair<Key, std::uint32_t>> keys(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      CANYON_CHECK(points[i].allFinite(), "p = ", points[i].transpose());
      Key key = 0;
      for (int a = 0; a < 3; ++a) {
        // Far out blocks flow into one another, which costs time alone.
        const double cell = std::clamp(std::floor(static_cast<double>(points[i][a]) / kBlock_m), -1e6, 1e6) + 1e6;
        key = key << 21 | static_cast<Key>(cell);
      }
      keys[i] = {key, i};
    }
    std::sort(keys.begin(), keys.end());
    for (std::uint32_t k = 0; k < keys.size(); ++k) {
      order[k] = keys[k].second;
      if (k == 0 || keys[k].first != keys[k - 1].first) begin.push_back(k);
    }
    begin.push_back(static_cast<std::uint32_t>(keys.size()));
  }
};

}  // namespace

std::vector<NearestSurface> nearest_surfaces(const Scene& scene, std::span<const Eigen::Vector3f> points_W,
                                             double max_m) {
  CANYON_CHECK(max_m >= 0.0, "max_m = ", max_m);
  std::vector<NearestSurface> out(points_W.size());
  const Blocks blocks(points_W);
  Box reach;
  for (const Eigen::Vector3f& p : points_W) reach.add(p);
  const auto margin = static_cast<float>(std::min(max_m, 1e9) * 1.001 + 1.0);
  reach.low.array() -= margin;
  reach.high.array() += margin;
  const TriangleTree tree(scene.mesh(), reach);
  if (tree.empty()) return out;
  parallel_for(blocks.begin.size() - 1, kBlocksAtOnce, [&](std::size_t begin, std::size_t end) {
    BlockSearch search(scene.mesh(), tree, max_m);
    for (std::size_t b = begin; b < end; ++b)
      search.search(points_W, std::span(blocks.order).subspan(blocks.begin[b], blocks.begin[b + 1] - blocks.begin[b]),
                    out);
  });
  return out;
}

}  // namespace canyon::scene
