// What a street does to signals beyond mirrors: wedges, scattering walls, two states of shading; and who receives them.
#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/gnss/paths/bounce.h"
#include "canyon/gnss/paths/clutter/two_state_law.h"
#include "canyon/gnss/paths/diffraction/knife_edge.h"
#include "canyon/gnss/paths/diffraction/wedge.h"
#include "canyon/gnss/paths/plane_waves.h"
#include "canyon/gnss/paths/propagation.h"
#include "canyon/gnss/paths/scatter/directive_lobe.h"
#include "canyon/gnss/paths/scatter/facade_tiles.h"
#include "canyon/gnss/receiver/receiver_antenna.h"
#include "canyon/gnss/stress/subjects.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::text;
using Field = std::complex<double>;

const double kStreetWave_m = kL1WavelengthM;
const double kStreetNumber = 2.0 * kPi / kStreetWave_m;

/// Geometric optics and the edge, relative to the incident wave at the edge, at (s, phi) about a conducting wedge.
Field about_wedge(double n, double phi_in, double phi_out, double s_m, double mirror) {
  const double reach = kStreetNumber * s_m;
  Field u = WedgeBorders({n, phi_in, phi_out, 1.0, s_m, kStreetWave_m}).field(mirror, mirror) * std::polar(1.0, -reach);
  if (std::abs(phi_out - phi_in) < kPi) u += std::polar(1.0, reach * std::cos(phi_out - phi_in));
  if (phi_out + phi_in < kPi) u += mirror * std::polar(1.0, reach * std::cos(phi_out + phi_in));
  if (phi_out + phi_in > 2.0 * n * kPi - kPi)
    u += mirror * std::polar(1.0, reach * std::cos(2.0 * n * kPi - phi_out - phi_in));
  return u;
}

/// Sommerfeld's exact half-plane (Born & Wolf, section 11.5), time factor exp(+j w t).
Field half_plane(double phi_in, double phi_out, double s_m, double mirror) {
  const auto half = [&](double angle) {
    const double from = -std::sqrt(2.0 * kStreetNumber * s_m) * std::cos(0.5 * angle);
    const Field tail =
        std::sqrt(0.5 * kPi) * std::conj(Field(0.5, 0.5) - fresnel_integral(from * std::sqrt(2.0 / kPi)));
    return std::polar(1.0, 0.25 * kPi) / std::sqrt(kPi) * std::polar(1.0, kStreetNumber * s_m * std::cos(angle)) * tail;
  };
  return half(phi_out - phi_in) + mirror * half(phi_out + phi_in);
}

/// The thinnest wedge is the half-plane. Both stand on the same Fresnel integrals, so what is left is rounding: of some
/// five hundred operations on fields of order 1, and of phases of k s.
StressFigure thin_wedge(double s_m) {
  const double ks = kStreetNumber * s_m;
  StressFigure out{0.0, kEpsilon * (512.0 + 16.0 * ks)};
  for (const double mirror : {-1.0, 1.0})
    for (double phi_in = 0.15; phi_in < kPi; phi_in += 0.37)
      for (double phi_out = 0.03; phi_out < 2.0 * kPi; phi_out += 0.0517)
        take_worst(out,
                   std::abs(about_wedge(2.0, phi_in, phi_out, s_m, mirror) - half_plane(phi_in, phi_out, s_m, mirror)));
  return out;
}

/// Across a border the geometric field jumps by the whole wave and the wedge's jumps back: what is left is the step in
/// the angle times the field's slope in it, k s, of the four terms. A figure is the worst share of that.
StressFigure borders_of_wedge(double n) {
  const double s_m = 15.0, step = 1e-7;
  StressFigure out{0.0, 4.0 * step * kStreetNumber * s_m};
  for (const double mirror : {-1.0, 1.0})
    for (const double phi_in : {0.4, 1.1, 0.6 * n * kPi, n * kPi - 0.3})
      for (const double border : {phi_in + kPi, phi_in - kPi, kPi - phi_in, 2.0 * n * kPi - kPi - phi_in})
        if (border > 0.1 && border < n * kPi - 0.1)
          take_worst(out, std::abs(about_wedge(n, phi_in, border - step, s_m, mirror) -
                                   about_wedge(n, phi_in, border + step, s_m, mirror)));
  return out;
}

/// There and back is the same: rounding of some hundred operations on terms below cot(border) sqrt(k s).
StressFigure wedge_both_ways(double n) {
  StressFigure out{0.0, 1e-12};
  const Field face_0(-0.8, 0.1), face_n(-0.6, 0.2);
  for (double phi_in = 0.11; phi_in < n * kPi; phi_in += 0.31)
    for (double phi_out = 0.07; phi_out < n * kPi; phi_out += 0.29)
      for (const double sine_beta : {1.0, 0.3}) {
        const WedgeWay there{n, phi_in, phi_out, sine_beta, 12.0, kStreetWave_m},
            back{n, phi_out, phi_in, sine_beta, 12.0, kStreetWave_m};
        take_worst(out, std::abs(WedgeBorders(there).field(face_0, face_n) - WedgeBorders(back).field(face_0, face_n)));
      }
  return out;
}

/// A long edge is the endless one, and half of it half of it. Beyond u the integral is its first term by parts,
/// nu / (pi (u^2 + nu^2) u), over exp(-j pi nu^2 / 2) times the whole, erfc-like and no smaller than 1 / (pi nu): so
/// the rest is below nu^2 / u^3 at both ends; within, the sum states 1e-3.
StressFigure long_edge(double nu) {
  StressFigure out{0.0, 1e-3};
  take_worst(out, std::abs(finite_edge_factor(nu, -300.0, 300.0) - 1.0));
  take_worst(out, std::abs(finite_edge_factor(nu, 0.0, 300.0) - 0.5));
  take_worst(out, std::abs(finite_edge_factor(nu, -2.9, 2.9) + 2.0 * finite_edge_factor(nu, 2.9, 300.0) - 1.0));
  return out;
}

/// An edge's pieces add up to it, wherever it is cut: the same sums in another order, of some sixty terms below 1.
StressFigure pieces_of_edge(double nu) {
  StressFigure out{0.0, 64.0 * kEpsilon};
  for (double cut = -0.6; cut < 2.0; cut += 0.1)
    take_worst(out, std::abs(finite_edge_factor(nu, -0.7, 2.1) - finite_edge_factor(nu, -0.7, cut) -
                             finite_edge_factor(nu, cut, 2.1)));
  return out;
}

std::unique_ptr<scene::Scene> scattering_wall() {
  scene::SceneParts parts;
  parts.name = "wall";
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("wall", scene::ObjectKind::kWall);
  mesh.quad({-12, -40, 0}, {-12, 40, 0}, {-12, 40, 24}, {-12, -40, 24}, mesh.material("metal"));
  return std::make_unique<scene::Scene>(std::move(parts));
}

/// A wall's scattered field is the sum over its tiles, one by one, of what the model's own formula says of each, with
/// the detour of a plane wave by planes of equal phase. The lobe's integral is a table of 256 steps, off by less than
/// an eighth of a step squared times its curvature, which is no larger than itself: 2e-6 of the power. What a metal
/// keeps, 1.3e-4 / cosine, is one of 64, off by 4e-5 at the smallest cosine here, 0.05. Of the field it is half of
/// both.
StressFigure tiles_one_by_one(double elevation_deg, double carrier_hz) {
  const double k_1_m = 2.0 * kPi * carrier_hz / kSpeedOfLight;
  const auto city = scattering_wall();
  PropagationConfig config;
  config.paths.name = "visibility";
  config.scatter.name = "directive";
  PathParameters limits;
  limits.weakest_db = limits.weakest_nlos_db = -200.0;
  const auto model = *make_propagation(config, limits);
  const Vector3d p_W(0.0, 0.0, 2.0);
  StressFigure out{0.0, 2.1e-5};
  for (const double azimuth : {0.3, 1.2, 1.57, 2.4}) {
    const double e = elevation_deg * kDegree;
    const Vector3d s(std::cos(e) * std::sin(azimuth), std::cos(e) * std::cos(azimuth), std::sin(e));
    std::vector<SignalPaths> paths(1);
    GnssCounters counters;
    const std::vector directions{s};
    const std::vector carriers{carrier_hz};
    model->trace(p_W, PlaneWaves(directions, carriers), scene::SceneAt(*city), paths, counters);
    Field found = 0.0;
    for (const SignalPath& echo : paths[0].echoes) found += echo.copolar * std::polar(1.0, -k_1_m * echo.excess_m);

    const FacadeTiles tiles(*city, 8.0);
    Field expected = 0.0;
    double whole = 0.0;
    for (const FacadeTile& tile : tiles.tiles()) {
      const Vector3d from_W = tile.center_W - p_W;
      const double r_m = from_W.norm(), cosine = tile.normal_W.dot(s);
      if (cosine <= 0.0 || tile.normal_W.dot(from_W) >= 0.0) continue;
      const double fade = std::min(5.0 * (1.0 - r_m / 150.0), 1.0);
      const double detour_m = r_m + (s.dot(p_W) - s.dot(tile.center_W));
      const scene::Material& wall = city->materials()[tile.material];
      const DirectiveLobe lobe{wall.scatter_lobe};
      const Bounce b =
          bounce_off(wall, {std::sqrt(1.0 - cosine * cosine), 0.0, -cosine}, Vector3d::UnitZ(), 0.0, carrier_hz);
      const double given_back = 0.5 * (std::norm(b.coefficients.te) + std::norm(b.coefficients.tm));
      const Vector3d mirror = 2.0 * cosine * tile.normal_W - s;
      const double power = std::pow(wall.scatter_coefficient, 2) * given_back * tile.area_m2 * cosine *
                           lobe.at(-mirror.dot(from_W) / r_m) /
                           (lobe.integral_sr(cosine) * (r_m * r_m + tile.area_m2 / (2.0 * kPi)));
      const double amplitude = fade * std::sqrt(0.5 * power);
      expected += amplitude * tile.phase * std::polar(1.0, -k_1_m * detour_m);
      whole += amplitude;
    }
    take_worst(out, std::abs(found - expected) / whole);
  }
  return out;
}

/// Patterns are level at their zenith and have no null: between nodes 15 degrees apart none steps by 10 dB, which a
/// misplaced digit does; the other hand lies below the zenith's right one by 10 dB at least wherever a maker states an
/// axial ratio; and phase centres vary by centimetres. A figure is the worst share of these.
StressFigure antenna_pattern(const char* name) {
  StressFigure out{0.0, 1.0};
  const auto* row = find_model(antenna_models(), name);
  if (row == nullptr) return {stress::kInfinity, 1.0};
  ModelParameters own;
  if (row->parameters != nullptr) row->parameters(own);
  const auto antenna = row->make(own);
  take_worst(out, std::abs(antenna->rhcp_db(0.5 * kPi)) / 1e-12);
  double before_r = antenna->rhcp_db(-0.5 * kPi), before_l = antenna->lhcp_db(-0.5 * kPi);
  for (int k = -89; k <= 90; ++k) {
    const double e = k * kDegree, r = antenna->rhcp_db(e), l = antenna->lhcp_db(e);
    take_worst(out, worse(std::abs(r - before_r), std::abs(l - before_l)) / (10.0 / 15.0));
    take_worst(out, worse(r, 0.0) / 1e-9);
    take_worst(out, worse(l + 10.0, 0.0) / 1e-9);
    before_r = r, before_l = l;
    // About the phase centre at the zenith, less the way that the offset's height makes.
    const Vector3d u(0.0, std::cos(e), std::sin(e)), back(0.0, -std::cos(e), std::sin(e)), zenith = Vector3d::UnitZ();
    const double both = 0.5 * (antenna->phase_centre_m(u) + antenna->phase_centre_m(back));
    if (k >= 0) take_worst(out, std::abs(both - std::sin(e) * antenna->phase_centre_m(zenith)) / 0.03);
  }
  return out;
}

/// M_A grows with z, and its mean over z is that of the two states. Between two of its quantiles, 0.05 in z apart, it
/// rises by no more than the states lie apart, 20 dB, and a straight line there is off by half of that at most: by
/// 20 x 0.05 x 0.4 / 2 of the mean.
StressFigure mixture(const char* environment) {
  StressFigure out{0.0, 0.2};
  const TwoStateLaw law(environment, 1.0);
  for (const TwoStateLaw::Elevation& e : law.table()) {
    double mean = 0.0, before = -1e9;
    constexpr int kParts = 4000;
    double weight = 0.0;
    for (int k = 0; k < kParts; ++k) {
      const double z = -5.0 + 10.0 * (k + 0.5) / kParts, density = std::exp(-0.5 * z * z);
      const double level = law.mean_level_db(z, e.elevation_rad);
      if (!(level >= before)) return {stress::kInfinity, 0.2};
      before = level;
      mean += density * level;
      weight += density;
    }
    const double expected = (1.0 - e.shaded_share) * e.good.ma_db + e.shaded_share * e.bad.ma_db;
    take_worst(out, std::abs(mean / weight - expected));
  }
  return out;
}

/// Spread and multipath of either state, at every elevation of the table, between two of them and beyond: of levels
/// weaker than both states the bad one's straight line, of stronger ones the good one's, evenly shared between; none
/// below 0. Sixteen epsilons of the terms.
StressFigure spreads(const std::string& environment) {
  stress::Worst worst;
  const TwoStateLaw law(environment, 1.0);
  const auto& table = law.table();
  const auto line = [](double slope, double level, double at_0) { return worse(slope * level + at_0, 0.0); };
  const auto of = [&](const TwoStateLaw::Elevation& e, double level) {
    const double good = line(e.good.g1, level, e.good.g2_db), bad = line(e.bad.g1, level, e.bad.g2_db);
    if (level >= e.good.ma_db) return good;
    if (level <= e.bad.ma_db) return bad;
    const double share = (level - e.bad.ma_db) / (e.good.ma_db - e.bad.ma_db);
    return share * good + (1.0 - share) * bad;
  };
  for (std::size_t i = 0; i < table.size(); ++i)
    for (const double part : {0.0, 0.25, 0.7}) {
      const auto& low = table[i];
      const auto& high = table[std::min(i + 1, table.size() - 1)];
      double elevation = low.elevation_rad + part * (high.elevation_rad - low.elevation_rad);
      if (i == 0 && part == 0.25) elevation = 0.01;
      if (i + 1 == table.size()) elevation += part;
      const double share = i == 0 && part == 0.25 ? 0.0 : part;
      for (double level = -30.0; level < 6.0; level += 0.7)
        worst.look(law.spread_db(level, elevation) - ((1.0 - share) * of(low, level) + share * of(high, level)),
                   16.0 * kEpsilon * 60.0);
      for (const bool shaded : {false, true}) {
        const auto db = [&](const TwoStateLaw::Elevation& e) {
          const SignalState& state = shaded ? e.bad : e.good;
          return state.h1 * state.ma_db + state.h2_db;
        };
        const double power = std::pow(10.0, ((1.0 - share) * db(low) + share * db(high)) / 10.0);
        worst.look(law.multipath_power(shaded, elevation) / power - 1.0, 1e-13);
      }
    }
  return worst.figure();
}

}  // namespace

std::vector<StressCase> street_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "a wedge's field from beside its edge to far away",
           .why = "a border's cotangent is infinite where its transition function is 0",
           .expected = "that of a half-plane in closed form, where the wedge has no angle",
           .unit = ""});
  for (const double s_m : {0.01, 1.0, 100.0, 1e4})
    rows.add("street/half_plane_" + text(s_m) + "_m", [s_m] { return thin_wedge(s_m); });
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "a wedge's field across the borders of shadow and reflection",
           .why = "what the edge adds must jump by just what the rays lose",
           .expected = "no jump but the step's own",
           .unit = ""});
  for (const double n : {1.2, 1.5, 2.0})
    rows.add("street/borders_of_wedge_" + text(n) + "_pi", [n] { return borders_of_wedge(n); });
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "a wedge's field there and back",
           .why = "the four terms are not symmetric one by one",
           .expected = "the same both ways",
           .unit = ""});
  for (const double n : {1.2, 1.5, 2.0})
    rows.add("street/both_ways_about_" + text(n) + "_pi", [n] { return wedge_both_ways(n); });
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "pieces of an edge, from its shadow's border to deep in it",
           .why = "a sum of a function that is a spike at the border and oscillates behind it",
           .expected = "pieces add up to the whole, to rounding",
           .unit = ""});
  for (const double nu : {0.01, 0.3, 1.0, 4.0, 12.0})
    rows.add("street/pieces_at_nu_" + text(nu), [nu] { return pieces_of_edge(nu); });
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "a long edge, from its shadow's border to deep in it",
           .why = "what is cut off of an integral that falls with the cube alone",
           .expected = "the endless edge, to the 1e-3 that is stated of any piece",
           .unit = "",
           .loose = "what is stated holds for any piece; whole edges, whose ends are far away, are better"});
  for (const double nu : {0.01, 0.3, 1.0, 4.0, 12.0})
    rows.add("street/long_edge_at_nu_" + text(nu), [nu] { return long_edge(nu); });
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "a scattering wall and its tiles one by one",
           .why = "phases of ways of hundreds of wavelengths; shares of a lobe from a table",
           .expected = "the sum over the tiles, with the detours that planes of equal phase make",
           .unit = ""});
  for (const double e : {1.0, 20.0, 45.0, 80.0})
    rows.add("street/tiles_" + text(e) + "_deg", [e] { return tiles_one_by_one(e, kL1Hz); });
  for (const double mhz : {1176.45, 1227.60, 1561.098, 1602.0})  // L5, L2, B1I, G1's channel 0
    rows.add("street/tiles_45_deg_at_" + text(mhz) + "_mhz", [mhz] { return tiles_one_by_one(45.0, 1e6 * mhz); });
  rows.of(
      {.group = StressGroup::kData,
       .mechanism = "an antenna's pattern from nadir to zenith",
       .why = "a table of a maker's figures, typed in",
       .expected =
           "level at the zenith, no step of 10 dB in 15 degrees, the other hand 10 dB below, phase centres within 3 cm",
       .unit = ""});
  for (const char* name : {"sine", "patch", "survey", "choke_ring"})
    rows.add(std::string("street/antenna_") + name, [name] { return antenna_pattern(name); });
  rows.of({.group = StressGroup::kData,
           .mechanism = "a level of two states from its weakest to its strongest",
           .why = "quantiles of a mixture whose states hardly overlap",
           .expected = "it grows with its share, and its mean is the states' own",
           .unit = "dB"});
  for (const char* name : {"urban", "suburban"})
    rows.add(std::string("street/two_states_") + name, [name] { return mixture(name); });
  rows.of({.group = StressGroup::kData,
           .mechanism = "spread and multipath of two states, at all elevations",
           .why = "a line of the other state, a level for its inverse, an elevation beyond the table",
           .expected = "the table's own lines, shared between states and elevations: roundings",
           .unit = "of the bound"});
  for (const std::string& environment : TwoStateLaw::environments())
    rows.add("street/spreads_in_" + environment, [environment] { return spreads(environment); });
  return rows.take();
}

}  // namespace canyon::gnss
