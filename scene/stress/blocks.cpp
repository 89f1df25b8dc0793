// Streets found between blocks of houses, of which it is known how many ways lead around them, and how wide.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/scene/stress/made_scenes.h"
#include "canyon/scene/stress/subjects.h"
#include "canyon/scene/tracing/free_space.h"

namespace canyon::scene {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using stress::Looks;

/// Ground with blocks on it, what stands between them, and what one may expect.
struct Quarter {
  SceneParts parts = made::nothing();
  AlignedBox2d ground;
  std::vector<AlignedBox2d> closed;  ///< what no way leads through
  std::vector<Vector2d> streets;     ///< places in the middle of a street
  int loops = 0, dead_ends = 0;
};

class Builder {
 public:
  Builder(Quarter& quarter, const AlignedBox2d& ground, double slope)
      : quarter_(quarter), slope_(slope), mesh_(quarter.parts) {
    quarter.ground = ground;
    mesh_.begin_object("ground", ObjectKind::kTerrain);
    const Vector2d a = ground.min(), b = ground.max();
    mesh_.quad(at(a.x(), a.y(), 0), at(b.x(), a.y(), 0), at(b.x(), b.y(), 0), at(a.x(), b.y(), 0),
               mesh_.material("asphalt"));
  }
  /// A box that follows the ground, from one height over it to another.
  void stands(const AlignedBox2d& box, double from_m, double to_m, ObjectKind kind = ObjectKind::kWall) {
    mesh_.begin_object("thing " + std::to_string(quarter_.parts.objects.size()), kind);
    const auto outline = rectangle(box.min().x(), box.min().y(), box.max().x(), box.max().y());
    std::vector<double> low, high;
    for (const Vector2d& p : outline)
      low.push_back(at(p.x(), p.y(), from_m).z()), high.push_back(at(p.x(), p.y(), to_m).z());
    const auto brick = mesh_.material("brick");
    mesh_.walls(outline, low, high, brick);
    const auto corner = [&](std::size_t k) { return Vector3d(outline[k].x(), outline[k].y(), high[k]); };
    mesh_.quad(corner(0), corner(1), corner(2), corner(3), brick);
  }
  void block(const AlignedBox2d& box, bool told) {
    if (told) {
      Building house;
      house.footprint_W = rectangle(box.min().x(), box.min().y(), box.max().x(), box.max().y());
      quarter_.parts.buildings.push_back(house);
    } else {
      stands(box, -1.0, 9.0, ObjectKind::kBuilding);
    }
    quarter_.closed.push_back(box);
  }

 private:
  Vector3d at(double x, double y, double up) const { return {x, y, slope_ * (x - 0.7 * y) + up}; }
  Quarter& quarter_;
  double slope_;
  MeshBuilder mesh_;
};

AlignedBox2d box(double x0, double y0, double x1, double y1) {
  return {Vector2d(x0, y0), Vector2d(x1, y1)};
}

/// Three by two blocks, some told as outlines, some only by their walls; streets of 12 to 26 m between and around them.
/// A gate shuts one street; a kiosk stands in the middle of a wide one; a kerb, a tree, an arch and a slab of the
/// road's own height are nothing to a car; one court is too short to be a street, another is one.
Quarter quarter(std::uint64_t seed, double slope, const Vector2d& origin) {
  const RandomStream draws(seed, "stress.blocks");
  Quarter q;
  double x[4], y[3], widths[4], heights[3];
  for (std::uint32_t k = 0; k < 4; ++k) widths[k] = draws.uniform(14.0, 26.0, 0, k);
  for (std::uint32_t k = 0; k < 3; ++k) heights[k] = draws.uniform(14.0, 26.0, 1, k);
  double east = origin.x() + widths[0], north = origin.y() + heights[0];
  double sizes_x[3], sizes_y[2];
  for (std::uint32_t k = 0; k < 3; ++k)
    x[k] = east, sizes_x[k] = draws.uniform(70.0, 100.0, 2, k), east += sizes_x[k] + widths[k + 1];
  for (std::uint32_t k = 0; k < 2; ++k)
    y[k] = north, sizes_y[k] = draws.uniform(95.0, 120.0, 3, k), north += sizes_y[k] + heights[k + 1];
  Builder builder(q, box(origin.x(), origin.y(), east, north), slope);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 2; ++j) {
      const double x0 = x[i], y0 = y[j], x1 = x0 + sizes_x[i], y1 = y0 + sizes_y[j];
      // Courts open to the south, 10 m wide.
      const double court = i == 1 && j == 0 ? 62.0 : i == 2 && j == 1 ? 14.0 : 0.0;
      if (court > 0.0) {
        const double middle = 0.5 * (x0 + x1);
        builder.block(box(x0, y0, middle - 5.0, y0 + court), true);
        builder.block(box(middle + 5.0, y0, x1, y0 + court), false);
        builder.block(box(x0, y0 + court, x1, y1), true);
        q.dead_ends += court > 40.0 ? 1 : 0;
      } else {
        builder.block(box(x0, y0, x1, y1), (i + j) % 2 == 0);
      }
      ++q.loops;
    }
  const auto street_x = [&](int k) {
    return k == 0 ? x[0] - 0.5 * widths[0] : x[k - 1] + sizes_x[k - 1] + 0.5 * widths[k];
  };
  const auto street_y = [&](int k) {
    return k == 0 ? y[0] - 0.5 * heights[0] : y[k - 1] + sizes_y[k - 1] + 0.5 * heights[k];
  };
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 2; ++j)
      if (k != 1 || j != 0) q.streets.emplace_back(street_x(k), y[j] + 0.8 * sizes_y[j]);
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i) q.streets.emplace_back(x[i] + 0.25 * sizes_x[i], street_y(k));
  // The gate: a wall of 1.2 m across the street between the first two blocks of the first row.
  const AlignedBox2d gate = box(x[0] + sizes_x[0], y[0] + 45.0, x[1], y[0] + 46.0);
  builder.stands(gate, -0.5, 1.2), q.closed.push_back(gate), --q.loops, q.dead_ends += 2;
  // A kiosk in the eastern street, which is made wide enough for it by the ground's rim: 1.5 m of it is closed.
  const AlignedBox2d kiosk = box(street_x(3) - 0.7, y[1] + 40.0, street_x(3) + 0.7, y[1] + 41.4);
  if (widths[3] > 18.0) builder.stands(kiosk, 0.0, 2.0), q.closed.push_back(kiosk), ++q.loops;
  // Nothing to a car.
  const double s = street_x(2);
  builder.stands(box(s - 0.7, y[0] + 20.0, s + 0.8, y[0] + 21.5), -0.5, 0.25 - 4.3 * slope);     // a kerb's end
  builder.stands(box(s - 1.0, y[0] + 50.0, s + 1.0, y[0] + 52.0), 0.0, 7.0, ObjectKind::kTree);  // a tree
  // An arch, whose lowest corner leaves room over its highest ground.
  builder.stands(box(x[1] + sizes_x[1] - 5.0, y[0] + 70.0, x[2] + 5.0, y[0] + 76.0), 2.6 + 45.0 * slope, 8.0);
  return q;
}

double to_segment(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const double l2 = (b - a).squaredNorm(), u = l2 > 0.0 ? std::clamp((p - a).dot(b - a) / l2, 0.0, 1.0) : 0.0;
  return (p - a - u * (b - a)).norm();
}

/// As many ways around as there are blocks apart from one another; as many ends as courts that are long enough; a line
/// in the middle of every street; and each as wide as the nearest walls let it be: to a cell of 2 m, what a line is
/// straightened by, 1.5 m, and the chamfer's 8 %.
StressFigure ways_around(std::uint64_t seed, double slope, const Vector2d& origin) {
  Looks looks;
  const Quarter q = quarter(seed, slope, origin);
  const StreetGraph found = free_space_streets(q.parts);
  std::map<std::uint32_t, int> ends;
  for (const auto& e : found.edges) ++ends[e.a], ++ends[e.b];
  looks.right(ends.size() == found.nodes_W.size());
  const int loops = static_cast<int>(found.edges.size()) - static_cast<int>(ends.size()) + 1;
  looks.right(loops == q.loops);
  int dead = 0;
  for (const auto& [node, count] : ends) dead += count == 1 ? 1 : 0;
  looks.right(dead == q.dead_ends);
  for (const auto& e : found.edges) {
    const Vector2d a = found.nodes_W[e.a], b = found.nodes_W[e.b];
    double least = 1e9;
    for (double u = 0.0; u <= 1.0; u += 1.0 / 64.0) {
      const Vector2d p = a + u * (b - a);
      for (const AlignedBox2d& c : q.closed) least = std::min(least, c.exteriorDistance(p));
      least = std::min(least, (p - q.ground.min()).minCoeff<Eigen::PropagateNaN>());
      least = std::min(least, (q.ground.max() - p).minCoeff<Eigen::PropagateNaN>());
    }
    looks.right(e.width_m >= 5.0 && e.width_m <= 30.0 && least > 0.0);
    looks.near(0.5 * e.width_m, std::min(least, 15.0), 2.0 + 1.5 + 0.08 * least);
  }
  for (const Vector2d& p : q.streets) {
    double least = 1e9;
    for (const auto& e : found.edges) least = std::min(least, to_segment(p, found.nodes_W[e.a], found.nodes_W[e.b]));
    looks.near(least, 0.0, 2.0 + 1.5 + 0.08 * 13.0);
  }
  return looks.figure();
}

/// Five blocks on ground of 4.5 km: beyond 150 m of what stands, in squares of 16 m, it is not looked at.
StressFigure far_ground(bool north) {
  Looks looks;
  Quarter q;
  const auto turned = [north](double x0, double y0, double x1, double y1) {
    return north ? box(y0, x0, y1, x1) : box(x0, y0, x1, y1);
  };
  {
    Builder builder(q, turned(-400, -300, 4100, 300), 0.0);
    // Walls of a yard are all that is told of them.
    for (int k = 0; k < 5; ++k) builder.block(turned(60.0 * k, -20, 60.0 * k + 40.0, 20), false);
  }
  const StreetGraph found = free_space_streets(q.parts);
  std::map<std::uint32_t, int> ends;
  for (const auto& e : found.edges) ++ends[e.a], ++ends[e.b];
  looks.right(static_cast<int>(found.edges.size()) - static_cast<int>(ends.size()) + 1 == 5);
  double farthest = 0.0;
  for (const Vector2d& p : found.nodes_W) {
    double least = 1e9;
    for (const AlignedBox2d& c : q.closed) {
      const Vector2d off = (c.min() - p).cwiseMax(p - c.max()).cwiseMax(0.0);
      least = std::min(least, off.maxCoeff<Eigen::PropagateNaN>());
    }
    farthest = worse(farthest, least);
  }
  // In the middle between what stands and where it is no longer looked, or straight to there.
  looks.right(farthest > 50.0 && farthest < 150.0 + 16.0);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> block_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "streets between blocks of houses, by their number, ends and widths",
           "a thinning that cuts a way or leaves two, what one drives under or over that shuts it, ends kept or lost",
           "as many ways around as blocks apart; widths to a cell, the straightening and the chamfer", "of the bound"});
  for (const std::uint64_t seed : {1U, 2U, 3U})
    for (const double slope : {0.0, 0.06})
      rows.add("streets/ways_around_blocks_" + std::to_string(seed) + "_at_a_slope_of_" + stress::text(slope), [=] {
        return ways_around(seed, slope, {-100.3 - 7.0 * static_cast<double>(seed), 40.9});
      });
  rows.add("streets/far_ground_to_the_east", [] { return far_ground(false); })
      .add("streets/far_ground_to_the_north", [] { return far_ground(true); });
  return rows.take();
}

}  // namespace canyon::scene
