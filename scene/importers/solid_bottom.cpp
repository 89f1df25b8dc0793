#include "scene/importers/solid_bottom.h"

#include <algorithm>
#include <iterator>
#include <limits>

#include <Eigen/Geometry>

#include "scene/importers/outline.h"
#include "scene/triangulate.h"

namespace canyon::scene {
namespace {

std::vector<std::array<Eigen::Vector3d, 3>> corners_of(const std::vector<SolidFace>& faces) {
  std::vector<std::array<Eigen::Vector3d, 3>> out;
  for (const SolidFace& face : faces) out.push_back(face.corners);
  return out;
}

double mean_height_m(const std::vector<Eigen::Vector3d>& ring) {
  double sum_m = 0.0;
  for (const Eigen::Vector3d& p : ring) sum_m += p.z();
  return sum_m / static_cast<double>(ring.size());
}

std::vector<Eigen::Vector2d> from_above(const std::vector<Eigen::Vector3d>& ring) {
  std::vector<Eigen::Vector2d> out;
  for (const Eigen::Vector3d& p : ring) out.emplace_back(p.head<2>());
  return out;
}

}  // namespace

SolidBottom bottom_of(const std::vector<SolidFace>& faces) {
  double low_m = std::numeric_limits<double>::infinity(), high_m = -low_m;
  for (const SolidFace& face : faces)
    for (const Eigen::Vector3d& p : face.corners) low_m = std::min(low_m, p.z()), high_m = std::max(high_m, p.z());
  const double middle_m = 0.5 * (low_m + high_m);  // eaves and balconies are above it
  std::vector<SolidFace> bottom;
  std::copy_if(faces.begin(), faces.end(), std::back_inserter(bottom), [](const SolidFace& f) { return f.bottom; });
  if (bottom.empty()) {
    std::copy_if(faces.begin(), faces.end(), std::back_inserter(bottom), [&](const SolidFace& f) {
      const auto& [a, b, c] = f.corners;
      const Eigen::Vector3d normal = (b - a).cross(c - a);
      return normal.z() < -0.5 * normal.norm() && a.z() + b.z() + c.z() < 3.0 * middle_m;
    });
  }
  SolidBottom out;
  if (!bottom.empty()) {
    out.rings = border_rings(corners_of(bottom));
    for (const SolidFace& face : bottom) out.triangles.push_back(face.triangle);
    return out;
  }
  out.rings = border_rings(corners_of(faces));
  std::erase_if(out.rings, [&](const auto& ring) { return mean_height_m(ring) > middle_m; });
  for (auto& ring : out.rings) std::reverse(ring.begin(), ring.end());
  return out;
}

std::vector<std::array<Eigen::Vector2d, 3>> floor_of(const SolidBottom& bottom) {
  std::vector<std::array<Eigen::Vector2d, 3>> floor;
  std::vector<std::vector<Eigen::Vector2d>> rings;
  for (const auto& ring : bottom.rings) rings.push_back(from_above(ring));
  for (const auto& outline : rings) {
    if (twice_area(outline) >= 0.0) continue;
    std::vector<std::vector<Eigen::Vector2d>> polygon{outline};
    for (const auto& yard : rings)
      if (twice_area(yard) > 0.0 && polygon_contains(outline, yard.front())) polygon.push_back(yard);
    std::vector<Eigen::Vector2d> corners;
    for (const auto& ring : polygon) corners.insert(corners.end(), ring.begin(), ring.end());
    for (const auto& t : triangulate(polygon)) floor.push_back({corners[t[0]], corners[t[2]], corners[t[1]]});
  }
  return floor;
}

}  // namespace canyon::scene
