// Ways over one edge, two in turn and past one to another, in scenes of sheets and boxes, against plane geometry.
#include <array>
#include <cmath>
#include <complex>
#include <memory>
#include <optional>
#include <vector>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/paths/bounce.h"
#include "canyon/gnss/paths/diffraction/diffraction.h"
#include "canyon/gnss/paths/diffraction/edge_air.h"
#include "canyon/gnss/paths/diffraction/knife_edge.h"
#include "canyon/gnss/paths/diffraction/wedge.h"
#include "canyon/gnss/paths/propagation.h"
#include "canyon/gnss/stress/subjects.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using stress::Looks;
using EdgeField = std::complex<double>;

constexpr double kEdgeWave_m = kL1WavelengthM;

scene::SceneParts bare_parts() {
  scene::SceneParts parts;
  parts.name = "edges";
  parts.materials = scene::builtin_materials();
  return parts;
}

/// An upright sheet across the plane y = 0, its border far away but for its top.
void add_sheet(scene::SceneParts& parts, double x_m, double top_m) {
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("sheet " + std::to_string(parts.objects.size()), scene::ObjectKind::kWall);
  mesh.quad({x_m, 256, -256}, {x_m, -256, -256}, {x_m, -256, top_m}, {x_m, 256, top_m}, mesh.material("metal"));
}

SignalPaths paths_about(std::unique_ptr<DiffractionModel> (*make)(const PathParameters&), const PathParameters& p,
                        const scene::Scene& scene, const Vector3d& s) {
  const std::vector<Vector3d> sky{s};
  std::vector<SignalPaths> out(1);
  GnssCounters counters;
  const scene::SceneAt at(scene);
  make_visibility(p)->trace(Vector3d::Zero(), PlaneWaves(sky), at, out, counters);
  make(p)->trace(Vector3d::Zero(), PlaneWaves(sky), at, out, counters);
  return out[0];
}

/// In the plane: what a way from `from` over `at` towards s is longer than straight on, and the same between points.
double longer(const Vector2d& from, const Vector2d& at, const Vector2d& s) {
  const Vector2d way = at - from;
  const double forward = way.dot(s);
  return std::pow(way.x() * s.y() - way.y() * s.x(), 2) / (way.norm() + forward);
}

EdgeField dark(double detour_m) {
  return knife_edge_field(2.0 * std::sqrt(detour_m / kEdgeWave_m));
}
EdgeField lit(double detour_m) {
  return knife_edge_field(-2.0 * std::sqrt(detour_m / kEdgeWave_m));
}

struct TwoSheets {
  Vector2d near, far;  // their tops
  double elevation_rad;
};

/// What the way of a wave over two sheets is by the recommendation that the model names: nullopt for no way.
struct OverSheets {
  EdgeField direct = 1.0;
  std::optional<EdgeField> echo;
  double excess_m = 0.0;
  int edges = 0;
  Vector2d arrival = Vector2d::Zero();
  double margin = 1.0;  // how far it is from being another case, rad
};
OverSheets by_plane_geometry(const TwoSheets& t) {
  const Vector2d s(std::cos(t.elevation_rad), std::sin(t.elevation_rad)), p = Vector2d::Zero();
  const auto rise = [](const Vector2d& v) { return std::atan2(v.y(), v.x()); };
  const double up_near = rise(t.near), up_far = rise(t.far), between = rise(t.far - t.near);
  const Vector2d near_out = t.near + Vector2d(0.0, kOffEdge_m), far_out = t.far + Vector2d(0.0, kOffEdge_m);
  OverSheets out;
  out.margin = std::min({std::abs(up_near - up_far), std::abs(up_near - t.elevation_rad),
                         std::abs(up_far - t.elevation_rad), std::abs(between - t.elevation_rad)});
  if (t.elevation_rad > worse(up_near, up_far)) {
    // The nearest of those whose way is not cut off by the other.
    double nearest = kDeepestLitNu;
    const auto look = [&](const Vector2d& top, bool cut_off) {
      const double nu = 2.0 * std::sqrt(longer(p, top, s) / kEdgeWave_m);
      if (cut_off || nu >= nearest) return;
      nearest = nu;
      out.direct = knife_edge_field(-nu);
    };
    look(t.near, between > t.elevation_rad);
    look(t.far, up_near > up_far);
    return out;
  }
  if (up_far > up_near) {
    out.excess_m = longer(p, t.far, s);
    out.edges = 1;
    EdgeField beside = 1.0;
    const double past_m = (t.far - t.near).norm() + t.near.norm() - t.far.norm();
    if (2.0 * std::sqrt(past_m / kEdgeWave_m) < kDeepestLitNu) beside = lit(past_m);
    out.echo = dark(out.excess_m) * beside;
    out.arrival = far_out.normalized();
    return out;
  }
  out.arrival = near_out.normalized();
  if (between < t.elevation_rad) {
    out.excess_m = longer(p, t.near, s);
    out.edges = 1;
    out.echo = dark(out.excess_m);
    return out;
  }
  // The second leg begins where the first edge's way is led outside of it.
  const double far_m = longer(near_out, t.far, s), near_m = (t.far - t.near).norm() + t.near.norm() - t.far.norm();
  const EdgeField first = dark(near_m), second = dark(far_m);
  out.excess_m = far_m + near_m;
  out.edges = 2;
  out.echo = first * second;
  const double deep = std::pow(10.0, -15.0 / 20.0), apart_m = (t.far - near_out).norm();
  if (std::abs(first) < deep && std::abs(second) < deep) *out.echo *= std::sqrt(apart_m / (apart_m + t.near.norm()));
  return out;
}

/// Sheets of many heights and distances and a wave of any elevation beside them: the ways, their fields, phases and
/// directions as plane geometry says. Tops are exact numbers of single precision; detours are small
/// differences of ways of 60 m, eight roundings, of which a field's slope, steep beside a border, makes a hundred
/// times.
StressFigure sheets_in_turn(std::uint64_t seed) {
  Looks looks;
  const RandomStream draws(seed, "stress.edges");
  PathParameters p;
  p.weakest_db = p.weakest_nlos_db = -34.0;
  const double weakest = std::pow(10.0, p.weakest_nlos_db / 20.0),
               reach_m = largest_detour_m(largest_knife_edge_nu(p.weakest_nlos_db), kEdgeWave_m);
  std::array<int, 3> found{};
  int lit_ones = 0;
  for (std::uint64_t k = 0; k < 260; ++k) {
    TwoSheets t;
    t.near.x() = std::round(8.0 * draws.uniform(4.0, 20.0, 0, k)) / 8.0;
    t.far.x() = t.near.x() + std::round(8.0 * draws.uniform(1.0, 40.0, 1, k)) / 8.0;
    t.elevation_rad = draws.uniform(0.15, 1.0, 2, k);
    const auto top = [&](double x, int entity) {
      const double angle = std::clamp(t.elevation_rad + draws.uniform(-0.12, 0.12, entity, k), 0.05, 1.2);
      return std::round(256.0 * x * std::tan(angle)) / 256.0;
    };
    t.near.y() = top(t.near.x(), 3), t.far.y() = top(t.far.x(), 4);
    const OverSheets expected = by_plane_geometry(t);
    // Ways that pass 3 cm outside of an edge: what is this near to another case may be of that one.
    if (expected.margin < 0.02) continue;
    if (expected.echo && std::abs(std::abs(*expected.echo) / weakest - 1.0) < 0.02) continue;
    if (expected.excess_m > 0.98 * reach_m) continue;
    scene::SceneParts parts = bare_parts();
    add_sheet(parts, t.near.x(), t.near.y());
    add_sheet(parts, t.far.x(), t.far.y());
    const scene::Scene scene(std::move(parts));
    const Vector3d s(std::cos(t.elevation_rad), 0.0, std::sin(t.elevation_rad));
    const SignalPaths paths = paths_about(make_double_knife_edge, p, scene, s);
    const bool followed = expected.echo && std::abs(*expected.echo) > weakest;
    looks.right(paths.echoes.size() == (followed ? 1U : 0U) && paths.line_of_sight == !expected.echo);
    if (paths.line_of_sight) looks.near(std::abs(paths.direct - expected.direct), 0.0, 1e-11);
    lit_ones += expected.direct != 1.0 ? 1 : 0;
    if (!followed || paths.echoes.size() != 1) continue;
    const SignalPath& echo = paths.echoes[0];
    looks.right(echo.diffractions == expected.edges && echo.reflections == 0);
    looks.near(echo.excess_m, expected.excess_m, 8.0 * stress::kEpsilon * 60.0);
    const EdgeField copolar = *expected.echo * std::polar(1.0, 2.0 * kPi * expected.excess_m / kEdgeWave_m);
    looks.near(std::abs(echo.copolar - copolar), 0.0, 1e-11);
    looks.near(std::abs(echo.crosspolar), 0.0, 1e-300);
    looks.near((echo.arrival_W - Vector3d(expected.arrival.x(), 0.0, expected.arrival.y())).norm(), 0.0,
               16.0 * stress::kEpsilon);
    ++found[static_cast<std::size_t>(expected.edges)];
  }
  looks.right(found[1] > 20 && found[2] > 5 && lit_ones > 5);
  return looks.figure();
}

/// The roof of a box of a house's materials: the field of a wedge of a right angle with angles from its top face, both
/// polarizations, at every elevation beside its shadow; with any limit of weakness it fades to none within 3.5 dB of
/// it. Corners are exact numbers; the end's factor of an edge of 512 m states 1e-3.
StressFigure roof(const char* material, double distance_m) {
  Looks looks;
  const double top_m = 0.75 * distance_m;
  scene::SceneParts parts = bare_parts();
  {
    scene::MeshBuilder mesh(parts);
    mesh.begin_object("house", scene::ObjectKind::kBuilding);
    mesh.box({distance_m + 128.0, 0.0, top_m - 128.0}, Eigen::Matrix3d::Identity(), {128.0, 256.0, 128.0},
             mesh.material(material));
  }
  const scene::Scene scene(std::move(parts));
  const scene::Material& of = scene.materials()[scene.edges().edges().front().material_1];
  PathParameters p;
  p.weakest_db = p.weakest_nlos_db = -36.0;
  const double weakest = std::pow(10.0, -36.0 / 20.0), border = std::atan2(top_m, distance_m);
  int ways = 0;
  for (int k = -30; k <= 30; ++k) {
    const double elevation = border + 0.011 * k + 0.003;
    const Vector3d s(std::cos(elevation), 0.0, std::sin(elevation));
    const SignalPaths paths = paths_about(make_wedge, p, scene, s);
    looks.right(paths.line_of_sight == (elevation > border) && paths.direct == (elevation > border ? 1.0 : 0.0));
    const double reach_m = std::hypot(distance_m, top_m);
    const double detour_m = longer(Vector2d::Zero(), {distance_m, top_m}, {s.x(), s.z()});
    const double grazing = 0.5 * std::abs(elevation - border);
    const Vector3d in(std::cos(grazing), 0.0, -std::sin(grazing));
    const Fresnel mirror = bounce_off(of, in, Vector3d::UnitZ(), 0.0, kL1Hz).coefficients;
    // From the top face round through the air: the wave stands at its elevation, the antenna beyond half a turn.
    const WedgeBorders borders({1.5, elevation, kPi + border, 1.0, reach_m, kEdgeWave_m});
    const EdgeField soft = borders.field(mirror.te, mirror.te), hard = borders.field(mirror.tm, mirror.tm);
    const EdgeField copolar = 0.5 * (soft + hard), crosspolar = 0.5 * (hard - soft);
    const double amplitude = std::hypot(std::abs(copolar), std::abs(crosspolar));
    const double kept = std::clamp(2.0 * (amplitude / weakest - 1.0), 0.0, 1.0);
    if (kept == 0.0 && amplitude > 0.99 * weakest) continue;
    looks.right(paths.echoes.size() == (kept > 0.0 ? 1U : 0U));
    if (paths.echoes.size() != 1) continue;
    const SignalPath& echo = paths.echoes[0];
    // 1e-3 of the field, and where it fades twice that over the weakest.
    const double bound = 1e-3 * amplitude * (kept < 1.0 ? 1.0 + 2.0 * amplitude / weakest : 1.0) + 1e-9;
    looks.near(std::abs(echo.copolar - kept * copolar), 0.0, bound);
    looks.near(std::abs(echo.crosspolar - kept * crosspolar), 0.0, bound);
    looks.near(echo.excess_m, detour_m, 1e-9);
    looks.right(echo.diffractions == 1);
    ++ways;
  }
  looks.right(ways > 20);
  return looks.figure();
}

/// Where a way from p over the edge's line towards s is the shortest, by bisection over 4 km of it; as far
/// along from its first end, and how much longer than straight on.
struct ShortestWay {
  double at_m = 0.0, longer_m = 0.0;
  Vector3d point_W;
};
ShortestWay shortest_over(const scene::Edge& edge, const Vector3d& p_W, const Vector3d& s) {
  const Vector3d along = (edge.b_W - edge.a_W).normalized();
  const auto slope = [&](double x) {
    const Vector3d way = edge.a_W + x * along - p_W;
    return way.normalized().dot(along) - s.dot(along);  // of the length that is to be least: it grows with x
  };
  double low = -2000.0, high = 2000.0;
  for (int k = 0; k < 80; ++k) {
    const double middle = 0.5 * (low + high);
    (slope(middle) < 0.0 ? low : high) = middle;
  }
  ShortestWay out;
  out.at_m = 0.5 * (low + high);
  out.point_W = edge.a_W + out.at_m * along;
  const Vector3d way = out.point_W - p_W;
  out.longer_m = way.cross(s).squaredNorm() / (way.norm() + way.dot(s));
  return out;
}

/// About an edge, from its first face through the air to a direction across it; the solid's side is beyond n pi.
double through_the_air(const scene::Edge& edge, const Vector3d& towards_W, double n) {
  const Vector3d along = (edge.b_W - edge.a_W).normalized();
  // In the face, away from the edge: across its normal, to where the other face's outside is behind.
  Vector3d in_face = along.cross(edge.normal_1_W);
  if (in_face.dot(edge.outward_W) > 0.0) in_face = -in_face;
  const double angle = std::atan2(towards_W.dot(edge.normal_1_W), towards_W.dot(in_face));
  const double turned = angle < 0.0 ? angle + 2.0 * kPi : angle;
  return turned > n * kPi ? (turned - n * kPi < 2.0 * kPi - turned ? n * kPi : 0.0) : turned;
}

/// Over boxes of all bearings strewn about the antenna, one edge at a time and each by itself: the point by bisection,
/// what hides its two legs by rays, its field by its detour or as a wedge of its faces; a lit way has the nearest
/// edge's field. Points to 1e-12 of 4 km: detours to 1e-10 of a wave; of pieces of wedges the stated 1e-3.
StressFigure strewn_edges(std::uint64_t seed, bool wedges) {
  Looks looks;
  const RandomStream draws(seed, "stress.strewn_edges");
  scene::SceneParts parts = bare_parts();
  scene::MeshBuilder mesh(parts);
  for (std::uint64_t k = 0; k < 26; ++k) {
    mesh.begin_object("box " + std::to_string(k), scene::ObjectKind::kBuilding);
    const double away = 9.0 + 1.7 * static_cast<double>(k), bearing = 2.4 * static_cast<double>(k),
                 half = draws.uniform(2, 9, 0, k);
    mesh.box({away * std::cos(bearing), away * std::sin(bearing), half - 3.0},
             Eigen::AngleAxisd(draws.uniform(0, 3, 1, k), Vector3d::UnitZ()).toRotationMatrix(),
             {draws.uniform(1, 3, 2, k), draws.uniform(1, 3, 3, k), half},
             mesh.material(k % 2 == 0 ? "concrete" : "glass"));
  }
  parts.foliage.push_back({{3.0, 3.0, 4.0}, {2.0, 2.0, 2.5}});
  const scene::Scene scene(std::move(parts));
  const scene::SceneAt at(scene);
  PathParameters p;
  p.weakest_db = p.weakest_nlos_db = -26.0;
  const double weakest = std::pow(10.0, -26.0 / 20.0);
  const double reach_m = largest_detour_m(largest_knife_edge_nu(wedges ? -26.0 - kOverScreen_db : -26.0), kEdgeWave_m);
  std::vector<Vector3d> sky;
  for (int k = 0; k < 160; ++k) {
    const double e = 0.1 + 1.1 * std::fmod(0.618 * k, 1.0), a = 2.4 * k + 0.3;
    sky.emplace_back(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
  }
  std::vector<SignalPaths> found(sky.size());
  GnssCounters counters;
  make_visibility(p)->trace(Vector3d::Zero(), PlaneWaves(sky), at, found, counters);
  (wedges ? make_wedge(p) : make_knife_edge(p))->trace(Vector3d::Zero(), PlaneWaves(sky), at, found, counters);
  int echoes = 0, lit_ones = 0;
  for (std::size_t k = 0; k < sky.size(); ++k) {
    const Vector3d& s = sky[k];
    const bool clear = !at.blocked_towards(Vector3d::Zero(), s);
    looks.right(found[k].line_of_sight == clear);
    std::vector<SignalPath> expected;
    std::vector<bool> sure;  // not beside a border of being there
    double nearest = kDeepestLitNu;
    EdgeField direct = clear ? 1.0 : 0.0;
    for (const scene::Edge& edge : scene.edges().edges()) {
      if (edge.normal_1_W.dot(s) * edge.normal_2_W.dot(s) >= 0.0) continue;
      const ShortestWay way = shortest_over(edge, Vector3d::Zero(), s);
      const double length_m = (edge.b_W - edge.a_W).norm(), forward_m = way.point_W.dot(s);
      if (forward_m <= 0.0 || way.longer_m > reach_m) continue;
      const bool within = way.at_m >= 0.0 && way.at_m <= length_m;
      if (!wedges && !within) continue;
      const Vector3d point = edge.a_W + std::clamp(way.at_m, 0.0, length_m) / length_m * (edge.b_W - edge.a_W);
      const Vector3d out_W = point + 0.03 * edge.outward_W;
      const bool open = !at.blocked_towards(out_W, s) &&
                        !at.blocked_towards(Vector3d::Zero(), out_W.normalized(), out_W.norm()) &&
                        ends_in_air(edge, point, at);
      if (!open) continue;
      const double nu = 2.0 * std::sqrt(way.longer_m / kEdgeWave_m);
      SignalPath path;
      path.excess_m = way.longer_m, path.arrival_W = out_W.normalized(), path.diffractions = 1;
      path.foliage_m = at.foliage_m(out_W, s) + at.foliage_m(Vector3d::Zero(), path.arrival_W, out_W.norm());
      if (!wedges) {
        const bool shadow = (way.point_W - forward_m * s).dot(edge.outward_W) > 0.0;
        if (shadow == clear) continue;
        if (clear) {
          if (nu < nearest) nearest = nu, direct = knife_edge_field(-nu);
          continue;
        }
        path.copolar = knife_edge_field(nu) * std::polar(1.0, 2.0 * kPi * way.longer_m / kEdgeWave_m);
        if (std::abs(path.copolar) < weakest) continue;
        sure.push_back(std::abs(path.copolar) > 1.0001 * weakest);
      } else {
        WedgeWay w;
        const Vector3d along = (edge.b_W - edge.a_W) / length_m, from_W = edge.a_W + way.at_m * along;
        w.n = 1.0 + std::acos(std::clamp(edge.normal_1_W.dot(edge.normal_2_W), -1.0, 1.0)) / kPi;
        w.phi_in_rad = through_the_air(edge, s, w.n), w.phi_out_rad = through_the_air(edge, -from_W, w.n);
        w.sine_beta = s.cross(along).norm(), w.distance_m = from_W.norm(), w.wavelength_m = kEdgeWave_m;
        const double grazing = 0.5 * std::acos(std::clamp(s.dot(from_W.normalized()), -1.0, 1.0));
        const auto mirror = [&](std::uint16_t material) {
          return bounce_off(scene.materials()[material], {std::cos(grazing), 0.0, -std::sin(grazing)},
                            Vector3d::UnitZ(), 0.0, kL1Hz)
              .coefficients;
        };
        const Fresnel one = mirror(edge.material_1), two = mirror(edge.material_2);
        const WedgeBorders borders(w);
        const EdgeField soft = borders.field(one.te, two.te), hard = borders.field(one.tm, two.tm);
        const double per_m = w.sine_beta * std::sqrt(2.0 / (kEdgeWave_m * w.distance_m));
        const EdgeField part = finite_edge_factor(nu, -way.at_m * per_m, (length_m - way.at_m) * per_m);
        path.copolar = 0.5 * (soft + hard), path.crosspolar = 0.5 * (hard - soft);
        const double amplitude = std::abs(part) * std::hypot(std::abs(path.copolar), std::abs(path.crosspolar));
        const double kept = std::clamp(2.0 * (amplitude / weakest - 1.0), 0.0, 1.0);
        if (std::abs(part) < 0.5 * weakest || kept == 0.0) continue;
        path.copolar *= kept * part, path.crosspolar *= kept * part;
        sure.push_back(kept > 0.05 && std::abs(part) > 0.51 * weakest);
      }
      expected.push_back(path);
    }
    if (!wedges) looks.near(std::abs(found[k].direct - direct), 0.0, 1e-9);
    lit_ones += clear && nearest < kDeepestLitNu ? 1 : 0;
    std::size_t matched = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const auto same = std::find_if(found[k].echoes.begin(), found[k].echoes.end(), [&](const SignalPath& e) {
        return std::abs(e.excess_m - expected[i].excess_m) < 1e-9 &&
               (e.arrival_W - expected[i].arrival_W).norm() < 1e-9;
      });
      if (same == found[k].echoes.end()) {
        looks.right(!sure[i]);
        continue;
      }
      ++matched, ++echoes;
      const double bound = wedges ? 3e-3 * (std::abs(expected[i].copolar) + weakest) : 1e-8;
      looks.near(std::abs(same->copolar - expected[i].copolar), 0.0, bound);
      looks.near(std::abs(same->crosspolar - expected[i].crosspolar), 0.0, bound);
      looks.near(same->foliage_m, expected[i].foliage_m, 1e-6);
      looks.right(same->diffractions == 1 && same->reflections == 0);
    }
    looks.right(found[k].echoes.size() == matched);
  }
  looks.right(echoes > 20 && (wedges || lit_ones > 5));
  return looks.figure();
}

/// Without any satellite nothing is looked for, by any model.
StressFigure no_satellites() {
  scene::SceneParts parts = bare_parts();
  add_sheet(parts, 8.0, 4.0);
  const scene::Scene scene(std::move(parts));
  const std::vector<Vector3d> none;
  const std::vector<double> no_carriers;
  int wrong = 0;
  for (auto* const make : {make_knife_edge, make_double_knife_edge, make_wedge}) {
    GnssCounters counters;
    make({})->trace({0, 0, 0}, PlaneWaves(none, no_carriers), scene::SceneAt(scene), {}, counters);
    wrong += counters.occlusion_rays == 0 && counters.diffracted_paths == 0 ? 0 : 1;
  }
  for (auto* const make : {make_visibility, make_specular1, make_specular2, make_specular3, make_launching}) {
    GnssCounters counters;
    make({})->trace({0, 0, 0}, PlaneWaves(none, no_carriers), scene::SceneAt(scene), {}, counters);
    wrong += counters.occlusion_rays == 0 ? 0 : 1;
  }
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> edge_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "ways over one sheet, two in turn, and past one to another",
           "a way from the wrong end, a detour of the other edge, a lit edge for one in the shadow",
           "plane geometry with each edge's field: roundings of its ways", "of the bound"});
  for (const std::uint64_t seed : {1U, 2U})
    rows.add("edges/sheets_in_turn_" + std::to_string(seed), [seed] { return sheets_in_turn(seed); });
  rows.of({StressGroup::kGeometry, "ways over the roof of a house",
           "an angle from the other face, a wave's polarization for another's, a fading of the wrong side",
           "the wedge's field of a right angle to the 1e-3 that an edge's end states", "of the bound"});
  for (const char* material : {"concrete", "metal", "glass"})
    rows.add(std::string("edges/roof_of_") + material, [material] { return roof(material, 16.0); });
  rows.add("edges/roof_of_brick_far_away", [] { return roof("brick", 128.0); });
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "edges of boxes strewn about the antenna",
           .why = "a bound that leaves an edge out, a point beside the law of diffraction, an end that is none",
           .expected = "every edge by itself, its point by bisection: roundings, and the 1e-3 of pieces",
           .unit = "of the bound",
           .loose = "points of both are found nearer than bounds of fields ask for"});
  for (const std::uint64_t seed : {1U, 2U}) {
    rows.add("edges/strewn_" + std::to_string(seed), [seed] { return strewn_edges(seed, false); });
    rows.add("edges/strewn_wedges_" + std::to_string(seed), [seed] { return strewn_edges(seed, true); });
  }
  rows.of({StressGroup::kData, "no satellite at all", "the least of none", "nothing is looked for", "models"});
  rows.add("edges/without_satellites", no_satellites);
  return rows.take();
}

}  // namespace canyon::gnss
