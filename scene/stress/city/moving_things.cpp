// What moves: shapes in their measures, where each is and how it is turned over time, all the room that it ever takes,
// and what is said of a way that is none.
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/stress/looks.h"
#include "canyon/scene/city/site.h"
#include "canyon/scene/city/traffic.h"
#include "canyon/scene/stress/city/subjects.h"
#include "canyon/scene/stress/made_scenes.h"

namespace canyon::scene {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using stress::kHalfUlp;
using stress::kInfinity;
using stress::Looks;

/// A square of 200 m that rises by a tenth to the east; its height in single precision of 10 m.
std::unique_ptr<Scene> rising_square() {
  SceneParts parts = made::nothing();
  MeshBuilder mesh(parts);
  mesh.begin_object("ground", ObjectKind::kTerrain);
  mesh.quad({-100, -100, -10}, {100, -100, 10}, {100, 100, 10}, {-100, 100, -10}, mesh.material("asphalt"));
  return made::scene_of(std::move(parts));
}
constexpr double kPlaceGrain_m = 8.0 * kHalfUlp * 16.0;

MovingConfig mover(std::string name, std::string shape, std::vector<double> path_m, double speed_m_s, double start_s) {
  return {.name = std::move(name),
          .shape = std::move(shape),
          .path_m = std::move(path_m),
          .speed_m_s = speed_m_s,
          .start_s = start_s};
}

/// Measures of shapes, all of metal but people: 4.5 x 1.8 x 1.5 m, 12 x 2.55 x 3 m, 0.3 x 0.5 x 1.75 m, on the ground
/// but for what wheels need.
StressFigure measures_of_movers() {
  Looks looks;
  const auto scene = rising_square();
  looks.right(moving_shapes() == std::vector<std::string>{"car", "bus", "person"});
  const struct {
    const char* shape;
    ObjectKind kind;
    Vector3d low, high;
    std::size_t boxes;
    const char* material;
  } expected[] = {{"car", ObjectKind::kVehicle, {-2.25, -0.9, 0.2}, {2.25, 0.9, 1.5}, 2, "painted_metal"},
                  {"bus", ObjectKind::kVehicle, {-6.0, -1.275, 0.3}, {6.0, 1.275, 3.0}, 1, "painted_metal"},
                  {"person", ObjectKind::kPerson, {-0.15, -0.25, 0.0}, {0.15, 0.25, 1.75}, 1, "clothing"}};
  for (const auto& e : expected) {
    const auto traffic = Traffic::make({mover("", e.shape, {1, 2}, 1.0, 0.0)}, *scene);
    looks.right(traffic.ok() && !traffic->empty());
    if (!traffic.ok()) continue;
    const RigidShape& shape = *traffic->at(0.0).at(0).shape;
    Vector3d low = Vector3d::Constant(kInfinity), high = -low;
    for (const auto& v : shape.mesh().vertices)
      low = low.cwiseMin(v.cast<double>()), high = high.cwiseMax(v.cast<double>());
    looks.near((low - e.low).norm(), 0.0, 8.0 * kHalfUlp * 6.0), looks.near((high - e.high).norm(), 0.0, 1e-5);
    looks.right(shape.kind() == e.kind && shape.name() == e.shape && shape.mesh().triangles.size() == 12 * e.boxes);
    for (const auto m : shape.mesh().material) looks.right(scene->materials()[m].name == e.material);
  }
  // The car's cabin, its 9th to 16th corner of four a quad: 2.4 x 1.6 x 0.6 m, 0.3 m aft.
  const auto car = Traffic::make({mover("", "car", {1, 2}, 1.0, 0.0)}, *scene);
  if (!car.ok()) return looks.figure();
  Vector3d low = Vector3d::Constant(kInfinity), high = -low;
  for (const auto& v : car->at(0.0).at(0).shape->mesh().vertices) {
    if (v.z() < 0.95F && std::abs(v.x()) > 1.6F) continue;  // of the body
    low = low.cwiseMin(v.cast<double>()), high = high.cwiseMax(v.cast<double>());
  }
  looks.near((low - Vector3d(-1.5, -0.8, 0.9)).norm(), 0.0, 1e-5);
  looks.near((high - Vector3d(0.9, 0.8, 1.5)).norm(), 0.0, 1e-5);
  looks.right(Traffic::make({}, *scene)->empty());
  // As a configuration says nothing else.
  const MovingConfig usual;
  looks.right(usual.shape == "car" && usual.speed_m_s == 8.0 && usual.start_s == 0.0 && usual.name.empty() &&
              usual.path_m.empty());
  return looks.figure();
}

/// Along a way of three legs, 30, 40 and 50 m: where it is after a time, headed along its leg, upright to the ground,
/// or to the vertical if it walks; before its start and after its end it stands; with a leg without length, too.
StressFigure places_over_time() {
  Looks looks;
  const auto scene = rising_square();
  const std::vector<double> path = {-20, -10, 10, -10, 10, -10, 10, 30, -30, 60};
  const auto made = Traffic::make({mover("", "bus", path, 5.0, 3.0), mover("walker", "person", path, 1.25, 0.0),
                                   mover("", "car", {7, 8}, 9.0, 0.0), mover("", "bus", {4, -4, 4, 4}, 2.0, 1.0)},
                                  *scene);
  if (!made.ok()) return {kInfinity, 1.0};
  const Vector3d slope = Vector3d(-0.1, 0.0, 1.0).normalized();
  const auto expect = [&](const Instance& found, const std::string& name, const Vector2d& at, const Vector2d& ahead,
                          const Vector3d& up) {
    looks.right(found.name == name);
    looks.near((found.X_WS.p - Vector3d(at.x(), at.y(), 0.1 * at.x())).norm(), 0.0, kPlaceGrain_m);
    const Eigen::Matrix3d R = found.X_WS.R.toRotationMatrix();
    // Its left is level with the ground and at right angles to the way in plan. Single precision.
    const Vector3d left = Vector3d(-ahead.y(), ahead.x(), (up.x() * ahead.y() - up.y() * ahead.x()) / up.z());
    looks.near((R.col(2) - up).norm(), 0.0, 8.0 * kHalfUlp);
    looks.near((R.col(1) - left.normalized()).norm(), 0.0, 16.0 * kHalfUlp);
    looks.near((R.col(0) - left.normalized().cross(up)).norm(), 0.0, 16.0 * kHalfUlp);
  };
  const auto place = [](double along_m) {
    struct {
      Vector2d at, ahead;
    } out;
    const double m = along_m < 0.0 ? 0.0 : along_m > 120.0 ? 120.0 : along_m;
    if (m <= 30.0)
      out = {{-20.0 + m, -10.0}, {1.0, 0.0}};
    else if (m <= 70.0)
      out = {{10.0, -10.0 + (m - 30.0)}, {0.0, 1.0}};
    else
      out = {{10.0 - 0.8 * (m - 70.0), 30.0 + 0.6 * (m - 70.0)}, {-0.8, 0.6}};
    return out;
  };
  for (const double t_s : {-5.0, 0.0, 2.9, 3.0, 4.7, 8.3, 11.0, 16.9, 17.3, 26.0, 27.0, 90.0, 1e5}) {
    const auto now = made->at(t_s);
    looks.right(now.size() == 4);
    const auto bus = place(5.0 * (t_s - 3.0)), walker = place(1.25 * t_s);
    expect(now[0], "bus 1", bus.at, bus.ahead, slope);
    expect(now[1], "walker", walker.at, walker.ahead, Vector3d::UnitZ());
    expect(now[2], "car 3", {7, 8}, {1, 0}, slope);
    const double on = t_s < 1.0 ? 0.0 : t_s > 5.0 ? 8.0 : 2.0 * (t_s - 1.0);
    expect(now[3], "bus 4", {4.0, -4.0 + on}, {0, 1}, slope);
    looks.right(now[3].shape == now[0].shape && now[2].shape != now[0].shape);
  }
  return looks.figure();
}

/// The room of a way: a leg after another, as wide as the farthest corner of the shape is from its origin, and half a
/// metre higher than that above the leg's highest ground; one room about a thing that stands.
StressFigure rooms_of_ways() {
  Looks looks;
  const auto scene = rising_square();
  const auto made =
      Traffic::make({mover("", "person", {5, 5}, 1.0, 0.0), mover("", "bus", {-40, 10, 20.5, 10, 20.5, -30}, 1.0, 0.0),
                     mover("", "car", {0, 0, -30, 40}, 1.0, 0.0)},
                    *scene);
  if (!made.ok()) return {kInfinity, 1.0};
  const auto rooms = made->swept();
  const double person = std::sqrt(0.15 * 0.15 + 0.25 * 0.25 + 1.75 * 1.75),
               bus = std::sqrt(6.0 * 6.0 + 1.275 * 1.275 + 3.0 * 3.0),
               car = std::sqrt(2.25 * 2.25 + 0.9 * 0.9 + 0.9 * 0.9);
  const struct {
    Vector2d from, to;
    double reach, ground;
  } expected[] = {{{5, 5}, {5, 5}, person, 0.5},
                  {{-40, 10}, {20.5, 10}, bus, 2.05},
                  {{20.5, 10}, {20.5, -30}, bus, 2.05},
                  {{0, 0}, {-30, 40}, car, 0.0}};
  looks.right(rooms.size() == 4);
  for (std::size_t k = 0; k < 4 && k < rooms.size(); ++k) {
    looks.near((rooms[k].from_W - expected[k].from).norm() + (rooms[k].to_W - expected[k].to).norm(), 0.0, 1e-12);
    looks.near(rooms[k].radius_m, expected[k].reach, 4.0 * kHalfUlp * 8.0);
    looks.near(rooms[k].top_m, expected[k].ground + expected[k].reach + 0.5, 4.0 * kPlaceGrain_m);
    const auto box = rooms[k].around();
    const Vector2d low = expected[k].from.cwiseMin(expected[k].to), high = expected[k].from.cwiseMax(expected[k].to);
    for (int a = 0; a < 2; ++a) {
      looks.near(box.min()[a], low[a] - expected[k].reach, 4.0 * kHalfUlp * 8.0);
      looks.near(box.max()[a], high[a] + expected[k].reach, 4.0 * kHalfUlp * 8.0);
    }
  }
  // A hill on the way, 3 m in front of its end, is not missed: a ramp that rises to a ridge across it.
  SceneParts parts = made::nothing();
  MeshBuilder mesh(parts);
  mesh.begin_object("ground", ObjectKind::kTerrain);
  const auto asphalt = mesh.material("asphalt");
  mesh.quad({-50, -50, 0}, {17, -50, 0}, {17, 50, 0}, {-50, 50, 0}, asphalt);
  mesh.quad({17, -50, 0}, {27, -50, 5}, {27, 50, 5}, {17, 50, 0}, asphalt);
  mesh.quad({27, -50, 5}, {37, -50, 0}, {37, 50, 0}, {27, 50, 5}, asphalt);
  const auto ridge = made::scene_of(std::move(parts));
  const auto over = Traffic::make({mover("", "car", {-30, 0, 30, 0}, 1.0, 0.0)}, *ridge);
  if (!over.ok()) return {kInfinity, 1.0};
  // Looked at every metre at least: half a metre on a slope of a half is a quarter of a metre less.
  const double top_m = over->swept().at(0).top_m;
  looks.right(top_m <= 5.0 + car + 0.5 + 1e-5 && top_m >= 4.75 + car + 0.5 - 1e-5);
  return looks.figure();
}

/// Ways that are none, by the words of their refusal: the number of the thing, what it has, and what was expected; of
/// the second thing as well as of the first. A figure counts what is let through or said otherwise.
StressFigure refused_ways() {
  const auto scene = rising_square();
  int wrong = 0;
  Site site;
  site.low_W = {-100, -100}, site.high_W = {100, 100}, site.extent_keys = "scene.extent_m";
  const MovingConfig good = mover("", "car", {1, 2, 3, 4}, 1.0, 0.0);
  const struct {
    std::vector<double> path;
    const char *made, *checked;
  } bad[] = {{{}, "0 numbers, expected x, y of at least one point", nullptr},
             {{1.0}, "1 numbers, expected x, y of at least one point", nullptr},
             {{1, 2, 3}, "3 numbers, expected x, y of at least one point", nullptr},
             {{1, 2, 100.5, 3},
              "(100.5, 3) lies outside the scene, expected a point on the terrain",
              "(100.5, 3) lies outside the scene, expected a point on the terrain (scene.extent_m)"},
             {{1, -101},
              "(1, -101) lies outside the scene, expected a point on the terrain",
              "(1, -101) lies outside the scene, expected a point on the terrain (scene.extent_m)"}};
  const auto text = [](const auto& result) { return result.ok() ? std::string("let through") : result.error().str(); };
  for (const auto& b : bad)
    for (const std::size_t place : {0U, 1U, 2U}) {
      std::vector<MovingConfig> things(3, good);
      things[place].path_m = b.path;
      const std::string key = "scene.moving[" + std::to_string(place + 1) + "].path_m: ";
      wrong += text(Traffic::make(things, *scene)) == key + b.made ? 0 : 1;
      wrong += text(check_ways(things, site)) == key + (b.checked != nullptr ? b.checked : b.made) ? 0 : 1;
    }
  wrong += Traffic::make({good, good}, *scene).ok() && check_ways({good, good}, site).ok() ? 0 : 1;
  // The corners themselves lie within.
  wrong += check_ways({mover("", "car", {-100, -100, 100, 100}, 1.0, 0.0)}, site).ok() ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> moving_thing_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "things that move on ways over a slope",
           .why = "another leg's direction, the time that was not stood, the first thing's shape for all",
           .expected = "places, axes and rooms in closed form, to single precision of the ground",
           .unit = "of the bound",
           .loose = "the bound of what is exact in double precision is that of single precision"});
  rows.add("moving_things/measures", measures_of_movers)
      .add("moving_things/places_over_time", places_over_time)
      .add("moving_things/rooms_of_ways", rooms_of_ways);
  rows.of({.group = StressGroup::kData,
           .mechanism = "ways that are none",
           .why = "the first thing's path looked at for all, a point beyond the border let through",
           .expected = "refused with the number of the thing, what it has and what was expected",
           .unit = "wrong"});
  rows.add("moving_things/refused_ways", refused_ways);
  return rows.take();
}

}  // namespace canyon::scene
