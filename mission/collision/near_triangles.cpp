#include "canyon/mission/collision/near_triangles.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/check.h"

namespace canyon::mission {

int NearTriangles::cell(double from_centre_m) const {
  const double cell = std::floor((from_centre_m + kHalf_m) / kCell_m);
  return static_cast<int>(std::clamp(cell, 0.0, static_cast<double>(kCells - 1)));
}

void NearTriangles::gather(const Eigen::Vector2d& centre_W) {
  centre_W_ = centre_W;
  gathered_ = true;
  const scene::Mesh& mesh = scene_.scene().mesh();
  // Once to count what each cell holds, once to fill it; what does not meet the square is in none.
  const auto for_cells = [&](std::uint32_t index, const auto& visit) {
    const auto& t = mesh.triangles[index];
    const Eigen::Vector2d a = mesh.vertices[t[0]].head<2>().cast<double>() - centre_W,
                          b = mesh.vertices[t[1]].head<2>().cast<double>() - centre_W,
                          c = mesh.vertices[t[2]].head<2>().cast<double>() - centre_W;
    const Eigen::Vector2d low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    if ((low.array() > kHalf_m).any() || (high.array() < -kHalf_m).any()) return;
    for (int row = cell(low.y()); row <= cell(high.y()); ++row)
      for (int column = cell(low.x()); column <= cell(high.x()); ++column)
        visit(static_cast<std::size_t>(row) * kCells + static_cast<std::size_t>(column));
  };
  const auto triangles = static_cast<std::uint32_t>(mesh.triangles.size());
  first_.assign(static_cast<std::size_t>(kCells) * kCells + 1, 0);
  for (std::uint32_t i = 0; i < triangles; ++i) for_cells(i, [this](std::size_t k) { ++first_[k + 1]; });
  for (std::size_t k = 1; k < first_.size(); ++k) first_[k] += first_[k - 1];
  members_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t i = 0; i < triangles; ++i) for_cells(i, [&](std::size_t k) { members_[next[k]++] = i; });
}

const std::vector<NearTriangle>& NearTriangles::near(const Eigen::Vector3d& p_W, double max_m) {
  CANYON_CHECK(p_W.allFinite() && max_m >= 0.0 && max_m <= kMost_m, "p = ", p_W.transpose(), ", max_m = ", max_m);
  const Eigen::Vector2d from_centre = p_W.head<2>() - centre_W_;
  if (!gathered_ || from_centre.cwiseAbs().maxCoeff() + max_m > kHalf_m) gather(p_W.head<2>());
  const Eigen::Vector2d at = p_W.head<2>() - centre_W_;
  found_.clear();
  for (int row = cell(at.y() - max_m); row <= cell(at.y() + max_m); ++row)
    for (int column = cell(at.x() - max_m); column <= cell(at.x() + max_m); ++column) {
      const auto k = static_cast<std::size_t>(row) * kCells + static_cast<std::size_t>(column);
      found_.insert(found_.end(), members_.begin() + first_[k], members_.begin() + first_[k + 1]);
    }
  std::sort(found_.begin(), found_.end());
  found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
  near_.clear();
  const auto take = [&](std::uint32_t index, const scene::Triangle& corners) {
    if ((corners.closest_point(p_W) - p_W).norm() <= max_m) near_.push_back({index, corners});
  };
  const scene::Mesh& mesh = scene_.scene().mesh();
  for (const std::uint32_t index : found_) take(index, scene::Triangle::of(mesh, index));
  auto index = static_cast<std::uint32_t>(mesh.triangles.size());
  for (const scene::Instance& instance : scene_.instances()) {
    const scene::Mesh& shape = instance.shape->mesh();
    for (std::uint32_t k = 0; k < shape.triangles.size(); ++k, ++index) {
      const scene::Triangle in_S = scene::Triangle::of(shape, k);
      take(index, {instance.X_WS * in_S.a, instance.X_WS * in_S.b, instance.X_WS * in_S.c});
    }
  }
  return near_;
}

}  // namespace canyon::mission
