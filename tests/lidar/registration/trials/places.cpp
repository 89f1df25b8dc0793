#include "canyon/tests/lidar/registration/trials/places.h"

#include <cmath>
#include <string>

#include "canyon/core/units.h"
#include "canyon/tests/lidar/lidar_scenes.h"

namespace canyon::lidar::trials {
namespace {

using testing::add_box;
using testing::add_wall;

scene::SceneParts bare(double half_m) {
  static const auto materials = scene::builtin_materials();
  scene::SceneParts parts;
  parts.name = "trial";
  parts.materials = materials;
  testing::add_ground(parts, half_m);
  return parts;
}

/// Body and cabin, on the ground.
void add_car(scene::SceneParts& parts, double x, double y, double yaw_rad, double length_m) {
  const Eigen::Vector2d ahead(std::cos(yaw_rad), std::sin(yaw_rad));
  add_box(parts, {x, y, 0.6}, {0.5 * length_m, 0.9, 0.4}, yaw_rad);
  const Eigen::Vector2d cabin = Eigen::Vector2d(x, y) - 0.1 * length_m * ahead;
  add_box(parts, {cabin.x(), cabin.y(), 1.2}, {0.27 * length_m, 0.8, 0.25}, yaw_rad);
}

void add_parked_cars(scene::SceneParts& parts, Draws& draws, double y, double share) {
  for (double x = -70; x < 70; x += 6.5) {
    const double length_m = draws.uniform(3.8, 4.9), along_m = draws.uniform(0, 1), across_m = draws.normal(0.1),
                 yaw_rad = draws.normal(1.5 * kDegree);
    if (draws.uniform(0, 1) < share) add_car(parts, x + along_m, y + across_m, yaw_rad, length_m);
  }
}

/// Houses side by side, each with a setback, a height and a relief (bays, recessed doors) of its own.
void add_terrace(scene::SceneParts& parts, Draws& draws, double y, double side) {
  for (double x = -90; x < 90;) {
    const double width_m = draws.uniform(9, 16), height_m = draws.uniform(8, 16), back_m = draws.uniform(0, 0.6);
    const double front_m = y + side * back_m;
    add_box(parts, {x + 0.5 * width_m, front_m + side * 6, 0.5 * height_m}, {0.5 * width_m - 0.05, 6, 0.5 * height_m},
            0);
    const double bay_m = draws.uniform(0.8, 1.6), bay_x = x + draws.uniform(2, width_m - 2);
    add_box(parts, {bay_x, front_m, 4.5}, {bay_m, draws.uniform(0.25, 0.6), 2}, 0);
    for (double at = x + draws.uniform(0.8, 2); at < x + width_m - 0.8; at += draws.uniform(2.2, 3.4))
      add_box(parts, {at, front_m, 2.0}, {0.15, 0.12, 2.0}, 0);
    x += width_m;
  }
}

scene::SceneParts street(Draws& draws, bool) {
  auto parts = bare(120);
  for (const double side : {-1.0, 1.0}) {
    add_terrace(parts, draws, side * draws.uniform(7.5, 9.5), side);
    add_parked_cars(parts, draws, side * 4.6, 0.6);
    for (double x = -70; x < 70; x += 24) add_box(parts, {x + draws.uniform(0, 4), side * 6.3, 3}, {0.1, 0.1, 3}, 0);
  }
  return parts;
}

scene::SceneParts crossing(Draws& draws, bool) {
  auto parts = bare(120);
  for (const double sx : {-1.0, 1.0}) {
    for (const double sy : {-1.0, 1.0}) {
      const Eigen::Vector3d half(draws.uniform(20, 32), draws.uniform(20, 32), draws.uniform(4, 9));
      const double x = sx * (draws.uniform(6.5, 9) + half.x()), y = sy * (draws.uniform(6.5, 9) + half.y());
      add_box(parts, {x, y, half.z()}, half, draws.normal(1.0 * kDegree));
    }
  }
  for (int k = 0; k < 8; ++k) {
    const bool along_x = k % 2 == 0;
    const double at = draws.side() * draws.uniform(9, 40), beside = draws.side() * draws.uniform(4.2, 4.8);
    add_car(parts, along_x ? at : beside, along_x ? beside : at, (along_x ? 0 : 90) * kDegree + draws.normal(0.03),
            draws.uniform(3.8, 4.9));
  }
  return parts;
}

scene::SceneParts square(Draws& draws, bool) {
  auto parts = bare(120);
  const double x = draws.uniform(24, 34), y = draws.uniform(18, 28);
  for (const double side : {-1.0, 1.0}) {
    add_box(parts, {side * (x + 6), 0, 6}, {6, y - draws.uniform(0, 6), draws.uniform(5, 9)}, draws.normal(kDegree));
    add_box(parts, {draws.normal(3), side * (y + 6), 6}, {x - draws.uniform(0, 6), 6, draws.uniform(5, 9)},
            draws.normal(kDegree));
  }
  add_box(parts, {draws.uniform(-4, 4), draws.uniform(9, 12), 1.5}, {1.2, 1.2, 1.5}, draws.uniform(0, 1.5));
  for (int k = 0; k < 10; ++k)  // trunks
    add_box(parts, {draws.side() * draws.uniform(5, x - 2), draws.side() * draws.uniform(7, y - 2), 2.5},
            {0.2, 0.2, 2.5}, draws.uniform(0, 1.5));
  for (int k = 0; k < 3; ++k)  // stalls
    add_box(parts, {draws.uniform(-x + 4, x - 4), -draws.uniform(8, y - 2), 1.2}, {1.5, 1.0, 1.2}, draws.uniform(0, 3));
  return parts;
}

/// Two blank walls.
scene::SceneParts corridor(Draws& draws, bool) {
  auto parts = bare(300);
  const double height_m = draws.uniform(6, 12);
  for (const double side : {-1.0, 1.0}) {
    const double y = side * draws.uniform(4, 7);
    add_wall(parts, {-300, y}, {300, y}, height_m);
  }
  return parts;
}

/// A vault of flat strips, and a raised walkway.
scene::SceneParts tunnel(Draws& draws, bool) {
  auto parts = bare(300);
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("vault", scene::ObjectKind::kBuilding);
  constexpr int kStrips = 16;
  const double radius_m = draws.uniform(4.8, 6), rise_m = draws.uniform(1.0, 2.0);
  const auto rim = [&](int k, double x) {
    const double angle = kPi * k / kStrips;
    return Eigen::Vector3d(x, radius_m * std::cos(angle), rise_m + 0.8 * radius_m * std::sin(angle));
  };
  for (int k = 0; k < kStrips; ++k)
    mesh.quad(rim(k, -300), rim(k, 300), rim(k + 1, 300), rim(k + 1, -300), mesh.material("concrete"));
  for (const double side : {-1.0, 1.0}) add_wall(parts, {-300, side * radius_m}, {300, side * radius_m}, rise_m);
  add_box(parts, {0, radius_m - 0.4, 0.2}, {300, 0.5, 0.2}, 0);
  return parts;
}

/// Level ground and a few bushes and posts, some of them in reach.
scene::SceneParts field(Draws& draws, bool) {
  auto parts = bare(300);
  for (int k = 0; k < 5; ++k) {
    const double range_m = draws.uniform(15, 60), azimuth = draws.uniform(-kPi, kPi), half_m = draws.uniform(0.1, 0.5);
    add_box(parts, {range_m * std::cos(azimuth), range_m * std::sin(azimuth), 0.6}, {half_m, half_m, 0.6},
            draws.uniform(0, 1.5));
  }
  return parts;
}

constexpr double kPeriod_m = 6.0;
/// Two facades of pillars and recesses that repeat every 6 m as far as a sensor sees.
scene::SceneParts facades(Draws& draws, bool) {
  auto parts = bare(300);
  for (const double side : {-1.0, 1.0}) {
    const double y = side * draws.uniform(7, 10), depth_m = draws.uniform(0.3, 0.6), pillar_m = draws.uniform(0.3, 0.6);
    const double height_m = draws.uniform(8, 14);
    add_wall(parts, {-300, y}, {300, y}, height_m);
    for (double x = -252; x <= 252; x += kPeriod_m)
      add_box(parts, {x, y - side * 0.5 * depth_m, 0.5 * height_m}, {pillar_m, 0.5 * depth_m, 0.5 * height_m}, 0);
  }
  return parts;
}

/// The street with fewer parked cars and a column of traffic either way, every car some metres on.
scene::SceneParts moving_cars(Draws& draws, bool later) {
  auto parts = bare(120);
  for (const double side : {-1.0, 1.0}) {
    add_terrace(parts, draws, side * draws.uniform(9.5, 11), side);
    add_parked_cars(parts, draws, side * 7.2, 0.3);
    const double way_m = side * draws.uniform(1.5, 12);
    for (double x = -60; x < 60; x += draws.uniform(9, 15)) {
      const double length_m = draws.uniform(3.8, 4.9);
      if (std::abs(x) > 14) add_car(parts, x + (later ? way_m : 0.0), side * 3.6, 0, length_m);
    }
  }
  return parts;
}

constexpr Place kPlaces[] = {
    {"street", street, 15, 1.5, false, false, 0, false},
    {"crossing", crossing, 6, 1.5, false, false, 0, true},
    {"square", square, 6, 4, false, false, 0, false},
    {"corridor", corridor, 20, 1, true, false, 0, false},
    {"tunnel", tunnel, 20, 1, true, false, 0, true},
    {"field", field, 5, 5, true, true, 0, true},
    {"facades", facades, 20, 1.5, false, false, kPeriod_m, false},
    {"moving_cars", moving_cars, 8, 1, false, false, 0, true},
};

}  // namespace

std::span<const Place> places() {
  return kPlaces;
}

}  // namespace canyon::lidar::trials
