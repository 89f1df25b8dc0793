// Indices of facets and edges against trying all.
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/random/random.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/scene/stress/made_scenes.h"
#include "canyon/scene/stress/subjects.h"

namespace canyon::scene {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::kHalfUlp;
using stress::kInfinity;
using stress::Worst;

/// Boxes all over a kilometre and more, turned and of many heights, some of them hanging or sunk.
std::unique_ptr<Scene> scattered(std::uint64_t seed, double longer_m = 0.0) {
  const RandomStream draw(seed, "stress.boxes");
  SceneParts parts = made::nothing();
  for (std::uint64_t k = 0; k < 150; ++k) {
    MeshBuilder mesh(parts);
    mesh.begin_object("box " + std::to_string(k), ObjectKind::kBuilding);
    const Vector3d half(1.0 + (9.0 + longer_m) * draw.uniform(0, k), 1.0 + 9.0 * draw.uniform(1, k),
                        1.0 + 20.0 * draw.uniform(2, k));
    const Eigen::Matrix3d axes =
        rotation_from({.yaw_rad = longer_m > 0.0 ? 0.3 * draw.uniform(3, k) : 6.0 * draw.uniform(3, k),
                       .pitch_rad = k % 3 == 0 ? 0.5 * draw.uniform(4, k) : 0.0,
                       .roll_rad = 0.0})
            .toRotationMatrix();
    mesh.box({1500.0 * (draw.uniform(5, k) - 0.5), 1500.0 * (draw.uniform(6, k) - 0.5), 30.0 * draw.uniform(7, k)},
             axes, half, mesh.material("brick"));
  }
  return made::scene_of(std::move(parts));
}

/// Facets near a point: those whose ball comes within the radius, all of them and no other, ascending. Mirrors: none
/// left out that could mirror a wave from that high, which for walls is standing above its elevation, for level roofs
/// lying below it; none taken that is beyond reach. A figure counts.
StressFigure facets(std::uint64_t seed) {
  const auto scene = scattered(seed);
  const FacetIndex& index = scene->facets();
  const auto& all = index.facets();
  const RandomStream draw(seed, "stress.places");
  StressFigure out;
  out.figure += all.size() == 6 * 150 ? 0.0 : 1.0;
  std::vector<std::uint32_t> found;
  for (std::uint64_t k = 0; k < 60; ++k) {
    const Vector3d p(1600.0 * (draw.uniform(0, k) - 0.5), 1600.0 * (draw.uniform(1, k) - 0.5),
                     20.0 * draw.uniform(2, k));
    const double radius = k % 4 == 0 ? 0.01 : 200.0 * draw.uniform(3, k);
    index.near(p, radius, found);
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < all.size(); ++i)
      if ((all[i].center_W - p).norm() <= all[i].radius_m + radius) expected.push_back(i);
    out.figure += found == expected ? 0.0 : 1.0;

    const double elevation = 0.05 + 1.3 * draw.uniform(4, k), reach = k % 2 == 0 ? kInfinity : 3.0, leaning_m = 300.0;
    index.mirrors(p, elevation, reach, leaning_m, found);
    const std::set<std::uint32_t> listed(found.begin(), found.end());
    out.figure += listed.size() == found.size() ? 0.0 : 1.0;
    for (std::uint32_t i = 0; i < all.size(); ++i) {
      const Facet& f = all[i];
      // Horizontal distances of its corners: what is nearer than the nearest point of its ball is none of it.
      const double middle_m = (f.center_W - p).head<2>().norm(), near_m = worse(middle_m - f.radius_m, 0.0);
      const double far_m = middle_m + f.radius_m, up = f.normal_W.z();
      const bool wall = std::abs(up)<1e-4, roof = up> 1.0 - 1e-7;
      const double top = std::tan(elevation) * near_m, rise_m = f.top_m - p.z();
      const bool within = near_m <= reach * f.area_m2;
      if (wall && within && rise_m > top + 0.01) {
        // From its farthest point too it stands out: surely one of them.
        if (rise_m > std::tan(elevation) * far_m + 0.01) out.figure += listed.count(i) == 1 ? 0.0 : 1.0;
      }
      // An upright one may lean by a milliradian.
      if (wall && rise_m < std::tan(elevation - 2.1e-3) * near_m - 0.1) out.figure += listed.count(i) == 0 ? 0.0 : 1.0;
      if (roof && f.bottom_m - p.z() > 0.01) out.figure += listed.count(i) == 0 ? 0.0 : 1.0;
      if (!(near_m <= reach * f.area_m2 + 0.1)) out.figure += listed.count(i) == 0 ? 0.0 : 1.0;
    }
  }
  return out;
}

/// A box has twelve edges of its three lengths, each between two of its faces and pointing out of it; those that shade
/// a place are those that reach above a direction by no more than the bend that the detour allows: trying all. And a
/// sheet has four borders. A figure counts.
StressFigure edges(std::uint64_t seed, double longer_m) {
  const auto scene = scattered(seed, longer_m);
  const EdgeIndex& index = scene->edges();
  const auto& all = index.edges();
  StressFigure out;
  out.figure += all.size() == 12 * 150 ? 0.0 : 1.0;
  for (const Edge& e : all) {
    const Vector3d along = (e.b_W - e.a_W).normalized();
    // Corners of single precision, 6e-5 m at 800 m, over edges of 2 m.
    constexpr double kSquare = 2e-4;
    const bool square = std::abs(e.normal_1_W.dot(e.normal_2_W)) < kSquare &&
                        std::abs(along.dot(e.normal_1_W)) < kSquare && std::abs(along.dot(e.normal_2_W)) < kSquare;
    out.figure += square && (e.outward_W - (e.normal_1_W + e.normal_2_W).normalized()).norm() < kSquare ? 0.0 : 1.0;
  }
  const RandomStream draw(seed, "stress.shading");
  std::vector<std::uint32_t> found;
  for (std::uint64_t k = 0; k < 40; ++k) {
    const Vector3d p(1600.0 * (draw.uniform(0, k) - 0.5), 1600.0 * (draw.uniform(1, k) - 0.5),
                     20.0 * draw.uniform(2, k));
    const double elevation = 0.05 + 1.2 * draw.uniform(3, k), detour_m = 0.5 * draw.uniform(4, k);
    index.shading(p, elevation, detour_m, found);
    const std::set<std::uint32_t> listed(found.begin(), found.end());
    for (std::uint32_t i = 0; i < all.size(); ++i) {
      // Points along it: one that stands above the direction must be listed; none that is below it by twice the bend of
      // the farthest one.
      bool above = false, far_below = true;
      for (int s = 0; s <= 20; ++s) {
        const Vector3d q = all[i].a_W + s / 20.0 * (all[i].b_W - all[i].a_W) - p;
        const double distance = q.head<2>().norm(), angle = std::atan2(q.z(), distance);
        above = above || angle >= elevation;
        const double half = 0.5 * (all[i].b_W - all[i].a_W).norm();
        const double reach = worse(distance - 2.0 * half, 0.0);
        const double bend =
            std::sqrt(2.0 * detour_m * (q.norm() + 2.0 * half) / std::cos(elevation)) / std::cos(elevation);
        far_below = far_below && q.z() + 2.0 * half + 2.0 * bend < reach * std::tan(elevation);
      }
      if (above) out.figure += listed.count(i) == 1 ? 0.0 : 1.0;
      if (far_below) out.figure += listed.count(i) == 0 ? 0.0 : 1.0;
    }
  }
  SceneParts sheet = made::nothing();
  made::add_wall(sheet, {5, 0, 0}, 3.0);
  const auto one = made::scene_of(std::move(sheet));
  out.figure += one->edges().edges().size() == 4 ? 0.0 : 1.0;
  for (const Edge& e : one->edges().edges())
    out.figure += (e.normal_1_W + e.normal_2_W).norm() < 1e-12 &&
                          e.outward_W.dot(0.5 * (e.a_W + e.b_W) - Vector3d(5, 0, 0)) > 2.99
                      ? 0.0
                      : 1.0;
  return out;
}

/// Long roofs about places on the diagonal, each alone in its square of the ground: seen from beyond their ends, where
/// no other coordinate than that along them tells how far they reach. Every edge of which a point stands above the
/// direction is listed. A figure counts those that are not.
StressFigure long_roofs_on_the_diagonal() {
  StressFigure out;
  for (const bool along_x : {true, false}) {
    SceneParts parts = made::nothing();
    for (int k = -3; k <= 3; ++k) {
      MeshBuilder mesh(parts);
      mesh.begin_object("roof " + std::to_string(k), ObjectKind::kBuilding);
      const double at = 25.0 + 700.0 * k;
      mesh.box({at, at, 10.0}, Eigen::Matrix3d::Identity(), along_x ? Vector3d(220, 2, 1) : Vector3d(2, 220, 1),
               mesh.material("brick"));
    }
    const auto scene = made::scene_of(std::move(parts));
    const auto& all = scene->edges().edges();
    std::vector<std::uint32_t> found;
    int above = 0;
    for (int k = -3; k <= 3; ++k)
      for (const double beyond_m : {5.0, 20.0, 60.0})
        for (const double elevation : {0.05, 0.15, 0.4, 0.9}) {
          const double at = 25.0 + 700.0 * k, along = 220.0 + beyond_m;
          const Vector3d p(at + (along_x ? along : 0.5), at + (along_x ? 0.5 : along), 1.0);
          scene->edges().shading(p, elevation, 1e-3, found);
          const std::set<std::uint32_t> listed(found.begin(), found.end());
          for (std::uint32_t i = 0; i < all.size(); ++i) {
            bool stands_out = false;
            for (int s = 0; s <= 40; ++s) {
              const Vector3d q = all[i].a_W + s / 40.0 * (all[i].b_W - all[i].a_W) - p;
              stands_out = stands_out || std::atan2(q.z(), q.head<2>().norm()) >= elevation;
            }
            above += stands_out ? 1 : 0;
            if (stands_out) out.figure += listed.count(i) == 1 ? 0.0 : 1.0;
          }
        }
    out.figure += above > 40 ? 0.0 : 1.0;
  }
  return out;
}

}  // namespace

std::vector<StressCase> index_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "facets near a place and facets that mirror there",
           "a cell, a block or a class of lean that is left out", "as trying all finds them", "wrong"});
  for (const std::uint64_t seed : {1U, 2U})
    rows.add("indices/facets_" + std::to_string(seed), [seed] { return facets(seed); });
  rows.of({StressGroup::kGeometry, "edges of solids, and those that shade a place",
           "an edge of two coplanar faces, a normal of another, a square of the ground left out",
           "twelve of a box, four of a sheet, and as trying all finds them", "wrong"});
  for (const std::uint64_t seed : {1U, 2U})
    rows.add("indices/edges_" + std::to_string(seed), [seed] { return edges(seed, 0.0); });
  rows.add("indices/edges_of_long_roofs", [] { return edges(4, 250.0); });
  rows.add("indices/edges_of_roofs_on_the_diagonal", long_roofs_on_the_diagonal);
  return rows.take();
}

}  // namespace canyon::scene
