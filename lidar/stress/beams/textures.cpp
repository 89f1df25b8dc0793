// Brightness and windows at the ends of their numbers: far off, on the faces of cubes, on walls that are hardly any.
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/output/printed.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/lidar/beam/surfaces.h"
#include "canyon/lidar/beam/texture/value_noise.h"
#include "canyon/lidar/beam/texture/windows.h"
#include "canyon/lidar/stress/subjects.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/scene_at.h"

namespace canyon::lidar {
namespace {

using Eigen::Vector3d;
using stress::kHalfUlp;
using stress::Looks;

constexpr float kWidestNoise = 0.95f;

/// From W's origin to beyond all places, with fine and coarse grains: within the limits, and sixteen places are to the
/// bit what each is. A figure counts what is not.
StressFigure far_off() {
  StressFigure out;
  for (const float per_m : {0.01f, 2.0f, 100.0f})
    for (const double far_m : {0.0, -0.0, 1e-300, -1e-9, 1.0, -3e3, 1e7, -1e13, 1e18})
      for (int axis = 0; axis < 3; ++axis) {
        Places places;
        Grains grains;
        float factor[16];
        for (std::size_t i = 0; i < 16; ++i) {
          const auto step = static_cast<double>(i);
          places.x[i] = (axis == 0 ? far_m : 0.0) + 0.3 * step, places.y[i] = (axis == 1 ? far_m : 0.0) - 0.1 * step;
          places.z[i] = (axis == 2 ? far_m : 0.0) + 0.01 * step;
          grains.widest[i] = kWidestNoise, grains.per_m[i] = per_m,
          grains.key[i] = 0xffffff00u + static_cast<unsigned>(i);
        }
        vary(places, grains, factor);
        for (std::size_t i = 0; i < 16; ++i) {
          const float one = vary({places.x[i], places.y[i], places.z[i]}, kWidestNoise, per_m, grains.key[i]);
          out.figure += factor[i] >= 1.0f - kWidestNoise - 4.0f * 0x1p-24f &&
                                factor[i] <= 1.0f + kWidestNoise + 4.0f * 0x1p-24f && factor[i] == one
                            ? 0.0
                            : 1.0;
        }
      }
  return out;
}

/// Through faces, edges and corners of cubes there is no step: along lines in any direction, of which some begin at
/// W's origin, a corner, two places differ by no more than 2 widest sqrt(3) per_m times what they are apart. And what
/// is constant is none: on the way brightness comes within a fifth of both its limits.
StressFigure no_steps() {
  Looks looks;
  const RandomStream draw(1, "stress.textures");
  float least = 2.0f, most = 0.0f;
  for (std::uint64_t line = 0; line < 40; ++line) {
    const Vector3d d = draw.direction(0, line),
                   from = line < 20 ? Vector3d::Zero() : Vector3d(300.0 * draw.normal3(line));
    for (const double step_m : {1e-6, 1e-3, 0.02}) {
      float before = vary(from - 500.0 * step_m * d, kWidestNoise, 2.0f, 9);
      for (int k = -499; k <= 500; ++k) {
        const float now = vary(from + k * step_m * d, kWidestNoise, 2.0f, 9);
        looks.near(now, before, 2.0 * double{kWidestNoise} * std::sqrt(3.0) * 2.0 * step_m + 16.0 * kHalfUlp);
        least = now < least ? now : least, most = now > most ? now : most;
        before = now;
      }
    }
  }
  looks.right(least < 1.0f - 0.7f * kWidestNoise && most > 1.0f + 0.7f * kWidestNoise);
  return looks.figure();
}

/// Corners beside one another, and keys, have nothing in common: correlations of a hundred thousand corners' values
/// with their neighbours' in thirteen directions and with the next key's, 5 sigma (false alarms 6e-7 each, 14 looks).
/// The variance is a uniform distribution's, its mean none.
StressFigure corners_apart() {
  // Corners lie where the cubes' axes, turned against W, count whole numbers: W = R^T n.
  const Eigen::Quaterniond turn = Eigen::Quaterniond(1.0, std::sqrt(2.0), std::sqrt(3.0), std::sqrt(5.0)).normalized();
  const auto value_at = [&](double i, double j, double k, std::uint32_t key) {
    return double{vary(turn.conjugate() * Vector3d(i, j, k), 1.0f, 1.0f, key)} - 1.0;
  };
  constexpr int kSide = 46;
  constexpr double kCount = kSide * kSide * kSide;
  Looks looks;
  double sum = 0.0, squares = 0.0, next_key = 0.0;
  double products[14] = {};
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j)
      for (int k = 0; k < kSide; ++k) {
        const double here = value_at(i, j, k, 3);
        sum += here, squares += here * here, next_key += here * value_at(i, j, k, 4);
        for (int n = 14; n < 27; ++n)
          products[n - 14] += here * value_at(i + n / 9 - 1, j + n / 3 % 3 - 1, k + n % 3 - 1, 3);
      }
  constexpr double kThird = 1.0 / 3.0;
  looks.near(sum / kCount, 0.0, 5.0 * std::sqrt(kThird / kCount));
  looks.near(squares / kCount, kThird, 5.0 * std::sqrt((1.0 / 5.0 - 1.0 / 9.0) / kCount));
  looks.near(next_key / kCount, 0.0, 5.0 * kThird / std::sqrt(kCount));
  for (int n = 0; n < 13; ++n) looks.near(products[n] / kCount, 0.0, 5.0 * kThird / std::sqrt(kCount));
  return looks.figure();
}

/// A house of `bays` and `floors`, exactly as many, turned and `far_m` off: each of its walls has them, a pane in the
/// middle of each, none between two and none beside them. A figure counts.
StressFigure whole_bays(int bays, int floors, double yaw_rad, double far_m) {
  scene::SceneParts parts;
  parts.name = "house";
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("house", scene::ObjectKind::kBuilding);
  const Vector3d half(1.5 * bays, 1.5 * bays, 1.5 * floors), middle(far_m, -far_m, half.z());
  const Eigen::Matrix3d axes = rotation_from({.yaw_rad = yaw_rad}).toRotationMatrix();
  mesh.box(middle, axes, half, mesh.material("brick"));
  const scene::Scene scene(std::move(parts));
  const auto& walls = scene.facades().facades();
  StressFigure out;
  out.figure += walls.size() == 4 ? 0.0 : 1.0;
  for (const scene::Facade& wall : walls) {
    out.figure += wall.bays == bays && wall.first_floor == 0.0 && wall.end_floor == floors ? 0.0 : 1.0;
    const auto at = [&](double bay, double z) {
      const double along_m = wall.begin_m + (bay + 0.5) * (wall.end_m - wall.begin_m) / bays;
      return on_pane(wall, {along_m * wall.along_W.x(), along_m * wall.along_W.y(), wall.base_m + z});
    };
    for (int b = -1; b <= bays; ++b)
      for (int f = -1; f <= floors; ++f) {
        const bool own = b >= 0 && b < bays && f >= 0 && f < floors;
        out.figure += at(b, 3.0 * f + 1.65) == own ? 0.0 : 1.0;
        out.figure += at(b + 0.5, 3.0 * f + 1.65) || at(b, 3.0 * f + 0.45) || at(b, 3.0 * f + 2.7) ? 1.0 : 0.0;
      }
  }
  return out;
}

/// Walls that are hardly any: thinner than a bay, lower than a floor, of no width, below their building's ground, of a
/// height that is none. No pane anywhere, nothing that is not a number. A figure counts.
StressFigure hardly_walls() {
  const double none = std::numeric_limits<double>::quiet_NaN(), endless = std::numeric_limits<double>::infinity();
  StressFigure out;
  struct Wall {
    double width_m, bottom_m, top_m, base_m;
  };
  for (const Wall& w :
       {Wall{2.998, 0, 9, 0}, Wall{0.0, 0, 9, 0}, Wall{1e-300, 0, 9, 0}, Wall{9, 0, 2.998, 0}, Wall{9, 0, 0, 0},
        Wall{9, -9, 0, 0}, Wall{9, 1, 5, 0}, Wall{9, 0, 9, none}, Wall{none, 0, 9, 0}, Wall{9, 0, 9, endless}}) {
    scene::Facade wall;
    wall.along_W = {0.6, 0.8};
    wall.begin_m = 0.0, wall.end_m = w.width_m, wall.bottom_m = w.bottom_m, wall.top_m = w.top_m,
    wall.base_m = w.base_m;
    wall.divide();
    for (int k = 0; k < 400; ++k) {
      const double along_m = 0.05 * (k % 200), z = -9.0 + 0.07 * k;
      out.figure += on_pane(wall, {0.6 * along_m, 0.8 * along_m, z}) ? 1.0 : 0.0;
    }
  }
  return out;
}

/// Packets whose neighbours meet one wall after another, ground, nothing and what moves: each lane is to the bit what
/// its ray alone is, in all three ways of asking. A figure counts.
StressFigure lanes_apart(std::uint64_t seed) {
  const RandomStream draw(seed, "stress.textures");
  scene::SceneParts parts;
  parts.name = "row";
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("ground", scene::ObjectKind::kTerrain);
  mesh.quad({-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0}, mesh.material("asphalt"));
  const char* const kinds[] = {"brick", "concrete", "glass", "wood", "metal", "retro_sheeting"};
  for (int k = 0; k < 6; ++k) {
    mesh.begin_object("house " + std::to_string(k), scene::ObjectKind::kBuilding);
    mesh.box({12.0 + k % 2, 9.0 * (k - 2.5), 5.0}, Eigen::Matrix3d::Identity(), {3.0, 4.0, 5.0},
             mesh.material(kinds[k]));
  }
  const scene::Scene scene(std::move(parts));
  const scene::SceneAt at(scene);
  const Surfaces surfaces(at, 905.0, MattReflection::kRough, {Brightness::kVaried, Windows::kLattice});
  const Vector3d origin_W(0.5, -0.25, 2.0);
  StressFigure out;
  int panes = 0, missed = 0;
  for (std::uint64_t k = 0; k < 400; ++k) {
    scene::RayPacket rays{};
    scene::HitPacket hits{};
    for (std::uint32_t i = 0; i < 16; ++i) {
      const double azimuth = 1.4 * (draw.uniform(i, k, 0) - 0.5), elevation = 0.9 * (draw.uniform(i, k, 1) - 0.3);
      rays.direction_x[i] = static_cast<float>(std::cos(elevation) * std::cos(azimuth));
      rays.direction_y[i] = static_cast<float>(std::cos(elevation) * std::sin(azimuth));
      rays.direction_z[i] = static_cast<float>(std::sin(elevation));
      rays.max_m[i] = 100.0f;
    }
    at.trace(std::span(&rays, 1), std::span(&hits, 1), origin_W);
    EchoPacket many;
    float alone[EchoPacket::kShots];
    surfaces.echoes(rays, hits, origin_W, many);
    surfaces.reflectivities(rays, hits, origin_W, alone);
    for (std::size_t i = 0; i < EchoPacket::kShots; ++i) {
      const Echo one = surfaces.echo(rays, hits, i, origin_W);
      out.figure += many.reflectivity[i] == one.reflectivity && alone[i] == one.reflectivity &&
                            many.truth[i].material == one.truth.material && many.truth[i].object == one.truth.object &&
                            one.reflectivity >= 0.0f
                        ? 0.0
                        : 1.0;
      missed += one.any() ? 0 : 1;
      if (one.any()) panes += scene.materials()[one.truth.material].name == "glass" && one.truth.object != 3 ? 1 : 0;
    }
  }
  out.figure += panes > 200 && missed > 200 ? 0.0 : 1.0;
  return out;
}

}  // namespace

std::vector<StressCase> texture_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "brightness from W's origin to beyond all places",
           "a cube's number that no integer holds; a share of the way to the next beyond 0 and 1",
           "within its limits, sixteen as one: exact", "wrong"});
  rows.add("textures/brightness_far_off", far_off);
  rows.of({StressGroup::kGeometry, "brightness through faces, edges and corners of its cubes",
           "a place on a face counted to one cube and measured in the other: a step",
           "no more than the steepest slope times the way, and eight units", "of the bound"});
  rows.add("textures/no_steps", no_steps);
  rows.of({StressGroup::kData, "hashes of cubes beside one another",
           "indices that are added up: a row of corners repeats the next, and stripes are seen",
           "a uniform distribution's mean and variance, no correlation: 5 sigma of 97336", "of the bound"});
  rows.add("textures/corners_apart", corners_apart);
  rows.of({StressGroup::kGeometry, "walls of whole bays and floors, turned and far off",
           "a bay or floor lost to single precision of the corners; a pane beyond the wall's end",
           "as many as fit, a pane in each and none beside: exact", "wrong"});
  for (const double far_m : {0.0, 1e3, 1e4}) {
    rows.add(printed("textures/houses_%g_m_off", far_m), [far_m] { return whole_bays(4, 3, 0.0, far_m); });
    rows.add(printed("textures/turned_houses_%g_m_off", far_m), [far_m] { return whole_bays(7, 12, 0.7, far_m); });
  }
  rows.of({StressGroup::kGeometry, "walls that are hardly any", "bays over a width of none; floors from no height",
           "no pane: exact", "panes"});
  rows.add("textures/hardly_walls", hardly_walls);
  rows.of({StressGroup::kData, "packets whose neighbours meet different things",
           "the wall, the grain or the pane of the lane before", "each lane as its ray alone: exact", "lanes"});
  for (const std::uint64_t seed : {1, 2})
    rows.add(printed("textures/lanes_apart_%d", static_cast<int>(seed)), [seed] { return lanes_apart(seed); });
  return rows.take();
}

}  // namespace canyon::lidar
