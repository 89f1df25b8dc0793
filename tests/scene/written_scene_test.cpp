#include "canyon/scene/written_scene.h"

#include <gtest/gtest.h>

#include "canyon/scene/city/city.h"
#include "canyon/scene/import.h"
#include "canyon/scene/inspect.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/tests/support/outside_program.h"

namespace canyon::scene {
namespace {

TEST(WrittenScene, ReadsBackAsTheSameScene) {
  const canyon::testing::ScratchDirectory scratch;
  CityConfig config;
  config.extent_m = 300.0;
  config.seed = 7;
  const SceneParts city = make_city(config);
  ASSERT_TRUE(write_scene(city, scratch.file("")).ok());
  ImportConfig from;
  from.file = scratch.file("scene.json");
  const auto read = import_scene(from, {});
  ASSERT_TRUE(read.ok()) << read.error().str();
  const Scene before(city), after(read->parts);
  EXPECT_EQ(before.hash(), after.hash());
  ASSERT_EQ(read->parts.buildings.size(), city.buildings.size());
  for (std::size_t i = 0; i < city.buildings.size(); ++i) {
    EXPECT_EQ(read->parts.buildings[i].name, city.buildings[i].name);
    EXPECT_EQ(read->parts.buildings[i].footprint_W, city.buildings[i].footprint_W);
    EXPECT_EQ(read->parts.buildings[i].height_m, city.buildings[i].height_m);
  }
  EXPECT_EQ(read->parts.streets.nodes_W, city.streets.nodes_W);
  EXPECT_EQ(read->parts.streets.edges.size(), city.streets.edges.size());
  // As a plain OBJ the triangles are the same too.
  from.file = scratch.file("scene.obj");
  const auto plain = import_scene(from, {});
  ASSERT_TRUE(plain.ok()) << plain.error().str();
  EXPECT_EQ(plain->parts.mesh.vertices, city.mesh.vertices);
  EXPECT_EQ(plain->parts.mesh.triangles, city.mesh.triangles);
}

TEST(Inspect, TellsHolesFlippedAndRepeatedFaces) {
  const auto look = [](const auto& change) {
    SceneParts parts;
    parts.materials = builtin_materials();
    MeshBuilder mesh(parts);
    mesh.begin_object("box", ObjectKind::kBuilding);
    mesh.box({0, 0, 5}, Eigen::Matrix3d::Identity(), {1, 2, 3}, mesh.material("glass"));
    change(parts.mesh);
    return soundness(Scene(std::move(parts)));
  };
  const Soundness whole = look([](Mesh&) {});
  EXPECT_EQ(whole.objects, 1u);
  EXPECT_EQ(whole.watertight, 1u);
  EXPECT_EQ(whole.open_edges + whole.flipped_edges + whole.crowded_edges + whole.inside_out, 0u);
  const auto drop = [](Mesh& m) { m.triangles.pop_back(), m.material.pop_back(), m.object.pop_back(); };
  EXPECT_EQ(look(drop).open_edges, 3u);
  EXPECT_EQ(look(drop).watertight, 0u);
  EXPECT_EQ(look([](Mesh& m) { std::swap(m.triangles[0][0], m.triangles[0][1]); }).flipped_edges, 3u);
  EXPECT_EQ(look([](Mesh& m) {
              for (auto& t : m.triangles) std::swap(t[0], t[1]);
            }).inside_out,
            1u);
  const Soundness twice = look([](Mesh& m) {
    m.triangles.push_back(m.triangles[0]), m.material.push_back(m.material[0]), m.object.push_back(0);
  });
  EXPECT_EQ(twice.repeated_triangles, 1u);
  EXPECT_EQ(twice.crowded_edges, 3u);

  SceneParts parts;
  parts.materials = builtin_materials();
  MeshBuilder mesh(parts);
  mesh.begin_object("box", ObjectKind::kBuilding);
  mesh.box({0, 0, 5}, Eigen::Matrix3d::Identity(), {1, 2, 3}, mesh.material("glass"));
  const Scene scene(std::move(parts));
  const auto areas = material_areas(scene);
  ASSERT_EQ(areas.size(), 1u);
  EXPECT_EQ(areas[0].name, "glass");
  EXPECT_NEAR(areas[0].area_m2, 8.0 * (1 * 2 + 1 * 3 + 2 * 3), 1e-5);
  const SensorNeeds needs = sensor_needs(scene);
  EXPECT_EQ(needs.reflecting_facets, 6u);
  EXPECT_EQ(needs.edges, 12u);
  EXPECT_TRUE(needs.transparent);
  EXPECT_FALSE(needs.retro);
}

}  // namespace
}  // namespace canyon::scene
