// What the search for ways takes for sure without following it: rows of facets and waves, beams, skylines, bounds.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/paths/beam.h"
#include "canyon/gnss/paths/diffraction/wedge.h"
#include "canyon/gnss/paths/diffraction/wedge_bound.h"
#include "canyon/gnss/paths/path_model.h"
#include "canyon/gnss/paths/plane_waves.h"
#include "canyon/gnss/paths/rows/facet_rows.h"
#include "canyon/gnss/paths/rows/near_waves.h"
#include "canyon/gnss/paths/skyline.h"
#include "canyon/gnss/stress/subjects.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;
using scene::Facet;
using stress::Looks;

/// Boxes in all directions, turned and tilted, of all sizes.
std::unique_ptr<scene::Scene> strewn_boxes(std::uint64_t seed, int count, bool upright, double farthest_m = 120.0) {
  const RandomStream draws(seed, "stress.shortcuts");
  scene::SceneParts parts;
  parts.name = "strewn";
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::uint64_t>(i);
    mesh.begin_object("box " + std::to_string(i), scene::ObjectKind::kBuilding);
    const Vector3d half(draws.uniform(0.5, 6.0, 0, k), draws.uniform(0.5, 6.0, 1, k), draws.uniform(0.5, 9.0, 2, k));
    const Eigen::Matrix3d turn = (AngleAxisd(draws.uniform(0, 6.2, 3, k), Vector3d::UnitZ()) *
                                  AngleAxisd(upright ? 0.0 : draws.uniform(-0.6, 0.6, 4, k), Vector3d::UnitX()))
                                     .toRotationMatrix();
    const double away_m = draws.uniform(12.0, farthest_m, 5, k), bearing = draws.uniform(0, 6.2832, 6, k);
    mesh.box({away_m * std::cos(bearing), away_m * std::sin(bearing), draws.uniform(-3.0, 12.0, 7, k)}, turn, half,
             mesh.material(i % 3 == 0 ? "metal" : "concrete"));
  }
  return std::make_unique<scene::Scene>(std::move(parts));
}

/// Every pair of an axis and a wave by their product in double precision: all that reach it, none that lack more than
/// the stated share of the axis's length, twice taken off by single precision; by axis and then by wave.
StressFigure near_waves() {
  int wrong = 0;
  const RandomStream draws(1, "stress.shortcuts");
  for (const int waves : {1, 7, 8, 37})
    for (const int count : {1, 63, 64, 65, 200}) {
      std::vector<Vector3d> sky;
      for (int i = 0; i < waves; ++i) sky.push_back(draws.direction(20, static_cast<std::uint64_t>(100 * waves + i)));
      WaveAxes axes;
      std::vector<Vector3d> axis;
      std::vector<double> least;
      axes.resize(5), axes.clear();
      for (int i = 0; i < count; ++i) {
        const auto k = static_cast<std::uint64_t>(i);
        const double length = draws.uniform(0.3, 40.0, 21, k);
        axis.push_back(length * draws.direction(22, k));
        least.push_back(length * draws.uniform(-0.2, 1.0, 23, k));
        axes.add(axis.back(), length, least.back());
      }
      wrong += axes.size() == static_cast<std::size_t>(count) ? 0 : 1;
      NearWaves near;
      near.fill(sky);
      std::vector<AxisAndWave> found{{7, 7}};
      near.find(axes, found);
      std::size_t at = 0;
      for (std::uint32_t a = 0; a < axis.size(); ++a)
        for (std::uint32_t w = 0; w < sky.size(); ++w) {
          const double more = axis[a].dot(sky[w]) - least[a], slack = 2.0 * WaveAxes::kRounding * axis[a].norm();
          const bool is = at < found.size() && found[at].axis == a && found[at].wave == w;
          wrong += is ? (more >= -slack ? 0 : 1) : (more >= 0.0 ? 1 : 0);
          at += is ? 1 : 0;
        }
      wrong += at == found.size() ? 0 : 1;
    }
  return {1.0 * wrong, 0.0};
}

/// Facets that may be met through a window, one by one in double precision: in front of the window's plane, within its
/// four sides, facing the apex, each with the ball's radius and a centimetre of slack; and half a millimetre either way
/// for single precision at 150 m.
StressFigure facets_through_windows() {
  int wrong = 0;
  std::size_t met_ones = 0;
  const auto boxes = strewn_boxes(2, 70, false);
  const auto& facets = boxes->facets().facets();
  FacetRows rows;
  // Not all of them, and no whole number of rows.
  for (std::uint32_t i = 0; i < facets.size(); ++i)
    if (i % 7 != 3) rows.ids.push_back(i);
  rows.fill(facets);
  for (std::uint32_t w = 0; w < facets.size(); w += 5) {
    const Facet& window = facets[w];
    const Vector3d antenna(1.0, -2.0, 1.5);
    const double to_plane = window.normal_W.dot(antenna) - window.offset_m;
    if (to_plane <= 0.0) continue;
    const Vector3d apex = antenna - 2.0 * to_plane * window.normal_W;
    std::vector<std::uint32_t> found{1, 2, 3};
    rows.meet(window, Beam(apex, window), found);
    met_ones += found.size();
    std::size_t at = 0;
    for (const std::uint32_t id : rows.ids) {
      const Facet& f = facets[id];
      double room = f.normal_W.dot(apex) - f.offset_m;
      room = std::min(room, window.normal_W.dot(f.center_W) - window.offset_m + f.radius_m);
      for (std::size_t k = 0; k < 4; ++k) {
        // Sides by the rectangle's corners, inward where its middle lies.
        const Vector3d a = window.rectangle_W[k] - apex, b = window.rectangle_W[(k + 1) % 4] - apex;
        Vector3d n = a.cross(b).normalized();
        if (n.dot(window.rectangle_W[(k + 2) % 4] - apex) < 0.0) n = -n;
        room = std::min(room, n.dot(f.center_W - apex) + f.radius_m);
      }
      const bool is = at < found.size() && found[at] == id;
      wrong += is ? (room + 0.01 > -5e-4 ? 0 : 1) : (room + 0.01 > 5e-4 ? 1 : 0);
      at += is ? 1 : 0;
    }
    wrong += at == found.size() ? 0 : 1;
  }
  wrong += met_ones > 200 ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

/// Points of the pyramid through a rectangle are in the beam, points beside it are not, and a ball is as far as it
/// reaches over.
StressFigure beams() {
  int wrong = 0;
  const RandomStream draws(3, "stress.shortcuts");
  const auto boxes = strewn_boxes(4, 12, false);
  std::uint64_t k = 0;
  for (const Facet& f : boxes->facets().facets()) {
    ++k;
    const Vector3d apex = f.center_W - draws.uniform(3.0, 60.0, 30, k) * f.normal_W + 2.0 * draws.direction(31, k);
    const Beam beam(apex, f);
    wrong += beam.apex_W == apex ? 0 : 1;
    for (int i = 0; i < 40; ++i) {
      const double u = draws.uniform(-0.5, 1.5, 32, 64 * k + static_cast<std::uint64_t>(i)),
                   v = draws.uniform(-0.5, 1.5, 33, 64 * k + static_cast<std::uint64_t>(i)),
                   far = draws.uniform(0.2, 5.0, 34, 64 * k + static_cast<std::uint64_t>(i));
      const auto& c = f.rectangle_W;
      const Vector3d point = apex + far * (c[0] + u * (c[1] - c[0]) + v * (c[3] - c[0]) - apex);
      const bool inside = u > 0.0 && u < 1.0 && v > 0.0 && v < 1.0;
      wrong += beam.may_meet(point, 0.0) == inside ? 0 : 1;
      double beyond_m = 0.0;
      for (const Vector3d& n : beam.inward_W) {
        wrong += std::abs(n.norm() - 1.0) < 1e-12 ? 0 : 1;
        beyond_m = worse(beyond_m, -n.dot(point - apex));
      }
      wrong +=
          beam.may_meet(point, 1.001 * beyond_m + 1e-9) && (inside || !beam.may_meet(point, 0.999 * beyond_m)) ? 0 : 1;
    }
  }
  return {1.0 * wrong, 0.0};
}

/// Does the straight line between two points pass through the rectangle?
bool cut(const Facet& wall, const Vector3d& a, const Vector3d& b) {
  const double from = wall.normal_W.dot(a) - wall.offset_m, to = wall.normal_W.dot(b) - wall.offset_m;
  if (from * to >= 0.0) return false;
  const Vector3d point = a + from / (from - to) * (b - a);
  const auto& c = wall.rectangle_W;
  const Vector3d u = c[1] - c[0], v = c[3] - c[0];
  const double x = (point - c[0]).dot(u) / u.squaredNorm(), y = (point - c[0]).dot(v) / v.squaredNorm();
  return x > 0.0 && x < 1.0 && y > 0.0 && y < 1.0;
}

/// What a skyline hides is hidden: every line to 25 points of it passes a wall.
StressFigure skylines(std::uint64_t seed) {
  int wrong = 0;
  std::size_t hidden = 0;
  const auto boxes = strewn_boxes(seed, 130, true);
  const auto& facets = boxes->facets().facets();
  std::vector<std::uint32_t> walls;
  for (std::uint32_t i = 0; i < facets.size(); ++i)
    if (i % 4 != 1) walls.push_back(i);
  for (const Vector3d& p : {Vector3d(0.3, -0.2, 1.5), Vector3d(-6.0, 5.0, 9.0), Vector3d(3.0, 4.0, -2.0)}) {
    const Skyline skyline(p, facets, walls);
    for (const Facet& f : facets) {
      if (!skyline.hides(f)) continue;
      ++hidden;
      const auto& c = f.rectangle_W;
      for (int i = 0; i <= 4; ++i)
        for (int j = 0; j <= 4; ++j) {
          const Vector3d q = c[0] + 0.25 * i * (c[1] - c[0]) + 0.25 * j * (c[3] - c[0]);
          const auto passes = [&](std::uint32_t w) { return cut(facets[w], p, q); };
          wrong += std::any_of(walls.begin(), walls.end(), passes) ? 0 : 1;
        }
    }
  }
  wrong += hidden > 30 ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

/// One wall about the antenna at every bearing, and a small box far behind its middle: hidden; one beside it, above it
/// or before it is not.
StressFigure behind_one_wall() {
  int wrong = 0;
  for (int k = 0; k < 48; ++k) {
    const double bearing = kPi / 24.0 * k + 0.01;
    const AngleAxisd turn(bearing, Vector3d::UnitZ());
    scene::SceneParts parts;
    parts.name = "one wall";
    parts.materials = scene::builtin_materials();
    scene::MeshBuilder mesh(parts);
    const Vector3d p(2.0, -1.0, 1.5);
    const auto at = [&](double x, double y, double z) { return Vector3d(p + turn * Vector3d(x, y, z)); };
    mesh.begin_object("wall", scene::ObjectKind::kWall);
    const double tilt = 3.0 * std::sin(0.7 * k);  // not square to the way there
    mesh.quad(at(10 + tilt, 8, -1.2), at(10 - tilt, -8, -1.2), at(10 - tilt, -8, 6), at(10 + tilt, 8, 6),
              mesh.material("metal"));
    struct Behind {
      Vector3d at;
      bool hidden;
    };
    const Behind boxes[] = {{{30, 0, 1}, true},  {{30, 14, 1}, true},  {{30, -14, 1}, true},  {{60, 20, 3}, true},
                            {{30, 0, 14}, true}, {{30, 0, 21}, false}, {{30, 35, 1}, false},  {{30, -35, 1}, false},
                            {{5, 0, 0}, false},  {{-30, 0, 1}, false}, {{0.5, 30, 1}, false}, {{30, 0, -6}, false}};
    for (const Behind& b : boxes) {
      mesh.begin_object("box", scene::ObjectKind::kBuilding);
      mesh.box(at(b.at.x(), b.at.y(), b.at.z()), turn.toRotationMatrix(), Vector3d::Constant(0.4),
               mesh.material("metal"));
    }
    const scene::Scene scene(std::move(parts));
    const auto& facets = scene.facets().facets();
    std::vector<std::uint32_t> wall;
    for (std::uint32_t i = 0; i < facets.size(); ++i)
      if (facets[i].object == 0) wall.push_back(i);
    const Skyline skyline(p, facets, wall);
    for (const Facet& f : facets)
      if (f.object > 0) wrong += skyline.hides(f) == boxes[f.object - 1].hidden ? 0 : 1;
    for (const std::uint32_t i : wall) wrong += skyline.hides(facets[i]) ? 1 : 0;
    // Only upright rectangles hide, and those that are worth it.
    std::vector<Facet> other = {facets[wall[0]], facets[wall[0]], facets[wall[0]]};
    other[0].fills_rectangle = false;
    other[1].normal_W.z() = 0.01;
    other[2].area_m2 = 1e-5;
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::vector<std::uint32_t> one{i};
      const Skyline none(p, other, one);
      for (const Facet& f : facets) wrong += none.hides(f) ? 1 : 0;
    }
  }
  return {1.0 * wrong, 0.0};
}

/// Bounds of an edge's parts and of wedges' fields: never below what they bound, and over draws of all places not above
/// it by more than a few times, in the middle of them.
StressFigure bounds_of_wedges() {
  int wrong = 0;
  const RandomStream draws(5, "stress.shortcuts");
  std::vector<double> room, field_room;
  for (std::uint64_t k = 0; k < 3000; ++k) {
    const double nu = std::pow(10.0, draws.uniform(-3.0, 1.2, 40, k)), u = draws.uniform(-20.0, 20.0, 41, k),
                 length = std::pow(10.0, draws.uniform(-2.0, 1.5, 42, k));
    const double most = largest_finite_edge_factor(nu, u, u + length),
                 is = std::abs(finite_edge_factor(nu, u, u + length));
    wrong += most >= is ? 0 : 1;
    // Beside the 1e-3 that is added.
    if (is > 0.02) room.push_back(most / is);
    WedgeWay way;
    way.n = draws.uniform(1.1, 1.95, 43, k);
    way.phi_in_rad = way.n * kPi * draws.uniform(44, k), way.phi_out_rad = way.n * kPi * draws.uniform(45, k);
    way.sine_beta = draws.uniform(0.1, 1.0, 46, k), way.distance_m = std::pow(10.0, draws.uniform(0.0, 2.5, 47, k));
    way.wavelength_m = draws.uniform(0.18, 0.26, 48, k);
    const std::complex<double> one = std::polar(draws.uniform(49, k), 6.3 * draws.uniform(50, k)),
                               two = std::polar(draws.uniform(51, k), 6.3 * draws.uniform(52, k));
    const double largest = largest_wedge_field(way);
    for (const auto& [first, second] : {std::pair{one, two},
                                        {std::complex<double>(1.0), std::complex<double>(1.0)},
                                        {std::complex<double>(-1.0), std::complex<double>(-1.0)}}) {
      const double field = std::abs(WedgeBorders(way).field(first, second));
      wrong += largest >= field ? 0 : 1;
      if (first.real() == -1.0) field_room.push_back(largest / field);
    }
  }
  const auto middle = [](std::vector<double> x) {
    std::nth_element(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2), x.end());
    return x[x.size() / 2];
  };
  wrong += room.size() > 300 && middle(room) < 2.0 && middle(field_room) < 5.0 ? 0 : 1;
  wrong +=
      largest_finite_edge_factor(0.0, -1.0, 1.0) <= 1.01 && largest_finite_edge_factor(1e-9, 5.0, 6.0) <= 1.01 ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

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

/// Of waves each at its own carrier, their lengths and the extremes of them.
StressFigure carriers_of_waves() {
  Looks looks;
  const std::vector<Vector3d> sky{Vector3d::UnitZ(), Vector3d::UnitX(), Vector3d::UnitY()};
  const std::vector<double> hz{1227.6e6, 1602e6, 1176.45e6};
  const PlaneWaves waves(sky, hz);
  for (std::size_t i = 0; i < 3; ++i) {
    looks.close(waves.wavelength_m(i), 299792458.0 / hz[i], 4.0);
    looks.right(waves.carrier_hz(i) == hz[i] && waves.direction_W(i) == sky[i]);
  }
  looks.close(waves.shortest_wavelength_m(), 299792458.0 / 1602e6, 4.0);
  looks.close(waves.longest_wavelength_m(), 299792458.0 / 1176.45e6, 4.0);
  looks.right(waves.at(GpsTime{77}).t().ns == 77 && waves.at(GpsTime{77}).carrier_hz(1) == hz[1]);
  const PlaneWaves plain(sky);
  looks.close(plain.shortest_wavelength_m(), 0.190293672798, 1e4);
  looks.close(plain.longest_wavelength_m(), 0.190293672798, 1e4);
  const std::vector<double> bad{1e9, 0.0, 1e9}, few{1e9, 1e9};
  looks.right(stress::not_refused([&] { return PlaneWaves(sky, bad); }) == 0);
  looks.right(stress::not_refused([&] { return PlaneWaves(sky, few); }) == 0);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> shortcut_cases() {
  StressRows rows;
  const auto group = StressGroup::kGeometry;
  rows.of({group, "rows of waves and facets that are looked at together",
           "a row that is not filled up, slack that is taken off, a side of another facet's",
           "each by itself in double precision, to the stated slack: exact", "wrong"});
  rows.add("shortcuts/near_waves", near_waves)
      .add("shortcuts/facets_through_windows", facets_through_windows)
      .add("shortcuts/beams", beams);
  rows.of({group, "walls that hide what stands behind them",
           "a sector beside the wall's, a top as low as the far end's",
           "every line to what is hidden passes a wall, and what stands far behind one is hidden", "wrong"});
  for (const std::uint64_t seed : {6U, 7U})
    rows.add("shortcuts/skyline_" + std::to_string(seed), [seed] { return skylines(seed); });
  rows.add("shortcuts/behind_one_wall", behind_one_wall);
  rows.of({group, "ways that are left out, and rays for images",
           "a limit off by one, a wall's reflection in the other's turn",
           "the same ways without those that are left out; fields of rays as images have them", "of the bound"});
  rows.add("shortcuts/left_out", left_out).add("shortcuts/launched_fields", launched_fields);
  rows.of({group, "bounds of what wedges and parts of edges make",
           "a bound that is none, or so wide that it tells nothing",
           "above what they bound, by less than a few times in the middle", "wrong"});
  rows.add("shortcuts/bounds_of_wedges", bounds_of_wedges);
  rows.of({group, "carriers of waves", "the longest wave for the shortest",
           "speed of light over the carrier: roundings", "of the bound"});
  rows.add("shortcuts/carriers_of_waves", carriers_of_waves);
  return rows.take();
}

}  // namespace canyon::gnss
