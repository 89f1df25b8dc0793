// Brightness and windows as the LIDAR meets them: from any side, on any pass, with either beam.
#include <cmath>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/core/process/parallel.h"
#include "canyon/lidar/beam/surfaces.h"
#include "canyon/scene/tracing/instances.h"
#include "canyon/tests/lidar/beam/screens.h"

namespace canyon::lidar {
namespace {

using testing::kStart;
using testing::same;

constexpr TextureConfig kBoth{Brightness::kVaried, Windows::kLattice};

std::uint16_t index_of(const scene::Scene& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.materials().size(); ++i)
    if (scene.materials()[i].name == name) return static_cast<std::uint16_t>(i);
  throw std::runtime_error("no material " + name);
}

/// Houses, a garden wall and ground.
scene::SceneParts street() {
  scene::SceneParts parts = testing::street_crossing();
  testing::add_wall(parts, {-6, 20}, {-6, 2}, 8.0, "brick");  // no building's: no windows
  return parts;
}

/// What a ray from `from` towards `towards` meets.
Echo seen(const scene::SceneAt& at, const Surfaces& surfaces, const Eigen::Vector3d& from,
          const Eigen::Vector3d& towards) {
  const Eigen::Vector3d origin_W = at.packet_origin(from);
  scene::RayPacket rays{};
  const Eigen::Vector3f d = (towards - from).normalized().cast<float>();
  const Eigen::Vector3f o = (from - origin_W).cast<float>();
  for (std::size_t i = 0; i < 16; ++i) {
    rays.origin_x[i] = o.x(), rays.origin_y[i] = o.y(), rays.origin_z[i] = o.z();
    rays.direction_x[i] = d.x(), rays.direction_y[i] = d.y(), rays.direction_z[i] = d.z();
    rays.max_m[i] = i == 3 ? 500.0f : -1.0f;
  }
  std::vector<scene::HitPacket> hits(1);
  at.trace(std::span(&rays, 1), hits, origin_W);
  const Echo one = surfaces.echo(rays, hits[0], 3, origin_W);
  EchoPacket many;
  surfaces.echoes(rays, hits[0], origin_W, many);
  float alone[16];
  surfaces.reflectivities(rays, hits[0], origin_W, alone);
  EXPECT_EQ(many.reflectivity[3], one.reflectivity) << "of a packet as of one ray, to the bit";
  EXPECT_EQ(alone[3], one.reflectivity);
  EXPECT_EQ(many.truth[3].material, one.truth.material);
  return one;
}

/// A place on a wall is as bright from one side as from another. Where rays meet it is known to their single precision,
/// 40 m 2^-22, times the noise's slope, 2 widest sqrt(3) / grain.
TEST(TexturedScan, APlaceIsAsBrightFromEverySide) {
  const scene::Scene scene(street());
  const scene::SceneAt at(scene);
  const Surfaces varied(at, 905.0, MattReflection::kLambertian, {Brightness::kVaried, Windows::kNone});
  const double mean = scene.materials()[index_of(scene, "brick")].lidar_reflectance;
  const double slope_1_m = 2.0 * scene.materials()[index_of(scene, "brick")].widest() * std::sqrt(3.0) / 0.25;
  double least = 9.0, most = 0.0;
  for (int k = 0; k < 400; ++k) {
    const Eigen::Vector3d place(7.0, 9.0 + 0.1 * k, 3.0 + 0.01 * k);  // on the house in the north-east
    std::vector<double> reflectances;
    for (const Eigen::Vector3d& from : {Eigen::Vector3d(0, 10, 2), Eigen::Vector3d(1.5, 30, 7)}) {
      const Echo echo = seen(at, varied, from, place);
      ASSERT_NEAR(echo.truth.range_m, (place - from).norm(), 1e-4) << "nothing stands in between";
      reflectances.push_back(echo.reflectivity / echo.truth.cos_incidence);
    }
    EXPECT_NEAR(reflectances[0], reflectances[1], mean * (slope_1_m * 40.0 * 0x1p-22 + 4.0 * 0x1p-24)) << k;
    least = std::min(least, reflectances[0] / mean), most = std::max(most, reflectances[0] / mean);
  }
  EXPECT_LT(least, 0.75);
  EXPECT_GT(most, 1.25);
}

TEST(TexturedScan, SamePassAnyPassAnyThreads) {
  const scene::Scene scene(street());
  const scene::SceneAt at(scene);
  for (const char* model : {"single_ray", "footprint"}) {
    LidarConfig config = testing::ideal_lidar();
    config.model.name = model;
    config.texture = kBoth;
    const auto scan = [&](int threads, std::int64_t index) {
      set_threads(threads);
      return (*make_scanner(config, 1))->scan(index, kStart, testing::standing(testing::pose_at(0, 0, 1.8, 20)), at);
    };
    const LidarOutput one = scan(1, 0);
    EXPECT_TRUE(same(one, scan(2, 0))) << model;
    EXPECT_TRUE(same(one, scan(8, 0))) << model;
    EXPECT_TRUE(same(one, scan(1, 5))) << model << ": an ideal sensor that stands sees the same on every pass";
    set_threads(0);
  }
}

/// Nothing but intensity and material depend on it.
TEST(TexturedScan, WithoutItNothingChangesAndWithItNoRangeDoes) {
  const scene::Scene scene(street());
  const scene::SceneAt at(scene);
  LidarConfig config = testing::ideal_lidar();
  const auto scan = [&] {
    return (*make_scanner(config, 1))->scan(0, kStart, testing::standing(testing::pose_at(0, 0, 1.8, 20)), at);
  };
  const LidarOutput plain = scan();
  testing::set_keys(config, "brightness = \"uniform\"\nwindows = \"none\"");
  EXPECT_TRUE(same(plain, scan()));
  for (std::size_t i = 0; i < plain.truth.size(); ++i) {
    const scene::Material& m = scene.materials()[plain.truth[i].material];
    EXPECT_EQ(plain.scan.points[i].intensity, static_cast<float>(m.lidar_reflectance) * plain.truth[i].cos_incidence);
  }
  config.texture = kBoth;
  const LidarOutput textured = scan();
  ASSERT_EQ(textured.truth.size(), plain.truth.size());
  std::size_t glass = 0;
  for (std::size_t i = 0; i < plain.truth.size(); ++i) {
    EXPECT_EQ(textured.truth[i].range_m, plain.truth[i].range_m);
    EXPECT_EQ(textured.truth[i].object, plain.truth[i].object);
    glass += textured.truth[i].material != plain.truth[i].material ? 1 : 0;
  }
  EXPECT_GT(glass, 100u);
}

/// A house of 12 x 9 m looked at: share of its wall that is glass, what glass sends back, and what has no windows.
TEST(TexturedScan, WindowsAreOfGlassAndOfBuildingsAlone) {
  scene::SceneParts parts = testing::empty_parts();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("house", scene::ObjectKind::kBuilding);
  mesh.box({16, 0, 4.5}, Eigen::Matrix3d::Identity(), {6, 6, 4.5}, mesh.material("concrete"));
  testing::add_wall(parts, {10, 20}, {10, 8}, 9.0);
  const scene::Scene scene(parts);
  const scene::SceneAt at(scene);
  const std::uint16_t glass = index_of(scene, "glass");
  const Surfaces surfaces(at, 905.0, MattReflection::kLambertian, {Brightness::kUniform, Windows::kLattice});
  const Surfaces plain(at, 905.0);
  constexpr int kRows = 90, kColumns = 120;  // of 0.1 m, whose middles no border of a pane comes near
  int panes = 0;
  for (int r = 0; r < kRows; ++r)
    for (int c = 0; c < kColumns; ++c) {
      const Eigen::Vector3d place(10.0, -6.0 + 0.1 * (c + 0.5) + 0.01, 0.1 * (r + 0.5) + 0.01);
      const Echo echo = seen(at, surfaces, place - Eigen::Vector3d(5, 1, 0.5), place);
      if (echo.truth.material == glass) ++panes;
      EXPECT_EQ(echo.reflectivity, surfaces.of_material(echo.truth.material, echo.truth.cos_incidence));
      EXPECT_EQ(seen(at, plain, place - Eigen::Vector3d(5, 1, 0.5), place).truth.material, index_of(scene, "concrete"));
    }
  EXPECT_EQ(panes, 4 * 3 * 15 * 15);
  EXPECT_EQ(seen(at, surfaces, {0, 14, 3}, {10, 13.5, 1.65}).truth.material, index_of(scene, "concrete"))
      << "a garden wall has no windows";
  EXPECT_EQ(seen(at, surfaces, {16, 0, 20}, {14.5, 1.65, 9}).truth.material, index_of(scene, "concrete"))
      << "nor has a roof";
}

/// Behind a window is what stands behind the wall, where light goes on behind glass.
TEST(TexturedScan, LightGoesOnBehindAWindowWhereItGoesOnBehindGlass) {
  scene::SceneParts parts = testing::empty_parts();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("house", scene::ObjectKind::kBuilding);
  mesh.quad({10, 6, 0}, {10, -6, 0}, {10, -6, 9}, {10, 6, 9}, mesh.material("concrete"));
  testing::add_screen(parts, 20.0, 30.0, "brick");
  LidarConfig config = testing::level_laser();
  config.report.returns = ReturnMode::kAll;
  config.texture.windows = Windows::kLattice;
  config.see_through = {.panes = true};
  const Pose at_a_window{Eigen::Quaterniond::Identity(), {0, 0, 1.65}};
  const LidarOutput out = testing::scan_of(parts, config, at_a_window);
  const scene::Scene scene(parts);
  std::map<std::string, int> met;
  bool behind = false;
  for (std::size_t i = 0; i < out.truth.size(); ++i) {
    if (std::abs(testing::yaw_deg(out.scan.points[i])) > 30.0) continue;
    const std::string& name = scene.materials()[out.truth[i].material].name;
    ++met[name];
    // The first echo of a shot is of the wall; one of the brick behind it follows a pane alone.
    if (out.scan.points[i].return_index == 1) {
      behind = true;
      EXPECT_EQ(name, "brick");
      EXPECT_EQ(scene.materials()[out.truth[i - 1].material].name, "glass");
    }
  }
  EXPECT_TRUE(behind);
  EXPECT_GT(met["concrete"], 0);
  EXPECT_EQ(met["glass"], met["brick"]) << "each pane is passed, nothing else";
}

/// What moves keeps one brightness: a brick car that stands varies no more than one that drives.
TEST(TexturedScan, WhatMovesIsUniform) {
  scene::SceneParts shape_parts = testing::empty_parts();
  scene::MeshBuilder mesh(shape_parts);
  mesh.begin_object("box", scene::ObjectKind::kVehicle);
  mesh.box({0, 0, 1}, Eigen::Matrix3d::Identity(), {2, 1, 1}, mesh.material("brick"));
  const auto shape = std::make_shared<const scene::RigidShape>("box", scene::ObjectKind::kVehicle, shape_parts.mesh);
  const scene::Scene scene(testing::empty_parts());
  scene::SceneAt at(scene);
  at.set_instances({{shape, "box", {Eigen::Quaterniond::Identity(), {12, 0, 0}}}});
  LidarConfig config = testing::ideal_lidar();
  config.texture = kBoth;
  const LidarOutput out =
      (*make_scanner(config, 1))->scan(0, kStart, testing::standing({Eigen::Quaterniond::Identity(), {0, 0, 1}}), at);
  ASSERT_GT(out.truth.size(), 50u);
  for (std::size_t i = 0; i < out.truth.size(); ++i)
    EXPECT_EQ(out.scan.points[i].intensity, 0.25f * out.truth[i].cos_incidence);
}

}  // namespace
}  // namespace canyon::lidar
