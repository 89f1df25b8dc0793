// What propagation states of its need: where it says "not needed" the search finds nothing, and what is put in the way
// flips the verdict, wherever it is put.
#include "canyon/gnss/paths/need/path_question.h"

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/gnss/paths/propagation.h"
#include "canyon/gnss/sensor/sensor_need.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene_at.h"
#include "canyon/tests/gnss/paths/wall_scene.h"

namespace canyon::gnss::testing {
namespace {

constexpr int kPlacements = 20;
const GpsTime kStart = GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0);

/// Level ground of 400 x 400 m at z = 0, and what is put onto it.
class Field {
 public:
  Field() {
    parts_.name = "field";
    parts_.frame = LocalFrame({kVicksburgLat, kVicksburgLon, 60.0});
    parts_.materials = scene::builtin_materials();
    scene::MeshBuilder mesh(parts_);
    mesh.begin_object("ground", scene::ObjectKind::kTerrain);
    for (double x = -200; x < 200; x += 20)
      for (double y = -200; y < 200; y += 20)
        mesh.quad({x, y, 0}, {x + 20, y, 0}, {x + 20, y + 20, 0}, {x, y + 20, 0}, mesh.material("grass"));
  }
  /// A sheet of 4 x 4 m around q that faces n (unit, level).
  Field& mirror(const Eigen::Vector3d& q, const Eigen::Vector3d& n) {
    scene::MeshBuilder mesh(parts_);
    mesh.begin_object("mirror", scene::ObjectKind::kWall);
    const Eigen::Vector3d u = 2.0 * Eigen::Vector3d::UnitZ().cross(n), v(0, 0, 2);
    mesh.quad(q - u - v, q + u - v, q + u + v, q - u + v, mesh.material("metal"));
    return *this;
  }
  /// A fence of four walls, `distance_m` from the middle, whose upper border stands at that elevation seen from
  /// `height_m` over the middle of each wall's foot.
  Field& fence(double distance_m, double height_m) {
    scene::MeshBuilder mesh(parts_);
    mesh.begin_object("fence", scene::ObjectKind::kWall);
    const double d = distance_m, h = height_m;
    const auto concrete = mesh.material("concrete");
    mesh.quad({d, -d, 0}, {d, d, 0}, {d, d, h}, {d, -d, h}, concrete);
    mesh.quad({-d, d, 0}, {-d, -d, 0}, {-d, -d, h}, {-d, d, h}, concrete);
    mesh.quad({d, d, 0}, {-d, d, 0}, {-d, d, h}, {d, d, h}, concrete);
    mesh.quad({-d, -d, 0}, {d, -d, 0}, {d, -d, h}, {-d, -d, h}, concrete);
    return *this;
  }
  /// Upright, from foot to top; seen from where it goes from left to right it faces you.
  Field& wall(const Eigen::Vector3d& foot, const Eigen::Vector3d& top, const char* material) {
    scene::MeshBuilder mesh(parts_);
    mesh.begin_object("wall " + std::to_string(parts_.objects.size()), scene::ObjectKind::kWall);
    mesh.quad(foot, {top.x(), top.y(), foot.z()}, top, {foot.x(), foot.y(), top.z()}, mesh.material(material));
    return *this;
  }
  Field& box(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double height_m) {
    scene::MeshBuilder mesh(parts_);
    mesh.begin_object("house " + std::to_string(parts_.objects.size()), scene::ObjectKind::kBuilding);
    mesh.block(scene::rectangle(low.x(), low.y(), high.x(), high.y()), 0, height_m, mesh.material("concrete"),
               mesh.material("concrete"));
    return *this;
  }
  Field& crown(const Eigen::Vector3d& center, double radius_m) {
    parts_.foliage.push_back({center, Eigen::Vector3d::Constant(radius_m)});
    return *this;
  }
  std::unique_ptr<scene::Scene> build() const { return std::make_unique<scene::Scene>(parts_); }

 private:
  scene::SceneParts parts_;
};

RouteSegment corridor(const Eigen::Vector2d& middle) {
  RouteSegment segment;
  for (const double x : {-5.0, 0.0, 5.0}) segment.points_W.emplace_back(middle.x() + x, middle.y(), 0.0);
  segment.half_width_m = 3.0;
  segment.low_m = -0.3;
  segment.high_m = 0.3;
  return segment;
}

SkySpan span_of(const scene::Scene& scene, double duration_s, double mask_deg = 10.0) {
  return sky_span(*make_nominal_gps(), scene.frame(), kStart, kStart + duration_s, {Eigen::Vector3d::Zero(), 300.0},
                  mask_deg * kDegree);
}

/// A question about one piece, and what it is made of.
struct Asked {
  Asked(const Field& field, const RouteSegment& piece, double duration_s = 300.0, double mask_deg = 10.0)
      : scene(field.build()), segment(piece), sky(span_of(*scene, duration_s, mask_deg)), heights(*scene) {
    limits.weakest_nlos_db = -20.0;
  }
  PathQuestion question() const {
    return {.segment = segment,
            .antenna_reach_m = 1.3,
            .antenna_above_m = 1.0,
            .scene = *scene,
            .sky = sky,
            .heights = heights,
            .limits = limits};
  }
  Verdict verdict(const std::string& effect) const {
    std::vector<Need> needs = specular_needs(2, question());
    for (const auto ask : {diffraction_needs, scatter_needs, clutter_needs})
      for (Need& need : ask(question())) needs.push_back(need);
    for (const Need& need : needs)
      if (need.effect == effect) return need.verdict;
    ADD_FAILURE() << effect;
    return Verdict::kNeeded;
  }
  std::unique_ptr<scene::Scene> scene;
  RouteSegment segment;
  SkySpan sky;
  ObstacleHeights heights;
  PathParameters limits;
};

/// Seeded: a piece of the corridor, an antenna in it, and a satellite that is received there.
struct Placement {
  explicit Placement(std::uint64_t k) {
    const RandomStream stream(7, "test.placements");
    middle = {stream.uniform(-60, 60, 0, k), stream.uniform(-60, 60, 1, k)};
    antenna = {middle.x() + stream.uniform(-5, 5, 2, k), middle.y() + stream.uniform(-3, 3, 3, k), 1.2};
    const SkySpan sky = span_of(*Field().build(), 300.0);
    do {
      const auto i =
          static_cast<std::size_t>(stream.uniform(4, k, draw++) * static_cast<double>(sky.directions.size()));
      s = sky.directions[i].s_W;
    } while (s.z() > 0.8 || s.z() < 0.2);
    // A wall before which the satellite stands, up to 60 degrees from facing it.
    const double turn = stream.uniform(-1.0, 1.0, 5, k), c = std::cos(turn), d = std::sin(turn);
    const Eigen::Vector3d level = Eigen::Vector3d(s.x(), s.y(), 0).normalized();
    normal = {c * level.x() - d * level.y(), d * level.x() + c * level.y(), 0.0};
    mirrored = s - 2.0 * s.dot(normal) * normal;
    away_m = stream.uniform(8.0, 20.0, 6, k);
  }
  std::uint32_t draw = 0;
  Eigen::Vector2d middle;
  Eigen::Vector3d antenna, s, normal, mirrored;
  double away_m = 0.0;
};

TEST(PathNeeds, AnOpenFieldNeedsNone) {
  const Asked asked(Field{}, corridor({0, 0}));
  for (const char* effect :
       {kOcclusion, kFoliage, kReflections[0], kReflections[1], kDiffraction, kScattering, kClutter})
    EXPECT_EQ(asked.verdict(effect), Verdict::kNotNeeded) << effect;
  EXPECT_EQ(wedge_needs(asked.question())[0].verdict, Verdict::kNotNeeded);
}

TEST(PathNeeds, AHouseMakesAStreetThatScattersAndHasClutter) {
  const Asked asked(Field().box({100.0, 100.0}, {110.0, 110.0}, 5.0), corridor({0, 0}));
  EXPECT_EQ(asked.verdict(kScattering), Verdict::kUndecidable);
  EXPECT_EQ(asked.verdict(kClutter), Verdict::kUndecidable);
}

TEST(PathNeeds, AReflectorBesideTheCorridorFlipsTheVerdict) {
  for (std::uint64_t k = 0; k < kPlacements; ++k) {
    const Placement p(k);
    const Asked asked(Field().mirror(p.antenna + p.away_m * p.mirrored, p.normal), corridor(p.middle));
    EXPECT_NE(asked.verdict(kReflections[0]), Verdict::kNotNeeded) << k;
  }
}

TEST(PathNeeds, ACrownOnARayFlipsTheVerdict) {
  for (std::uint64_t k = 0; k < kPlacements; ++k) {
    const Placement p(k);
    const Asked asked(Field().crown(p.antenna + (p.away_m + 5.0) * p.s, 2.0), corridor(p.middle));
    EXPECT_NE(asked.verdict(kFoliage), Verdict::kNotNeeded) << k;
    EXPECT_EQ(asked.verdict(kReflections[0]), Verdict::kNotNeeded) << k;
  }
}

// One satellite of the span, moved to where a wall mirrors it, and back.
TEST(PathNeeds, AMovedSatelliteFlipsTheVerdict) {
  for (std::uint64_t k = 0; k < kPlacements; ++k) {
    const Placement p(k);
    RouteSegment narrow = corridor(p.antenna.head<2>());
    narrow.points_W = {narrow.points_W[1]};
    narrow.half_width_m = 0.5;
    Asked asked(Field().mirror(p.antenna + p.away_m * p.mirrored, p.normal), narrow);
    asked.sky.spread_rad = 0.003;
    asked.sky.directions = {{{}, (0.3 * Eigen::Vector3d::UnitZ() - p.normal).normalized()}};  // behind the wall
    EXPECT_EQ(asked.verdict(kReflections[0]), Verdict::kNotNeeded) << k;
    asked.sky.directions[0].s_W = p.s;
    EXPECT_NE(asked.verdict(kReflections[0]), Verdict::kNotNeeded) << k;
  }
}

// A fence that reaches up to 9 degrees stands below every satellite above a mask of 10 degrees, not of 5: within three
// hours some rises or sets.
TEST(PathNeeds, AMaskLoweredByFiveDegreesFlipsTheVerdict) {
  for (std::uint64_t k = 0; k < kPlacements; ++k) {
    const RandomStream stream(7, "test.fences");
    const Eigen::Vector2d middle(stream.uniform(-8, 8, 0, k), stream.uniform(-8, 8, 1, k));
    const double distance_m = stream.uniform(120.0, 190.0, 2, k);
    // From the corner of the corridor, and the corner of a square of the raster, that come nearest to the fence.
    const double least_m = distance_m - 8.0 - 5.0 - 3.0 - 1.3 - 6.0;
    const Field field = Field().fence(distance_m, 0.7 + least_m * std::tan(9.0 * kDegree));
    EXPECT_EQ(Asked(field, corridor(middle), 10800.0, 10.0).verdict(kOcclusion), Verdict::kNotNeeded) << k;
    EXPECT_NE(Asked(field, corridor(middle), 10800.0, 5.0).verdict(kOcclusion), Verdict::kNotNeeded) << k;
  }
}

// A bus of 3 m beside a mask of 10 degrees hides nothing from 30 m away on; nearer it may.
TEST(PathNeeds, ThingsThatMoveCountWhereTheyMayCome) {
  const Asked asked(Field{}, corridor({0, 0}));
  for (const double away_m : {12.0, 80.0}) {
    const std::vector<scene::SweptRoom> bus{{{-150.0, away_m}, {150.0, away_m}, 6.3, 6.8}};
    const ObstacleHeights heights(*asked.scene, bus);
    const PathQuestion question{.segment = asked.segment,
                                .antenna_reach_m = 1.3,
                                .antenna_above_m = 1.0,
                                .scene = *asked.scene,
                                .sky = asked.sky,
                                .heights = heights,
                                .limits = asked.limits};
    EXPECT_EQ(specular_needs(0, question)[0].verdict, away_m < 50.0 ? Verdict::kUndecidable : Verdict::kNotNeeded);
  }
}

// 2026-11-22: a bus on the road beside the field was dropped, since no square of the ground lay there.
TEST(PathNeeds, ThingsThatMoveBeyondTheGroundCount) {
  const Asked asked(Field{}, corridor({0, 150}));
  const RouteSegment at_the_edge = corridor({0, 190});
  for (const bool bus : {false, true}) {
    std::vector<scene::SweptRoom> moving;
    if (bus) moving = {{{-150.0, 212.0}, {150.0, 212.0}, 6.3, 6.8}};
    const ObstacleHeights heights(*asked.scene, moving);
    const PathQuestion question{.segment = at_the_edge,
                                .antenna_reach_m = 1.3,
                                .antenna_above_m = 1.0,
                                .scene = *asked.scene,
                                .sky = asked.sky,
                                .heights = heights,
                                .limits = asked.limits};
    EXPECT_EQ(specular_needs(0, question)[0].verdict, bus ? Verdict::kUndecidable : Verdict::kNotNeeded);
  }
}

/// Two walls of 60 m along the corridor, 12 m apart, 25 m high in the north and 9 m in the south.
Field& street(Field& field, const char* material) {
  return field.wall({-30, 6, 0}, {30, 6, 25}, material).wall({30, -6, 0}, {-30, -6, 9}, material);
}

/// A satellite in the south at 17 degrees, hidden by the lower wall, whose wave comes over it to the corridor by way of
/// the higher wall (at 10.5 m), the lower one (6.8 m) and the higher one again (3.1 m), nearly at right angles to both.
Asked across_the_street(const char* material, double weakest_db) {
  Field field;
  RouteSegment narrow = corridor({0, 0});
  narrow.points_W = {{0, 0, 0}};
  narrow.half_width_m = 0.5;
  Asked asked(street(field, material), narrow);
  asked.sky.spread_rad = 0.003;
  asked.sky.directions = {{{}, Eigen::Vector3d(0.05, -std::cos(0.3), std::sin(0.3)).normalized()}};
  asked.limits.weakest_db = asked.limits.weakest_nlos_db = weakest_db;
  return asked;
}

// Off 5.24 as permittivity, three times, no more than -23 dB is left at that incidence, off metal nearly all. Followed
// down to -40 dB it may act again.
TEST(PathNeeds, WhatWallsReflectDecidesOfWaysOverThree) {
  const auto verdict = [](const Asked& asked) { return reflection_need(3, asked.question()); };
  const Need weak = verdict(across_the_street("roofing", -20.0));
  EXPECT_EQ(weak.verdict, Verdict::kNotNeeded) << weak.reason;
  EXPECT_TRUE(weak.reason.starts_with("what walls mirror of a satellite is below -2")) << weak.reason;
  EXPECT_EQ(weak.bound, 0.0);
  EXPECT_EQ(verdict(across_the_street("roofing", -40.0)).verdict, Verdict::kUndecidable);
  const Need metal = verdict(across_the_street("metal", -20.0));
  EXPECT_EQ(metal.verdict, Verdict::kUndecidable);
  EXPECT_TRUE(metal.reason.ends_with(" dB at most")) << metal.reason;
}

// The search itself, over what the bound was taken of: nothing is found there, which off metal is.
TEST(PathNeeds, WaysOverThreeWallsThatReflectTooLittleAreNotFound) {
  const RandomStream stream(5, "test.street");
  for (const char* material : {"roofing", "metal"}) {
    const Asked asked = across_the_street(material, -20.0);
    const auto paths = make_specular3(asked.limits);
    const scene::SceneAt scene(*asked.scene);
    int over_three = 0;
    for (std::uint64_t k = 0; k < 50; ++k) {
      const Eigen::Vector3d antenna(stream.uniform(-0.5, 0.5, 0, k), stream.uniform(-0.5, 0.5, 1, k), 1.2);
      const std::vector<Eigen::Vector3d> satellites{asked.sky.directions[0].s_W};
      std::vector<SignalPaths> found(1);
      GnssCounters counters;
      paths->trace(antenna, satellites, scene, found, counters);
      for (const SignalPath& path : found[0].echoes) over_three += path.reflections == 3 ? 1 : 0;
    }
    EXPECT_EQ(over_three > 0, material == std::string("metal")) << material;
  }
}

// Fields with a few houses: wherever the antenna is in the piece and whichever satellite is looked at, the search in
// full and without what is not needed give the same, to the bit.
void what_is_not_needed_is_never_found(const char* diffraction, StatePathNeeds* edges_need, bool borders = false) {
  const RandomStream stream(11, "test.fields");
  int left_out = 0, found = 0;
  for (std::uint64_t k = 0; k < 60; ++k) {
    Field field;
    for (std::uint32_t house = 0; house < 3; ++house) {
      const Eigen::Vector2d at(stream.uniform(-150, 150, 10 + house, k), stream.uniform(-150, 150, 20 + house, k));
      const Eigen::Vector2d size(stream.uniform(2, 20, 30 + house, k), stream.uniform(2, 20, 40 + house, k));
      field.box(at, at + size, stream.uniform(1, 15, 50 + house, k));
    }
    field.crown({stream.uniform(-40, 40, 60, k), stream.uniform(-40, 40, 61, k), 5.0}, 3.0);
    Asked asked(field, corridor({stream.uniform(-50, 50, 62, k), stream.uniform(-50, 50, 63, k)}));
    asked.limits.reflection_borders = borders;
    std::vector<Need> needs = specular_needs(2, asked.question());
    for (Need& need : edges_need(asked.question())) needs.push_back(need);
    PathParameters full, less;
    less.leave_out = omissions_of(needs);
    if (less.leave_out == PathOmissions{}) continue;
    ++left_out;
    PropagationConfig config;
    config.paths.name = "specular2";
    config.diffraction.name = diffraction;
    config.reflection_borders = borders;
    const auto in_full = *make_propagation(config, full), reduced = *make_propagation(config, less);
    const scene::SceneAt scene(*asked.scene);
    std::vector<Eigen::Vector3d> satellites;
    for (const auto& direction : asked.sky.directions)
      if (std::asin(direction.s_W.z()) > 10.0 * kDegree) satellites.push_back(direction.s_W);
    for (std::uint64_t j = 0; j < 20; ++j) {
      const Eigen::Vector3d& middle = asked.segment.points_W[1];
      const Eigen::Vector3d antenna(middle.x() + stream.uniform(-5, 5, 70, 100 * k + j),
                                    middle.y() + stream.uniform(-3, 3, 71, 100 * k + j), 1.2);
      std::vector<SignalPaths> a(satellites.size()), b(satellites.size());
      GnssCounters counters;
      in_full->trace(antenna, satellites, scene, a, counters);
      reduced->trace(antenna, satellites, scene, b, counters);
      for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_EQ(a[i].line_of_sight, b[i].line_of_sight) << k;
        ASSERT_EQ(a[i].direct, b[i].direct) << k;
        ASSERT_EQ(a[i].foliage_m, b[i].foliage_m) << k;
        ASSERT_EQ(a[i].echoes.size(), b[i].echoes.size()) << k;
        found += static_cast<int>(a[i].echoes.size());
      }
    }
  }
  EXPECT_GT(left_out, 20) << "fields of which nothing can be said show nothing";
  EXPECT_GT(found, 0) << "nor do fields in which nothing is found";
}

TEST(PathNeeds, WhatIsNotNeededIsNeverFound) {
  what_is_not_needed_is_never_found("double_knife_edge", diffraction_needs);
}

TEST(PathNeeds, WhatWedgesDoNotNeedIsNeverFound) {
  what_is_not_needed_is_never_found("wedge", wedge_needs);
}

TEST(PathNeeds, WhatFadingMirrorsDoNotNeedIsNeverFound) {
  what_is_not_needed_is_never_found("wedge", wedge_needs, true);
}

}  // namespace
}  // namespace canyon::gnss::testing
