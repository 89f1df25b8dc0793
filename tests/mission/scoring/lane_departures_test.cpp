// The lane is left with need and without.
#include "canyon/mission/scoring/lane_departures.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/surfaces/material.h"

namespace canyon::mission {
namespace {

using Eigen::Vector2d;

/// A lane of 150 m along x over level ground, with posts of 20 cm and a wall across after its end.
struct LaneWithPosts {
  explicit LaneWithPosts(const std::vector<Vector2d>& posts, double wall_x_m = 1e9) {
    scene::SceneParts parts;
    parts.materials = scene::builtin_materials();
    scene::MeshBuilder mesh(parts);
    const std::uint16_t concrete = mesh.material("concrete");
    mesh.begin_object("ground", scene::ObjectKind::kTerrain);
    mesh.quad({-50, -60, 0}, {250, -60, 0}, {250, 60, 0}, {-50, 60, 0}, concrete);
    for (const Vector2d& p : posts) {
      mesh.begin_object("post " + std::to_string(parts.objects.size()), scene::ObjectKind::kPole);
      mesh.box({p.x(), p.y(), 1.0}, Eigen::Matrix3d::Identity(), {0.1, 0.1, 1.0}, concrete);
    }
    if (wall_x_m < 1e9) {
      mesh.begin_object("wall", scene::ObjectKind::kWall);
      mesh.box({wall_x_m, 0.0, 1.0}, Eigen::Matrix3d::Identity(), {0.1, 8.0, 1.0}, concrete);
    }
    scene = std::make_unique<scene::Scene>(std::move(parts));
    at = std::make_unique<scene::SceneAt>(*scene);
  }
  std::unique_ptr<scene::Scene> scene;
  std::unique_ptr<scene::SceneAt> at;
};

using Beside = std::function<double(double x_m)>;

/// To y = `aside_m` and back, within 10 m each.
Beside out_and_back(double from_x_m, double to_x_m, double aside_m) {
  return [=](double x_m) { return aside_m * std::clamp(0.1 * std::min(x_m - from_x_m, to_x_m - x_m), 0.0, 1.0); };
}

/// How often the lane is left without need from x = 0 to 149 m, headed along it; truth less what is believed is
/// `error`.
int needless(const LaneWithPosts& lane, const Beside& y_m, const Vector2d& error = Vector2d::Zero(),
             const std::function<void(double x_m)>& before = {}, const Beside& yaw_deg = {}) {
  LaneDepartures departures(VehicleConfig{}, Path({{0.0, 0.0}, {150.0, 0.0}}, 6.5), *lane.at);
  for (double x_m = 0.0; x_m < 149.0; x_m += 0.05) {
    if (before) before(x_m);
    KinematicState truth;
    truth.X_WB.p = {x_m, y_m(x_m), 0.0};
    if (yaw_deg) truth.X_WB.R = rotation_from({yaw_deg(x_m) * kDegree, 0.0, 0.0});
    departures.look(truth, [&] { return Eigen::Vector3d(x_m - error.x(), y_m(x_m) - error.y(), 0.0); });
  }
  return departures.needless();
}

TEST(LaneDepartures, WhoIsInItsLaneHasNotLeftIt) {
  const LaneWithPosts free({});
  EXPECT_EQ(needless(free, [](double) { return 0.0; }), 0);
  EXPECT_EQ(needless(free, [](double) { return 0.45; }), 0);
  EXPECT_EQ(needless(free, out_and_back(40.0, 80.0, 0.45)), 0);
}

TEST(LaneDepartures, AroundAThingThereIsNeed) {
  EXPECT_EQ(needless(LaneWithPosts({{60.0, 0.0}}), out_and_back(40.0, 80.0, 1.5)), 0);
}

TEST(LaneDepartures, AroundNothingThereIsNone) {
  EXPECT_EQ(needless(LaneWithPosts({}), out_and_back(40.0, 80.0, 1.5)), 1);
  EXPECT_EQ(needless(LaneWithPosts({}), out_and_back(40.0, 80.0, -1.5)), 1) << "to the right";
  EXPECT_EQ(needless(LaneWithPosts({{100.0, 0.0}}), out_and_back(40.0, 60.0, 1.5)), 1)
      << "a thing 55 m on is no reason";
}

// In and out of the half metre every 1.5 m, as a vehicle that goes along what it takes for a wall.
TEST(LaneDepartures, TheSameNothingCountsOnce) {
  const LaneWithPosts free({});
  EXPECT_EQ(
      needless(free, [](double x) { return x < 40.0 || x > 80.0 ? 0.0 : 0.5 + 0.1 * std::sin(2.0 * kPi * x / 3.0); }),
      1);
  const Beside first = out_and_back(30.0, 60.0, 1.5), second = out_and_back(80.0, 110.0, 1.5);
  EXPECT_EQ(needless(free, [&](double x) { return first(x) + second(x); }), 2) << "two of them, 20 m apart";
}

TEST(LaneDepartures, WhoStartsBesideItsLaneHasNotLeftIt) {
  const LaneWithPosts free({});
  const auto joining = [](double x) { return 1.5 * std::clamp(0.1 * (30.0 - x), 0.0, 1.0); };
  EXPECT_EQ(needless(free, joining), 0);
  EXPECT_EQ(needless(free, [](double) { return 1.5; }), 0) << "it never joins";
  const Beside later = out_and_back(60.0, 90.0, 1.5);
  EXPECT_EQ(needless(free, [&](double x) { return joining(x) + later(x); }), 1) << "from where it has joined it has";
  // It turns around on the spot first, and that takes it aside.
  EXPECT_EQ(needless(free, out_and_back(20.0, 50.0, 1.5), Vector2d::Zero(), {},
                     [](double x) { return x < 25.0 ? 120.0 : 0.0; }),
            0);
}

// Its estimate is a metre off to the right: it takes itself to be in its lane while it is a metre to the left, and
// beside it while it is there.
TEST(LaneDepartures, WhatTheEstimateExplainsIsNone) {
  const LaneWithPosts free({});
  const Vector2d left(0.0, 1.0);
  EXPECT_EQ(needless(
                free, [](double) { return 1.0; }, left),
            0);
  EXPECT_EQ(needless(
                free, [](double) { return 0.0; }, left),
            0);
  EXPECT_EQ(needless(free, out_and_back(40.0, 80.0, 1.45), left), 0);
  EXPECT_EQ(needless(free, out_and_back(40.0, 80.0, 1.55), left), 1) << "55 cm beside where it puts the lane";
  EXPECT_EQ(needless(free, out_and_back(40.0, 80.0, -0.55), left), 1) << "55 cm beside where the lane is";
}

// It drives 3 m beside its lane, and takes that for the lane: a post there it has to go around.
TEST(LaneDepartures, AThingWhereTheLaneIsBelievedIsNeedToo) {
  const Beside around = [](double x) { return 3.0 + out_and_back(40.0, 80.0, 1.5)(x); };
  EXPECT_EQ(needless(LaneWithPosts({{60.0, 3.0}}), around, {0.0, 3.0}), 0);
  EXPECT_EQ(needless(LaneWithPosts({}), around, {0.0, 3.0}), 1);
}

// The body's side is 0.75 m from the lane's middle: a post's face 0.9 m from it is in the lane, one 1.1 m from it not.
TEST(LaneDepartures, WhatItPassesByAMetreIsNoReason) {
  EXPECT_EQ(needless(LaneWithPosts({{60.0, -1.75}}), out_and_back(40.0, 80.0, 1.5)), 0);
  EXPECT_EQ(needless(LaneWithPosts({{60.0, -1.95}}), out_and_back(40.0, 80.0, 1.5)), 1);
}

// The body has left the post behind at x = 61.5 m; 30 m on there is no need of it any more.
TEST(LaneDepartures, WhoDoesNotComeBackStaysWithoutNeed) {
  EXPECT_EQ(needless(LaneWithPosts({{60.0, 0.0}}), out_and_back(40.0, 88.0, 1.5)), 0);
  EXPECT_EQ(needless(LaneWithPosts({{60.0, 0.0}}), out_and_back(40.0, 130.0, 1.5)), 1);
}

TEST(LaneDepartures, WhatStandsAfterTheLanesEndIsAReason) {
  EXPECT_EQ(needless(LaneWithPosts({}, 165.0), out_and_back(135.0, 200.0, 1.5)), 0);
  EXPECT_EQ(needless(LaneWithPosts({}), out_and_back(135.0, 200.0, 1.5)), 1);
}

// 2026-11-30: `low` left its lane five times in the built-in mission, each time where it swung out behind a corner of
// its route that is sharper than its own turning circle.
TEST(LaneDepartures, WhoCannotTurnSoSharplySwingsOut) {
  const LaneWithPosts free({});
  const auto swings = [&](double corner_radius_m, double from_s_m) {
    const Path lane({{0.0, 0.0}, {60.0, 0.0}, {60.0, 55.0}}, corner_radius_m);
    LaneDepartures departures(VehicleConfig{}, lane, *free.at);
    const Beside aside = out_and_back(from_s_m, from_s_m + 14.0, 1.2);
    for (double s = 0.0; s < lane.length_m(); s += 0.05) {
      const Vector2d along = lane.direction(s), p = lane.at(s) + aside(s) * Vector2d(along.y(), -along.x());
      KinematicState truth;
      truth.X_WB.p = {p.x(), p.y(), 0.0};
      truth.X_WB.R = rotation_from({std::atan2(along.y(), along.x()), 0.0, 0.0});
      departures.look(truth, [&] { return truth.X_WB.p; });
    }
    return departures.needless();
  };
  EXPECT_EQ(swings(0.5, 61.0), 0);
  EXPECT_EQ(swings(6.5, 61.0), 1) << "that it could have followed";
  EXPECT_EQ(swings(0.5, 80.0), 1) << "20 m after it";
}

// A box that stands in the lane until the vehicle is at x = 50 m.
TEST(LaneDepartures, WhatHasJustGoneWasAReason) {
  const LaneWithPosts lane({});
  scene::SceneParts parts;
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("box", scene::ObjectKind::kVehicle);
  mesh.box({0, 0, 0.75}, Eigen::Matrix3d::Identity(), {2.0, 0.9, 0.75}, mesh.material("painted_metal"));
  const auto shape =
      std::make_shared<const scene::RigidShape>("box", scene::ObjectKind::kVehicle, std::move(parts.mesh));
  const auto stands_to = [&](double to_x_m) {
    return [&lane, &shape, to_x_m](double x_m) {
      std::vector<scene::Instance> moving;
      if (x_m < to_x_m) moving.push_back({shape, "box", {Eigen::Quaterniond::Identity(), {60.0, 0.0, 0.0}}});
      lane.at->set_instances(std::move(moving));
    };
  };
  EXPECT_EQ(needless(lane, out_and_back(40.0, 80.0, 1.5), Vector2d::Zero(), stands_to(50.0)), 0);
  EXPECT_EQ(needless(lane, out_and_back(40.0, 80.0, 1.5), Vector2d::Zero(), stands_to(40.0)), 1);
}

/// A slab from x = -10 to 160 m, from 1.5 to 4 m to the right of the lane, on ground that rises by 0.2 from 0.9 m on,
/// or on level ground; or across the lane from x = 59 to 61 m.
enum class Slab { kOnLevelGround, kOnRisingGround, kAcross };
struct LaneWithSlab : LaneWithPosts {
  LaneWithSlab(Slab where, double height_m, scene::ObjectKind kind) : LaneWithPosts({}) {
    scene::SceneParts parts;
    parts.materials = scene::builtin_materials();
    scene::MeshBuilder mesh(parts);
    const std::uint16_t concrete = mesh.material("concrete");
    const double rise = where == Slab::kOnRisingGround ? 0.2 : 0.0;
    const auto at_place = [&](double x, double y, double above_m) {
      return Eigen::Vector3d(x, y, rise * std::max(0.0, -0.9 - y) + above_m);
    };
    const auto sheet = [&](const Vector2d& low, const Vector2d& high, double above_m) {
      mesh.quad(at_place(low.x(), low.y(), above_m), at_place(high.x(), low.y(), above_m),
                at_place(high.x(), high.y(), above_m), at_place(low.x(), high.y(), above_m), concrete);
    };
    mesh.begin_object("ground", scene::ObjectKind::kTerrain);
    sheet({-50, -60}, {250, -0.9}, 0.0);
    sheet({-50, -0.9}, {250, 60}, 0.0);
    mesh.begin_object("slab", kind);
    const Vector2d low = where == Slab::kAcross ? Vector2d(59, -4) : Vector2d(-10, -4);
    const Vector2d high = where == Slab::kAcross ? Vector2d(61, 4) : Vector2d(160, -1.5);
    sheet(low, high, height_m);
    mesh.quad(at_place(low.x(), high.y(), 0.0), at_place(high.x(), high.y(), 0.0),
              at_place(high.x(), high.y(), height_m), at_place(low.x(), high.y(), height_m), concrete);
    at.reset();
    scene = std::make_unique<scene::Scene>(std::move(parts));
    at = std::make_unique<scene::SceneAt>(*scene);
  }
};

// 2026-11-30: kerbs beside the lane made every departure a needful one. The body begins 0.2 m above the ground, and a
// mission's kerbs may be as high; on ground that rises beside the lane lower ones stand as high beside the body.
TEST(LaneDepartures, AKerbBesideTheLaneIsNoReason) {
  const Beside aside = out_and_back(40.0, 80.0, 1.5);
  using scene::ObjectKind;
  EXPECT_EQ(needless(LaneWithSlab(Slab::kOnLevelGround, 0.12, ObjectKind::kOther), aside), 1);
  EXPECT_EQ(needless(LaneWithSlab(Slab::kOnLevelGround, 0.2, ObjectKind::kOther), aside), 1);
  EXPECT_EQ(needless(LaneWithSlab(Slab::kOnRisingGround, 0.12, ObjectKind::kOther), aside), 1);
}

TEST(LaneDepartures, WhatIsHigherThanAKerbOrKnownIsAReason) {
  const Beside aside = out_and_back(40.0, 80.0, 1.5);
  using scene::ObjectKind;
  EXPECT_EQ(needless(LaneWithSlab(Slab::kOnLevelGround, 0.25, ObjectKind::kOther), aside), 0);
  EXPECT_EQ(needless(LaneWithSlab(Slab::kOnRisingGround, 0.25, ObjectKind::kOther), aside), 0);
  EXPECT_EQ(needless(LaneWithSlab(Slab::kOnRisingGround, 0.12, ObjectKind::kWall), aside), 0);
  EXPECT_EQ(needless(LaneWithSlab(Slab::kAcross, 0.25, ObjectKind::kOther), aside), 0);
  EXPECT_EQ(needless(LaneWithSlab(Slab::kAcross, 0.12, ObjectKind::kOther), aside), 1) << "it drives over it";
}

TEST(LaneDepartures, WithoutALaneNothingIsCounted) {
  const LaneWithPosts free({});
  LaneDepartures departures(VehicleConfig{}, Path(), *free.at);
  departures.look(KinematicState{}, [] { return Eigen::Vector3d::Zero().eval(); });
  EXPECT_EQ(departures.needless(), 0);
}

}  // namespace
}  // namespace canyon::mission
