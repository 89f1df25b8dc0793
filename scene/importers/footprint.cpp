#include "canyon/scene/importers/footprint.h"

#include <algorithm>
#include <cmath>

#include "canyon/scene/importers/outline.h"
#include "canyon/scene/surfaces/triangulate.h"

namespace canyon::scene {
namespace {

using Ring = std::vector<Eigen::Vector2d>;

bool is_convex(const Ring& ring) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d a = ring[(i + 1) % ring.size()] - ring[i],
                          b = ring[(i + 2) % ring.size()] - ring[(i + 1) % ring.size()];
    if (a.x() * b.y() - a.y() * b.x() < -1e-3 * a.norm() * b.norm()) return false;
  }
  return true;
}

/// The smallest rectangle around an outline: center, unit axis along its longer side, half lengths.
struct Box {
  Eigen::Vector2d center, along;
  double half_along_m, half_across_m;
};

Box box_around(const Ring& ring) {
  const Ring hull = convex_hull(ring);
  Box best{};
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d u = (hull[(i + 1) % hull.size()] - hull[i]).normalized(), v(-u.y(), u.x());
    Eigen::Vector2d low = Eigen::Vector2d::Constant(1e300), high = -low;
    for (const Eigen::Vector2d& p : hull) {
      low = low.cwiseMin(Eigen::Vector2d(p.dot(u), p.dot(v)));
      high = high.cwiseMax(Eigen::Vector2d(p.dot(u), p.dot(v)));
    }
    const Eigen::Vector2d half = 0.5 * (high - low), middle = 0.5 * (low + high);
    if (half.prod() >= smallest) continue;
    smallest = half.prod();
    const bool long_u = half.x() >= half.y();
    best = {middle.x() * u + middle.y() * v, long_u ? u : v, std::max(half.x(), half.y()),
            std::min(half.x(), half.y())};
  }
  return best;
}

/// A roof plane: height = level + slope . p.
struct RoofPlane {
  double level_m;
  Eigen::Vector2d slope;
  double at(const Eigen::Vector2d& p) const { return level_m + slope.dot(p); }
};

/// The roof is the lowest of these planes everywhere.
std::vector<RoofPlane> roof_planes(const RawFootprint& f, const Ring& outline, double eaves_m) {
  Box box = box_around(outline);
  if (f.ridge_across) {
    box.along = {-box.along.y(), box.along.x()};
    std::swap(box.half_along_m, box.half_across_m);
  }
  const Eigen::Vector2d across(-box.along.y(), box.along.x());
  std::vector<RoofPlane> planes;
  // Rises from `half_m` off the middle line towards it, to the full height after `run_m`.
  const auto add = [&](const Eigen::Vector2d& outward, double half_m, double run_m) {
    const double grade = f.roof_height_m / std::max(run_m, 1e-3);
    planes.push_back({eaves_m + grade * (half_m + outward.dot(box.center)), -grade * outward});
  };
  add(across, box.half_across_m, box.half_across_m);
  add(-across, box.half_across_m, box.half_across_m);
  if (f.roof == RoofShape::kGabled) return planes;
  const double run_m =
      f.roof == RoofShape::kPyramidal ? box.half_along_m : std::min(box.half_across_m, box.half_along_m);
  add(box.along, box.half_along_m, run_m);
  add(-box.along, box.half_along_m, run_m);
  return planes;
}

/// The part of a convex ring where plane k is the lowest.
Ring part_of(Ring ring, const std::vector<RoofPlane>& planes, std::size_t k) {
  for (std::size_t other = 0; other < planes.size() && !ring.empty(); ++other) {
    if (other == k) continue;
    Ring kept;
    const auto margin = [&](const Eigen::Vector2d& p) { return planes[other].at(p) - planes[k].at(p); };
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
      const double ma = margin(a), mb = margin(b);
      if (ma >= 0.0) kept.push_back(a);
      if ((ma > 0.0 && mb < 0.0) || (ma < 0.0 && mb > 0.0)) kept.push_back(a + ma / (ma - mb) * (b - a));
    }
    ring = std::move(kept);
  }
  return ring;
}

void add_pitched(const RawFootprint& f, Ring outline, double bottom_m, double eaves_m, std::uint16_t wall,
                 std::uint16_t roof, MeshBuilder& mesh) {
  const std::vector<RoofPlane> planes = roof_planes(f, outline, eaves_m);
  std::vector<std::array<Eigen::Vector3d, 3>> triangles;
  for (std::size_t k = 0; k < planes.size(); ++k) {
    const Ring part = part_of(outline, planes, k);
    std::vector<Eigen::Vector3d> corners;
    // A roof that is wider than its eaves' box would sink below them by rounding.
    for (const Eigen::Vector2d& p : part) corners.emplace_back(p.x(), p.y(), std::max(planes[k].at(p), eaves_m));
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      if ((corners[i] - corners[0]).cross(corners[i + 1] - corners[0]).norm() < 1e-6) continue;
      triangles.push_back({corners[0], corners[i], corners[i + 1]});
      mesh.triangle(corners[0], corners[i], corners[i + 1], roof);
    }
  }
  for (const auto& ring : border_rings(triangles)) {
    Ring flat;
    std::vector<double> top_m;
    for (const Eigen::Vector3d& p : ring) {
      flat.push_back(p.head<2>());
      top_m.push_back(p.z());
    }
    mesh.walls(flat, std::vector<double>(ring.size(), bottom_m), top_m, wall);
  }
}

}  // namespace

bool add_footprint(const RawFootprint& f, double bottom_m, double base_m, std::uint16_t wall, std::uint16_t roof,
                   MeshBuilder& mesh) {
  std::vector<Ring> rings = f.rings;
  for (std::size_t r = 0; r < rings.size(); ++r)
    if ((twice_area(rings[r]) > 0.0) != (r == 0)) std::reverse(rings[r].begin(), rings[r].end());
  const double top_m = base_m + f.height_m;
  const bool floats = f.lift_m > 0.0;
  const double floor_m = floats ? base_m + f.lift_m : bottom_m;
  const bool pitched = f.roof != RoofShape::kFlat && f.roof_height_m > 0.0;
  const bool can_be_pitched = rings.size() == 1 && is_convex(rings[0]);
  if (pitched && can_be_pitched) {
    add_pitched(f, rings[0], floor_m, top_m - f.roof_height_m, wall, roof, mesh);
  } else {
    for (const Ring& ring : rings)
      mesh.walls(ring, std::vector<double>(ring.size(), floor_m), std::vector<double>(ring.size(), top_m), wall);
  }
  std::vector<Eigen::Vector2d> points;
  for (const Ring& ring : rings) points.insert(points.end(), ring.begin(), ring.end());
  const auto at = [&](std::uint32_t i, double z) { return Eigen::Vector3d(points[i].x(), points[i].y(), z); };
  for (const auto& t : triangulate(rings)) {
    if (!pitched || !can_be_pitched) mesh.triangle(at(t[0], top_m), at(t[1], top_m), at(t[2], top_m), roof);
    if (floats) mesh.triangle(at(t[0], floor_m), at(t[2], floor_m), at(t[1], floor_m), wall);
  }
  return !pitched || can_be_pitched;
}

}  // namespace canyon::scene
