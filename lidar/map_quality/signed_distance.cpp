#include "canyon/lidar/map_quality/signed_distance.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/check.h"
#include "canyon/core/units.h"
#include "canyon/scene/surfaces/triangle.h"

namespace canyon::lidar {
namespace {

constexpr double kSame_m = 1e-4;  // corners, and points on an edge

Eigen::Vector3d unit_normal(const scene::Triangle& t) {
  return t.area_normal().normalized();
}

double angle_at(const Eigen::Vector3d& corner, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d u = b - corner, v = c - corner;
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

double distance_to_segment_m(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d along = b - a;
  const double s = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - a - s * along).norm();
}

}  // namespace

/// Which triangles meet at which corner: corners of equal rounded place are one.
struct SignedDistance::Corners {
  using Key = std::array<std::int64_t, 3>;
  std::vector<std::pair<Key, std::uint32_t>> sorted;

  static Key key(const Eigen::Vector3f& v) {
    const auto round = [](float x) {
      return static_cast<std::int64_t>(std::llround(static_cast<double>(x) / kSame_m));
    };
    return {round(v.x()), round(v.y()), round(v.z())};
  }

  explicit Corners(const scene::Mesh& mesh) {
    sorted.reserve(3 * mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      for (const std::uint32_t v : mesh.triangles[t]) sorted.emplace_back(key(mesh.vertices[v]), t);
    std::sort(sorted.begin(), sorted.end());
  }

  /// Those at a corner, in ascending order; of neighbouring keys too, as rounding may part equal corners.
  void at(const Eigen::Vector3f& corner, std::vector<std::uint32_t>& out) const {
    const Key middle = key(corner);
    for (std::int64_t dx = -1; dx <= 1; ++dx)
      for (std::int64_t dy = -1; dy <= 1; ++dy)
        for (std::int64_t dz = -1; dz <= 1; ++dz) {
          const Key k{middle[0] + dx, middle[1] + dy, middle[2] + dz};
          for (auto i = std::lower_bound(sorted.begin(), sorted.end(), std::pair(k, std::uint32_t{0}));
               i != sorted.end() && i->first == k; ++i)
            out.push_back(i->second);
        }
  }
};

SignedDistance::SignedDistance(const scene::Scene& scene)
    : scene_(scene), corners_(std::make_unique<Corners>(scene.mesh())) {}

SignedDistance::~SignedDistance() = default;

/// Sum of the normals of all triangles that contain the nearest point, each with its angle there.
Eigen::Vector3d SignedDistance::pseudo_normal(const Eigen::Vector3d& nearest_W, std::uint32_t triangle) const {
  const scene::Mesh& mesh = scene_.scene().mesh();
  const scene::Triangle own = scene::Triangle::of(mesh, triangle);
  const std::array<Eigen::Vector3d, 3> corners{own.a, own.b, own.c};
  std::vector<std::uint32_t> around;
  for (std::size_t i = 0; i < 3; ++i) {
    const bool touched = distance_to_segment_m(nearest_W, corners[i], corners[(i + 1) % 3]) < kSame_m ||
                         distance_to_segment_m(nearest_W, corners[i], corners[(i + 2) % 3]) < kSame_m;
    if (touched) corners_->at(mesh.vertices[mesh.triangles[triangle][i]], around);
  }
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const std::uint32_t t : around) {
    const scene::Triangle other = scene::Triangle::of(mesh, t);
    if ((other.closest_point(nearest_W) - nearest_W).norm() > kSame_m) continue;
    const std::array<Eigen::Vector3d, 3> c{other.a, other.b, other.c};
    double angle = kPi;  // on an edge
    for (std::size_t i = 0; i < 3; ++i)
      if ((c[i] - nearest_W).norm() < kSame_m) angle = angle_at(c[i], c[(i + 1) % 3], c[(i + 2) % 3]);
    sum += angle * unit_normal(other);
  }
  return around.empty() ? unit_normal(own) : sum;
}

SurfaceOffset SignedDistance::at(const Eigen::Vector3d& p_W, double cap_m) const {
  CANYON_CHECK(p_W.allFinite() && cap_m > 0, "p = ", p_W.transpose(), ", cap_m = ", cap_m);
  return at(p_W, cap_m, scene_.nearest(p_W, cap_m));
}

SurfaceOffset SignedDistance::at(const Eigen::Vector3d& p_W, double cap_m, const scene::NearestSurface& nearest) const {
  SurfaceOffset out;
  if (nearest.triangle == scene::Hit::kMiss || nearest.distance_m >= cap_m) return out;
  out.found = true;
  out.triangle = nearest.triangle;
  out.offset_W = p_W - nearest.point_W;
  out.normal_W = unit_normal(scene::Triangle::of(scene_.scene().mesh(), nearest.triangle));
  const bool behind = pseudo_normal(nearest.point_W, nearest.triangle).dot(out.offset_W) < 0.0;
  out.distance_m = behind ? -nearest.distance_m : nearest.distance_m;
  return out;
}

}  // namespace canyon::lidar
