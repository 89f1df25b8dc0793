#include "canyon/scene/importers/solid_bottom.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

#include <Eigen/Geometry>

#include "canyon/scene/importers/outline.h"
#include "canyon/scene/surfaces/triangulate.h"

namespace canyon::scene {
namespace {

std::vector<std::array<Eigen::Vector3d, 3>> corners_of(const std::vector<SolidFace>& faces) {
  std::vector<std::array<Eigen::Vector3d, 3>> out;
  for (const SolidFace& face : faces) out.push_back(face.corners);
  return out;
}

/// Faces by the parts that they belong to: those with a corner in common.
std::vector<std::vector<SolidFace>> parts_of(const std::vector<SolidFace>& faces) {
  using Key = std::array<long long, 3>;
  std::map<Key, std::size_t> face_at;
  std::vector<std::size_t> before(faces.size());  // each face's way to the first of its part
  const auto first_of = [&](std::size_t face) {
    while (before[face] != face) face = before[face] = before[before[face]];
    return face;
  };
  for (std::size_t i = 0; i < faces.size(); ++i) {
    before[i] = i;
    for (const Eigen::Vector3d& p : faces[i].corners) {
      const Key key{std::llround(p.x() * 1e3), std::llround(p.y() * 1e3), std::llround(p.z() * 1e3)};
      const std::size_t a = first_of(face_at.try_emplace(key, i).first->second), b = first_of(i);
      before[std::max(a, b)] = std::min(a, b);
    }
  }
  std::map<std::size_t, std::vector<SolidFace>> parts;
  for (std::size_t i = 0; i < faces.size(); ++i) parts[first_of(i)].push_back(faces[i]);
  std::vector<std::vector<SolidFace>> out;
  for (auto& [first, part] : parts) out.push_back(std::move(part));
  return out;
}

std::vector<Eigen::Vector2d> from_above(const std::vector<Eigen::Vector3d>& ring) {
  std::vector<Eigen::Vector2d> out;
  for (const Eigen::Vector3d& p : ring) out.emplace_back(p.head<2>());
  return out;
}

}  // namespace

std::vector<SolidBottom> bottoms_of(const std::vector<SolidFace>& faces) {
  const bool said = std::any_of(faces.begin(), faces.end(), [](const SolidFace& f) { return f.bottom; });
  std::vector<SolidBottom> out;
  for (const std::vector<SolidFace>& part : parts_of(faces)) {
    double low_m = std::numeric_limits<double>::infinity();
    for (const SolidFace& face : part)
      for (const Eigen::Vector3d& p : face.corners) low_m = std::min(low_m, p.z());
    std::vector<SolidFace> faces_below;
    std::copy_if(part.begin(), part.end(), std::back_inserter(faces_below), [&](const SolidFace& f) {
      const auto& [a, b, c] = f.corners;
      const Eigen::Vector3d normal = (b - a).cross(c - a);
      const bool looks_down = normal.z() < -0.5 * normal.norm();
      return said ? f.bottom : looks_down && std::max({a.z(), b.z(), c.z()}) <= low_m + kBottom_m;
    });
    SolidBottom bottom;
    if (!faces_below.empty()) {
      bottom.rings = border_rings(corners_of(faces_below));
      for (const SolidFace& face : faces_below) bottom.triangles.push_back(face.triangle);
    } else if (!said) {
      bottom.rings = border_rings(corners_of(part));
      std::erase_if(bottom.rings, [&](const auto& ring) {
        return std::any_of(ring.begin(), ring.end(), [&](const auto& p) { return p.z() > low_m + kBottom_m; });
      });
      for (auto& ring : bottom.rings) std::reverse(ring.begin(), ring.end());
    }
    bottom.low_m = low_m;
    bottom.sure = said;
    if (!bottom.rings.empty()) out.push_back(std::move(bottom));
  }
  const auto lowest =
      std::min_element(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.low_m < b.low_m; });
  if (lowest != out.end()) lowest->sure = true;
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
