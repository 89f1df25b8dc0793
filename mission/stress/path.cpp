#include "canyon/mission/autonomy/path.h"

#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/mission/autonomy/local_grid.h"
#include "canyon/mission/stress/subjects.h"

namespace canyon::mission {
namespace {

using Eigen::Vector2d;

/// How many of a path's answers are no numbers, or not on it: everywhere along it and beyond its ends.
int broken(const Path& path, double spacing_m) {
  int wrong = 0;
  for (double s = -10.0; s <= path.length_m() + 10.0; s += 0.37) {
    const Vector2d p = path.at(s), d = path.direction(s);
    const double k = path.curvature(s);
    wrong += p.allFinite() && d.allFinite() && std::isfinite(k) && std::abs(d.norm() - 1.0) < 1e-12 ? 0 : 1;
    const double found = path.project(p, 0.0, path.length_m());
    wrong += (path.at(found) - p).norm() <= spacing_m ? 0 : 1;
    wrong += std::isfinite(path.offset(p + Vector2d(1.0, 1.0), s)) ? 0 : 1;
  }
  return wrong;
}

/// Points that repeat, legs of a millimetre, a way that turns on the spot, a spike, and one that stays on a line.
StressFigure degenerate_ways() {
  constexpr double kSpacing_m = 0.25;
  const std::vector<std::vector<Vector2d>> ways = {
      {{0, 0}, {0, 0}, {10, 0}, {10, 0}, {10, 10}}, {{0, 0}, {10, 0}, {0, 0}},
      {{0, 0}, {20, 0}, {20, 1e-9}, {0, 1e-9}},     {{0, 0}, {0.0011, 0}, {0.0022, 0.0011}, {5, 5}},
      {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 1e-12}}, {{0, 0}, {30, 0}, {30.002, 0.002}, {0, 30}},
      {{0, 0}, {10, 0}, {1e-3, 1e-6}, {10, 2e-6}},
  };
  int wrong = 0;
  for (const auto& way : ways)
    for (const double radius_m : {0.0, 1e-9, 5.0, 1e6}) {
      const Path path(way, radius_m, kSpacing_m);
      wrong += path.empty() ? 1 : broken(path, kSpacing_m);
    }
  wrong += Path({}, 5.0).empty() && Path({{1, 1}}, 5.0).empty() && Path({{1, 1}, {1, 1}}, 5.0).empty() ? 0 : 1;
  wrong += stress::not_refused([] { Path({{0, 0}, {1, 0}}, 5.0, 0.0); });
  return {1.0 * wrong, 0.0};
}

/// A round of 40 m at 10^5 m from W's origin is the one at the origin: lengths to a rounding of the place for each of
/// the points.
StressFigure far_way() {
  const std::vector<Vector2d> way = {{0, 0}, {40, 0}, {40, 40}, {0, 40}, {0, 1}};
  std::vector<Vector2d> far = way;
  for (Vector2d& p : far) p += Vector2d(1e5, -1e5);
  const Path near_path(way, 6.0), far_path(far, 6.0);
  const double each = 4.0 * stress::kEpsilon * 1.5e5;
  stress::Worst worst;
  worst.look(near_path.length_m() - far_path.length_m(), each * static_cast<double>(near_path.points().size()));
  for (double s = 0.0; s < near_path.length_m(); s += 0.9)
    worst.look((far_path.at(s) - near_path.at(s) - Vector2d(1e5, -1e5)).norm(),
               each * static_cast<double>(near_path.points().size()));
  return worst.figure();
}

/// The same wall before the vehicle, at W's origin and 10^5 m off: the same obstacles at the same distances. Cells are
/// whole numbers of them from W's origin, so that the shift is one of them too.
StressFigure far_grid(double off_m) {
  const auto grid_at = [](double x_m) {
    LocalGrid grid({});
    std::vector<Eigen::Vector3f> wall;
    for (float y = -5.0F; y <= 5.0F; y += 0.05F)
      for (float z = 0.1F; z <= 2.0F; z += 0.3F) wall.emplace_back(8.1F, y, z);
    const Pose here{Eigen::Quaterniond::Identity(), {x_m, -x_m, 0.0}};
    grid.add(wall, here, here, 1.0);
    grid.update_distances();
    return grid;
  };
  const LocalGrid here = grid_at(0.0), far = grid_at(off_m);
  int wrong = here.obstacles() == far.obstacles() && here.obstacles() > 30 ? 0 : 1;
  for (double x = -24.9; x < 24.9; x += 0.5)
    for (double y = -24.9; y < 24.9; y += 0.5)
      wrong += here.distance_m({x, y}) == far.distance_m({x + off_m, y - off_m}) ? 0 : 1;
  for (const double beyond : {1e6, -1e9, 1e15}) wrong += here.distance_m({beyond, 0.0}) == LocalGrid::kFar ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

/// Steps of 1 m in some cells of a grid, in others ones that a wheel climbs, too few points, or points too high and too
/// low: the distances from the first alone, of all cells from middle to middle of the nearest, by trying all; single
/// precision of 10 m. What has not been seen for the memory is forgotten, not before half of it.
StressFigure all_distances() {
  LocalGridConfig config;
  config.half_size_m = 8.0;
  LocalGrid grid(config);
  std::vector<Vector2d> places;
  std::vector<Eigen::Vector3f> points;
  const auto add = [&](double x, double y, int hits, double low_m, double high_m) {
    for (int k = 0; k < hits; ++k)
      points.emplace_back(static_cast<float>(x), static_cast<float>(y),
                          static_cast<float>(k % 2 == 0 ? low_m : high_m));
  };
  for (int k = 0; k < 12; ++k) {
    const Vector2d cell(std::floor(28.0 * std::sin(1.7 * k)), std::floor(28.0 * std::cos(2.9 * k)));
    places.push_back(0.25 * (cell + Vector2d(0.5, 0.5)));
    add(places.back().x(), places.back().y(), 4, 0.0, 1.0);
  }
  add(0.625, 0.625, 8, 0.0, 0.39), add(-1.375, 0.625, 2, 0.0, 1.0), add(0.625, -1.375, 8, 2.3, 3.0),
      add(2.1, 2.1, 8, -4.0, -2.6);
  const Pose X_WL{Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero()};
  grid.add(points, X_WL, X_WL, 100.0);
  grid.update_distances();
  stress::Worst worst;
  worst.look(static_cast<double>(grid.obstacles()) - 12.0, 1e-9);
  for (int i = -31; i < 31; ++i)
    for (int j = -31; j < 31; ++j) {
      const Vector2d middle = 0.25 * Vector2d(i + 0.5, j + 0.5);
      double nearest = LocalGrid::kFar;
      for (const Vector2d& place : places) nearest = std::min(nearest, (place - middle).norm());
      worst.look(grid.distance_m(middle) - nearest, 8.0 * stress::kHalfUlp * 10.0);
    }
  grid.add({}, X_WL, X_WL, 100.0 + 0.45 * config.memory_s);
  grid.update_distances();
  worst.look(static_cast<double>(grid.obstacles()) - 12.0, 1e-9);
  grid.add({}, X_WL, X_WL, 100.0 + 1.1 * config.memory_s);
  grid.update_distances();
  worst.look(static_cast<double>(grid.obstacles()), 1e-9);
  return worst.figure();
}

/// Four right angles rounded by arcs of radius r: shorter than the corners by (4 - pi) r in all, but for chords of the
/// spacing h, h^2 / (24 r^2) of the arcs; on an arc the curvature is 1 / r with its sign, beside the way a metre is a
/// metre; and mirrored or driven backwards it is as long.
StressFigure rounded(double radius_m) {
  std::vector<Vector2d> way = {{0, 0}, {60, 0}, {60, 50}, {120, 50}, {120, 0}};
  const Path path(way, radius_m);
  const double corners_m = 60.0 + 50.0 + 60.0 + 50.0, h = 0.25, arc = 1.5 * kPi * radius_m;
  const double exact_m = corners_m - 6.0 * radius_m + arc, chords = arc * h * h / (24.0 * radius_m * radius_m);
  stress::Worst worst;
  worst.look(path.length_m() - exact_m, 2.0 * chords + 1e-9);
  std::vector<Vector2d> mirrored = way, reversed(way.rbegin(), way.rend());
  for (Vector2d& p : mirrored) p.y() = -p.y();
  const Path left(mirrored, radius_m), back(reversed, radius_m);
  worst.look(left.length_m() - path.length_m(), 1e-9);
  worst.look(back.length_m() - path.length_m(), 2.0 * chords + 1e-9);
  // The middle of the first arc: a left turn; of the second a right one.
  const double first_m = 60.0 - radius_m + 0.25 * kPi * radius_m;
  const double second_m = 60.0 + 50.0 - 3.0 * radius_m + 0.75 * kPi * radius_m;
  worst.look(path.curvature(first_m) * radius_m - 1.0, 0.5 * h / radius_m);
  worst.look(path.curvature(second_m) * radius_m + 1.0, 0.5 * h / radius_m);
  worst.look(left.curvature(first_m) * radius_m + 1.0, 0.5 * h / radius_m);
  worst.look(path.curvature(20.0), 1e-9);
  const Vector2d beside = path.at(30.0) + Vector2d(0.0, 1.0);
  worst.look(path.offset(beside, 30.0) - 1.0, 1e-9);
  worst.look(left.offset(beside, 30.0) - 1.0, 1e-9);
  worst.look(path.project(beside, 0.0, path.length_m()) - 30.0, 1e-6);
  // Driven at v with stops at both ends: the length over v, half of v over a at either end more, and in the corners the
  // speed sqrt(a_lateral r), reached and left evenly.
  const double v = 4.0, a = 2.0, lateral = 100.0;
  const double time_s = nominal_drive_time_s(path, {v, lateral, a, a}, {0.0, path.length_m()});
  worst.look(time_s - (exact_m / v + v / a), 2.0 * h / v + 0.1 * std::sqrt(h / a));
  return worst.figure();
}

}  // namespace

std::vector<StressCase> path_cases() {
  const auto group = StressGroup::kGeometry;
  const StressMechanism degenerate{group, "legs without length and corners of half a turn",
                                   "a direction of 0 / 0, and the tangent of 90 degrees",
                                   "each answer along it is a number, and on the path", "answers"};
  StressMechanism far{group, "a way far from the origin", "arc lengths in single precision",
                      "the way at the origin, to roundings of its place", "of the bound"};
  far.loose = "the bound adds the roundings of all points, which cancel from leg to leg";
  const StressMechanism grid{group, "a rolling grid far from its origin",
                             "cell numbers in single precision, or a remainder that is negative",
                             "the same obstacles, the same distances to the bit", "cells"};
  const StressMechanism nearest{group, "distances of a grid's cells to the nearest obstacle",
                                "parabolas of a row that hide one another, a step that a wheel climbs",
                                "as trying all finds them, to single precision; forgotten after the memory",
                                "of the bound"};
  const StressMechanism corners{
      group, "rounded corners of a way", "an arc of the other hand, a tangent that is not met",
      "its length, curvature, offset and time in closed form, to chords of the spacing", "of the bound"};
  StressRows rows;
  rows.of(nearest).add("path/grid_distances", all_distances);
  for (const double radius_m : {2.0})
    rows.of(corners).add("path/corners_of_" + stress::text(radius_m) + "_m", [radius_m] { return rounded(radius_m); });
  rows.of(degenerate).add("path/degenerate_ways", degenerate_ways);
  rows.of(far).add("path/100_km_off", far_way);
  rows.of(grid).add("path/local_grid_64_km_off", [] { return far_grid(65536.0); });
  rows.of(grid).add("path/local_grid_64_km_off_to_the_west", [] { return far_grid(-65536.0); });
  return rows.take();
}

}  // namespace canyon::mission
