#include "canyon/scene/city/buildings.h"

#include <algorithm>
#include <string>

#include "canyon/core/process/progress.h"
#include "canyon/core/random/random.h"
#include "canyon/scene/city/draws.h"

namespace canyon::scene::city {
namespace {

/// A building before it stands on the ground. Corner 0 of an L is the inner (reflex) corner.
struct Design {
  Rectangle bounds;
  std::vector<Eigen::Vector2d> outline;
  double height_m = 0.0;
  std::string wall, roof;
  bool gable = false;
  bool machine_room = false;
};

/// The rectangle without its corner nearest to the block's middle, so that the street sides stay whole.
std::vector<Eigen::Vector2d> l_shape(const Rectangle& r, const Eigen::Vector2d& towards, double cut_x, double cut_y) {
  const double x = towards.x() > r.center().x() ? r.x1 - cut_x * r.width() : r.x0 + cut_x * r.width();
  const double y = towards.y() > r.center().y() ? r.y1 - cut_y * r.depth() : r.y0 + cut_y * r.depth();
  const bool east = towards.x() > r.center().x(), north = towards.y() > r.center().y();
  if (east && north) return {{x, y}, {x, r.y1}, {r.x0, r.y1}, {r.x0, r.y0}, {r.x1, r.y0}, {r.x1, y}};
  if (!east && north) return {{x, y}, {r.x0, y}, {r.x0, r.y0}, {r.x1, r.y0}, {r.x1, r.y1}, {x, r.y1}};
  if (!east) return {{x, y}, {x, r.y0}, {r.x1, r.y0}, {r.x1, r.y1}, {r.x0, r.y1}, {r.x0, y}};
  return {{x, y}, {r.x1, y}, {r.x1, r.y1}, {r.x0, r.y1}, {r.x0, r.y0}, {x, r.y0}};
}

void choose_tall(Design& d, Draws& draws) {
  const double u = draws.between(0.0, 1.0);
  d.height_m = 25.0 + 55.0 * u * u;
  const double m = draws.between(0.0, 1.0);
  d.wall = m < 0.45 ? "glass" : m < 0.85 ? "concrete" : "metal";
  d.roof = "concrete";
  d.machine_room = true;
}

void choose_middle(Design& d, Draws& draws) {
  d.height_m = draws.between(10.0, 22.0);
  const double m = draws.between(0.0, 1.0);
  d.wall = m < 0.4 ? "concrete" : m < 0.75 ? "brick" : m < 0.85 ? "plasterboard" : m < 0.93 ? "marble" : "glass";
  d.roof = "roofing";
}

void choose_low(Design& d, Draws& draws) {
  d.height_m = draws.between(4.0, 9.0);
  d.wall = draws.chance(0.55) ? "brick" : "wood";
  d.roof = "roofing";
  d.gable = true;
}

/// How a zone's blocks are divided and built on.
struct Pattern {
  double plot_m;                        ///< wished edge of a plot
  double setback_min_m, setback_max_m;  ///< from the sidewalk
  double gap_min_m, gap_max_m;          ///< from the plot's border towards neighbours
  double l_share;
  double built_share;  ///< plots that are built on
};

Pattern pattern_of(Zone zone) {
  switch (zone) {
    case Zone::kTall:
      return {38.0, 0.0, 1.5, 0.8, 2.5, 0.2, 1.0};
    case Zone::kMiddle:
      return {33.0, 0.0, 4.0, 1.5, 4.0, 0.35, 0.92};
    default:
      return {30.0, 4.0, 9.0, 3.0, 8.0, 0.2, 0.8};
  }
}

/// Cuts [low, high] into about equal parts with borders moved a little.
std::vector<double> cuts(double low, double high, double wished_m, Draws& draws) {
  const int count = std::max(1, static_cast<int>((high - low) / wished_m + 0.5));
  std::vector<double> at{low};
  for (int i = 1; i < count; ++i) at.push_back(low + (high - low) * (i + draws.between(-0.12, 0.12)) / count);
  at.push_back(high);
  return at;
}

std::vector<Design> design_block(const Block& block, std::size_t number, const RandomStream& stream) {
  if (block.zone == Zone::kOpen) return {};
  const Pattern pattern = pattern_of(block.zone);
  const Rectangle land = block.kerb.inset(kSidewalk_m);
  Draws plots(stream, number, 0);
  const std::vector<double> xs = cuts(land.x0, land.x1, pattern.plot_m, plots);
  const std::vector<double> ys = cuts(land.y0, land.y1, pattern.plot_m, plots);
  std::vector<Design> designs;
  for (std::size_t j = 0; j + 1 < ys.size(); ++j) {
    for (std::size_t i = 0; i + 1 < xs.size(); ++i) {
      Draws draws(stream, number, 1 + j * 16 + i);
      if (!draws.chance(pattern.built_share)) continue;
      const auto margin = [&](bool street) {
        const double setback = draws.between(pattern.setback_min_m, pattern.setback_max_m);
        const double gap = draws.between(pattern.gap_min_m, pattern.gap_max_m);
        return street ? setback : gap;
      };
      Design d;
      d.bounds.x0 = xs[i] + margin(i == 0);
      d.bounds.y0 = ys[j] + margin(j == 0);
      d.bounds.x1 = xs[i + 1] - margin(i + 2 == xs.size());
      d.bounds.y1 = ys[j + 1] - margin(j + 2 == ys.size());
      if (block.zone == Zone::kLow) {
        // A house does not fill its plot: keep the street corner, trim the rest.
        const double width_m = draws.between(10.0, 17.0), depth_m = draws.between(9.0, 13.0);
        if (d.bounds.width() > width_m)
          (i == 0 ? d.bounds.x1 = d.bounds.x0 + width_m : d.bounds.x0 = d.bounds.x1 - width_m);
        if (d.bounds.depth() > depth_m)
          (j == 0 ? d.bounds.y1 = d.bounds.y0 + depth_m : d.bounds.y0 = d.bounds.y1 - depth_m);
      }
      if (std::min(d.bounds.width(), d.bounds.depth()) < 6.0) continue;
      if (block.zone == Zone::kTall) choose_tall(d, draws);
      if (block.zone == Zone::kMiddle) choose_middle(d, draws);
      if (block.zone == Zone::kLow) choose_low(d, draws);
      const bool l = draws.chance(pattern.l_share) && std::min(d.bounds.width(), d.bounds.depth()) > 9.0;
      const double cut_x = draws.between(0.35, 0.6), cut_y = draws.between(0.35, 0.6);
      d.outline = l ? l_shape(d.bounds, block.kerb.center(), cut_x, cut_y)
                    : rectangle(d.bounds.x0, d.bounds.y0, d.bounds.x1, d.bounds.y1);
      d.gable = d.gable && !l;
      d.machine_room = d.machine_room && !l;
      designs.push_back(std::move(d));
    }
  }
  return designs;
}

/// Walls up to the eaves, two gables, two roof slopes; the ridge runs along the longer side.
void add_gabled(MeshBuilder& mesh, const Rectangle& r, double bottom_m, double eaves_m, double ridge_m,
                std::uint16_t wall, std::uint16_t roof) {
  const auto outline = rectangle(r.x0, r.y0, r.x1, r.y1);
  mesh.walls(outline, std::vector<double>(4, bottom_m), std::vector<double>(4, eaves_m), wall);
  const auto at = [](double x, double y, double z) { return Eigen::Vector3d(x, y, z); };
  const double xm = r.center().x(), ym = r.center().y();
  if (r.width() >= r.depth()) {
    mesh.triangle(at(r.x1, r.y0, eaves_m), at(r.x1, r.y1, eaves_m), at(r.x1, ym, ridge_m), wall);
    mesh.triangle(at(r.x0, r.y1, eaves_m), at(r.x0, r.y0, eaves_m), at(r.x0, ym, ridge_m), wall);
    mesh.quad(at(r.x0, r.y0, eaves_m), at(r.x1, r.y0, eaves_m), at(r.x1, ym, ridge_m), at(r.x0, ym, ridge_m), roof);
    mesh.quad(at(r.x1, r.y1, eaves_m), at(r.x0, r.y1, eaves_m), at(r.x0, ym, ridge_m), at(r.x1, ym, ridge_m), roof);
  } else {
    mesh.triangle(at(r.x0, r.y0, eaves_m), at(r.x1, r.y0, eaves_m), at(xm, r.y0, ridge_m), wall);
    mesh.triangle(at(r.x1, r.y1, eaves_m), at(r.x0, r.y1, eaves_m), at(xm, r.y1, ridge_m), wall);
    mesh.quad(at(r.x1, r.y0, eaves_m), at(r.x1, r.y1, eaves_m), at(xm, r.y1, ridge_m), at(xm, r.y0, ridge_m), roof);
    mesh.quad(at(r.x0, r.y1, eaves_m), at(r.x0, r.y0, eaves_m), at(xm, r.y0, ridge_m), at(xm, r.y1, ridge_m), roof);
  }
}

/// What of building `number` (from 1) does not depend on the ground.
Building planned(const Design& d, std::size_t number) {
  Building building;
  building.name = "building " + std::to_string(number);
  building.footprint_W = d.outline;
  return building;
}

void build(const Design& d, const Terrain& terrain, MeshBuilder& mesh, SceneParts& parts) {
  Building building = planned(d, parts.buildings.size() + 1);
  building.object = mesh.begin_object(building.name, ObjectKind::kBuilding);
  const Terrain::Span ground = terrain.span(d.bounds.x0, d.bounds.y0, d.bounds.x1, d.bounds.y1);
  building.base_m = ground.low_m;
  building.height_m = d.height_m + (ground.high_m - ground.low_m);  // the design's height holds on the uphill side
  const double bottom_m = building.base_m - 0.5, top_m = building.base_m + building.height_m;
  const std::uint16_t wall = mesh.material(d.wall), roof = mesh.material(d.roof);
  if (d.gable) {
    const double rise_m = 0.35 * std::min(d.bounds.width(), d.bounds.depth()) * 0.5 + 0.3;
    add_gabled(mesh, d.bounds, bottom_m, top_m - rise_m, top_m, wall, roof);
  } else {
    mesh.block(d.outline, bottom_m, top_m, wall, roof);
  }
  if (d.machine_room) {
    const Eigen::Vector2d c = d.bounds.center();
    const double hx = 0.15 * d.bounds.width(), hy = 0.15 * d.bounds.depth();
    mesh.block(rectangle(c.x() - hx, c.y() - hy, c.x() + hx, c.y() + hy), top_m, top_m + 3.0, mesh.material("metal"),
               mesh.material("metal"));
  }
  parts.buildings.push_back(std::move(building));
}

std::vector<Design> designs(const CityConfig& config, const Plan& plan) {
  const RandomStream stream(static_cast<std::uint64_t>(config.seed), "scene.city.buildings");
  std::vector<Design> all;
  for (std::size_t i = 0; i < plan.blocks.size(); ++i) {
    for (Design& d : design_block(plan.blocks[i], i, stream)) all.push_back(std::move(d));
  }
  return all;
}

}  // namespace

std::vector<Building> planned_buildings(const CityConfig& config, const Plan& plan) {
  std::vector<Building> buildings;
  for (const Design& d : designs(config, plan)) buildings.push_back(planned(d, buildings.size() + 1));
  return buildings;
}

void add_buildings(const CityConfig& config, const Plan& plan, const Terrain& terrain, SceneParts& parts) {
  MeshBuilder mesh(parts);
  for (const Design& d : designs(config, plan)) {
    throw_if_cancelled();
    build(d, terrain, mesh, parts);
  }
}

}  // namespace canyon::scene::city
