// Terrain at its borders, with holes and without steps.
#include <cmath>
#include <limits>
#include <map>

#include "canyon/core/output/printed.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/scene/city/city.h"
#include "canyon/scene/city/terrain.h"
#include "canyon/scene/elevation/elevation.h"
#include "canyon/scene/ground/ground_detail.h"
#include "canyon/scene/ground/ground_plan.h"
#include "canyon/scene/ground/ground_surface.h"
#include "canyon/scene/stress/made_scenes.h"
#include "canyon/scene/stress/subjects.h"

namespace canyon::scene {
namespace {

using stress::kEpsilon;

/// 7 + x / 4 - y / 8 + x y / 64 on whole places: bilinear, and so met everywhere; samples are exact in single
/// precision.
Elevation grid(double west, double north, int columns, int rows, double step = 2.0) {
  Elevation out;
  out.west = west, out.north = north, out.step_x = out.step_y = step;
  out.columns = columns, out.rows = rows;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const double x = step * c, y = -step * r;
      out.height_m.push_back(static_cast<float>(7.0 + x / 4.0 - y / 8.0 + x * y / 64.0));
    }
  return out;
}

/// Everywhere and on the borders: its own bilinear form; 16 eps of heights, and a place's own digits, eps of its
/// coordinates by a slope of 2.
StressFigure bilinear(double west, double north) {
  const Elevation e = grid(west, north, 65, 33);
  StressFigure out{0.0, 16.0 * kEpsilon * 200.0 + 4.0 * kEpsilon * (std::abs(west) + std::abs(north))};
  for (double x = 0.0; x <= 128.0; x += 0.5)
    for (double y = 0.0; y >= -64.0; y -= 0.5) {
      const auto h = e.height({west + x, north + y});
      take_worst(
          out, h ? std::abs(*h - (7.0 + x / 4.0 - y / 8.0 + x * y / 64.0)) : std::numeric_limits<double>::quiet_NaN());
    }
  return out;
}

/// A rounding beyond a border, beside a hole, of one row, one column, one sample, steps of 0, places that are none: no
/// height, or that of the samples. A figure counts what differs.
StressFigure borders_and_holes() {
  StressFigure out;
  const auto none = [&](const Elevation& e, double x, double y) { out.figure += e.height({x, y}) ? 1.0 : 0.0; };
  const auto some = [&](const Elevation& e, double x, double y, double h) {
    const auto found = e.height({x, y});
    out.figure += found && *found == h ? 0.0 : 1.0;
  };
  const double inf = std::numeric_limits<double>::infinity(), bad = std::numeric_limits<double>::quiet_NaN();
  const Elevation e = grid(0.0, 0.0, 9, 9);
  for (const double x : {-1e-12, std::nextafter(16.0, 17.0), 1e300, inf, -inf, bad}) none(e, x, -4.0), none(e, 4.0, -x);
  some(e, 16.0, -16.0, 7.0 + 4.0 + 2.0 - 4.0), some(e, 0.0, 0.0, 7.0);
  Elevation hole = e;
  hole.height_m[4 * 9 + 4] = std::numeric_limits<float>::quiet_NaN();
  none(hole, 8.0, -8.0), none(hole, 7.0, -7.0), none(hole, 9.9, -9.9);
  some(hole, 4.0, -4.0, 7.0 + 1.0 + 0.5 - 0.25), some(hole, 12.0, -12.0, 7.0 + 3.0 + 1.5 - 2.25);
  Elevation row = grid(0.0, 0.0, 9, 1), column = grid(0.0, 0.0, 1, 9), one = grid(0.0, 0.0, 1, 1);
  some(row, 4.0, 0.0, 8.0), some(column, 0.0, -8.0, 8.0), some(one, 0.0, 0.0, 7.0);
  none(row, 4.0, -0.1), none(column, 0.1, -4.0), none(one, 0.1, 0.0);
  Elevation flat = e;
  flat.step_x = 0.0;
  none(flat, 4.0, -4.0);
  return out;
}

/// The built-in terrain against the triangles that are made of it, at and beyond its corners, diagonals, borders: the
/// same height. Corners on whole metres are themselves: 16 eps of 512 m; others are floats, off by half a unit of 512 m
/// (3e-5 m) by the slope, and 4e-6 m of heights.
StressFigure city_terrain(double cell_m, double hill_m, double slope_percent) {
  CityConfig config;
  config.extent_m = 1024.0, config.terrain_cell_m = cell_m, config.hill_height_m = hill_m,
  config.slope_percent = slope_percent;
  const city::Terrain terrain(config);
  SceneParts parts = made::nothing();
  terrain.add_to(parts);
  double steepest = 0.0;
  for (double x = -510.0; x < 511.0; x += 17.0)
    for (double y = -510.0; y < 511.0; y += 17.0) steepest = worse(steepest, terrain.normal(x, y).head<2>().norm());
  const auto scene = made::scene_of(std::move(parts));
  const bool exact = cell_m > 1024.0 || std::fmod(1024.0, cell_m) == 0.0;
  StressFigure out{0.0, exact ? 16.0 * kEpsilon * 512.0 : 3.1e-5 * 2.0 * std::max(steepest, 0.01) + 8e-6};
  for (double x = -512.0; x <= 512.0; x += 16.0 / 3.0)
    for (double y = -512.0; y <= 512.0; y += 16.0) {
      const auto ground = scene->ground(std::clamp(x, -511.9999, 511.9999), std::clamp(y, -511.9999, 511.9999));
      take_worst(out, ground ? std::abs(ground->height_m - terrain.height(std::clamp(x, -511.9999, 511.9999),
                                                                          std::clamp(y, -511.9999, 511.9999)))
                             : std::numeric_limits<double>::quiet_NaN());
    }
  // Beyond its square the border's height; 0 at the origin, where a corner stands there.
  take_worst(out, std::abs(terrain.height(1e9, 0.0) - terrain.height(512.0, 0.0)));
  if (cell_m <= 512.0 && std::lround(1024.0 / cell_m) % 2 == 0) take_worst(out, std::abs(terrain.height(0.0, 0.0)));
  return out;
}

/// Ground of a scene on a slope of 1/8, or 1/1024 where that would be higher than mountains: height and normal by
/// closed form, none beyond its border, none of NaN.
StressFigure ground_of_slope(double half_m) {
  SceneParts parts = made::nothing();
  MeshBuilder mesh(parts);
  mesh.begin_object("terrain", ObjectKind::kTerrain);
  const double slope = half_m > 2048.0 ? 1.0 / 1024.0 : 0.125;
  const auto at = [&](double x, double y) { return Eigen::Vector3d(x, y, slope * x); };
  mesh.quad(at(-half_m, -half_m), at(half_m, -half_m), at(half_m, half_m), at(-half_m, half_m),
            mesh.material("asphalt"));
  const auto scene = made::scene_of(std::move(parts));
  const Eigen::Vector3d normal = Eigen::Vector3d(-slope, 0.0, 1.0).normalized();
  StressFigure out{0.0, 8.0 * kEpsilon * (slope * half_m + 1.0)};
  for (int k = -99; k <= 99; ++k) {
    const double x = half_m * k / 100.0, y = half_m * std::sin(k);
    const auto ground = scene->ground(x, y);
    if (!ground) return {std::numeric_limits<double>::infinity(), 1.0};
    take_worst(out, std::abs(ground->height_m - slope * x));
    take_worst(out, (ground->normal_W - normal).norm());
  }
  const double bad = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const double x : {1.001 * half_m, -1.001 * half_m, 1e30, inf, -inf, bad})
    if (scene->ground(x, 0.0) || scene->ground(0.0, x)) out.figure = inf;
  return out;
}

/// Ground with a large cell beside small ones has no crack: rays down on a closed net of places all meet it, and on a
/// plane, which every triangulation holds, at its height: corners stand on whole metres, and 16 eps of heights are
/// left.
StressFigure ground_without_cracks(double cell_m, double extent_m) {
  GroundDetail detail;
  detail.add({0.3 * extent_m, 0.1 * extent_m}, {0.32 * extent_m, 0.12 * extent_m});
  detail.add({-0.4 * extent_m, -0.4 * extent_m}, {-0.4 * extent_m, -0.4 * extent_m});
  detail.add({std::numeric_limits<double>::quiet_NaN(), 0.0}, {1.0, 1.0});
  GroundWish wish;
  wish.low = {-0.5 * extent_m, -0.5 * extent_m}, wish.high = {0.5 * extent_m, 0.5 * extent_m};
  wish.cell_m = cell_m;
  const GroundHeight plane = [](const Eigen::Vector2d& p) { return std::optional(p.x() / 16.0 + p.y() / 32.0); };
  const GroundPlan plan(wish, detail, plane, 1e6);
  GroundMesh ground(plan);
  if (!fill_ground(ground, plane)) return {std::numeric_limits<double>::infinity(), 1.0};
  SceneParts parts = made::nothing();
  add_ground(ground, "asphalt", parts);
  const auto scene = made::scene_of(std::move(parts));
  StressFigure out{0.0, 16.0 * kEpsilon * extent_m * 3.0 / 64.0};
  for (int i = 0; i <= 128; ++i)
    for (int j = 0; j <= 128; ++j) {
      const double x = extent_m * (i / 128.0 - 0.5) * 0.999, y = extent_m * (j / 128.0 - 0.5) * 0.999;
      const auto found = scene->ground(x, y);
      take_worst(out,
                 found ? std::abs(found->height_m - (x / 16.0 + y / 32.0)) : std::numeric_limits<double>::quiet_NaN());
    }
  return out;
}

/// The cells of a plan over ground with a bump of `rise_m` and nothing near it, or a house: they are as many as it
/// says, lie side by side without overlap, none of them wholly beyond the rectangle, cover every square of it, and
/// differ from whom they touch by two at most. A figure counts.
StressFigure cells_fit(double rise_m) {
  GroundDetail detail;
  detail.add({-700.0, -600.0}, {-690.0, -590.0});
  GroundWish wish;
  wish.low = {-1000.0, -900.0}, wish.high = {1003.0, 1100.0};
  const GroundHeight bump = [=](const Eigen::Vector2d& p) {
    return std::optional(rise_m * std::exp(-(p - Eigen::Vector2d(500.0, 400.0)).squaredNorm() / 900.0));
  };
  const GroundPlan plan(wish, detail, bump, 1e6);
  const std::vector<GroundPlan::Cell> cells = plan.list();
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> size_at;
  int wrong = plan.cells() == static_cast<double>(cells.size()) ? 0 : 1;
  for (const GroundPlan::Cell& cell : cells) {
    wrong += plan.x(cell.column) < wish.high.x() && plan.y(cell.row) < wish.high.y() ? 0 : 1;
    for (std::int32_t i = 0; i < cell.size; ++i)
      for (std::int32_t j = 0; j < cell.size; ++j)
        wrong += size_at.emplace(std::pair{cell.column + i, cell.row + j}, cell.size).second ? 0 : 1;
  }
  const std::int32_t columns = static_cast<std::int32_t>(std::ceil(2003.0 / wish.cell_m)),
                     rows = static_cast<std::int32_t>(std::ceil(2000.0 / wish.cell_m));
  for (std::int32_t column = 0; column < columns; ++column)
    for (std::int32_t row = 0; row < rows; ++row) {
      const auto here = size_at.find({column, row});
      if (here == size_at.end()) {
        ++wrong;
        continue;
      }
      for (const auto& beside : {std::pair{column + 1, row}, {column, row + 1}}) {
        const auto there = size_at.find(beside);
        if (there == size_at.end()) continue;
        wrong += here->second <= 2 * there->second && there->second <= 2 * here->second ? 0 : 1;
      }
    }
  return {1.0 * wrong, 0.0};
}

/// Heights known at one place, or nowhere: the one height everywhere, or told to be unknown. A figure counts.
StressFigure hardly_known() {
  StressFigure out;
  GroundWish wish;
  wish.low = {-200.0, -200.0}, wish.high = {200.0, 200.0};
  const GroundPlan plan(wish, GroundDetail{}, {}, 1e6);
  GroundMesh ground(plan);
  const Eigen::Vector2d known = ground.places.at(ground.places.size() / 2);
  out.figure +=
      fill_ground(ground, [&](const Eigen::Vector2d& p) { return p == known ? std::optional(5.5) : std::nullopt; })
          ? 0.0
          : 1.0;
  for (const double h : ground.height_m) out.figure += h == 5.5 ? 0.0 : 1.0;
  GroundMesh unknown(plan);
  out.figure += fill_ground(unknown, [](const Eigen::Vector2d&) { return std::optional<double>{}; }) ? 1.0 : 0.0;
  out.figure += GroundFit({})({3.0, 4.0}) == 0.0 ? 0.0 : 1.0;
  return out;
}

/// The smooth surface through scattered heights does not know where the origin is: moved by `offset_m`, it moves along.
/// Places round by eps / 2 of the offset, of which slopes below 1 make no more.
StressFigure moved_fit(double offset_m) {
  std::vector<Eigen::Vector3d> here, there;
  for (int k = 0; k < 400; ++k) {
    const double x = 300.0 * std::sin(1.0 * k), y = 300.0 * std::sin(1.7 * k + 0.4),
                 z = 3.0 + x / 16.0 + std::sin(0.9 * k);
    here.emplace_back(x, y, z), there.emplace_back(offset_m + x, y, z);
  }
  const GroundFit at_home(here), away(there);
  StressFigure out{0.0, 0.5 * kEpsilon * offset_m};
  for (int k = 0; k < 200; ++k) {
    const double x = std::round(250.0 * std::sin(2.1 * k)), y = 250.0 * std::sin(0.7 * k);
    take_worst(out, std::abs(away({offset_m + x, y}) - at_home({x, y})));
  }
  return out;
}

/// Through heights that are all one it is that one, to the bit, near and 1e7 m away, of 400, of seven, of one.
StressFigure level_fit() {
  StressFigure out;
  for (const int n : {1, 7, 400}) {
    std::vector<Eigen::Vector3d> heights;
    for (int k = 0; k < n; ++k) heights.emplace_back(1e6 + 300.0 * std::sin(k), 300.0 * std::cos(1.7 * k), 5.5);
    const GroundFit fit(heights);
    for (const double x : {1e6, 1e6 + 290.0, 0.0, -1e7}) take_worst(out, std::abs(fit({x, 3.0}) - 5.5));
  }
  return out;
}

}  // namespace

std::vector<StressCase> ground_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "bilinear heights up to the last sample",
           "the cell after the last, indices from a rounded quotient",
           "a bilinear form is met everywhere: 16 eps of heights", "m"});
  rows.add("grounds/bilinear_at_the_origin", [] { return bilinear(0.0, 0.0); }).add("grounds/bilinear_at_utm", [] {
    return bilinear(500000.0, 5600000.0);
  });
  rows.of({StressGroup::kData, "a grid's holes and borders, of one row, of steps of 0",
           "NaN that is taken for a height, a division by the step",
           "no height beside it or in a hole, the samples' own elsewhere", "wrong"});
  rows.add("grounds/borders_and_holes", borders_and_holes);
  rows.of({StressGroup::kGeometry, "terrain as a function and as triangles",
           "the other diagonal; a border's cell off by one", "the same height to the corners' single precision", "m"});
  struct Cell {
    double cell, hill, slope;
    const char* name;
  };
  for (const Cell& c :
       {Cell{4.0, 6.0, 3.0, "usual"}, Cell{5.3, 6.0, 3.0, "of_broken_cells"}, Cell{32.0, 60.0, 8.0, "steep_and_coarse"},
        Cell{1024.0, 6.0, 3.0, "one_cell"}, Cell{5000.0, 6.0, 3.0, "larger_than_all"}, Cell{3.0, 0.0, 0.0, "level"}})
    rows.add(std::string("grounds/terrain_") + c.name, [c] { return city_terrain(c.cell, c.hill, c.slope); });
  rows.of({StressGroup::kGeometry, "the ground under a point, from small to very large triangles",
           "a height by a ray in single precision; ground of places that are none",
           "the slope's height to 8 eps, none beyond its border", "m"});
  for (const double half : {1.0, 1024.0, 1e5, 1e7}) {
    rows.add(printed("grounds/slope_of_%.0e_m", half), [half] { return ground_of_slope(half); });
  }
  rows.of({StressGroup::kGeometry, "ground of cells of many sizes", "cracks where small cells touch large ones",
           "ground everywhere; a plane's height to 16 eps", "m"});
  rows.add("grounds/without_cracks_1_km", [] { return ground_without_cracks(5.0, 1000.0); })
      .add("grounds/without_cracks_60_km", [] { return ground_without_cracks(40.0, 60000.0); });
  rows.of({StressGroup::kGeometry, "cells of a ground that is hardly level",
           "a cell that is counted or left out twice, or ends beside four",
           "side by side without overlap, as many as is said, of at most twice their neighbours' size", "wrong"});
  for (const double rise_m : {0.0, 3.0, 30.0, 1000.0})
    rows.add("grounds/cells_around_a_bump_of_" + stress::text(rise_m) + "_m", [rise_m] { return cells_fit(rise_m); });
  rows.of({StressGroup::kData, "ground whose height is hardly known", "means of nothing",
           "the one height everywhere, or unknown", "wrong"});
  rows.add("grounds/known_at_one_place", hardly_known);
  rows.of({StressGroup::kStiff, "a surface through scattered heights, far from the origin",
           "sums of squares of coordinates of 1e6 m: no digit is left of their differences",
           "moved with its heights to eps / 2 of the way; level heights to the bit", "m"});
  rows.add("grounds/fit_moved_by_1e6_m", [] { return moved_fit(1e6); })
      .add("grounds/fit_moved_by_1e9_m", [] { return moved_fit(1e9); })
      .add("grounds/fit_of_level_heights", level_fit);
  return rows.take();
}

}  // namespace canyon::scene
