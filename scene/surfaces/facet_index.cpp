#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "canyon/core/check.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/scene/surfaces/facet.h"

namespace canyon::scene {
namespace {

constexpr double kCell_m = 25.0;
constexpr int kMaxCells = 400;  // per side; larger scenes get larger cells
constexpr double kFacetBlock_m = 50.0;
constexpr double kFacetTile_m = 2000.0;
constexpr double kFirstRing_m = 32.0;  // how far a bend turns is asked for at this distance, and at its doubles
constexpr std::size_t kRings = 12;

// Classes of lean: upright; leaning over (its upper edge hangs forward); so far over that it faces nearly straight
// down; and leaning back, by the degree.
constexpr double kUpright = 1e-3;  // |n_z|
constexpr double kFacesDown_rad = 85.0 * kDegree;
constexpr std::size_t kLeansBack = 3;  // the first of these
constexpr std::size_t kLeanClasses = kLeansBack + 90;

std::size_t lean_class(double n_z) {
  if (std::abs(n_z) <= kUpright) return 0;
  const double lean_rad = std::asin(std::min(std::abs(n_z), 1.0));
  if (n_z < 0.0) return lean_rad < kFacesDown_rad ? 1 : 2;
  return 3 + std::min(static_cast<std::size_t>(lean_rad / kDegree), std::size_t{89});
}

/// Elevations from which a wave may arrive that a facet of one class of lean has mirrored.
class Arrivals {
 public:
  /// `elevation_rad` may lie below the horizontal: a wave from above it may have been bent that far.
  Arrivals(double elevation_rad, std::size_t lean) {
    double lowest_rad = elevation_rad, highest_rad = kPi - elevation_rad;
    if (lean == 0) lowest_rad -= 2.0 * std::asin(kUpright);
    if (lean == 2) never_ = elevation_rad > 0.5 * kPi - kFacesDown_rad;  // nothing shines on it
    if (lean >= 3) {
      lowest_rad -= 2.0 * static_cast<double>(lean - 2) * kDegree;
      highest_rad -= 2.0 * static_cast<double>(lean - 3) * kDegree;
    }
    if (lowest_rad > 0.0) rise_ = std::tan(std::min(lowest_rad, 0.4999 * kPi));
    if (highest_rad < 0.0) fall_ = std::tan(std::min(-highest_rad, 0.4999 * kPi));
  }
  /// Can anything between two heights above p, no nearer than `distance_m` horizontally, lie there? Where only farther
  /// points could, the answer is yes.
  bool meet(double bottom_m, double top_m, double distance_m) const {
    constexpr double kSlack_m = 1e-3;  // rounding
    return !never_ && (!rise_ || top_m + kSlack_m >= distance_m * *rise_) &&
           (!fall_ || bottom_m - kSlack_m <= -distance_m * *fall_);
  }

 private:
  std::optional<double> rise_, fall_;  // least tangents upward and downward, where such are asked for
  bool never_ = false;
};

/// Arrivals of all classes of lean by distance: a wave that passes over a border with a longer way turns the more the
/// nearer that is. Made where they are asked for.
class ArrivalsByDistance {
 public:
  ArrivalsByDistance(double elevation_rad, double detour_m) : elevation_rad_(elevation_rad), detour_m_(detour_m) {}

  const std::vector<Arrivals>& from(double distance_m) {
    std::size_t ring = 0;
    if (detour_m_ > 0.0)
      while (ring + 1 < kRings && distance_m >= std::ldexp(kFirstRing_m, static_cast<int>(ring))) ++ring;
    std::vector<Arrivals>& arrivals = rings_[ring];
    if (arrivals.empty()) {
      double turn_rad = 0.0;  // the most at the ring's inner border; an angle is below its tangent
      if (detour_m_ > 0.0)
        turn_rad =
            ring == 0 ? 0.5 * kPi : std::sqrt(2.0 * detour_m_ / std::ldexp(kFirstRing_m, static_cast<int>(ring) - 1));
      for (std::size_t lean = 0; lean < kLeanClasses; ++lean)
        arrivals.emplace_back(std::max(elevation_rad_ - turn_rad, -0.5 * kPi), lean);
    }
    return arrivals;
  }

 private:
  double elevation_rad_, detour_m_;
  std::array<std::vector<Arrivals>, kRings> rings_;
};

}  // namespace

FacetIndex::FacetIndex(std::vector<Facet> facets) : facets_(std::move(facets)) {
  if (facets_.empty()) return;
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e300), high = -low;
  for (const Facet& f : facets_) {
    low = low.cwiseMin((f.center_W.array() - f.radius_m).matrix().head<2>());
    high = high.cwiseMax((f.center_W.array() + f.radius_m).matrix().head<2>());
  }
  CANYON_CHECK(low.allFinite() && high.allFinite(), "facets from ", low.transpose(), " to ", high.transpose());
  origin_ = low;
  cell_m_ = std::max(kCell_m, (high - low).maxCoeff() / kMaxCells);
  columns_ = static_cast<int>((high.x() - low.x()) / cell_m_) + 1;
  rows_ = static_cast<int>((high.y() - low.y()) / cell_m_) + 1;
  cells_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (std::uint32_t i = 0; i < facets_.size(); ++i) {
    throw_if_cancelled();
    const Cells range = cells_around(facets_[i].center_W, facets_[i].radius_m);
    for (int row = range.row0; row <= range.row1; ++row) {
      for (int column = range.column0; column <= range.column1; ++column) cells_[cell(column, row)].push_back(i);
    }
  }
  build_tiles();
}

void FacetIndex::Square::add(const Facet& f, bool leans_back) {
  reach_m = std::max(reach_m, std::hypot(f.center_W.x() - x_m, f.center_W.y() - y_m) + f.radius_m);
  area_m2 = std::max(area_m2, f.area_m2);
  if (!leans_back) upright_top_m = std::max(upright_top_m, f.top_m);
}

void FacetIndex::build_tiles() {
  const double block_m = std::max(kFacetBlock_m, cell_m_);
  using RowColumn = std::pair<int, int>;  // row, column
  const auto place_in = [&](const Facet& f, double edge_m) {
    return RowColumn(static_cast<int>((f.center_W.y() - origin_.y()) / edge_m),
                     static_cast<int>((f.center_W.x() - origin_.x()) / edge_m));
  };
  const auto square = [&](const RowColumn& place, double edge_m) {
    return Square{.x_m = origin_.x() + (place.second + 0.5) * edge_m,
                  .y_m = origin_.y() + (place.first + 0.5) * edge_m};
  };
  std::map<RowColumn, std::map<RowColumn, Block>> blocks;  // ordered by tile, then by block
  for (std::uint32_t i = 0; i < facets_.size(); ++i) {
    throw_if_cancelled();
    const Facet& f = facets_[i];
    const RowColumn place = place_in(f, block_m);
    auto& of_tile = blocks[place_in(f, kFacetTile_m)];
    Block& block = of_tile.try_emplace(place, Block{square(place, block_m), {}}).first->second;
    const std::size_t lean = lean_class(f.normal_W.z());
    block.add(f, lean >= kLeansBack);
    auto c = std::find_if(block.classes.begin(), block.classes.end(), [&](const auto& x) { return x.lean == lean; });
    if (c == block.classes.end()) c = block.classes.insert(c, Block::Class{.lean = lean, .facets = {}});
    c->bottom_m = std::min(c->bottom_m, f.bottom_m);
    c->top_m = std::max(c->top_m, f.top_m);
    c->area_m2 = std::max(c->area_m2, f.area_m2);
    c->facets.push_back({static_cast<float>(f.center_W.x()), static_cast<float>(f.center_W.y()),
                         static_cast<float>(f.radius_m), static_cast<float>(f.bottom_m), static_cast<float>(f.top_m),
                         static_cast<float>(f.area_m2), i});
  }
  for (auto& [place, of_tile] : blocks) {
    Tile tile{square(place, kFacetTile_m), {}};
    for (auto& [_, block] : of_tile) {
      for (const auto& c : block.classes)
        for (const Brief& f : c.facets) tile.add(facets_[f.facet], c.lean >= kLeansBack);
      tile.blocks.push_back(std::move(block));
    }
    tiles_.push_back(std::move(tile));
  }
}

FacetIndex::Cells FacetIndex::cells_around(const Eigen::Vector3d& p_W, double radius_m) const {
  const auto clamp_to = [&](double x, int count) {
    return static_cast<int>(std::clamp(std::floor(x / cell_m_), 0.0, static_cast<double>(count - 1)));
  };
  return {clamp_to(p_W.x() - radius_m - origin_.x(), columns_), clamp_to(p_W.x() + radius_m - origin_.x(), columns_),
          clamp_to(p_W.y() - radius_m - origin_.y(), rows_), clamp_to(p_W.y() + radius_m - origin_.y(), rows_)};
}

void FacetIndex::near(const Eigen::Vector3d& p_W, double radius_m, std::vector<std::uint32_t>& out) const {
  CANYON_CHECK(p_W.allFinite() && radius_m >= 0.0, "p = ", p_W.transpose(), ", radius_m = ", radius_m);
  out.clear();
  if (facets_.empty()) return;
  const Cells range = cells_around(p_W, radius_m);
  for (int row = range.row0; row <= range.row1; ++row) {
    for (int column = range.column0; column <= range.column1; ++column) {
      for (const std::uint32_t i : cells_[cell(column, row)]) {
        const Facet& f = facets_[i];
        // A facet that lies in several cells is taken in the first of them that is searched.
        const Cells own = cells_around(f.center_W, f.radius_m);
        if (column != std::max(own.column0, range.column0) || row != std::max(own.row0, range.row0)) continue;
        const double reach_m = radius_m + f.radius_m;
        if ((f.center_W - p_W).squaredNorm() <= reach_m * reach_m) out.push_back(i);
      }
    }
  }
  std::sort(out.begin(), out.end());
}

void FacetIndex::mirrors(const Eigen::Vector3d& p_W, double elevation_rad, double reach_per_area_1_m,
                         double leaning_reach_m, std::vector<std::uint32_t>& out, double detour_m) const {
  CANYON_CHECK(p_W.allFinite() && elevation_rad >= 0.0 && elevation_rad <= 0.5 * kPi && detour_m >= 0.0,
               "p = ", p_W.transpose(), ", elevation_rad = ", elevation_rad, ", detour_m = ", detour_m);
  out.clear();
  ArrivalsByDistance by_distance(elevation_rad, detour_m);
  // How far away a square's facets are at least; none if nothing of it can mirror.
  const auto within = [&](const Square& square) -> std::optional<double> {
    const double distance_m =
        std::max(Eigen::Vector2d(square.x_m - p_W.x(), square.y_m - p_W.y()).norm() - square.reach_m, 0.0);
    const bool stands_out = distance_m <= leaning_reach_m ||
                            by_distance.from(distance_m)[0].meet(-1e9, square.upright_top_m - p_W.z(), distance_m);
    return stands_out && distance_m <= reach_per_area_1_m * square.area_m2 ? std::optional(distance_m) : std::nullopt;
  };
  const auto add = [&](const Block& block, double distance_m) {
    const std::vector<Arrivals>& arrivals = by_distance.from(distance_m);
    for (const Block::Class& c : block.classes) {
      const Arrivals& a = arrivals[c.lean];
      if ((c.lean >= kLeansBack && distance_m > leaning_reach_m) || distance_m > reach_per_area_1_m * c.area_m2)
        continue;
      if (!a.meet(c.bottom_m - p_W.z(), c.top_m - p_W.z(), distance_m)) continue;
      for (const Brief& f : c.facets) {
        const double dx = f.x_m - p_W.x(), dy = f.y_m - p_W.y();
        const double own_m = std::max(std::sqrt(dx * dx + dy * dy) - f.radius_m, 0.0);
        if (own_m <= reach_per_area_1_m * f.area_m2 && a.meet(f.bottom_m - p_W.z(), f.top_m - p_W.z(), own_m))
          out.push_back(f.facet);
      }
    }
  };
  for (const Tile& tile : tiles_) {
    if (!within(tile)) continue;
    for (const Block& block : tile.blocks)
      if (const auto distance_m = within(block)) add(block, *distance_m);
  }
}

}  // namespace canyon::scene
