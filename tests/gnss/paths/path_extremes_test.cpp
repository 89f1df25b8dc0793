#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/gnss/paths/path_model.h"
#include "canyon/gnss/paths/propagation.h"
#include "canyon/scene/scene_at.h"
#include "canyon/tests/gnss/paths/wall_scene.h"

namespace canyon::gnss {
namespace {

using testing::direction;
using testing::WallScene;

/// Every path model by itself, and with diffraction and the ground.
std::vector<std::pair<std::string, std::unique_ptr<PathModel>>> all_models() {
  std::vector<std::pair<std::string, std::unique_ptr<PathModel>>> out;
  for (const auto& row : path_models()) {
    ModelParameters own;
    if (row.parameters != nullptr) row.parameters(own);
    out.emplace_back(row.name, row.make(own, {}));
    for (const auto& bend : diffraction_models())
      out.emplace_back(std::string(row.name) + " + " + bend.name + " + ground",
                       make_propagation(row.make(own, {}), bend.make({}, {}), true, {}));
  }
  return out;
}

std::vector<Eigen::Vector3d> whole_sky() {
  std::vector<Eigen::Vector3d> out;
  for (double elevation = 0.0; elevation <= 90.0; elevation += 7.5)
    for (double azimuth = 0.0; azimuth < 360.0; azimuth += 30.0) out.push_back(direction(azimuth, elevation));
  return out;
}

std::vector<SignalPaths> traced_at(const PathModel& model, const scene::Scene& scene,
                                   const Eigen::Vector3d& antenna_W) {
  const auto sky = whole_sky();
  std::vector<SignalPaths> out(sky.size());
  GnssCounters counters;
  model.trace(antenna_W, sky, scene::SceneAt(scene), out, counters);
  return out;
}

void expect_sound(const std::string& name, const std::vector<SignalPaths>& paths) {
  for (const auto& p : paths) {
    EXPECT_TRUE(std::isfinite(std::abs(p.direct)) && std::isfinite(p.foliage_m)) << name;
    for (const auto& e : p.echoes) {
      EXPECT_TRUE(std::isfinite(e.excess_m) && e.excess_m >= 0.0) << name << " " << e.excess_m;
      EXPECT_TRUE(std::isfinite(std::abs(e.copolar)) && std::isfinite(std::abs(e.crosspolar))) << name;
      EXPECT_LE(std::abs(e.copolar), 1.5) << name;
      EXPECT_NEAR(e.arrival_W.norm(), 1.0, 1e-9) << name;
    }
  }
}

// Inside a closed building nothing arrives: no direct way, nothing off the inner faces of its walls (they have no
// inside to reflect at: their normals point outward), nothing around its edges.
TEST(PathExtremes, InsideABuildingNothingArrives) {
  const auto scene = WallScene().box({-20, -20, 0}, {20, 20, 30}).box({-60, -20, 0}, {-30, 20, 60}, "glass").build();
  for (const auto& [name, model] : all_models()) {
    if (name.starts_with("none")) continue;  // leaves the scene out altogether
    const auto paths = traced_at(*model, *scene, {1.0, 2.0, 3.0});
    expect_sound(name, paths);
    for (const auto& p : paths) {
      EXPECT_FALSE(p.line_of_sight) << name;
      EXPECT_EQ(std::abs(p.direct), 0.0) << name;
      EXPECT_TRUE(p.echoes.empty()) << name << ": " << p.echoes.size() << " echoes";
    }
  }
}

// On a wall, in a corner, on the roof's edge, within a millimetre of a pane.
TEST(PathExtremes, AntennaOnASurface) {
  const auto scene = WallScene().box({-20, -20, 0}, {20, 20, 30}).box({22, -20, 0}, {30, 20, 60}, "glass").build();
  for (const Eigen::Vector3d& antenna :
       {Eigen::Vector3d(20, 0, 10), Eigen::Vector3d(20.0005, 0, 10), Eigen::Vector3d(20, 20, 30),
        Eigen::Vector3d(0, 0, 30), Eigen::Vector3d(20, 20, 0)})
    for (const auto& [name, model] : all_models()) expect_sound(name, traced_at(*model, *scene, antenna));
}

// From 400 m below the sea to 20 km up, over the built scene and far from it.
TEST(PathExtremes, HeightsFromBelowTheSeaTo20Km) {
  const auto scene = WallScene({0.0, kPi, -400.0}).box({-20, -20, 0}, {20, 20, 30}).build();
  for (const double up_m : {0.5, 400.0, 20400.0}) {
    for (const auto& [name, model] : all_models()) {
      const auto paths = traced_at(*model, *scene, {60.0, 0.0, up_m});
      expect_sound(name, paths);
      if (up_m < 30.0) continue;
      for (const auto& p : paths) EXPECT_TRUE(p.line_of_sight) << name << " at " << up_m;
    }
  }
}

// Satellites on the horizon and at the zenith of an open field: no wall, so nothing but the direct signal.
TEST(PathExtremes, AnEmptySceneHasNothingButTheDirectWay) {
  const auto scene = WallScene().wall({1e4, 1e4, -100}, {1, 0, 0}, {0, 0, 1}).build();
  for (const auto& [name, model] : all_models())
    for (const auto& p : traced_at(*model, *scene, {0, 0, 2})) {
      EXPECT_TRUE(p.line_of_sight) << name;
      EXPECT_TRUE(p.echoes.empty()) << name;
    }
}

}  // namespace
}  // namespace canyon::gnss
