#include "canyon/scene/surfaces/facet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/surfaces/triangle.h"

namespace canyon::scene {
namespace {

constexpr double kPlaneTolerance_m = 0.01;
const double kNormalCosine = std::cos(0.1 * kDegree);

/// Triangles of one object that may become facets, with their neighbours across edges. Corners at the same place count
/// as one vertex, since importers and builders often repeat vertices.
class Patch {
 public:
  Patch(const Mesh& mesh, std::vector<std::uint32_t> members) : mesh_(mesh), members_(std::move(members)) {
    std::unordered_map<std::uint64_t, std::vector<std::pair<Eigen::Vector3f, std::uint32_t>>> welded;
    const auto vertex_id = [&](const Eigen::Vector3f& p) {
      const Eigen::Vector3f q = p + Eigen::Vector3f::Zero();  // -0 becomes +0
      std::uint64_t key = 0;
      for (int k = 0; k < 3; ++k)
        key = key * 0x9e3779b97f4a7c15ull + static_cast<std::uint64_t>(std::llround(double{q[k]} * 1e4));
      auto& bucket = welded[key];
      for (const auto& [at, id] : bucket) {
        if (at == q) return id;
      }
      bucket.emplace_back(q, next_vertex_);
      return next_vertex_++;
    };
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> by_edge;
    corners_.resize(members_.size());
    for (std::uint32_t i = 0; i < members_.size(); ++i) {
      throw_if_cancelled();
      for (int k = 0; k < 3; ++k) corners_[i][k] = vertex_id(mesh.vertices[mesh.triangles[members_[i]][k]]);
      for (int k = 0; k < 3; ++k) by_edge[edge(i, k)].push_back(i);
    }
    neighbours_.resize(members_.size());
    for (std::uint32_t i = 0; i < members_.size(); ++i) {
      throw_if_cancelled();
      for (int k = 0; k < 3; ++k) {
        for (const std::uint32_t j : by_edge[edge(i, k)]) {
          if (j != i) neighbours_[i].push_back(j);
        }
      }
    }
  }

  /// Grows facets from the largest triangles down; appends them in the order of their lowest triangle.
  void merge(double min_area_m2, std::vector<Facet>& out) const {
    std::vector<std::uint32_t> seeds(members_.size());
    std::vector<double> area_m2(members_.size());
    for (std::uint32_t i = 0; i < seeds.size(); ++i) {
      seeds[i] = i;
      area_m2[i] = 0.5 * Triangle::of(mesh_, members_[i]).area_normal().norm();
    }
    std::stable_sort(seeds.begin(), seeds.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return area_m2[a] > area_m2[b]; });
    std::vector<bool> taken(members_.size(), false);
    std::vector<Facet> found;
    for (const std::uint32_t seed : seeds) {
      if (taken[seed]) continue;
      throw_if_cancelled();
      const std::vector<std::uint32_t> grown = grow(seed, taken);
      Facet facet = describe(grown);
      if (facet.area_m2 < min_area_m2) continue;
      facet.borders = borders(grown, facet.normal_W);
      found.push_back(std::move(facet));
    }
    std::sort(found.begin(), found.end(),
              [](const Facet& a, const Facet& b) { return a.triangles[0] < b.triangles[0]; });
    std::move(found.begin(), found.end(), std::back_inserter(out));
  }

 private:
  std::uint64_t edge(std::uint32_t i, int k) const {
    const std::uint64_t a = corners_[i][k], b = corners_[i][(k + 1) % 3];
    return a < b ? (a << 32) | b : (b << 32) | a;
  }

  /// Indices of members, ascending.
  std::vector<std::uint32_t> grow(std::uint32_t seed, std::vector<bool>& taken) const {
    const Triangle first = Triangle::of(mesh_, members_[seed]);
    const Eigen::Vector3d normal = first.area_normal().normalized();
    const auto fits = [&](std::uint32_t i) {
      const Triangle t = Triangle::of(mesh_, members_[i]);
      if (mesh_.material[members_[i]] != mesh_.material[members_[seed]]) return false;
      if (t.area_normal().normalized().dot(normal) < kNormalCosine) return false;
      return std::abs(normal.dot(t.a - first.a)) <= kPlaneTolerance_m &&
             std::abs(normal.dot(t.b - first.a)) <= kPlaneTolerance_m &&
             std::abs(normal.dot(t.c - first.a)) <= kPlaneTolerance_m;
    };
    std::vector<std::uint32_t> grown{seed};
    taken[seed] = true;
    for (std::size_t next = 0; next < grown.size(); ++next) {
      for (const std::uint32_t j : neighbours_[grown[next]]) {
        if (taken[j] || !fits(j)) continue;
        taken[j] = true;
        grown.push_back(j);
      }
    }
    std::sort(grown.begin(), grown.end());
    return grown;
  }

  /// Sides of the triangles that they have once, in their order.
  std::vector<FacetBorder> borders(const std::vector<std::uint32_t>& grown, const Eigen::Vector3d& normal_W) const {
    std::unordered_map<std::uint64_t, int> times;
    for (const std::uint32_t i : grown)
      for (int k = 0; k < 3; ++k) ++times[edge(i, k)];
    std::vector<FacetBorder> out;
    for (const std::uint32_t i : grown) {
      const Triangle t = Triangle::of(mesh_, members_[i]);
      const std::array<Eigen::Vector3d, 3> corners{t.a, t.b, t.c};
      const bool turns_left = t.area_normal().dot(normal_W) > 0.0;
      for (int k = 0; k < 3; ++k) {
        if (times[edge(i, k)] != 1) continue;
        const Eigen::Vector3d &a = corners[static_cast<std::size_t>(k)],
                              &b = corners[static_cast<std::size_t>((k + 1) % 3)];
        out.push_back(turns_left ? FacetBorder{a, b} : FacetBorder{b, a});
      }
    }
    return out;
  }

  Facet describe(const std::vector<std::uint32_t>& grown) const {
    std::vector<std::uint32_t> triangles(grown.size());
    std::transform(grown.begin(), grown.end(), triangles.begin(), [&](std::uint32_t i) { return members_[i]; });
    std::sort(triangles.begin(), triangles.end());
    Facet facet;
    facet.material = mesh_.material[triangles[0]];
    facet.object = mesh_.object[triangles[0]];
    Eigen::Vector3d area_normal = Eigen::Vector3d::Zero(), weighted = Eigen::Vector3d::Zero();
    Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
    for (const std::uint32_t i : triangles) {
      const Triangle t = Triangle::of(mesh_, i);
      area_normal += t.area_normal();
      const double area_m2 = 0.5 * t.area_normal().norm();
      facet.area_m2 += area_m2;
      weighted += area_m2 / 3.0 * (t.a + t.b + t.c);
      low = low.cwiseMin(t.a).cwiseMin(t.b).cwiseMin(t.c);
      high = high.cwiseMax(t.a).cwiseMax(t.b).cwiseMax(t.c);
    }
    facet.normal_W = area_normal.normalized();
    facet.offset_m = facet.normal_W.dot(weighted / facet.area_m2);
    facet.center_W = 0.5 * (low + high);
    for (const std::uint32_t i : triangles) {
      for (const std::uint32_t v : mesh_.triangles[i]) {
        facet.radius_m = std::max(facet.radius_m, (mesh_.vertices[v].cast<double>() - facet.center_W).norm());
      }
    }
    facet.bottom_m = low.z();
    facet.top_m = high.z();
    bound(triangles, facet);
    facet.triangles = std::move(triangles);
    return facet;
  }

  /// Flatness and bounding rectangle.
  void bound(const std::vector<std::uint32_t>& triangles, Facet& facet) const {
    for (const std::uint32_t i : triangles) {
      const Triangle t = Triangle::of(mesh_, i);
      for (const Eigen::Vector3d& p : {t.a, t.b, t.c})
        facet.flatness_m = std::max(facet.flatness_m, std::abs(facet.normal_W.dot(p) - facet.offset_m));
    }
    // Tried along every edge of the first triangles; a rectangle has two that fit.
    double smallest_m2 = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < std::min<std::size_t>(triangles.size(), 4); ++k) {
      const Triangle t = Triangle::of(mesh_, triangles[k]);
      for (const Eigen::Vector3d& edge :
           {Eigen::Vector3d(t.b - t.a), Eigen::Vector3d(t.c - t.b), Eigen::Vector3d(t.a - t.c)}) {
        const Eigen::Vector3d u = (edge - facet.normal_W.dot(edge) * facet.normal_W).normalized();
        const Eigen::Vector3d v = facet.normal_W.cross(u);
        Eigen::Vector2d low = Eigen::Vector2d::Constant(1e300), high = -low;
        for (const std::uint32_t i : triangles) {
          for (const std::uint32_t vertex : mesh_.triangles[i]) {
            const Eigen::Vector3d q = mesh_.vertices[vertex].cast<double>() - facet.center_W;
            const Eigen::Vector2d at(q.dot(u), q.dot(v));
            low = low.cwiseMin(at);
            high = high.cwiseMax(at);
          }
        }
        const double area_m2 = (high - low).prod();
        if (!(area_m2 < smallest_m2)) continue;
        smallest_m2 = area_m2;
        const Eigen::Vector3d on_plane =
            facet.center_W - (facet.normal_W.dot(facet.center_W) - facet.offset_m) * facet.normal_W;
        facet.rectangle_W = {on_plane + low.x() * u + low.y() * v, on_plane + high.x() * u + low.y() * v,
                             on_plane + high.x() * u + high.y() * v, on_plane + low.x() * u + high.y() * v};
      }
    }
    facet.fills_rectangle = facet.area_m2 >= (1.0 - 1e-6) * smallest_m2;
  }

  const Mesh& mesh_;
  std::vector<std::uint32_t> members_;
  std::vector<std::array<std::uint32_t, 3>> corners_;
  std::vector<std::vector<std::uint32_t>> neighbours_;
  std::uint32_t next_vertex_ = 0;
};

}  // namespace

std::vector<Facet> merge_planar_facets(const Scene& scene, double min_area_m2) {
  const Mesh& mesh = scene.mesh();
  std::vector<std::vector<std::uint32_t>> by_object(scene.objects().size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const ObjectKind kind = scene.objects()[mesh.object[i]].kind;
    if (kind != ObjectKind::kTerrain && kind != ObjectKind::kTree) by_object[mesh.object[i]].push_back(i);
  }
  std::vector<Facet> facets;
  for (std::vector<std::uint32_t>& members : by_object) {
    throw_if_cancelled();
    if (!members.empty()) Patch(mesh, std::move(members)).merge(min_area_m2, facets);
  }
  return facets;
}

bool facet_contains(const Facet& facet, const Scene& scene, const Eigen::Vector3d& p_W) {
  constexpr double kEdgeTolerance_m = 1e-9;
  const Eigen::Vector3d& n = facet.normal_W;
  for (const std::uint32_t index : facet.triangles) {
    const Triangle t = Triangle::of(scene.mesh(), index);
    const auto left_of = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
      const Eigen::Vector3d inward = n.cross(to - from);
      return inward.dot(p_W - from) >= -kEdgeTolerance_m * inward.norm();
    };
    if (left_of(t.a, t.b) && left_of(t.b, t.c) && left_of(t.c, t.a)) return true;
  }
  return false;
}

}  // namespace canyon::scene
