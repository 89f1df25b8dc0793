// Ways over several walls, against all pairs of walls tried one by one; the ground, the sky's mask, crowns.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/random/random.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/gnss/paths/ground_reflection.h"
#include "canyon/gnss/paths/obstruction.h"
#include "canyon/gnss/paths/path_model.h"
#include "canyon/gnss/stress/subjects.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Worst;

scene::SceneParts nothing() {
  scene::SceneParts parts;
  parts.name = "made";
  parts.materials = scene::builtin_materials();
  return parts;
}

void add_box(scene::SceneParts& parts, const Vector3d& middle_W, const Vector3d& half_m, double turned_rad = 0.0) {
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("box " + std::to_string(parts.objects.size()), scene::ObjectKind::kBuilding);
  mesh.box(middle_W, Eigen::AngleAxisd(turned_rad, Vector3d::UnitZ()).toRotationMatrix(), half_m,
           mesh.material("metal"));
}

void add_quad(scene::SceneParts& parts, const std::array<Vector3d, 4>& corners,
              scene::ObjectKind kind = scene::ObjectKind::kWall, const char* material = "metal") {
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("quad " + std::to_string(parts.objects.size()), kind);
  mesh.quad(corners[0], corners[1], corners[2], corners[3], mesh.material(material));
}

/// Boxes to all sides of the origin, some of them turned and some behind others, none nearer than 3 m.
std::unique_ptr<scene::Scene> some_city(std::uint64_t seed) {
  const RandomStream draw(seed, "stress.city");
  scene::SceneParts parts = nothing();
  for (std::uint64_t k = 0; k < 16; ++k) {
    const double away_m = 8.0 + 2.5 * static_cast<double>(k), bearing = 2.4 * static_cast<double>(k);
    const Vector3d half(1.0 + 3.0 * draw.uniform(0, k), 1.0 + 3.0 * draw.uniform(1, k),
                        2.0 + 12.0 * draw.uniform(2, k));
    add_box(parts, {away_m * std::cos(bearing), away_m * std::sin(bearing), half.z() - 2.0}, half,
            k % 2 == 0 ? 0.0 : kPi * draw.uniform(3, k));
  }
  return std::make_unique<scene::Scene>(std::move(parts));
}

std::vector<Vector3d> some_sky() {
  std::vector<Vector3d> out;
  for (int k = 0; k < 96; ++k) {
    const double elevation = 0.1 + 1.3 * std::fmod(0.618 * k, 1.0), azimuth = 2.4 * k;
    out.emplace_back(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                     std::sin(elevation));
  }
  return out;
}

PathParameters all_ways() {
  PathParameters p;
  p.cutoff_m = 1e6, p.weakest_db = p.weakest_nlos_db = -200.0, p.finite_facets = false;
  p.combine_all_m = 1e4;
  return p;
}

struct Found {
  std::vector<SignalPaths> paths;
  GnssCounters counters;
};
Found found_by(std::unique_ptr<PathModel> (*make)(const PathParameters&), const PathParameters& p,
               const Vector3d& antenna, const std::vector<Vector3d>& sky, const scene::Scene& city) {
  Found out{std::vector<SignalPaths>(sky.size()), {}};
  make(p)->trace(antenna, PlaneWaves(sky), scene::SceneAt(city), out.paths, out.counters);
  return out;
}

/// A way as the facets in turn and its excess.
struct Way {
  std::vector<std::uint32_t> facets;
  double excess_m;
  Vector3d arrival_W;
};

/// Every facet and every pair of them, by mirroring the antenna: the plane of the last in the direction of the
/// satellite, that of the one before it on the way there; each point within its facet, and no leg blocked.
std::vector<Way> try_all(const Vector3d& antenna, const Vector3d& s, const scene::Scene& city) {
  const auto& facets = city.facets().facets();
  const scene::SceneAt at(city);
  const auto mirrored = [](const scene::Facet& f, const Vector3d& p) {
    return Vector3d(p - 2.0 * (f.normal_W.dot(p) - f.offset_m) * f.normal_W);
  };
  /// Where the line from a towards direction d meets the facet from its front; none if it does not.
  const auto met = [&](const scene::Facet& f, const Vector3d& a, const Vector3d& d) -> std::optional<Vector3d> {
    const double along = f.normal_W.dot(d), way_m = (f.offset_m - f.normal_W.dot(a)) / along;
    if (!(along > 0.0) || !(way_m > 0.0)) return std::nullopt;  // from the image behind it
    const Vector3d point = a + way_m * d;
    return scene::facet_contains(f, city, point) ? std::optional(point) : std::nullopt;
  };
  const auto start = [](const scene::Facet& f, const Vector3d& p) {
    return Vector3d(p + (2e-3 + f.flatness_m) * f.normal_W);
  };
  const auto leg = [&](const Vector3d& a, const Vector3d& b) {
    return !at.blocked_towards(a, (b - a).normalized(), (b - a).norm());
  };
  std::vector<Way> out;
  for (std::uint32_t i = 0; i < facets.size(); ++i) {
    const scene::Facet& f = facets[i];
    if (f.normal_W.dot(antenna) <= f.offset_m) continue;
    const Vector3d image = mirrored(f, antenna);
    if (const auto p = met(f, image, s); p && leg(antenna, start(f, *p)) && !at.blocked_towards(start(f, *p), s))
      out.push_back({{i}, (antenna - image).dot(s), (*p - antenna).normalized()});
    for (std::uint32_t j = 0; j < facets.size(); ++j) {
      const scene::Facet& g = facets[j];
      if (j == i || g.normal_W.dot(image) <= g.offset_m) continue;
      const Vector3d second = mirrored(g, image);
      const auto q = met(g, second, s);
      if (!q) continue;
      const auto p = met(f, image, (*q - image).normalized());
      if (!p || f.normal_W.dot(*q) <= f.offset_m || g.normal_W.dot(*p) <= g.offset_m) continue;
      if (leg(antenna, start(f, *p)) && leg(start(f, *p), start(g, *q)) && !at.blocked_towards(start(g, *q), s))
        out.push_back({{i, j}, (antenna - second).dot(s), (*p - antenna).normalized()});
    }
  }
  return out;
}

/// What the search finds is what trying all pairs finds: the same facets, no other, and the same excess and direction
/// of arrival, to 64 roundings of the coordinates and of a direction.
StressFigure all_pairs(std::uint64_t seed) {
  const auto city = some_city(seed);
  const auto sky = some_sky();
  Worst worst;
  std::size_t twice = 0;
  for (const Vector3d& antenna : {Vector3d(0.3, -0.2, 1.1), Vector3d(1.9, 1.4, 6.0), Vector3d(-14.0, 3.0, 0.5)}) {
    PathParameters exhaustive = all_ways();
    exhaustive.exhaustive = true;
    const Found by = found_by(make_specular2, all_ways(), antenna, sky, *city),
                slow = found_by(make_specular2, exhaustive, antenna, sky, *city);
    if (by.counters.facets_tested >= slow.counters.facets_tested) return {kInfinity, 1.0};
    for (std::size_t k = 0; k < sky.size(); ++k) {
      std::vector<Way> expected = try_all(antenna, sky[k], *city);
      const bool blocked = scene::SceneAt(*city).blocked_towards(antenna, sky[k]);
      for (const Found* found : {&by, &slow}) {
        const auto& echoes = found->paths[k].echoes;
        worst.look(echoes.size() == expected.size() && found->paths[k].line_of_sight != blocked ? 0.0 : kInfinity, 1.0);
        for (std::size_t e = 1; e < echoes.size(); ++e)
          worst.look(echoes[e - 1].excess_m <= echoes[e].excess_m ? 0.0 : kInfinity, 1.0);
        for (const SignalPath& echo : echoes) {
          const auto same = std::find_if(expected.begin(), expected.end(), [&](const Way& way) {
            return std::equal(way.facets.begin(), way.facets.end(), echo.facets.begin()) &&
                   static_cast<int>(way.facets.size()) == echo.reflections;
          });
          if (same == expected.end()) return {kInfinity, 1.0};
          worst.look(echo.excess_m - same->excess_m, 64.0 * kEpsilon * 100.0);
          worst.look((echo.arrival_W - same->arrival_W).norm(), 64.0 * kEpsilon);
          twice += echo.reflections == 2 ? 1 : 0;
        }
      }
    }
  }
  worst.look(twice > 8 ? 0.0 : kInfinity, 1.0);
  return worst.figure();
}

/// Rays launched over the sphere find the ways that images find, but for facets that they miss; those they have are
/// where images have them, off by what the cone of capture lets an angle be off: its half-angle times twice the way,
/// and of the field a cosine and a length, four of its half-angles.
StressFigure launched() {
  scene::SceneParts parts = nothing();
  add_quad(parts, {{{12, 30, -5}, {12, -30, -5}, {12, -30, 25}, {12, 30, 25}}});
  add_quad(parts, {{{-30, 15, -5}, {30, 15, -5}, {30, 15, 20}, {-30, 15, 20}}});
  const scene::Scene walls(std::move(parts));
  // The first wall faces west; the second south, wound the other way round.
  const auto sky = some_sky();
  PathParameters p = all_ways();
  p.finite_facets = true;
  const Vector3d antenna(0.3, -0.2, 1.1);
  const double cone = 1.5 * std::sqrt(4.0 / p.launched_rays);
  const Found images = found_by(make_specular2, p, antenna, sky, walls),
              rays = found_by(make_launching, p, antenna, sky, walls);
  Worst worst;
  std::size_t shared = 0, missed = 0;
  for (std::size_t k = 0; k < sky.size(); ++k) {
    for (const SignalPath& echo : images.paths[k].echoes) {
      const auto& all = rays.paths[k].echoes;
      const auto same = std::find_if(all.begin(), all.end(), [&](const SignalPath& other) {
        return other.facets == echo.facets && other.reflections == echo.reflections;
      });
      if (same == all.end()) {
        ++missed;
        continue;
      }
      ++shared;
      const double way_m = 60.0;
      worst.look(same->excess_m - echo.excess_m, 2.0 * cone * way_m);
      worst.look(std::abs(same->copolar) - std::abs(echo.copolar), 4.0 * cone);
      worst.look(std::abs(same->crosspolar) - std::abs(echo.crosspolar), 4.0 * cone);
      worst.look((same->arrival_W - echo.arrival_W).norm(), 2.0 * cone);
    }
    // A ray that meets a wall within a cone of its border may reflect where the image's way does not.
    worst.look(worse(0.0, static_cast<double>(rays.paths[k].echoes.size()) -
                              static_cast<double>(images.paths[k].echoes.size())),
               1.5);
  }
  worst.look(shared >= 5 && missed <= shared / 4 ? 0.0 : kInfinity, 1.0);
  return worst.figure();
}

/// A way over a wall close by and a second one that reaches over the first one's plane by `over_m` with its tip alone:
/// one way, of the excess of an antenna mirrored twice. 64 roundings of 30 m.
StressFigure tip(double over_m) {
  constexpr double kBeside = 0.5, kAhead = 12.0, kRadius = 2.0;
  scene::SceneParts parts = nothing();
  add_quad(parts, {{{0, 2, -5}, {0, 11.999, -5}, {0, 11.999, 5}, {0, 2, 5}}});
  const Vector3d middle(over_m - kRadius, kAhead, 0);
  add_quad(parts, {{middle + Vector3d(-kRadius, 0, 0), middle + Vector3d(0, 0, -kRadius),
                    middle + Vector3d(kRadius, 0, 0), middle + Vector3d(0, 0, kRadius)}});
  const scene::Scene walls(std::move(parts));
  const Vector3d antenna(kBeside, 0.0, 0.0), point(0.5 * over_m, kAhead, 0.0);
  const Vector3d s = Vector3d(kBeside + point.x(), -kAhead, 0.0).normalized();
  const double excess_m = (antenna - Vector3d(-kBeside, 2.0 * kAhead, 0.0)).dot(s);
  Worst worst;
  for (const bool exhaustive : {false, true}) {
    PathParameters p = all_ways();
    p.exhaustive = exhaustive;
    const auto echoes = found_by(make_specular2, p, antenna, {s}, walls).paths[0].echoes;
    if (echoes.size() != 1 || echoes[0].reflections != 2) return {kInfinity, 1.0};
    worst.look(echoes[0].excess_m - excess_m, 64.0 * kEpsilon * 30.0);
  }
  return worst.figure();
}

/// Facets behind a wall that hides them are not looked at, those beside it are: counted from `shift_m` along it.
StressFigure hidden(double shift_m) {
  scene::SceneParts parts = nothing();
  add_quad(parts, {{{10, 60, -10}, {10, -60, -10}, {10, -60, 40}, {10, 60, 40}}});
  for (int k = 0; k < 40; ++k) add_box(parts, {20.0 + 3.0 * k, -6.0 + 0.3 * k, 4.0}, {1.0, 1.0, 4.0});
  const scene::Scene city(std::move(parts));
  // So low that every box stands out above it.
  const std::vector<Vector3d> sky{Vector3d(-1.0, 0.0, 0.02).normalized()};
  PathParameters exhaustive = all_ways();
  exhaustive.exhaustive = true;
  const Vector3d antenna(0.0, shift_m, 1.0);
  const auto tested = [&](const PathParameters& p) {
    return found_by(make_specular1, p, antenna, sky, city).counters.facets_tested;
  };
  // Of the boxes two sides at most face the antenna, and of those the wall leaves none where it stands before them all.
  const std::int64_t all = tested(exhaustive), seen = tested(all_ways());
  const bool before = std::abs(shift_m) < 30.0;
  const bool good = before ? seen == 1 && all > 40 : seen > 20;
  return {good ? 0.0 : 1.0, 0.0};
}

/// Over a plane that slopes by `slope` to the east the ground reflects as an endless mirror: 2 h cos(incidence) of the
/// height across it, the point found to 0.1 mm of which the excess depends in second order; 1e-4 over the distance.
StressFigure ground(double slope, double height_m) {
  scene::SceneParts parts = nothing();
  const double half = 512.0;
  add_quad(parts,
           {{{-half, -half, -slope * half},
             {half, -half, slope * half},
             {half, half, slope * half},
             {-half, half, -slope * half}}},
           scene::ObjectKind::kTerrain, "asphalt");
  const scene::Scene land(std::move(parts));
  const Vector3d antenna(2.0, -3.0, slope * 2.0 + height_m), up = Vector3d(-slope, 0.0, 1.0).normalized();
  Worst worst;
  for (const double elevation : {0.2, 0.7, 1.3})
    for (const double azimuth : {0.0, 2.0, 4.0}) {
      const std::vector<Vector3d> sky{
          {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)}};
      std::vector<SignalPaths> out(1);
      GnssCounters counters;
      add_ground_reflections(all_ways(), antenna, PlaneWaves(sky), scene::SceneAt(land), out, counters);
      const double across_m = up.dot(antenna), cosine = up.dot(sky[0]);
      if (cosine < 0.1) continue;  // the slope turns away from it
      if (out[0].echoes.size() != 1) return {kInfinity, 1.0};
      const SignalPath& echo = out[0].echoes[0];
      // Heights of the terrain's corners are of single precision.
      const double off_m = stress::kHalfUlp * std::abs(slope) * half + 64.0 * kEpsilon * height_m;
      worst.look(echo.excess_m - 2.0 * across_m * cosine, 2.0 * off_m);
      const Vector3d point = antenna - 2.0 * across_m * up + across_m / cosine * sky[0];
      worst.look((echo.arrival_W - (point - antenna).normalized()).norm(), 2.0 * (1e-4 + off_m / cosine) / across_m);
      worst.look(beyond(std::norm(echo.copolar) + std::norm(echo.crosspolar), 1.0), 64.0 * kEpsilon);
    }
  return worst.figure();
}

/// A wall of endless length to the east of height tan(e) over the antenna at its foot: open are the west, and of the
/// east what is above it. A cell is blocked where its middle is: the closed form over the cells' middles; and a crown
/// above hides nothing, but counts as way.
StressFigure mask() {
  scene::SceneParts parts = nothing();
  add_quad(parts, {{{10, 4000, -10}, {10, -4000, -10}, {10, -4000, 10}, {10, 4000, 10}}});
  parts.foliage.push_back({{-3.0, 0.0, 8.0}, {2.0, 2.0, 1.5}});
  const scene::Scene land(std::move(parts));
  const scene::SceneAt at(land);
  const ObstructionMask mask(Vector3d::Zero(), Vector3d::UnitZ(), Vector3d::UnitY(), at);
  Worst worst;
  double open = 0.0, all = 0.0;
  for (int e = 0; e < ObstructionMask::kElevations; ++e) {
    const double band = std::sin((e + 1) * kDegree) - std::sin(e * kDegree);
    for (int a = 0; a < ObstructionMask::kAzimuths; ++a) {
      const double east = std::sin((a + 0.5) * kDegree);
      const double margin = 10.0 * std::tan((e + 0.5) * kDegree) - 10.0 * worse(east, 0.0);
      const bool behind = east > 0.003 && margin < 0.0;  // beyond 4000 m there is none
      if (std::abs(margin) > 1e-6 && std::abs(east) > 0.003)
        worst.look(mask.blocked(a, e) == behind ? 0.0 : kInfinity, 1.0);
      open += mask.blocked(a, e) ? 0.0 : band;
      all += band;
    }
  }
  worst.look(mask.open_share(0) - open / all, 32400.0 * kEpsilon);
  // Straight up through the crown's middle, from beneath it: its height.
  const std::vector<Vector3d> sky{Vector3d::UnitZ()};
  std::vector<SignalPaths> out(1);
  GnssCounters counters;
  make_visibility({})->trace({-3.0, 0.0, 0.0}, PlaneWaves(sky), at, out, counters);
  worst.look(out[0].line_of_sight ? out[0].foliage_m - 3.0 : kInfinity, 64.0 * kEpsilon * 8.0);
  return worst.figure();
}

}  // namespace

std::vector<StressCase> way_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "ways over two of many walls, with and without shortcuts",
           "a beam, a row of facets or a skyline that leaves out what it only might",
           "as trying all pairs finds them: the same facets, excess and arrival to 64 eps of the coordinates",
           "of the bound"});
  for (const std::uint64_t seed : {1U, 3U})
    rows.add("ways/all_pairs_of_city_" + std::to_string(seed), [seed] { return all_pairs(seed); });
  rows.of({StressGroup::kGeometry, "rays launched over the sphere, against images",
           "a capture cone that catches another way, a field of another distance or wavelength",
           "the images' ways but for the cone's half-angle: twice it of the way, four times of the field",
           "of the bound"});
  rows.add("ways/launched_rays", launched);
  rows.of({StressGroup::kGeometry, "a facet that reaches into a beam with its tip alone",
           "slack for single precision that is taken off instead of added", "one way, in closed form to 64 eps",
           "of the bound"});
  for (const double over_m : {1e-3, 4e-3, 0.02, 0.1, 1.0})
    rows.add("ways/tip_of_" + stress::text(over_m) + "_m", [over_m] { return tip(over_m); });
  rows.of({StressGroup::kGeometry, "facets behind a wall that hides them",
           "sectors of the horizon that hide nothing, or what stands beside the wall",
           "none is looked at but the wall, and from beyond its end those beside it", "wrong"});
  for (const double shift_m : {0.0, -20.0, 150.0})
    rows.add("ways/hidden_from_" + stress::text(shift_m) + "_m", [shift_m] { return hidden(shift_m); });
  rows.of({StressGroup::kGeometry, "a reflection off sloping ground",
           "an iteration over planes that ends beside the point, or takes heights for distances",
           "an endless mirror's 2 h cos(incidence) to the ground's single precision", "of the bound"});
  for (const auto& [slope, height_m] : {std::pair{0.0, 1.5}, {0.1, 1.5}, {-0.2, 30.0}})
    rows.add("ways/ground_of_slope_" + stress::text(slope) + "_from_" + stress::text(height_m) + "_m",
             [slope = slope, height_m = height_m] { return ground(slope, height_m); });
  rows.of({StressGroup::kGeometry, "the sky's mask beside an endless wall",
           "azimuths of the other hand, a share of cells in place of solid angle",
           "each cell as its middle says, and their solid angles' share", "of the bound"});
  rows.add("ways/mask_beside_a_wall", mask);
  return rows.take();
}

}  // namespace canyon::gnss
