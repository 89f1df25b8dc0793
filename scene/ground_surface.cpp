#include "scene/ground_surface.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "core/parallel.h"
#include "scene/mesh_builder.h"

namespace canyon::scene {

GroundGrid ground_grid(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double cell_m) {
  GroundGrid grid;
  grid.cell_m = cell_m;
  grid.west_m = cell_m * std::floor(low.x() / cell_m);
  grid.south_m = cell_m * std::floor(low.y() / cell_m);
  grid.columns = std::max(2, static_cast<int>(std::ceil((high.x() - grid.west_m) / cell_m)) + 1);
  grid.rows = std::max(2, static_cast<int>(std::ceil((high.y() - grid.south_m) / cell_m)) + 1);
  grid.height_m.assign(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows), 0.0);
  return grid;
}

bool fill_ground(GroundGrid& grid, const std::function<std::optional<double>(const Eigen::Vector2d&)>& height) {
  std::vector<bool> known(grid.height_m.size(), false);
  std::size_t missing = 0;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const auto h = height({grid.x(column), grid.y(row)});
      known[grid.index(column, row)] = h.has_value();
      grid.height_m[grid.index(column, row)] = h.value_or(0.0);
      missing += h ? 0 : 1;
    }
  }
  if (missing == known.size()) return false;
  while (missing > 0) {
    const std::vector<bool> before = known;
    for (int row = 0; row < grid.rows; ++row) {
      for (int column = 0; column < grid.columns; ++column) {
        if (before[grid.index(column, row)]) continue;
        double sum = 0.0, count = 0.0;
        for (int r = std::max(row - 1, 0); r <= std::min(row + 1, grid.rows - 1); ++r) {
          for (int c = std::max(column - 1, 0); c <= std::min(column + 1, grid.columns - 1); ++c) {
            if (!before[grid.index(c, r)]) continue;
            sum += grid.height_m[grid.index(c, r)];
            count += 1.0;
          }
        }
        if (count == 0.0) continue;
        grid.height_m[grid.index(column, row)] = sum / count;
        known[grid.index(column, row)] = true;
        --missing;
      }
    }
  }
  return true;
}

void fit_ground(GroundGrid& grid, const std::vector<Eigen::Vector3d>& heights) {
  if (heights.empty()) return;
  constexpr double kWidth_m = 25.0;
  constexpr std::size_t kEnough = 8;
  // Buckets, so that a corner looks only at what is near.
  Eigen::Vector2d low = heights[0].head<2>(), high = low;
  for (const auto& p : heights) low = low.cwiseMin(p.head<2>()), high = high.cwiseMax(p.head<2>());
  const double bucket_m = std::max(50.0, 2.0 * std::sqrt((high - low).prod() / static_cast<double>(heights.size())));
  const auto cell = [&](double v, double origin, int count) {
    return std::clamp(static_cast<int>((v - origin) / bucket_m), 0, count - 1);
  };
  const int columns = static_cast<int>((high.x() - low.x()) / bucket_m) + 1;
  const int rows = static_cast<int>((high.y() - low.y()) / bucket_m) + 1;
  std::vector<std::vector<std::uint32_t>> buckets(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  const auto bucket = [&](int c, int r) -> std::vector<std::uint32_t>& {
    return buckets[static_cast<std::size_t>(r) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(c)];
  };
  for (std::uint32_t i = 0; i < heights.size(); ++i)
    bucket(cell(heights[i].x(), low.x(), columns), cell(heights[i].y(), low.y(), rows)).push_back(i);

  const auto fit = [&](double x, double y) {
    std::vector<std::pair<double, std::uint32_t>> near;
    for (int ring = 1;; ++ring) {
      near.clear();
      const double reach_m = ring * bucket_m;
      for (int r = cell(y - reach_m, low.y(), rows); r <= cell(y + reach_m, low.y(), rows); ++r)
        for (int c = cell(x - reach_m, low.x(), columns); c <= cell(x + reach_m, low.x(), columns); ++c)
          for (const std::uint32_t i : bucket(c, r)) {
            const double d2 = (heights[i].head<2>() - Eigen::Vector2d(x, y)).squaredNorm();
            if (d2 <= reach_m * reach_m || ring > columns + rows + 100) near.emplace_back(d2, i);
          }
      if (near.size() >= std::min(kEnough, heights.size())) break;
    }
    std::sort(near.begin(), near.end());
    const double eighth2 = near[std::min(kEnough, near.size()) - 1].first;
    const double width2 = std::max(kWidth_m * kWidth_m, 0.5 * eighth2);
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    const double middle_m = heights[near[0].second].z();
    for (const auto& [d2, i] : near) {
      const double w = std::exp(-0.5 * d2 / width2);
      const Eigen::Vector3d q(1.0, (heights[i].x() - x) / kWidth_m, (heights[i].y() - y) / kWidth_m);
      A += w * q * q.transpose();
      b += w * (heights[i].z() - middle_m) * q;
    }
    // A little against tilting where the heights lie in a line or all to one side: the mean then.
    A(1, 1) += 0.05 * A(0, 0), A(2, 2) += 0.05 * A(0, 0);
    return middle_m + A.ldlt().solve(b)(0);
  };
  parallel_for(static_cast<std::size_t>(grid.rows), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      for (int column = 0; column < grid.columns; ++column)
        grid.height_m[grid.index(column, static_cast<int>(row))] = fit(grid.x(column), grid.y(static_cast<int>(row)));
  });
}

void add_ground(const GroundGrid& grid, const std::string& material_name, SceneParts& parts) {
  MeshBuilder builder(parts);
  const std::uint16_t material = builder.material(material_name);
  const std::uint32_t object = builder.begin_object("terrain", ObjectKind::kTerrain);
  Mesh& mesh = parts.mesh;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      mesh.vertices.push_back(
          Eigen::Vector3d(grid.x(column), grid.y(row), grid.height_m[grid.index(column, row)]).cast<float>());
  const auto at = [&](int column, int row) { return first + static_cast<std::uint32_t>(grid.index(column, row)); };
  for (int row = 0; row + 1 < grid.rows; ++row) {
    for (int column = 0; column + 1 < grid.columns; ++column) {
      mesh.triangles.push_back({at(column, row), at(column + 1, row), at(column + 1, row + 1)});
      mesh.triangles.push_back({at(column, row), at(column + 1, row + 1), at(column, row + 1)});
      mesh.material.insert(mesh.material.end(), 2, material);
      mesh.object.insert(mesh.object.end(), 2, object);
    }
  }
}

}  // namespace canyon::scene
