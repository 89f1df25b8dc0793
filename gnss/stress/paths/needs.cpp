// What can be said of a piece of a route before anything is received: bounds of reflections, of directions, of
// horizons.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/motion/route_segment.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/paths/bounce.h"
#include "canyon/gnss/paths/diffraction/diffraction.h"
#include "canyon/gnss/paths/diffraction/fresnel.h"
#include "canyon/gnss/paths/need/ball.h"
#include "canyon/gnss/paths/need/obstacle_heights.h"
#include "canyon/gnss/paths/need/path_question.h"
#include "canyon/gnss/paths/need/reflection_bound.h"
#include "canyon/gnss/paths/need/sky_span.h"
#include "canyon/gnss/paths/propagation.h"
#include "canyon/gnss/satellites/constellation.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/sensor/sensor_need.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/stress/level_ground.h"
#include "canyon/gnss/stress/paths/plain.h"
#include "canyon/gnss/stress/subjects.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using stress::Looks;

/// Bounds that are made before anything is received: never below what is, and no farther above it than their steps.
StressFigure bounds() {
  Looks looks;
  const RandomStream draws(4, "stress.receptions");
  for (const scene::Material& material : scene::builtin_materials())
    for (const double rough_m : {0.0, 0.01}) {
      const ReflectionBound bound(material, rough_m);
      for (double cosine = 0.005; cosine < 1.0; cosine += 0.0217) {
        double most = 0.0;
        for (const double hz : {1.15e9, 1.3e9, kL1Hz, 1.62e9}) {
          const double incidence = std::acos(cosine);
          const Vector3d in(std::sin(incidence), 0.0, -cosine);
          const Bounce bounce = bounce_off(material, in, Vector3d::UnitZ(), rough_m, hz);
          most = worse(most, std::abs(bounce.coefficients.te) * bounce.factor);
          most = worse(most, std::abs(bounce.coefficients.tm) * bounce.factor);
        }
        looks.right(bound.from(cosine) >= most * (1.0 - 1e-12));
        if (material.thickness_m > 0.0 || material.rf_absorbing) continue;
        // A half-space: the largest TE at the carriers' ends, at the cosine's step below.
        const double step = std::floor(256.0 * cosine) / 256.0;
        double te = 0.0;
        for (const double hz : {1.15e9, 1.62e9})
          te = worse(te, std::abs(fresnel(material.permittivity(hz), std::acos(step)).te));
        looks.near(bound.from(cosine),
                   te * roughness_factor(std::hypot(material.roughness_m, rough_m), step, kSpeedOfLight / 1.15e9),
                   1e-12);
      }
    }
  const auto sky = make_nominal_gps();
  const LocalFrame frame(Geodetic{0.5646, -1.586, 60.0});
  const GpsTime start = GpsTime::from_week_sow(1600, 3000.0);
  const Ball place{{200.0, -100.0, 5.0}, 150.0};
  const SkySpan span = sky_span(*sky, frame, start, start + 400.0, place, 0.1);
  looks.right(span.directions.size() > 40 && span.spread_rad < 0.01);
  // The lowest stands no lower than its own direction less the spread, or the mask as it is tilted over the place.
  double lowest_rad = 4.0;
  for (const auto& d : span.directions) lowest_rad = std::min(lowest_rad, std::asin(d.s_W.z()));
  looks.right(span.lowest_rad <= worse(lowest_rad, 0.1) && span.lowest_rad >= lowest_rad - span.spread_rad - 1e-4);
  for (const double mask : {0.3, 0.6, 1.0}) {
    const SkySpan above = sky_span(*sky, frame, start, start + 400.0, place, mask);
    lowest_rad = 4.0;
    for (const auto& d : above.directions) lowest_rad = std::min(lowest_rad, std::asin(d.s_W.z()));
    if (above.directions.empty()) lowest_rad = 0.5 * kPi;
    looks.right(above.lowest_rad >= mask - 1e-3 && above.lowest_rad >= lowest_rad - above.spread_rad - 1e-4);
    // From beyond the last direction on there is none.
    looks.right(!above.through(place, place, above.directions.size()));
  }
  for (int k = 0; k < 150; ++k) {
    const Vector3d off = 150.0 * Vector3d(draws.uniform(-1, 1, 0, k), draws.uniform(-1, 1, 1, k), 0.0) / std::sqrt(2.0);
    const Vector3d p_E = frame.to_E(place.center_W + off);
    const GpsTime t = start + draws.uniform(0, 400, 2, k);
    for (const SatelliteId sv : sky->satellites()) {
      const auto signal = transmission_to(*sky, sv, t, p_E);
      if (!signal) continue;
      const Vector3d s = frame.R_EW().transpose() * (signal->p_E() - p_E).normalized();
      if (s.z() < std::sin(0.1)) continue;
      double nearest = 4.0;
      for (const auto& d : span.directions)
        if (d.sv == sv) nearest = std::min(nearest, 2.0 * std::asin(0.5 * (d.s_W - s).norm()));
      looks.right(nearest <= span.spread_rad && std::asin(s.z()) >= span.lowest_rad);
    }
    const Ball from{{draws.uniform(-50, 50, 3, k), draws.uniform(-50, 50, 4, k), 0.0}, draws.uniform(0, 5, 5, k)},
        at{{draws.uniform(-200, 200, 6, k), draws.uniform(-200, 200, 7, k), draws.uniform(0, 300, 8, k)},
           draws.uniform(0, 20, 9, k)};
    const Vector3d v = at.center_W - from.center_W;
    const double reach = at.radius_m + from.radius_m;
    std::optional<std::size_t> expected;
    for (std::size_t i = 0; i < span.directions.size() && !expected; ++i) {
      const double turned = std::acos(std::min(1.0, v.normalized().dot(span.directions[i].s_W)));
      if (v.norm() <= reach || turned <= std::asin(reach / v.norm()) + span.spread_rad) expected = i;
    }
    looks.right(span.through(from, at) == expected);
  }
  // A box on a plain, from along a way: its top over the lower end, by the distance less half widths and half a square.
  const scene::Scene plain = plain_at(0.0, 24.0);
  const ObstacleHeights heights(plain);
  for (const double x : {-150.0, -40.0, 30.0}) {
    RouteSegment segment;
    segment.points_W = {{x, 40.0, 0.0}, {x + 10.0, 40.0, 0.0}};
    segment.low_m = 0.0, segment.half_width_m = 2.0;
    const double found = heights.horizon_rad(segment, 1.5, 1.0);
    // The box spans 90 to 110 by x; a square's circle has up to 4 sqrt 2 of 4 m squares.
    const double true_m = 90.0 - (x + 10.0) - 3.0;
    looks.right(found >= std::atan((24.0 - 1.5) / true_m) && found <= std::atan((24.0 - 1.5 + 0.01) / (true_m - 8.0)));
  }
  RouteSegment inside;
  inside.points_W = {{95.0, 40.0, 0.0}, {99.0, 40.0, 0.0}};
  looks.near(heights.horizon_rad(inside, 1.5, 1.0), 0.5 * kPi, 1e-15);
  return looks.figure();
}

/// What may happen at least on a piece of a route: asked of walls near and far, strong and weak, of crowns and of
/// houses that hide the sky; and then followed from many places of that piece, at many times. What is said not to be
/// needed must not be there: none of the ways that a search without it leaves out, to the bit; and where it is said to
/// be needed for a wall that mirrors a satellite onto the piece, it must be found somewhere.
struct NeedScene {
  scene::SceneParts parts;
  PathParameters limits;
  std::optional<bool> reflects;  ///< whether it is known to be needed, and found
};
NeedScene need_scene(int which) {
  NeedScene out;
  out.parts = level_ground("needs", 400.0, 0.0);
  scene::MeshBuilder mesh(out.parts);
  const auto wall = [&](double x_m, double half_m, double top_m, const char* material) {
    mesh.begin_object("wall", scene::ObjectKind::kWall);
    // Faces the east.
    mesh.quad({x_m, -half_m, 0}, {x_m, half_m, 0}, {x_m, half_m, top_m}, {x_m, -half_m, top_m},
              mesh.material(material));
  };
  if (which == 1) wall(-12.0, 60.0, 40.0, "metal"), out.reflects = true;
  // Of concrete not more than half of a field: below what is looked for, however it stands.
  if (which == 2)
    wall(-12.0, 60.0, 40.0, "metal"), out.limits.weakest_db = out.limits.weakest_nlos_db = 0.5, out.reflects = false;
  if (which == 3) wall(-150.0, 0.3, 1.2, "concrete"), out.reflects = false;
  if (which == 4) wall(-90.0, 8.0, 9.0, "concrete"), wall(-30.0, 2.0, 3.0, "metal");
  if (which == 5) {
    mesh.begin_object("box", scene::ObjectKind::kBuilding);
    mesh.box({-60.0, 20.0, 6.0}, Eigen::Matrix3d::Identity(), {9.0, 7.0, 6.0}, mesh.material("concrete"));
    out.parts.foliage.push_back({{-30.0, -25.0, 5.0}, {3.0, 3.0, 3.0}});
  }
  return out;
}

StressFigure followed(int which) {
  Looks looks;
  const RandomStream draws(6, "stress.needs");
  NeedScene made = need_scene(which);
  const scene::Scene city(std::move(made.parts));
  const scene::SceneAt at(city);
  const GpsTime start = GpsTime::from_week_sow(1600, 30000.0);
  const auto sky = make_nominal_gps();
  RouteSegment segment;
  segment.points_W = {{0.0, -4.0, 0.0}, {0.0, 4.0, 0.0}};
  segment.end_m = 8.0, segment.half_width_m = 1.0;
  const Ball place{Vector3d::Zero(), 8.0};
  constexpr double kMask = 0.17;
  const SkySpan span = sky_span(*sky, city.frame(), start, start + 900.0, place, kMask);
  const ObstacleHeights heights(city);
  PathQuestion question{.segment = segment,
                        .antenna_reach_m = 1.6,
                        .antenna_above_m = 1.2,
                        .scene = city,
                        .sky = span,
                        .heights = heights,
                        .limits = made.limits};
  std::vector<Need> needs = specular_needs(2, question);
  for (const Need& need : diffraction_needs(question)) needs.push_back(need);
  const PathOmissions omissions = omissions_of(needs);
  looks.right(needs.size() == 5);
  for (const Need& need : needs) looks.right(!need.reason.empty());
  if (which == 0)
    looks.right(omissions.occlusion && omissions.foliage && omissions.diffraction && omissions.most_reflections == 0);
  if (made.reflects) looks.right((omissions.most_reflections == 0) != *made.reflects);
  PathParameters less = made.limits;
  less.leave_out = omissions;
  const auto all_of =
      make_propagation(make_specular2(made.limits), make_double_knife_edge(made.limits), false, made.limits);
  const auto rest_of = omissions.diffraction
                           ? make_specular2(less)
                           : make_propagation(make_specular2(less), make_double_knife_edge(less), false, less);
  int reflected = 0;
  for (int k = 0; k < 120; ++k) {
    const Vector3d antenna(draws.uniform(-1, 1, 0, k), draws.uniform(-4, 4, 1, k), draws.uniform(1.2, 1.6, 2, k));
    const GpsTime t = start + draws.uniform(0.0, 900.0, 3, k);
    const Vector3d p_E = city.frame().to_E(antenna);
    std::vector<Vector3d> directions;
    for (const SatelliteId sv : sky->satellites()) {
      const auto signal = transmission_to(*sky, sv, t, p_E);
      if (!signal) continue;
      const Vector3d s = city.frame().R_EW().transpose() * (signal->p_E() - p_E).normalized();
      if (s.z() > std::sin(kMask)) directions.push_back(s);
    }
    std::vector<SignalPaths> all(directions.size()), rest(directions.size());
    GnssCounters all_counters, rest_counters;
    all_of->trace(antenna, PlaneWaves(directions), at, all, all_counters);
    rest_of->trace(antenna, PlaneWaves(directions), at, rest, rest_counters);
    looks.right(rest_counters.occlusion_rays <= all_counters.occlusion_rays);
    for (std::size_t i = 0; i < directions.size(); ++i) {
      looks.right(all[i].line_of_sight == rest[i].line_of_sight && all[i].foliage_m == rest[i].foliage_m &&
                  all[i].direct == rest[i].direct && all[i].echoes.size() == rest[i].echoes.size());
      for (const SignalPath& echo : all[i].echoes) reflected += echo.reflections > 0 ? 1 : 0;
      if (omissions.occlusion) looks.right(all[i].line_of_sight);
      if (omissions.foliage) looks.right(all[i].foliage_m == 0.0);
    }
  }
  if (made.reflects) looks.right((reflected > 0) == *made.reflects);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> need_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "what can be said before anything is received",
           .why = "a bound that is none, or so wide that nothing is ever left out",
           .expected = "above all that is, and no farther than its steps",
           .unit = "of the bound"});
  rows.add("needs/bounds", bounds);
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "what a piece of a route needs, and what is received there",
           .why = "a wall that mirrors is said not to, a weak one to be needed, a limit the wrong way round",
           .expected = "without what is not needed the same ways to the bit; what is needed is found",
           .unit = "of the bound"});
  constexpr const char* kPlaces[] = {"an_open_field", "a_mirror",      "a_mirror_too_weak",
                                     "a_small_wall",  "two_far_walls", "a_house_and_a_tree"};
  for (int which = 0; which < 6; ++which)
    rows.add(std::string("needs/beside_") + kPlaces[which], [which] { return followed(which); });
  return rows.take();
}

}  // namespace canyon::gnss
