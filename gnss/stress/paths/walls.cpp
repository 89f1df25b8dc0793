// What walls scatter and what a street's clutter sends and shades, tile by tile and point by point as it is defined.
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "canyon/core/config/config.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/paths/bounce.h"
#include "canyon/gnss/paths/clutter/clutter.h"
#include "canyon/gnss/paths/clutter/clutter_scatterers.h"
#include "canyon/gnss/paths/clutter/lattice_noise.h"
#include "canyon/gnss/paths/clutter/street_shading.h"
#include "canyon/gnss/paths/clutter/two_state_law.h"
#include "canyon/gnss/paths/scatter/delay_bins.h"
#include "canyon/gnss/paths/scatter/directive_lobe.h"
#include "canyon/gnss/paths/scatter/facade_tiles.h"
#include "canyon/gnss/paths/scatter/scatter.h"
#include "canyon/gnss/paths/sight/point_sight.h"
#include "canyon/gnss/stress/level_ground.h"
#include "canyon/gnss/stress/subjects.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using stress::Looks;
using WallField = std::complex<double>;

/// Over the hemisphere, angles from the normal and about it: of a polynomial in their sines and cosines Simpson's 120
/// steps are good to (pi / 240)^4 of 20^4, 5e-3 of what is left at the widest lobe's border, and 96 steps about it
/// exact.
double lobe_by_quadrature(int exponent, double cosine) {
  const double sine = std::sqrt(1.0 - cosine * cosine);
  constexpr int kDown = 400, kAround = 96;
  double sum = 0.0;
  for (int i = 0; i <= kDown; ++i) {
    const double theta = 0.5 * kPi * i / kDown, weight = (i == 0 || i == kDown ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) / 3.0;
    double ring = 0.0;
    for (int k = 0; k < kAround; ++k) {
      const double phi = 2.0 * kPi * k / kAround;
      ring += std::pow(0.5 * (1.0 + cosine * std::cos(theta) + sine * std::sin(theta) * std::cos(phi)), exponent);
    }
    sum += weight * ring * std::sin(theta);
  }
  return sum * 0.5 * kPi / kDown * 2.0 * kPi / kAround;
}

StressFigure lobes() {
  Looks looks;
  for (const int exponent : {1, 2, 3, 4, 5, 8, 13, 20})
    for (const double cosine : {0.0, 0.2, 0.55, 0.9, 1.0}) {
      const DirectiveLobe lobe{exponent};
      // (h n)^4 / 180 of the integral.
      looks.near(lobe.integral_sr(cosine) / lobe_by_quadrature(exponent, cosine), 1.0,
                 std::pow(0.5 * kPi / 400.0 * exponent, 4) / 180.0 + 1e-11);
      looks.near(lobe.at(cosine), std::pow(0.5 * (1.0 + cosine), exponent), 1e-14);
      looks.near(lobe.at(-cosine), std::pow(0.5 * (1.0 - cosine), exponent), 1e-14);
    }
  return looks.figure();
}

/// A street between walls of several materials, one of which leans back, one takes in all, one is a triangle.
std::unique_ptr<scene::Scene> walled_street() {
  scene::SceneParts parts = level_ground("walls", 250.0, 0.0);
  scene::MeshBuilder mesh(parts);
  const auto wall = [&](const char* name, std::array<Vector3d, 4> c, const char* material) {
    mesh.begin_object(name, scene::ObjectKind::kBuilding);
    mesh.quad(c[0], c[1], c[2], c[3], mesh.material(material));
  };
  wall("west", {{{-14, -33, 0}, {-14, 31, 0}, {-14, 31, 17}, {-14, -33, 17}}}, "metal");
  wall("east", {{{15, 26, 0}, {15, -22, 0}, {15, -22, 9}, {15, 26, 9}}}, "concrete");
  wall("leans", {{{20, 90, 0}, {-20, 90, 0}, {-20, 102, 9}, {20, 102, 9}}}, "metal");
  mesh.begin_object("gable", scene::ObjectKind::kBuilding);
  mesh.triangle({-11, 45, 0}, {12, 45, 0}, {0, 45, 20}, mesh.material("brick"));
  return std::make_unique<scene::Scene>(std::move(parts));
}

/// Walls cut into near-squares, those of a gable whose middle lies within it; areas add up to the walls'; middles 5 cm
/// before them; phases even over the circle, each its own; and those within a radius are found, from a cell of 40 m
/// farther at most.
StressFigure tiles_of_walls() {
  Looks looks;
  const auto street = walled_street();
  const FacadeTiles all(*street, 6.0);
  double metal_m2 = 0.0, concrete_m2 = 0.0;
  WallField sum = 0.0;
  std::size_t gable = 0;
  for (const FacadeTile& tile : all.tiles()) {
    looks.near(std::abs(tile.phase), 1.0, 1e-14), looks.near(std::abs(tile.cross_phase), 1.0, 1e-14);
    sum += tile.phase + WallField(0.0, 1.0) * tile.cross_phase;
    looks.right(tile.area_m2 <= 36.0 && tile.area_m2 > 9.0);
    if (tile.normal_W.y() < -0.5) {
      ++gable;
      const double x = std::abs(tile.center_W.x() - 0.5), z = tile.center_W.z();
      looks.near(tile.center_W.y(), 45.0 - 0.05, 1e-5);
      looks.right(x < 12.0 && z > 0.0 && z < 20.0);
    } else if (tile.normal_W.x() > 0.5) {
      metal_m2 += tile.area_m2;
      looks.near(tile.center_W.x(), -14.0 + 0.05, 1e-5);
    } else {
      concrete_m2 += tile.area_m2;
      looks.near(tile.center_W.x(), 15.0 - 0.05, 1e-5);
    }
  }
  // 11 by 3 of 64 x 17 m and 8 by 2 of 48 x 9 m; the one that leans is more than 30 degrees off.
  looks.near(metal_m2, 64.0 * 17.0, 1e-3), looks.near(concrete_m2, 48.0 * 9.0, 1e-3);
  looks.right(all.tiles().size() == 33 + 16 + gable && gable > 4 && gable < 16);
  const auto n = static_cast<double>(all.tiles().size());
  looks.near(std::abs(sum), 0.0, 5.0 * std::sqrt(2.0 * n));
  std::vector<std::uint32_t> near{5};
  for (const Vector3d& p : {Vector3d(0, 0, 2), Vector3d(-50, 39, 2), Vector3d(200, 200, 2)})
    for (const double radius_m : {5.0, 30.0, 90.0}) {
      all.near(p, radius_m, near);
      for (std::uint32_t i = 0; i < all.tiles().size(); ++i) {
        const double off_m = (all.tiles()[i].center_W - p).head<2>().norm();
        const auto found = std::count(near.begin(), near.end(), i);
        looks.right(found <= 1 && (off_m > radius_m || found == 1) &&
                    (off_m < std::sqrt(2.0) * (radius_m + 40.0) || found == 0));
      }
    }
  return looks.figure();
}

/// In the middle of its street an antenna gets from each tile S^2 G^2 A cos(incidence) lobe(psi) / (integral of the
/// lobe (r^2 + A / (2 pi))) of power, S and lobe the material's if they are not given (-1 and 0), half into either
/// hand, as far as both ways are in sight, fading out over the reach's last fifth and over 6 dB above a tenth of the
/// weakest. G^2 by its own incidence: from a table of 64 steps, whose straight pieces are off by the eighth of a second
/// difference, 3e-3 at grazing incidence, and of the lobe's 1e-4; of the carrier rounded to 50 MHz 1e-3.
StressFigure scattered_fields(double coefficient, int lobe_exponent, double weakest_db, double reach_m) {
  Looks looks;
  const auto street = walled_street();
  const scene::SceneAt at(*street);
  ModelParameters own;
  directive_scatter_parameters(own);
  const auto node = ConfigNode::parse("scatter_coefficient = " + std::to_string(coefficient) +
                                          "\nscatter_lobe = " + std::to_string(lobe_exponent) +
                                          "\nscatter_tile_m = 6\nscatter_reach_m = " + std::to_string(reach_m),
                                      "stress");
  CANYON_CHECK(node && read_fields(&*node, "gnss", [&own](FieldVisitor& f) { own.visit_all(f); }).ok(), reach_m);
  PathParameters p;
  p.weakest_db = weakest_db, p.weakest_nlos_db = weakest_db + 3.0;
  const auto model = make_directive_scatter(own, p);
  const bool of_materials = coefficient < 0.0;
  for (const scene::Material& m : street->materials()) {
    const double s = of_materials ? m.scatter_coefficient : coefficient;
    looks.near(model->scattered_share().of(m), s * s, 1e-12);
  }
  const double weakest = std::pow(10.0, weakest_db / 20.0);
  const FacadeTiles tiles(*street, 6.0);
  PointSight sight(*street);
  std::vector<Vector3d> sky;
  std::vector<double> hz;
  for (int k = 0; k < 24; ++k) {
    const double e = 0.15 + 1.3 * std::fmod(0.618 * k, 1.0), a = 2.4 * k;
    sky.emplace_back(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
    hz.push_back(k % 3 == 0 ? 1.6e9 : 1.2e9);
  }
  const PlaneWaves waves(sky, hz);
  double all = 0.0;
  for (const Vector3d& antenna : {Vector3d(1.0, 3.0, 2.0), Vector3d(-9.0, -20.0, 1.5)}) {
    std::vector<SignalPaths> out(sky.size());
    GnssCounters counters;
    model->trace(antenna, waves, at, out, counters);
    const PointSight::From from = sight.from(antenna);
    for (std::size_t k = 0; k < sky.size(); ++k) {
      const PointSight::Towards towards = sight.towards(sky[k]);
      DelayBins bins;
      bins.clear(waves.wavelength_m(k));
      double size = 0.0;
      for (std::uint32_t i = 0; i < tiles.tiles().size(); ++i) {
        const FacadeTile& tile = tiles.tiles()[i];
        const Vector3d way = tile.center_W - antenna;
        const double r = way.norm(), cosine = tile.normal_W.dot(sky[k]);
        if (cosine <= 0.0 || way.dot(tile.normal_W) >= 0.0) continue;
        const Vector3d in(std::sqrt(1.0 - cosine * cosine), 0.0, -cosine), u = way / r;
        const Bounce b = bounce_off(street->materials()[tile.material], in, Vector3d::UnitZ(), 0.0, hz[k]);
        const double G2 = 0.5 * (std::norm(b.coefficients.te) + std::norm(b.coefficients.tm));
        const scene::Material& wall = street->materials()[tile.material];
        const double S = of_materials ? wall.scatter_coefficient : coefficient;
        const DirectiveLobe lobe{of_materials ? wall.scatter_lobe : lobe_exponent};
        const double cos_psi = (2.0 * cosine * tile.normal_W - sky[k]).dot(-u);
        const double power = S * S * G2 * tile.area_m2 * cosine * lobe.at(cos_psi) /
                             (lobe.integral_sr(cosine) * (r * r + tile.area_m2 / (2.0 * kPi)));
        const double fade = std::clamp((reach_m - r) / (0.2 * reach_m), 0.0, 1.0) *
                            std::clamp(std::sqrt(power) / (0.1 * weakest) - 1.0, 0.0, 1.0);
        const double a = from.share(i, tile.center_W, counters) * towards.share(i, tile.center_W, counters) * fade *
                         std::sqrt(0.5 * power);
        size += a;
        if (a > 0.0) bins.add({a * tile.phase, a * tile.cross_phase}, r - way.dot(sky[k]), u, a * a);
      }
      std::vector<SignalPath> expected;
      bins.append(0.5 * weakest, SignalPath::kScattered, expected);
      all += size;
      // Bins that are near to none may be there or not.
      const auto bound = 1e-2 * size + 1e-9;
      for (const SignalPath& path : out[k].echoes) {
        const auto same = std::find_if(expected.begin(), expected.end(),
                                       [&](const SignalPath& e) { return e.facets == path.facets; });
        if (same == expected.end()) {
          looks.near(std::abs(path.copolar) + std::abs(path.crosspolar), 0.0, bound);
          continue;
        }
        looks.near(std::abs(path.copolar - same->copolar), 0.0, bound);
        looks.near(std::abs(path.crosspolar - same->crosspolar), 0.0, bound);
        looks.near(path.gathered_copolar - same->gathered_copolar, 0.0, 2.0 * bound * size);
        looks.right(path.excess_m == same->excess_m);
      }
      for (const SignalPath& path : expected)
        if (std::none_of(out[k].echoes.begin(), out[k].echoes.end(),
                         [&](const SignalPath& e) { return e.facets == path.facets; }))
          looks.near(std::abs(path.copolar) + std::abs(path.crosspolar), 0.0, bound);
    }
  }
  looks.right(all > 0.1);
  return looks.figure();
}

/// Clutter by its definition: scatterers about the antenna as far as they are seen, each with power 1 / (r^2 + cell^2 /
/// (2 pi)) of all of them, faded out over the reach's last fifth; what a corner of directions lights as in the good
/// state, what it does not by way of the wall across the street as in the bad one, later by that way and back. Fields
/// of time from the same lattice. Roundings of 200 m in wavelengths.
StressFigure clutter_of_walls(double moving_share, double echo_db) {
  Looks looks;
  const auto street = walled_street();
  const scene::SceneAt at(*street);
  const std::string environment = "urban";
  ModelParameters own;
  street_clutter_parameters(own);
  const auto node = ConfigNode::parse(
      "clutter_environment = \"urban\"\nclutter_shaded_scale = 0.7\nclutter_echo_db = " + std::to_string(echo_db) +
          "\nclutter_moving_share = " + std::to_string(moving_share) +
          "\nclutter_coherence_s = 1.5\nclutter_cell_m = 6\nclutter_reach_m = 40\n"
          "clutter_street = 12",
      "stress");
  CANYON_CHECK(node && read_fields(&*node, "gnss", [&own](FieldVisitor& f) { own.visit_all(f); }).ok(), environment);
  PathParameters p;
  p.weakest_db = -60.0, p.weakest_nlos_db = -55.0, p.seed = 9;
  const auto model = make_street_clutter(own, p);
  const TwoStateLaw law(environment, 0.7);
  const StreetShading shading(law, {.moving_share = moving_share, .coherence_s = 1.5}, 12, 9);
  const LatticeNoise passing(9, "gnss.clutter.traffic");
  const ClutterScatterers scatterers(6.0, 12);
  PointSight sight(*street);
  std::vector<Vector3d> sky;
  for (int k = 0; k < 16; ++k) {
    const double e = 0.2 + 1.2 * std::fmod(0.618 * k, 1.0), a = 2.4 * k;
    sky.emplace_back(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
  }
  const PlaneWaves waves = PlaneWaves(sky).at(GpsTime::from_week_sow(1700, 321.25));
  int late = 0;
  for (const Vector3d& antenna : {Vector3d(1.0, 3.0, 2.0), Vector3d(-9.0, -20.0, 1.5)}) {
    std::vector<SignalPaths> out(sky.size());
    for (std::size_t k = 0; k < sky.size(); k += 2) out[k].line_of_sight = false, out[k].direct = 0.3;
    // One that comes of many scatterers already.
    SignalPath many;
    many.excess_m = 4.0, many.copolar = {0.2, 0.1}, many.crosspolar = {0.0, -0.3},
    many.arrival_W = Vector3d(0.6, 0.0, 0.8);
    many.gathered_copolar = 0.06, many.gathered_crosspolar = 0.11;
    out[3].echoes.push_back(many);
    GnssCounters counters;
    model->trace(antenna, waves, at, out, counters);
    std::vector<ClutterScatterer> near;
    scatterers.near(*street, antenna, 40.0, near);
    const PointSight::From from = sight.from(antenna);
    double whole = 0.0;
    const auto power_of = [&](const ClutterScatterer& one) {
      const Vector3d way = one.p_W - antenna;
      const double fade = std::clamp((40.0 - std::hypot(way.x(), way.y())) / 8.0, 0.0, 1.0);
      return fade * fade / (way.squaredNorm() + 36.0 / (2.0 * kPi));
    };
    for (const ClutterScatterer& one : near) whole += power_of(one);
    for (std::size_t k = 0; k < sky.size(); ++k) {
      const double elevation = std::asin(sky[k].z()),
                   shade = std::pow(10.0, shading.level_db(antenna, sky[k], waves.t()) / 20.0);
      looks.near(std::abs(out[k].direct - (out[k].line_of_sight ? shade : 0.3)), 0.0, 1e-13);
      const double good = std::pow(10.0, echo_db / 20.0) * std::sqrt(law.multipath_power(false, elevation)),
                   bad = std::pow(10.0, echo_db / 20.0) * std::sqrt(law.multipath_power(true, elevation));
      const PointSight::Towards towards = sight.towards(sky[k]);
      DelayBins bins;
      bins.clear(waves.wavelength_m(k));
      for (const ClutterScatterer& one : near) {
        const Vector3d way = one.p_W - antenna;
        const double share = from.share(one.number, one.p_W, counters);
        WallField hands[2] = {one.co, one.cross};
        const double place = 321.25 / 1.5 + 604800.0 * 1700.0 / 1.5 + static_cast<double>(one.id % 1021) / 1021.0;
        for (std::uint32_t h = 0; h < 2; ++h) {
          const auto draw = [&](std::uint32_t layer) {
            return passing.at<3>(
                {place, std::floor(static_cast<double>(one.id >> 32)), static_cast<double>(one.id & 0xffffffffU)},
                layer);
          };
          if (moving_share > 0.0)
            hands[h] = std::sqrt(1.0 - moving_share) * hands[h] +
                       std::sqrt(0.5 * moving_share) * WallField(draw(2 * h), draw(2 * h + 1));
          hands[h] *= share * std::sqrt(0.5 * power_of(one) / whole);
        }
        double lit = 0.0, across = 0.0, ways_m = 0.0;
        for (const auto& corner : towards.corners()) {
          if (corner.weight == 0.0) continue;
          if (!at.blocked_towards(one.p_W, corner.s_W)) {
            lit += corner.weight;
            continue;
          }
          const Vector2d away = -corner.s_W.head<2>().normalized();
          const scene::Hit hit = at.trace(
              {one.p_W, Eigen::Vector3f(static_cast<float>(away.x()), static_cast<float>(away.y()), 0.0F), 100.0F});
          if (hit.hit()) across += corner.weight, ways_m += corner.weight * static_cast<double>(hit.range_m);
        }
        const double straight_m = way.norm() - way.dot(sky[k]);
        const auto add = [&](double scale, double later_m) {
          const double power = scale * scale * (std::norm(hands[0]) + std::norm(hands[1]));
          bins.add({scale * hands[0], scale * hands[1]}, straight_m + later_m, way.normalized(), power * power);
        };
        if (share == 0.0) continue;
        if (across > 0.0) add(across * bad, 2.0 * std::cos(elevation) * ways_m / across), ++late;
        if (lit > 0.0) add(lit * good, 0.0);
      }
      std::vector<SignalPath> expected;
      bins.append(0.5 * std::pow(10.0, -60.0 / 20.0), SignalPath::kClutter, expected);
      if (k == 3) {
        const double left = std::pow(10.0, shading.level_db(antenna, many.arrival_W, waves.t()) / 20.0);
        const SignalPath first = out[k].echoes.front();
        looks.near(std::abs(first.copolar - left * many.copolar), 0.0, 1e-14);
        looks.near(std::abs(first.crosspolar - left * many.crosspolar), 0.0, 1e-14);
        looks.near(first.gathered_copolar, left * left * 0.06, 1e-14);
        looks.near(first.gathered_crosspolar, left * left * 0.11, 1e-14);
        out[k].echoes.erase(out[k].echoes.begin());
      }
      looks.right(out[k].echoes.size() == expected.size() && expected.size() > 1);
      if (out[k].echoes.size() != expected.size()) continue;
      for (std::size_t e = 0; e < expected.size(); ++e) {
        const SignalPath &a = out[k].echoes[e], &b = expected[e];
        looks.right(a.facets == b.facets && a.excess_m == b.excess_m);
        looks.near(std::abs(a.copolar - b.copolar), 0.0, 1e-10);
        looks.near(std::abs(a.crosspolar - b.crosspolar), 0.0, 1e-10);
        looks.near(a.gathered_copolar - b.gathered_copolar, 0.0, 1e-10);
        looks.near(a.gathered_crosspolar - b.gathered_crosspolar, 0.0, 1e-10);
        looks.near((a.arrival_W - b.arrival_W).norm(), 0.0, 1e-9);
        looks.near(a.spread, b.spread, 1e-7);
      }
    }
  }
  looks.right(late > 20);
  return looks.figure();
}

/// Shades by their definition: a field of place and direction of 14 m and 0.4 rad, a share of it by what passes, and
/// one of 2 m and 0.15 rad for the level about the mean.
StressFigure shades_by_definition() {
  Looks looks;
  const RandomStream draws(14, "stress.walls");
  const TwoStateLaw law("suburban", 1.0);
  const LatticeNoise still(6, "gnss.clutter.shade"), moving(8, "gnss.clutter.passing");
  for (const double share : {0.0, 0.35, 1.0}) {
    const ShadingScale scale{.state_m = 11.0,
                             .spread_m = 3.0,
                             .state_rad = 0.5,
                             .spread_rad = 0.1,
                             .moving_share = share,
                             .coherence_s = 4.0};
    const StreetShading shading(law, scale, 6, 8);
    for (std::uint64_t k = 0; k < 60; ++k) {
      const Vector3d p(draws.uniform(-90, 90, 0, k), draws.uniform(-90, 90, 1, k), 1.0);
      const double e = draws.uniform(0.05, 1.5, 2, k), a = draws.uniform(-3.1, 3.1, 3, k),
                   t_s = draws.uniform(0, 4e5, 4, k);
      const Vector3d from(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a),
                          k % 2 == 0 ? std::sin(e) : -std::sin(e));
      const GpsTime t = GpsTime{} + t_s;
      const double x = (0.5 * kPi - e) * std::cos(a), y = (0.5 * kPi - e) * std::sin(a);
      const double state = std::sqrt(1.0 - share) * still.at<4>({p.x() / 11.0, p.y() / 11.0, x / 0.5, y / 0.5}, 0) +
                           std::sqrt(share) * moving.at<3>({x / 0.5, y / 0.5, t_s / 4.0}, 0);
      const double mean = law.mean_level_db(state, e);
      const double level = mean + law.spread_db(mean, e) * still.at<4>({p.x() / 3.0, p.y() / 3.0, x / 0.1, y / 0.1}, 1);
      // Fields turn by up to 3 of a cell, whose place rounds by 1e-15 of 1e5 cells of time; levels change by up to 30
      // dB of a field.
      looks.near(shading.level_db(p, from, t), level, 1e-8);
    }
  }
  const ShadingScale as_it_comes;
  looks.right(as_it_comes.state_m == 14.0 && as_it_comes.spread_m == 2.0 && as_it_comes.state_rad == 0.4 &&
              as_it_comes.spread_rad == 0.15 && as_it_comes.moving_share == 0.2 && as_it_comes.coherence_s == 2.0);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> wall_cases() {
  StressRows rows;
  const auto group = StressGroup::kGeometry;
  rows.of({.group = group,
           .mechanism = "lobes and tiles of walls that scatter",
           .why = "a binomial of the wrong parity, a tile beside its wall, a middle of the facet's box",
           .expected = "quadrature over the hemisphere; areas, counts and places as the walls have them",
           .unit = "of the bound"});
  rows.add("walls/lobes", lobes).add("walls/tiles", tiles_of_walls);
  rows.of({.group = group,
           .mechanism = "the field that walls scatter",
           .why = "an angle from the normal for one from the mirror, a power for a field, a reach that ends at once",
           .expected = "the sum over tiles as it is stated, to the tables' 1e-2",
           .unit = "of the bound"});
  rows.add("walls/scattered_in_full", [] { return scattered_fields(0.4, 4, -80.0, 150.0); })
      .add("walls/scattered_narrowly", [] { return scattered_fields(0.7, 11, -46.0, 150.0); })
      .add("walls/scattered_within_a_reach", [] { return scattered_fields(0.5, 2, -70.0, 30.0); })
      .add("walls/scattered_as_each_material_does", [] { return scattered_fields(-1.0, 0, -70.0, 150.0); });
  rows.of({.group = group,
           .mechanism = "clutter between walls",
           .why = "a share of sight for its square, light from the wrong side of the street, time in other cells",
           .expected = "the sum over scatterers and the fields of shades as they are stated: roundings",
           .unit = "of the bound",
           .loose = "most of it is the same sum in the same order"});
  rows.add("walls/clutter_at_rest", [] { return clutter_of_walls(0.0, 3.0); })
      .add("walls/clutter_that_moves", [] { return clutter_of_walls(0.4, -2.0); })
      .add("walls/shades", shades_by_definition);
  return rows.take();
}

}  // namespace canyon::gnss
