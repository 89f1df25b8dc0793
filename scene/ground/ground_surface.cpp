#include "canyon/scene/ground/ground_surface.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Dense>

#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/scene/mesh_builder.h"

namespace canyon::scene {
namespace {

/// A corner's place in the order of rows.
using Corner = std::uint64_t;
Corner corner(std::int32_t column, std::int32_t row) {
  return static_cast<std::uint64_t>(row) << 32 | static_cast<std::uint32_t>(column);
}

/// Middles of a cell's sides that are corners of smaller cells: south, east, north, west.
std::array<bool, 4> finer_sides(const GroundPlan::Cell& cell, const std::vector<Corner>& corners) {
  const std::int32_t c = cell.column, r = cell.row, half = cell.size / 2, end = cell.size;
  const auto is_corner = [&](std::int32_t column, std::int32_t row) {
    return std::binary_search(corners.begin(), corners.end(), corner(column, row));
  };
  if (cell.size == 1) return {};
  return {is_corner(c + half, r), is_corner(c + end, r + half), is_corner(c + half, r + end), is_corner(c, r + half)};
}

void sort_unique(std::vector<Corner>& corners) {
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
}

}  // namespace

GroundMesh::GroundMesh(const GroundPlan& plan) {
  const std::vector<GroundPlan::Cell> cells = plan.list();
  throw_if_cancelled();
  std::vector<Corner> corners;
  corners.reserve(4 * cells.size());
  for (const GroundPlan::Cell& cell : cells)
    for (const std::int32_t r : {cell.row, cell.row + cell.size})
      for (const std::int32_t c : {cell.column, cell.column + cell.size}) corners.push_back(corner(c, r));
  sort_unique(corners);
  throw_if_cancelled();
  std::vector<Corner> middles;
  for (const GroundPlan::Cell& cell : cells) {
    const auto finer = finer_sides(cell, corners);
    if (std::find(finer.begin(), finer.end(), true) != finer.end())
      middles.push_back(corner(cell.column + cell.size / 2, cell.row + cell.size / 2));
  }
  // The middles of the cells' sides are those that are there before the middles of the cells are.
  std::vector<Corner> all = corners;
  all.insert(all.end(), middles.begin(), middles.end());
  sort_unique(all);
  throw_if_cancelled();
  for (const Corner at : all)
    places.emplace_back(plan.x(static_cast<std::int32_t>(at & 0xffffffffu)),
                        plan.y(static_cast<std::int32_t>(at >> 32)));
  height_m.assign(all.size(), 0.0);

  const auto index = [&](std::int32_t column, std::int32_t row) {
    return static_cast<std::uint32_t>(std::lower_bound(all.begin(), all.end(), corner(column, row)) - all.begin());
  };
  triangles.reserve(2 * cells.size());
  of_cell.reserve(cells.size());
  for (const GroundPlan::Cell& cell : cells) {
    const std::int32_t c = cell.column, r = cell.row, half = cell.size / 2, c1 = c + cell.size, r1 = r + cell.size;
    const std::uint32_t sw = index(c, r), se = index(c1, r), ne = index(c1, r1), nw = index(c, r1);
    const auto finer = finer_sides(cell, corners);
    const std::size_t before = triangles.size();
    if (std::find(finer.begin(), finer.end(), true) == finer.end()) {
      triangles.push_back({sw, se, ne});
      triangles.push_back({sw, ne, nw});
    } else {
      const std::uint32_t middle = index(c + half, r + half);
      const std::array<std::uint32_t, 5> around{sw, se, ne, nw, sw};
      const std::array<std::array<std::int32_t, 2>, 4> sides{
          {{c + half, r}, {c1, r + half}, {c + half, r1}, {c, r + half}}};
      for (std::size_t k = 0; k < 4; ++k) {
        if (!finer[k]) {
          triangles.push_back({middle, around[k], around[k + 1]});
          continue;
        }
        const std::uint32_t side = index(sides[k][0], sides[k][1]);
        triangles.push_back({middle, around[k], side});
        triangles.push_back({middle, side, around[k + 1]});
      }
    }
    of_cell.push_back(static_cast<std::uint8_t>(triangles.size() - before));
  }
}

bool fill_ground(GroundMesh& ground, const GroundHeight& height) {
  std::vector<bool> known(ground.places.size(), false);
  std::size_t missing = 0;
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (i % 1024 == 0) throw_if_cancelled();
    const auto h = height(ground.places[i]);
    known[i] = h.has_value();
    ground.height_m[i] = h.value_or(0.0);
    missing += h ? 0 : 1;
  }
  if (missing == known.size()) return false;
  if (missing == 0) return true;
  // Whom those without a height share a cell with.
  std::map<std::uint32_t, std::vector<std::uint32_t>> beside;
  std::size_t first = 0;
  for (const std::uint8_t count : ground.of_cell) {
    std::vector<std::uint32_t> corners;
    for (std::size_t i = first; i < first + count; ++i)
      corners.insert(corners.end(), ground.triangles[i].begin(), ground.triangles[i].end());
    first += count;
    for (const std::uint32_t corner_here : corners)
      if (!known[corner_here]) {
        auto& list = beside[corner_here];
        list.insert(list.end(), corners.begin(), corners.end());
      }
  }
  for (auto& [at, list] : beside) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  while (missing > 0) {
    throw_if_cancelled();
    const std::vector<bool> before = known;
    const std::size_t missing_before = missing;
    for (const auto& [at, list] : beside) {
      if (before[at]) continue;
      double sum = 0.0, count = 0.0;
      for (const std::uint32_t other : list) {
        if (!before[other]) continue;
        sum += ground.height_m[other];
        count += 1.0;
      }
      if (count == 0.0) continue;
      ground.height_m[at] = sum / count;
      known[at] = true;
      --missing;
    }
    if (missing == missing_before) break;  // cells that touch none that is known: level
  }
  return true;
}

GroundFit::GroundFit(std::vector<Eigen::Vector3d> heights) : heights_(std::move(heights)) {
  if (heights_.empty()) return;
  Eigen::Vector2d high = heights_[0].head<2>();
  low_ = high;
  for (const auto& p : heights_) low_ = low_.cwiseMin(p.head<2>()), high = high.cwiseMax(p.head<2>());
  // About four heights in each, also where they lie along a line.
  const double count = static_cast<double>(heights_.size());
  bucket_m_ = std::max({50.0, 2.0 * std::sqrt((high - low_).prod() / count), 2.0 * (high - low_).maxCoeff() / count});
  columns_ = static_cast<int>((high.x() - low_.x()) / bucket_m_) + 1;
  rows_ = static_cast<int>((high.y() - low_.y()) / bucket_m_) + 1;
  buckets_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (std::uint32_t i = 0; i < heights_.size(); ++i) {
    const int c = cell(heights_[i].x(), low_.x(), columns_), r = cell(heights_[i].y(), low_.y(), rows_);
    buckets_[static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(c)].push_back(
        i);
  }
}

int GroundFit::cell(double v, double origin, int count) const {
  return static_cast<int>(std::clamp((v - origin) / bucket_m_, 0.0, static_cast<double>(count - 1)));
}

double GroundFit::operator()(const Eigen::Vector2d& p) const {
  constexpr double kWidth_m = 25.0;
  constexpr std::size_t kEnough = 8;
  if (heights_.empty()) return 0.0;
  const double x = p.x(), y = p.y();
  std::vector<std::pair<double, std::uint32_t>> near;
  const Eigen::Vector2d high = low_.array() + bucket_m_ * Eigen::Array2d(columns_, rows_);
  const double away_m = (low_ - p).cwiseMax(p - high).cwiseMax(0.0).maxCoeff();  // nothing is nearer
  for (int ring = std::max(1, static_cast<int>(std::min(away_m / bucket_m_, 1e6)));; ++ring) {
    near.clear();
    const double reach_m = ring * bucket_m_;
    for (int r = cell(y - reach_m, low_.y(), rows_); r <= cell(y + reach_m, low_.y(), rows_); ++r)
      for (int c = cell(x - reach_m, low_.x(), columns_); c <= cell(x + reach_m, low_.x(), columns_); ++c)
        for (const std::uint32_t i : bucket(c, r)) {
          const double d2 = (heights_[i].head<2>() - p).squaredNorm();
          if (d2 <= reach_m * reach_m || ring > columns_ + rows_ + 100) near.emplace_back(d2, i);
        }
    if (near.size() >= std::min(kEnough, heights_.size())) break;
  }
  std::sort(near.begin(), near.end());
  const double eighth2 = near[std::min(kEnough, near.size()) - 1].first;
  const double width2 = std::max(kWidth_m * kWidth_m, 0.5 * eighth2);
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  const double middle_m = heights_[near[0].second].z();
  for (const auto& [d2, i] : near) {
    const double w = std::exp(-0.5 * d2 / width2);
    const Eigen::Vector3d q(1.0, (heights_[i].x() - x) / kWidth_m, (heights_[i].y() - y) / kWidth_m);
    A += w * q * q.transpose();
    b += w * (heights_[i].z() - middle_m) * q;
  }
  // A little against tilting where the heights lie in a line or all to one side: the mean then.
  A(1, 1) += 0.05 * A(0, 0), A(2, 2) += 0.05 * A(0, 0);
  return middle_m + A.ldlt().solve(b)(0);
}

void fill_ground(GroundMesh& ground, const GroundFit& fit) {
  parallel_for(ground.places.size(), 1024, [&](std::size_t begin, std::size_t end) {
    throw_if_cancelled();
    for (std::size_t i = begin; i < end; ++i) ground.height_m[i] = fit(ground.places[i]);
  });
}

void add_ground(const GroundMesh& ground, const std::string& material_name, SceneParts& parts) {
  MeshBuilder builder(parts);
  const std::uint16_t material = builder.material(material_name);
  const std::uint32_t object = builder.begin_object("terrain", ObjectKind::kTerrain);
  Mesh& mesh = parts.mesh;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::size_t i = 0; i < ground.places.size(); ++i)
    mesh.vertices.push_back(
        Eigen::Vector3d(ground.places[i].x(), ground.places[i].y(), ground.height_m[i]).cast<float>());
  for (const auto& t : ground.triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  mesh.material.insert(mesh.material.end(), ground.triangles.size(), material);
  mesh.object.insert(mesh.object.end(), ground.triangles.size(), object);
}

}  // namespace canyon::scene
