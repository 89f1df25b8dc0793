// Buildings on a slope: their shells reach into the ground and are closed there.
#include "canyon/scene/importers/solid_bottom.h"

#include <algorithm>

#include "canyon/scene/inspect.h"
#include "canyon/tests/scene/importers/import_fixture.h"

namespace canyon::scene::testing {
namespace {

/// Ground that rises 3 m over 60 m to the east, and a building of the given surfaces from x = 20 to 40 and y = 20 to
/// 40, z = 1.5 to 7.5: half a metre above the ground at its west. A yard, for those that use it, from 26 to 34.
std::string on_a_slope(const std::string& surfaces, const std::string& semantics) {
  return R"({"type":"CityJSON","version":"2.0","transform":{"scale":[0.1,0.1,0.1],"translate":[0,0,0]},"CityObjects":{
"land":{"type":"TINRelief","geometry":[{"type":"CompositeSurface","lod":1,"boundaries":[[[16,17,18]],[[16,18,19]]]}]},
"house":{"type":"Building","geometry":[{"type":"MultiSurface","lod":"2.0","boundaries":[)" +
         surfaces + "]" + semantics + R"(}]}},"vertices":[
[200,200,15],[400,200,15],[400,400,15],[200,400,15],[200,200,75],[400,200,75],[400,400,75],[200,400,75],
[260,260,15],[340,260,15],[340,340,15],[260,340,15],[260,260,75],[340,260,75],[340,340,75],[260,340,75],
[0,0,0],[600,0,30],[600,600,30],[0,600,0]]})";
}

constexpr const char* kWalls = "[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]";
constexpr const char* kYardWalls = "[[8,12,13,9]],[[9,13,14,10]],[[10,14,15,11]],[[11,15,12,8]]";

struct SolidBottomTest : Import {
  void expect_closed(const std::string& surfaces, const std::string& semantics, std::size_t yards) {
    const SceneParts made = parts("slope.city.json", on_a_slope(surfaces, semantics));
    ASSERT_EQ(made.buildings.size(), 1u);
    const Building& b = made.buildings[0];
    EXPECT_EQ(b.footprint_W.size(), 4u);
    EXPECT_EQ(b.courtyards_W.size(), yards);
    EXPECT_NEAR(b.height_m, 6.0, 1e-9);
    const Soundness sound = soundness(Scene(made));
    EXPECT_EQ(sound.objects, 1u);
    EXPECT_EQ(sound.watertight, 1u);
    EXPECT_EQ(sound.open_edges + sound.crowded_edges + sound.flipped_edges + sound.inside_out, 0u);
    // Walls to half a metre below the lowest ground around, which is that 5 cm before the western wall.
    const double depth_m = 1.0 - 0.05 * 0.05 - 0.5, wall_m = 7.5 - depth_m,
                 around_m = 4 * 20.0 + (yards > 0 ? 4 * 8.0 : 0.0);
    const double floor_m2 = yards > 0 ? 20 * 20 - 8 * 8 : 20 * 20;
    EXPECT_NEAR(area_m2(made, "concrete"), around_m * wall_m + floor_m2, 1e-3)
        << "walls and the floor; corners are rounded by 2e-6 m, sides sum to 112 m";
    float lowest_m = 1e9f;
    for (std::size_t i = 0; i < made.mesh.triangles.size(); ++i)
      if (made.objects[made.mesh.object[i]].kind == ObjectKind::kBuilding)
        for (const std::uint32_t v : made.mesh.triangles[i]) lowest_m = std::min(lowest_m, made.mesh.vertices[v].z());
    EXPECT_NEAR(lowest_m - b.base_m, depth_m - 1.5, 1e-6);
  }
};

TEST_F(SolidBottomTest, OfAClosedBuilding) {
  const std::string surfaces = std::string("[[3,2,1,0]],[[4,5,6,7]],") + kWalls;
  expect_closed(surfaces, "", 0);
  expect_closed(surfaces,
                R"(,"semantics":{"surfaces":[{"type":"GroundSurface"},{"type":"RoofSurface"},{"type":"WallSurface"}],)"
                R"("values":[0,1,2,2,2,2]})",
                0);
}

TEST_F(SolidBottomTest, OfOneThatIsOpenBelow) {
  expect_closed(std::string("[[4,5,6,7]],") + kWalls, "", 0);
}

TEST_F(SolidBottomTest, AroundAYard) {
  const std::string walls = std::string(kWalls) + "," + kYardWalls;
  expect_closed("[[4,5,6,7],[12,15,14,13]]," + walls, "", 1);
  expect_closed("[[4,5,6,7],[12,15,14,13]],[[3,2,1,0],[8,9,10,11]]," + walls, "", 1);
}

TEST_F(SolidBottomTest, AChimneyStaysOnItsRoof) {
  // A box open below on the flat roof, a part of its own: only the house is continued.
  const std::string house = std::string("[[4,5,6,7]],") + kWalls;
  const std::size_t alone = parts("slope.city.json", on_a_slope(house, "")).mesh.triangles.size();
  const std::string chimney = ",[[20,21,25,24]],[[21,22,26,25]],[[22,23,27,26]],[[23,20,24,27]]";
  std::string text = on_a_slope(house + chimney, "");
  text.replace(
      text.rfind("]]}"), 3,
      "],[250,250,75],[260,250,75],[260,260,75],[250,260,75],[250,250,90],[260,250,90],[260,260,90],[250,260,90]]}");
  EXPECT_EQ(parts("slope.city.json", text).mesh.triangles.size(), alone + 8);
}

/// Two triangles of a square about (x, 0), that look up or down.
std::vector<SolidFace> square(double x, double half, double z, bool down, std::uint32_t first) {
  const Eigen::Vector3d a(x - half, -half, z), b(x + half, -half, z), c(x + half, half, z), d(x - half, half, z);
  return down ? std::vector<SolidFace>{{{a, c, b}, first}, {{a, d, c}, first + 1}}
              : std::vector<SolidFace>{{{a, b, c}, first}, {{a, c, d}, first + 1}};
}
void join(std::vector<SolidFace>& faces, const std::vector<SolidFace>& more) {
  faces.insert(faces.end(), more.begin(), more.end());
}
/// What joins a square's corner to another's, so that both are of one part.
SolidFace brace(double x, double half, double z, double other_half, double other_z) {
  const Eigen::Vector3d a(x - half, -half, z), b(x - other_half, -other_half, other_z);
  return {{a, b, 0.5 * (a + b) + Eigen::Vector3d(0, 1, 0)}, 99};
}

TEST(SolidBottom, EavesAndPassagesAreNone) {
  // A foot on the ground, a ceiling at 4 m, a roof at 30 m.
  std::vector<SolidFace> faces = square(0, 2, 0, true, 0);
  join(faces, square(0, 4, 4, true, 2));
  join(faces, square(0, 4, 30, false, 4));
  faces.push_back(brace(0, 2, 0, 4, 4));
  faces.push_back(brace(0, 4, 4, 4, 30));
  const auto bottoms = bottoms_of(faces);
  ASSERT_EQ(bottoms.size(), 1u);
  EXPECT_EQ(bottoms[0].rings.size(), 1u);
  EXPECT_EQ(bottoms[0].triangles, (std::vector<std::uint32_t>{0, 1}));
}

TEST(SolidBottom, EveryPartHasItsOwn) {
  // Two houses of one object, one 80 m up the hill.
  std::vector<SolidFace> faces = square(0, 4, 0, true, 0);
  join(faces, square(0, 4, 8, false, 2));
  faces.push_back(brace(0, 4, 0, 4, 8));
  join(faces, square(50, 4, 80, true, 4));
  join(faces, square(50, 4, 90, false, 6));
  faces.push_back(brace(50, 4, 80, 4, 90));
  const auto bottoms = bottoms_of(faces);
  ASSERT_EQ(bottoms.size(), 2u);
  EXPECT_EQ(bottoms[0].triangles, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(bottoms[1].triangles, (std::vector<std::uint32_t>{4, 5}));
}

TEST(SolidBottom, AFloorLeavesTheYardOpen) {
  SolidBottom bottom;
  bottom.rings = {{{0, 0, 0}, {0, 10, 0}, {10, 10, 0}, {10, 0, 0}}, {{4, 4, 0}, {6, 4, 0}, {6, 6, 0}, {4, 6, 0}}};
  double twice_m2 = 0;
  for (const auto& t : floor_of(bottom)) {
    const Eigen::Vector2d ab = t[1] - t[0], ac = t[2] - t[0];
    const double part = ab.x() * ac.y() - ab.y() * ac.x();
    EXPECT_LE(part, 0.0) << "looks down";
    twice_m2 -= part;
  }
  EXPECT_DOUBLE_EQ(twice_m2, 2.0 * (100.0 - 4.0));
}

}  // namespace
}  // namespace canyon::scene::testing
