// Ways that are left out of a search, and rays that are launched for them.
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/stress/looks.h"
#include "canyon/gnss/paths/path_model.h"
#include "canyon/gnss/paths/plane_waves.h"
#include "canyon/gnss/stress/paths/strewn_boxes.h"
#include "canyon/gnss/stress/subjects.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using stress::Looks;

PathParameters every_way() {
  PathParameters p;
  p.cutoff_m = 1e6, p.weakest_db = p.weakest_nlos_db = -200.0, p.combine_all_m = 1e4;
  p.finite_facets = false;
  return p;
}

std::vector<Vector3d> even_sky(int count) {
  std::vector<Vector3d> out;
  for (int k = 0; k < count; ++k) {
    const double elevation = 0.08 + 1.35 * std::fmod(0.618 * k, 1.0), azimuth = 2.4 * k + 0.05;
    out.emplace_back(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                     std::sin(elevation));
  }
  return out;
}

std::vector<SignalPaths> traced(std::unique_ptr<PathModel> (*make)(const PathParameters&), const PathParameters& p,
                                const scene::Scene& city, const std::vector<Vector3d>& sky, GnssCounters& counters) {
  std::vector<SignalPaths> out(sky.size());
  make(p)->trace({0.3, -0.2, 1.1}, PlaneWaves(sky), scene::SceneAt(city), out, counters);
  return out;
}

/// What is left out is left out, and nothing else changes: ways of no, one or two reflections; straight ways that are
/// not followed, and leaves. Counters say what was done.
StressFigure left_out() {
  int wrong = 0;
  const auto city = strewn_boxes(8, 40, true, 25.0);
  scene::SceneParts parts = city->parts();
  parts.foliage.push_back({{5.0, 0.0, 9.0}, {4.0, 6.0, 6.0}});
  const scene::Scene leafy(std::move(parts));
  const auto sky = even_sky(300);
  GnssCounters all_counters;
  const auto all = traced(make_specular3, every_way(), leafy, sky, all_counters);
  std::size_t by_reflections[4] = {}, shaded = 0;
  for (const SignalPaths& paths : all) {
    for (const SignalPath& echo : paths.echoes) ++by_reflections[echo.reflections];
    shaded += paths.foliage_m > 0.0 ? 1 : 0;
  }
  wrong += by_reflections[1] > 10 && by_reflections[2] > 10 && by_reflections[3] > 3 && shaded > 1 ? 0 : 1;
  wrong += all_counters.reflected_paths ==
                   static_cast<std::int64_t>(by_reflections[1] + by_reflections[2] + by_reflections[3])
               ? 0
               : 1;
  wrong += all_counters.path_searches == 300 ? 0 : 1;
  for (int most = 0; most <= 3; ++most)
    for (const bool straight : {false, true}) {
      PathParameters p = every_way();
      p.leave_out.most_reflections = most, p.leave_out.occlusion = straight, p.leave_out.foliage = straight;
      GnssCounters counters;
      const auto some = traced(make_specular3, p, leafy, sky, counters);
      wrong += straight == (counters.path_searches == 0) ? 0 : 1;
      for (std::size_t k = 0; k < sky.size(); ++k) {
        std::size_t count = 0;
        for (const SignalPath& echo : all[k].echoes) count += echo.reflections <= most ? 1 : 0;
        wrong += some[k].echoes.size() == count ? 0 : 1;
        for (std::size_t e = 1; e < some[k].echoes.size(); ++e)
          wrong += some[k].echoes[e - 1].excess_m <= some[k].echoes[e].excess_m ? 0 : 1;
        wrong += some[k].line_of_sight == (straight || all[k].line_of_sight) ? 0 : 1;
        wrong += some[k].direct == (some[k].line_of_sight ? 1.0 : 0.0) ? 0 : 1;
        wrong += some[k].foliage_m == (straight ? 0.0 : all[k].foliage_m) ? 0 : 1;
      }
    }
  return {1.0 * wrong, 0.0};
}

/// Two walls of different materials in a corner: a ray that is launched takes each wall's own reflection in its turn,
/// so that of endless walls the fields are the images' to rounding; the excess is as far off as the ray misses the
/// satellite by, a cone's half-angle of twice the way; of walls that are not endless each is the smaller for its own
/// distance, to that cone.
StressFigure launched_fields() {
  Looks looks;
  scene::SceneParts parts;
  parts.name = "corner";
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("east", scene::ObjectKind::kWall);
  mesh.quad({9, 30, -6}, {9, -30, -6}, {9, -30, 28}, {9, 30, 28}, mesh.material("glass"));
  mesh.begin_object("north", scene::ObjectKind::kWall);
  mesh.quad({-30, 14, -6}, {30, 14, -6}, {30, 14, 28}, {-30, 14, 28}, mesh.material("brick"));
  parts.foliage.push_back({{4.0, 7.0, 4.0}, {2.0, 2.0, 2.0}});
  const scene::Scene corner(std::move(parts));
  const auto sky = even_sky(300);
  for (const bool finite : {false, true}) {
    PathParameters p = every_way();
    p.finite_facets = finite, p.roughness_m = 0.01, p.launched_rays = 6000;
    GnssCounters counters;
    const auto images = traced(make_specular2, p, corner, sky, counters),
               rays = traced(make_launching, p, corner, sky, counters);
    const double cone = 1.5 * std::sqrt(4.0 / p.launched_rays);
    int twice = 0;
    for (std::size_t k = 0; k < sky.size(); ++k)
      for (const SignalPath& ray : rays[k].echoes)
        for (const SignalPath& image : images[k].echoes) {
          if (image.facets != ray.facets || image.reflections != ray.reflections) continue;
          twice += ray.reflections == 2 ? 1 : 0;
          const double bound = finite ? 4.0 * cone : 1e-12;
          looks.near(std::abs(ray.copolar - image.copolar), 0.0, bound);
          looks.near(std::abs(ray.crosspolar - image.crosspolar), 0.0, bound);
          looks.near(ray.excess_m, image.excess_m, 2.0 * cone * 50.0);
          looks.near((ray.arrival_W - image.arrival_W).norm(), 0.0, 2.0 * cone);
          // Through a crown of 2 m the way is 4 m at most, and changes by less than that.
          looks.right(ray.foliage_m >= 0.0 && ray.foliage_m < 13.0 && (ray.foliage_m > 0.0 || image.foliage_m < 4.0));
        }
    looks.right(twice > 20);
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> traced_way_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "ways that are left out, and rays for images",
           "a limit off by one, a wall's reflection in the other's turn",
           "the same ways without those that are left out; fields of rays as images have them", "of the bound"});
  rows.add("shortcuts/left_out", left_out).add("shortcuts/launched_fields", launched_fields);
  return rows.take();
}

}  // namespace canyon::gnss
