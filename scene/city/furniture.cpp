#include "scene/city/furniture.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/random.h"
#include "scene/city/draws.h"

namespace canyon::scene::city {
namespace {

/// One side of one street, with coordinates along it and across it (0 at the centre line, positive to its own side).
struct Kerb {
  Eigen::Vector2d start, along, across;
  double length_m;

  Eigen::Vector2d at(double along_m, double across_m) const { return start + along_m * along + across_m * across; }
};

/// Two kerbs per street; the entity of their random draws is their place in this list.
std::vector<Kerb> kerbs(const StreetGraph& streets) {
  std::vector<Kerb> all;
  for (const StreetGraph::Edge& e : streets.edges) {
    const Eigen::Vector2d a = streets.nodes_W[e.a], b = streets.nodes_W[e.b];
    const Eigen::Vector2d along = (b - a).normalized(), left(-along.y(), along.x());
    all.push_back({a, along, left, (b - a).norm()});
    all.push_back({a, along, -left, (b - a).norm()});
  }
  return all;
}

double by_zone(Zone zone, double tall, double middle, double low, double open) {
  switch (zone) {
    case Zone::kTall:
      return tall;
    case Zone::kMiddle:
      return middle;
    case Zone::kLow:
      return low;
    default:
      return open;
  }
}

// ---- vehicles

void add_vehicles(const CityConfig& config, const Plan& plan, const Terrain& terrain, SceneParts& parts) {
  constexpr double kLength_m = 4.5, kWidth_m = 1.8, kSlot_m = 6.5, kCorner_m = 15.0;
  const RandomStream stream(static_cast<std::uint64_t>(config.seed), "scene.city.vehicles");
  MeshBuilder mesh(parts);
  const std::uint16_t paint = mesh.material("painted_metal"), glass = mesh.material("glass");
  std::size_t count = 0;
  const std::vector<Kerb> all = kerbs(plan.streets);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Kerb& kerb = all[k];
    const double share =
        by_zone(plan.zone_near(kerb.at(0.5 * kerb.length_m, config.street_width_m)), 0.45, 0.35, 0.2, 0.05);
    for (std::size_t slot = 0; kCorner_m + (static_cast<double>(slot) + 1.0) * kSlot_m < kerb.length_m - kCorner_m;
         ++slot) {
      Draws draws(stream, k, slot);
      const bool occupied = draws.chance(share);
      const double along_m = kCorner_m + (static_cast<double>(slot) + 0.5) * kSlot_m + draws.between(-0.6, 0.6);
      const double across_m = 0.5 * config.street_width_m - 0.5 * kWidth_m - draws.between(0.08, 0.16);
      if (!occupied) continue;
      const Eigen::Vector2d xy = kerb.at(along_m, across_m);
      Eigen::Matrix3d axes;
      axes.col(2) = terrain.normal(xy.x(), xy.y());
      const Eigen::Vector3d heading(kerb.along.x(), kerb.along.y(), 0.0);
      axes.col(1) = axes.col(2).cross(heading).normalized();
      axes.col(0) = axes.col(1).cross(axes.col(2));
      const Eigen::Vector3d on_ground(xy.x(), xy.y(), terrain.height(xy.x(), xy.y()));
      mesh.begin_object("vehicle " + std::to_string(++count), ObjectKind::kVehicle);
      mesh.box(on_ground + 0.55 * axes.col(2), axes, {0.5 * kLength_m, 0.5 * kWidth_m, 0.35}, paint);
      mesh.box(on_ground + 1.20 * axes.col(2) - 0.2 * axes.col(0), axes, {1.2, 0.5 * kWidth_m - 0.12, 0.30}, glass);
    }
  }
}

// ---- trees

struct TreeShape {
  double crown_center_m;  ///< above ground
  Eigen::Vector3d radii_m;
};

void add_tree(const Eigen::Vector2d& xy, const TreeShape& shape, const Terrain& terrain, const RandomStream& leaves,
              std::size_t number, MeshBuilder& mesh, SceneParts& parts) {
  constexpr int kLeaves = 40;
  mesh.begin_object("tree " + std::to_string(number + 1), ObjectKind::kTree);
  const double ground_m = terrain.height(xy.x(), xy.y());
  const std::uint16_t bark = mesh.material("bark"), leaf = mesh.material("foliage");

  const double r = 0.08 * shape.radii_m.x();
  const std::vector<Eigen::Vector2d> trunk{xy + Eigen::Vector2d(r, 0.0),
                                           xy + Eigen::Vector2d(0.5 * r, 0.866 * r),
                                           xy + Eigen::Vector2d(-0.5 * r, 0.866 * r),
                                           xy + Eigen::Vector2d(-r, 0.0),
                                           xy + Eigen::Vector2d(-0.5 * r, -0.866 * r),
                                           xy + Eigen::Vector2d(0.5 * r, -0.866 * r)};
  mesh.walls(trunk, std::vector<double>(6, ground_m - 0.3), std::vector<double>(6, ground_m + shape.crown_center_m),
             bark);

  const Foliage crown{{xy.x(), xy.y(), ground_m + shape.crown_center_m}, shape.radii_m};
  parts.foliage.push_back(crown);
  // Clumps of leaves as free triangles: uniform in the crown, turned at random, together hiding about half of what is
  // behind.
  const auto entity = static_cast<std::uint32_t>(number);
  const double size_m = 0.29 * shape.radii_m.x();
  for (std::uint64_t i = 0; i < kLeaves; ++i) {
    // The largest of three uniform numbers is distributed as a radius in a ball.
    const double radius =
        0.85 * std::max({leaves.uniform(entity, i, 10), leaves.uniform(entity, i, 11), leaves.uniform(entity, i, 12)});
    const Eigen::Vector3d center =
        crown.center_W + radius * leaves.direction(entity, 2 * i).cwiseProduct(crown.radii_m);
    const Eigen::Vector3d normal = leaves.direction(entity, 2 * i + 1);
    const Eigen::Vector3d other = std::abs(normal.z()) < 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
    const Eigen::Vector3d u = normal.cross(other).normalized(), v = normal.cross(u);
    mesh.triangle(center + size_m * u, center + size_m * (-0.5 * u + 0.866 * v),
                  center + size_m * (-0.5 * u - 0.866 * v), leaf);
  }
}

bool clear_of_buildings(const Eigen::Vector2d& xy, double clearance_m, const std::vector<Building>& buildings) {
  for (const Building& b : buildings) {
    Eigen::Vector2d low = b.footprint_W[0], high = low;
    for (const Eigen::Vector2d& p : b.footprint_W) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const Eigen::Vector2d outside = (low - xy).cwiseMax(xy - high).cwiseMax(0.0);
    if (outside.norm() < clearance_m) return false;
  }
  return true;
}

void add_trees(const CityConfig& config, const Plan& plan, const Terrain& terrain, SceneParts& parts) {
  constexpr double kSpacing_m = 13.0, kCorner_m = 12.0, kBeyondKerb_m = 1.3;
  const auto seed = static_cast<std::uint64_t>(config.seed);
  const RandomStream streets(seed, "scene.city.street_trees"), parks(seed, "scene.city.park_trees"),
      leaves(seed, "scene.city.leaves");
  MeshBuilder mesh(parts);
  std::size_t number = 0;

  const std::vector<Kerb> all = kerbs(plan.streets);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Kerb& kerb = all[k];
    const double share =
        by_zone(plan.zone_near(kerb.at(0.5 * kerb.length_m, config.street_width_m)), 0.25, 0.4, 0.5, 0.4);
    for (std::size_t slot = 0; kCorner_m + (static_cast<double>(slot) + 1.0) * kSpacing_m < kerb.length_m - kCorner_m;
         ++slot) {
      Draws draws(streets, k, slot);
      const bool grown = draws.chance(share);
      const double radius_m = draws.between(1.3, 1.7), tall_m = draws.between(1.6, 2.0),
                   center_m = draws.between(4.9, 5.6);
      if (!grown) continue;
      const Eigen::Vector2d xy = kerb.at(kCorner_m + (static_cast<double>(slot) + 0.5) * kSpacing_m,
                                         0.5 * config.street_width_m + kBeyondKerb_m);
      add_tree(xy, {center_m, {radius_m, radius_m, tall_m}}, terrain, leaves, number++, mesh, parts);
    }
  }

  for (std::size_t b = 0; b < plan.blocks.size(); ++b) {
    const Block& block = plan.blocks[b];
    const Rectangle land = block.kerb.inset(kSidewalk_m + 2.5);
    const double area_per_tree_m2 = by_zone(block.zone, 2500.0, 900.0, 500.0, 260.0);
    const auto wished = static_cast<std::size_t>(land.width() * land.depth() / area_per_tree_m2);
    for (std::size_t i = 0; i < wished; ++i) {
      Draws draws(parks, b, i);
      const Eigen::Vector2d xy(draws.between(land.x0, land.x1), draws.between(land.y0, land.y1));
      const double radius_m = draws.between(1.8, 3.5), tall_m = draws.between(2.0, 3.2),
                   center_m = draws.between(5.5, 7.0);
      if (!clear_of_buildings(xy, radius_m + 0.5, parts.buildings)) continue;
      add_tree(xy, {center_m, {radius_m, radius_m, tall_m}}, terrain, leaves, number++, mesh, parts);
    }
  }
}

// ---- poles and walls

void add_poles(const CityConfig& config, const Plan& plan, const Terrain& terrain, SceneParts& parts) {
  constexpr double kSpacing_m = 26.0, kCorner_m = 12.0, kBeyondKerb_m = 0.6, kHeight_m = 8.0, kHalf_m = 0.07;
  MeshBuilder mesh(parts);
  const std::uint16_t metal = mesh.material("metal");
  std::size_t count = 0;
  const std::vector<Kerb> all = kerbs(plan.streets);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Kerb& kerb = all[k];
    for (double along_m = kCorner_m + (k % 2 == 0 ? 0.0 : 13.0); along_m < kerb.length_m - kCorner_m;
         along_m += kSpacing_m) {
      const Eigen::Vector2d p = kerb.at(along_m, 0.5 * config.street_width_m + kBeyondKerb_m);
      const double ground_m = terrain.height(p.x(), p.y());
      mesh.begin_object("pole " + std::to_string(++count), ObjectKind::kPole);
      mesh.block(rectangle(p.x() - kHalf_m, p.y() - kHalf_m, p.x() + kHalf_m, p.y() + kHalf_m), ground_m - 0.3,
                 ground_m + kHeight_m, metal, metal);
    }
  }
}

/// A straight wall that follows the ground in short pieces.
void add_wall(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double height_m, const Terrain& terrain,
              std::size_t number, MeshBuilder& mesh) {
  constexpr double kPiece_m = 6.0, kHalfThickness_m = 0.12;
  mesh.begin_object("wall " + std::to_string(number), ObjectKind::kWall);
  const std::uint16_t brick = mesh.material("brick");
  const Eigen::Vector2d along = (to - from).normalized(),
                        left = kHalfThickness_m * Eigen::Vector2d(-along.y(), along.x());
  const int pieces = std::max(1, static_cast<int>(std::ceil((to - from).norm() / kPiece_m)));
  for (int i = 0; i < pieces; ++i) {
    const Eigen::Vector2d a = from + (to - from) * i / pieces, b = from + (to - from) * (i + 1) / pieces;
    const double za = terrain.height(a.x(), a.y()), zb = terrain.height(b.x(), b.y());
    const std::vector<Eigen::Vector2d> outline{a - left, b - left, b + left, a + left};
    const std::vector<double> top{za + height_m, zb + height_m, zb + height_m, za + height_m};
    mesh.walls(outline, {za - 0.4, zb - 0.4, zb - 0.4, za - 0.4}, top, brick);
    const auto corner = [&](std::size_t k) { return Eigen::Vector3d(outline[k].x(), outline[k].y(), top[k]); };
    mesh.quad(corner(0), corner(1), corner(2), corner(3), brick);
  }
}

/// Garden walls along the sidewalk of blocks with houses, each with a gap for a gate.
void add_garden_walls(const CityConfig& config, const Plan& plan, const Terrain& terrain, SceneParts& parts) {
  constexpr double kGate_m = 4.0;
  const RandomStream stream(static_cast<std::uint64_t>(config.seed), "scene.city.walls");
  MeshBuilder mesh(parts);
  std::size_t count = 0;
  for (std::size_t b = 0; b < plan.blocks.size(); ++b) {
    if (plan.blocks[b].zone != Zone::kLow) continue;
    const Rectangle land = plan.blocks[b].kerb.inset(kSidewalk_m + 0.3);
    const auto corners = rectangle(land.x0, land.y0, land.x1, land.y1);
    for (std::size_t side = 0; side < 4; ++side) {
      Draws draws(stream, b, side);
      const bool built = draws.chance(0.45);
      const double gate = draws.between(0.3, 0.7), height_m = draws.between(0.9, 1.8);
      if (!built) continue;
      const Eigen::Vector2d from = corners[side], to = corners[(side + 1) % 4], along = (to - from).normalized();
      const double length_m = (to - from).norm();
      add_wall(from + 2.0 * along, from + (gate * length_m - 0.5 * kGate_m) * along, height_m, terrain, ++count, mesh);
      add_wall(from + (gate * length_m + 0.5 * kGate_m) * along, to - 2.0 * along, height_m, terrain, ++count, mesh);
    }
  }
}

}  // namespace

void add_furniture(const CityConfig& config, const Plan& plan, const Terrain& terrain, SceneParts& parts) {
  add_vehicles(config, plan, terrain, parts);
  add_trees(config, plan, terrain, parts);
  add_poles(config, plan, terrain, parts);
  add_garden_walls(config, plan, terrain, parts);
}

}  // namespace canyon::scene::city
