#include "canyon/lidar/clearance.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace canyon::lidar {

namespace {

using Rectangle = Eigen::AlignedBox2d;

struct Piece {
  const RouteSegment& segment;
  Rectangle around;
  double clear_m = Clearance::kMost_m;
  double ground_slope = 0.0;

  explicit Piece(const RouteSegment& s) : segment(s) {
    for (const Eigen::Vector3d& p : s.points_W) around.extend(Eigen::Vector2d(p.head<2>()));
  }
  /// From a body's origin anywhere in the piece. Half a step between the polyline's points may lie nearer.
  double distance_m(const Rectangle& what) const {
    const double least_m = std::sqrt(around.squaredExteriorDistance(what)) - segment.half_width_m;
    if (least_m >= clear_m) return least_m;
    double nearest_m = 1e30, step_m = 0.0;
    for (std::size_t i = 0; i < segment.points_W.size(); ++i) {
      nearest_m = std::min(nearest_m, what.exteriorDistance(Eigen::Vector2d(segment.points_W[i].head<2>())));
      if (i > 0) step_m = std::max(step_m, (segment.points_W[i] - segment.points_W[i - 1]).head<2>().norm());
    }
    return nearest_m - 0.5 * step_m - segment.half_width_m;
  }
  void stands(const Rectangle& what) { clear_m = std::max(0.0, std::min(clear_m, distance_m(what))); }
};

Rectangle round(const Eigen::Vector2d& center, double radius_m) {
  return {center - Eigen::Vector2d::Constant(radius_m), center + Eigen::Vector2d::Constant(radius_m)};
}

template <class Visit>
void each_triangle(const scene::Scene& scene, bool terrain, const Visit& visit) {
  const scene::Mesh& mesh = scene.mesh();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if ((scene.objects()[mesh.object[i]].kind == scene::ObjectKind::kTerrain) != terrain) continue;
    Rectangle what;
    Eigen::Matrix3d corners;
    for (int k = 0; k < 3; ++k) {
      corners.col(k) = mesh.vertices[mesh.triangles[i][static_cast<std::size_t>(k)]].cast<double>();
      what.extend(Eigen::Vector2d(corners.col(k).head<2>()));
    }
    const Eigen::Vector3d across = (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0));
    visit(what, across.head<2>().norm() / std::max(std::abs(across.z()), 1e-9));
  }
}

}  // namespace

std::vector<Clearance> clearances(const scene::Scene& scene, const std::vector<scene::SweptRoom>& moving,
                                  const std::vector<RouteSegment>& route) {
  std::vector<Piece> pieces;
  for (const RouteSegment& segment : route) pieces.emplace_back(segment);
  each_triangle(scene, false, [&](const Rectangle& what, double) {
    for (Piece& piece : pieces) piece.stands(what);
  });
  for (Piece& piece : pieces) {
    for (const scene::Foliage& crown : scene.foliage())
      piece.stands(round(crown.center_W.head<2>(), crown.radii_m.maxCoeff()));
    for (const scene::SweptRoom& room : moving) piece.stands(room.around());
  }
  each_triangle(scene, true, [&](const Rectangle& what, double slope) {
    for (Piece& piece : pieces)
      if (slope > piece.ground_slope && piece.distance_m(what) <= piece.clear_m) piece.ground_slope = slope;
  });
  std::vector<Clearance> out;
  for (const Piece& piece : pieces) out.push_back({piece.clear_m, piece.ground_slope});
  return out;
}

}  // namespace canyon::lidar
