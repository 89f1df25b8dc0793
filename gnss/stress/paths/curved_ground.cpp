// Ground that is no plane: how wide the patch is that reflects.
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/gnss/paths/ground_reflection.h"
#include "canyon/gnss/paths/path_model.h"
#include "canyon/gnss/stress/subjects.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using stress::Worst;

scene::Scene valley_of(double slope, double side) {
  scene::SceneParts parts;
  parts.name = "valley";
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("valley", scene::ObjectKind::kTerrain);
  const double half = 4096.0, rim = slope * side;
  const auto material = mesh.material("asphalt");
  mesh.quad({0, -half, 0}, {side, -half, rim}, {side, half, rim}, {0, half, 0}, material);
  mesh.quad({-side, -half, rim}, {0, -half, 0}, {0, half, 0}, {-side, half, rim}, material);
  return scene::Scene(std::move(parts));
}

/// A valley along W's y of two slopes, seen from above its bottom along it: a patch of radius r has heights slope r to
/// both sides and 0 before and behind, so that its plane lies slope r / 2 above the bottom, and the way is 2 sin(e) (h
/// - slope r / 2) longer. The radius is that of the first Fresnel zone across, sqrt(wavelength h / sin e), held at 0.3
/// and 10 m. Heights of the terrain's corners, 16 m to the side, are in single precision.
StressFigure valley(double slope) {
  const double side = 16.0, rim = slope * side;
  const scene::Scene land = valley_of(slope, side);
  PathParameters p;
  p.cutoff_m = 1e6, p.weakest_db = p.weakest_nlos_db = -300.0;
  Worst worst;
  for (const double h : {0.2, 1.3, 4.0, 30.0, 900.0})
    for (const double e : {0.35, 0.8, 1.3}) {
      const std::vector<Vector3d> sky{{0.0, std::cos(e), std::sin(e)}};
      std::vector<SignalPaths> out(1);
      GnssCounters counters;
      add_ground_reflections(p, {0.0, 0.0, h}, PlaneWaves(sky), scene::SceneAt(land), out, counters);
      if (out[0].echoes.size() != 1 || counters.reflected_paths != 1) return {stress::kInfinity, 1.0};
      const double zone_m = std::sqrt(299792458.0 / 1575.42e6 * h / std::sin(e));
      const double r = zone_m < 0.3 ? 0.3 : zone_m > 10.0 ? 10.0 : zone_m, own_h = h - 0.5 * slope * r;
      const double off_m = 4.0 * stress::kHalfUlp * rim;
      worst.look(out[0].echoes[0].excess_m - 2.0 * own_h * std::sin(e), 2.0 * off_m);
      // To 0.1 mm, and what its height is off.
      const Vector3d expected(0.0, std::cos(e), -std::sin(e));
      worst.look((out[0].echoes[0].arrival_W - expected).norm(), (1e-4 + 2.0 * off_m) / own_h);
      worst.look(out[0].echoes[0].facets[0] == SignalPath::kTerrain ? 0.0 : stress::kInfinity, 1.0);
    }
  return worst.figure();
}

/// The same valley, looked across from above its bottom: the ground that reflects is the one slope, as an endless
/// mirror, once the search has left the bottom: 2 h (sin(e) - slope cos(e)) / (1 + slope^2). 0.1 mm along the slope
/// move no mirror.
StressFigure across_valley(double slope) {
  const double side = 1024.0;
  const scene::Scene land = valley_of(slope, side);
  PathParameters p;
  p.cutoff_m = 1e6, p.weakest_db = p.weakest_nlos_db = -300.0;
  Worst worst;
  for (const double h : {40.0, 150.0})
    for (const double e : {0.5, 0.9})
      for (const double to : {-1.0, 1.0}) {
        const std::vector<Vector3d> sky{{to * std::cos(e), 0.0, std::sin(e)}};
        std::vector<SignalPaths> out(1);
        GnssCounters counters;
        add_ground_reflections(p, {0.0, 0.0, h}, PlaneWaves(sky), scene::SceneAt(land), out, counters);
        if (out[0].echoes.size() != 1) return {stress::kInfinity, 1.0};
        const double exact_m = 2.0 * h * (std::sin(e) - slope * std::cos(e)) / (1.0 + slope * slope);
        worst.look(out[0].echoes[0].excess_m - exact_m, 4.0 * stress::kHalfUlp * slope * side);
      }
  return worst.figure();
}

}  // namespace

std::vector<StressCase> curved_ground_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "the patch of ground that reflects",
           "a radius over the height for the root of their product, an end of its range of another power of ten",
           "a valley's plane by the first Fresnel zone across, from 0.3 to 10 m: single precision of its corners",
           "of the bound"});
  for (const double slope : {0.02, 0.1, 0.2})
    rows.add("curved_ground/valley_of_slope_" + stress::text(slope), [slope] { return valley(slope); })
        .add("curved_ground/across_a_slope_of_" + stress::text(slope), [slope] { return across_valley(slope); });
  return rows.take();
}

}  // namespace canyon::gnss
