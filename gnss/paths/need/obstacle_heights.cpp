#include "canyon/gnss/paths/need/obstacle_heights.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "canyon/core/units.h"

namespace canyon::gnss {

namespace {

constexpr double kMostColumns = 500.0;

}  // namespace

template <class Visit>
void ObstacleHeights::each_square(const Eigen::Vector2d& low, const Eigen::Vector2d& high, const Visit& visit) {
  const auto index = [&](double x, double from, int count) {
    return std::clamp(static_cast<int>(std::floor((x - from) / cell_m_)), 0, count - 1);
  };
  const int x0 = index(low.x(), origin_.x(), columns_), x1 = index(high.x(), origin_.x(), columns_);
  const int y0 = index(low.y(), origin_.y(), rows_), y1 = index(high.y(), origin_.y(), rows_);
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x)
      visit(squares_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x)]);
}

ObstacleHeights::ObstacleHeights(const scene::Scene& scene, const std::vector<scene::SweptRoom>& moving) {
  const scene::Mesh& mesh = scene.mesh();
  if (mesh.triangles.empty()) return;
  ground_ = {scene.extent().min.head<2>(), scene.extent().max.head<2>()};
  // What moves may come from beyond the ground.
  Eigen::AlignedBox2d all = ground_;
  for (const scene::SweptRoom& room : moving) all.extend(room.around());
  const Eigen::Vector2d size = all.sizes();
  cell_m_ = std::max(4.0, size.maxCoeff() / kMostColumns);
  origin_ = all.min();
  columns_ = static_cast<int>(std::floor(size.x() / cell_m_)) + 1;
  rows_ = static_cast<int>(std::floor(size.y() / cell_m_)) + 1;
  squares_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const scene::ObjectKind kind = scene.objects()[mesh.object[i]].kind;
    if (kind == scene::ObjectKind::kTree) continue;
    Eigen::Matrix3d corners;
    for (int k = 0; k < 3; ++k)
      corners.col(k) = mesh.vertices[mesh.triangles[i][static_cast<std::size_t>(k)]].cast<double>();
    const Eigen::Vector3d low = corners.rowwise().minCoeff(), high = corners.rowwise().maxCoeff();
    // Rounded up: single precision holds a height of 10 km to 1 mm.
    const auto top_m = static_cast<float>(high.z() + 1e-3);
    const Eigen::Vector3d across = (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0));
    const auto slope = static_cast<float>(across.head<2>().norm() / std::max(std::abs(across.z()), 1e-9));
    each_square(low.head<2>(), high.head<2>(), [&](Square& square) {
      if (kind == scene::ObjectKind::kTerrain) {
        square.terrain_top_m = std::max(square.terrain_top_m, top_m);
        square.slope = std::max(square.slope, slope);
      } else {
        square.solid_top_m = std::max(square.solid_top_m, top_m);
      }
    });
  }
  for (const scene::SweptRoom& room : moving) add(room);
}

void ObstacleHeights::add(const scene::SweptRoom& room) {
  const Eigen::AlignedBox2d around = room.around();
  // Square by square, so that a way across the town does not fill the rectangle around it.
  RouteSegment way;
  way.points_W = {{room.from_W.x(), room.from_W.y(), 0.0}, {room.to_W.x(), room.to_W.y(), 0.0}};
  const auto index = [&](double x, double from, int count) {
    return std::clamp(static_cast<int>(std::floor((x - from) / cell_m_)), 0, count - 1);
  };
  const double wide_m = room.radius_m + std::sqrt(0.5) * cell_m_;
  for (int y = index(around.min().y(), origin_.y(), rows_); y <= index(around.max().y(), origin_.y(), rows_); ++y) {
    for (int x = index(around.min().x(), origin_.x(), columns_); x <= index(around.max().x(), origin_.x(), columns_);
         ++x) {
      const Eigen::Vector2d middle = origin_ + cell_m_ * Eigen::Vector2d(x + 0.5, y + 0.5);
      if (way.distance_m(middle) > wide_m) continue;
      Square& square =
          squares_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x)];
      square.solid_top_m = std::max(square.solid_top_m, static_cast<float>(room.top_m + 1e-3));
    }
  }
}

double ObstacleHeights::horizon_rad(const RouteSegment& segment, double above_m, double beside_m) const {
  if (squares_.empty()) return 0.5 * kPi;
  const double lowest_m = segment.low_m + above_m;
  // Every square counts as the circle around it.
  const double wide_m = segment.half_width_m + beside_m + std::sqrt(0.5) * cell_m_;
  double tangent = 0.0;
  for (int y = 0; y < rows_; ++y) {
    for (int x = 0; x < columns_; ++x) {
      const Square& square =
          squares_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x)];
      const Eigen::Vector2d middle = origin_ + cell_m_ * Eigen::Vector2d(x + 0.5, y + 0.5);
      const double distance_m = segment.distance_m(middle) - wide_m;
      const double solid_m = square.solid_top_m - lowest_m, terrain_m = square.terrain_top_m - lowest_m;
      if (solid_m > 0.0) {
        if (distance_m <= 0.0) return 0.5 * kPi;
        tangent = std::max(tangent, solid_m / distance_m);
      }
      if (distance_m <= kNear_m) {
        if (!square.terrain() && ground_.contains(middle)) return 0.5 * kPi;
        tangent = std::max(tangent, static_cast<double>(square.slope));
      } else if (terrain_m > 0.0) {
        tangent = std::max(tangent, terrain_m / distance_m);
      }
    }
  }
  return std::atan(tangent);
}

}  // namespace canyon::gnss
