// Diffraction, reflection and the ways through a scene, where waves graze, meet edges or start on a surface.
#include <array>
#include <cmath>
#include <complex>
#include <limits>

#include "canyon/core/output/printed.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/gnss/paths/bounce.h"
#include "canyon/gnss/paths/diffraction/fresnel.h"
#include "canyon/gnss/paths/diffraction/knife_edge.h"
#include "canyon/gnss/paths/diffraction/mirror_borders.h"
#include "canyon/gnss/paths/path_model.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/stress/subjects.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {
namespace {

using Complex = std::complex<double>;
using stress::kEpsilon;
using stress::kInfinity;

/// At even whole x = 2^k, exp(j pi x^2 / 2) = 1: C = 1/2 + O(1 / (pi^2 x^3)), S = 1/2 - 1 / (pi x). The documented
/// 1e-10 and that next term.
StressFigure at_powers_of_two(int k) {
  const double x = std::ldexp(1.0, k), next = 1.0 / (kPi * kPi * x * x * x);
  const Complex value = fresnel_integral(x), other = fresnel_integral(-x);
  const Complex exact(0.5, 0.5 - 1.0 / (kPi * x));
  StressFigure out{std::abs(value - exact), 1e-10 + 1.2 * next};
  take_worst(out, std::abs(value + other));
  return out;
}

/// Across the seam of series and continued fraction, and from nothing on: Simpson in long double, h = x / 20,000, whose
/// error is h^4 / 180 x (pi x)^4 < 1e-13; at the seam the series' largest terms are e^(2 pi) = 535: 2 * 535 eps.
StressFigure small_arguments() {
  StressFigure out{0.0, 1e-13 + 2.0 * 535.0 * kEpsilon};
  for (const double x : {0.0, 1e-300, 1e-9, 0.1, 1.0, 1.9999999, 2.0, 2.0000001, 3.7, 5.0}) {
    constexpr int n = 20000;
    const long double h = static_cast<long double>(x) / n, half_pi = 0.5L * std::numbers::pi_v<long double>;
    std::complex<long double> sum = 0;
    for (int k = 0; k <= n; ++k) {
      const long double t = k * h, weight = k == 0 || k == n ? 1 : k % 2 == 1 ? 4 : 2;
      sum += weight * std::complex<long double>(cosl(half_pi * t * t), sinl(half_pi * t * t));
    }
    const std::complex<long double> exact = sum * (h / 3.0L);
    take_worst(out, std::abs(fresnel_integral(x) -
                             Complex(static_cast<double>(exact.real()), static_cast<double>(exact.imag()))));
  }
  return out;
}

/// Deep in the shadow |F| = 1 / (sqrt 2 pi nu) (1 + O(3 / (pi nu^2)^2)); what cancels is 1/2 (1 + j) to 8
/// eps, the integral far out having no more.
StressFigure deep_shadow(double nu) {
  const double exact = 1.0 / (std::sqrt(2.0) * kPi * nu);
  return {std::abs(std::abs(knife_edge_field(nu)) / exact - 1.0),
          4.0 / std::pow(kPi * nu * nu, 2) + 8.0 * kEpsilon / exact};
}

/// Far lit the field is 1 with ripples of 1 / (sqrt 2 pi nu) and the same terms.
StressFigure far_lit(double nu) {
  StressFigure out{0.0, (1.0 + 4.0 / std::pow(kPi * nu * nu, 2)) / (std::sqrt(2.0) * kPi * nu) + 1e-10};
  for (int k = 0; k < 50; ++k) take_worst(out, std::abs(knife_edge_field(-nu * (1.0 + 0.01 * k)) - 1.0));
  return out;
}

/// At the shadow's border half of the field; beside it F changes by |dF/dnu| = 1 / sqrt 2 at most.
StressFigure shadow_border() {
  StressFigure out{std::abs(knife_edge_field(0.0) - 0.5), 8.0 * kEpsilon};
  for (const double nu : {1e-300, 1e-12, -1e-12})
    take_worst(out, beyond(std::abs(knife_edge_field(nu) - 0.5), std::abs(nu)));
  // The lit and the shadowed side of one edge make up the free field (Babinet).
  for (double nu = 0.0; nu < 8.0; nu += 0.01)
    take_worst(out, std::abs(knife_edge_field(nu) + knife_edge_field(-nu) - 1.0));
  return out;
}

/// What reflects nothing, at all incidences up to grazing: a medium of permittivity 1. With c = cos i, a rounding of
/// s^2 = 1 - c^2 by eps changes the root sqrt(1 - s^2) by eps / c, which is below c / 1000 as long as c > 1e-6.
StressFigure air() {
  StressFigure out{0.0, 32.0 * kEpsilon};
  for (const double c : {1.0, 0.5, 1e-2, 1e-4, 1e-6, 1e-8, 0.0}) {
    const double incidence = std::acos(c);
    const Fresnel f = fresnel(1.0, incidence);
    take_worst(out, worse(std::abs(f.te), std::abs(f.tm)));
  }
  return out;
}

/// Grazing every surface is a mirror of the same sense: TE and TM to -1, as 2 c / sqrt(eps - 1) and 2 c eps / sqrt(eps
/// - 1) of their distance; and nothing ever reflects more than comes. A figure is the worst share of these bounds.
StressFigure grazing(Complex permittivity) {
  StressFigure out{0.0, 1.0};
  const double root = std::sqrt(std::abs(permittivity - 1.0));
  for (const double c : {1e-3, 1e-6, 1e-9, 1e-12}) {
    // Grazing begins where eps c is small against the root.
    const double share = std::abs(permittivity) * c / root;
    if (share > 0.05) continue;
    const Fresnel f = fresnel(permittivity, std::acos(c));
    const double cosine = std::cos(std::acos(c));
    take_worst(out, std::abs(f.te + 1.0) / (2.0 * cosine / root * (1.0 + 2.0 * share) + 8.0 * kEpsilon));
    take_worst(out, std::abs(f.tm + 1.0) / (2.0 * share * (1.0 + 2.0 * share) + 8.0 * kEpsilon));
  }
  for (int k = 0; k <= 1000; ++k) {
    const Fresnel f = fresnel(permittivity, 0.5 * kPi * k / 1000.0);
    take_worst(out, worse(std::abs(f.te), std::abs(f.tm)) / (1.0 + 8.0 * kEpsilon));
  }
  return out;
}

/// Slabs: of no thickness none is reflected, endless ones reflect as a half-space, and half a wave thick without loss
/// none. A slab's phase of 2 pi d / wavelength n rounds by eps of it.
StressFigure slab(double thickness_m) {
  StressFigure out{0.0, 64.0 * kEpsilon};
  const double wavelength = kL1WavelengthM;
  for (const double i : {0.0, 0.7, 1.5}) {
    if (thickness_m == 0.0) {
      take_worst(out, std::abs(fresnel_slab({5.0, -0.5}, 0.0, wavelength, i).te));
      const double half_wave = 0.5 * wavelength / std::sqrt(4.0 - std::sin(i) * std::sin(i));
      take_worst(out, std::abs(fresnel_slab(4.0, half_wave, wavelength, i).te));
      take_worst(out, std::abs(fresnel_slab(4.0, half_wave, wavelength, i).tm));
    } else {
      const Fresnel whole = fresnel({5.0, -0.5}, i), thick = fresnel_slab({5.0, -0.5}, thickness_m, wavelength, i);
      take_worst(out, std::abs(thick.te - whole.te));
      take_worst(out, std::abs(thick.tm - whole.tm));
    }
  }
  return out;
}

/// Finite, and between 0 and 1, of facets without area, at no distance, at grazing; a figure counts what is not.
StressFigure factors() {
  StressFigure out;
  const auto share = [&](double f) { out.figure += f >= 0.0 && f <= 1.0 ? 0.0 : 1.0; };
  for (const double area : {0.0, 1e-12, 1.0, 1e12})
    for (const double c : {0.0, 1e-12, 1.0})
      for (const double d : {0.0, 1e-9, 1e9}) share(finite_facet_factor(area, c, 0.19, d));
  for (const double sigma : {0.0, 1e-9, 0.05, 1e3, 1e200})
    for (const double c : {0.0, 1e-9, 1.0}) share(roughness_factor(sigma, c, 0.19));
  if (finite_facet_factor(1e12, 1.0, 0.19, 1.0) != 1.0 || roughness_factor(0.0, 1.0, 0.19) != 1.0) out.figure += 1.0;
  return out;
}

/// A rectangle of z = 0 from (-wide, -deep) to (wide, deep) that faces up.
scene::Facet rectangle(double wide_m, double deep_m) {
  scene::Facet facet;
  facet.normal_W = Eigen::Vector3d::UnitZ();
  facet.area_m2 = 4.0 * wide_m * deep_m;
  const std::array<Eigen::Vector3d, 4> corners{
      Eigen::Vector3d(-wide_m, -deep_m, 0.0), {wide_m, -deep_m, 0.0}, {wide_m, deep_m, 0.0}, {-wide_m, deep_m, 0.0}};
  for (std::size_t k = 0; k < 4; ++k) facet.borders.push_back({corners[k], corners[(k + 1) % 4]});
  return facet;
}

/// Finite, and no more than kMostMirrored, on sides and corners, from within the plane, of needles; a figure counts
/// what is not. Endless in all directions it is 1, and far beside it is nothing.
StressFigure mirrors_at_their_ends() {
  StressFigure out;
  for (const double wide : {1e-9, 0.1, 5.0, 1e5}) {
    for (const double deep : {1e-6, 3.0, 1e6}) {
      const scene::Facet facet = rectangle(wide, deep);
      for (const double depth : {0.0, 1e-9, 2.0, 1e7}) {
        for (const double x : {0.0, wide, std::nextafter(wide, 1e9), 1e6}) {
          for (const double grazing : {1e-9, 0.3, 0.5 * kPi}) {
            const Eigen::Vector3d towards(std::cos(grazing), 0.0, std::sin(grazing)), at(x, deep, 0.0);
            const Eigen::Vector3d image = at - depth / std::max(std::sin(grazing), 1e-12) * towards;
            const Complex share = mirrored_share(facet, x <= wide, {image, towards, at, 0.19});
            out.figure += std::isfinite(std::abs(share)) && std::abs(share) <= kMostMirrored ? 0.0 : 1.0;
          }
        }
      }
    }
  }
  const scene::Facet endless = rectangle(1e6, 1e6);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const auto at = [&](const scene::Facet& f, double x, bool holds) {
    return mirrored_share(f, holds, {{x, 0, -10.0}, up, {x, 0, 0}, 0.19});
  };
  out.figure += std::abs(at(endless, 0.0, true) - 1.0) < 1e-3 ? 0.0 : 1.0;
  out.figure += std::abs(at(rectangle(1.0, 1.0), 1e6, false)) < 1e-6 ? 0.0 : 1.0;
  return out;
}

/// The field of bounces along a straight corner: every further one at the same two walls, with coefficients of a
/// perfect conductor, keeps |field| = 1: rotations of phase do not lose power. 64 eps a bounce.
StressFigure conductor_bounces() {
  StressFigure out{0.0, 3.0 * 64.0 * kEpsilon};
  for (double tilt = 0.0; tilt <= 1.5; tilt += 0.1) {
    Eigen::Vector3d way(std::cos(tilt), 0.1 * std::sin(tilt), -std::sin(tilt));
    way.normalize();
    std::vector<Bounce> bounces;
    for (int k = 0; k < 3; ++k) {
      Eigen::Vector3d normal(std::cos(1.1 * k), std::sin(1.1 * k), 0.3 * k);
      normal.normalize();
      if (normal.dot(way) > 0.0) normal = -normal;
      bounces.push_back({way, normal, {-1.0, 1.0, 0.0, 1.0}, 1.0});
      way -= 2.0 * way.dot(normal) * normal;
      const CircularField field = reflected_field(bounces);
      take_worst(out, std::abs(std::norm(field.copolar) + std::norm(field.crosspolar) - 1.0));
    }
  }
  return out;
}

/// A wall of 2 km square in the plane x = d, and ground that does not reflect.
std::unique_ptr<scene::Scene> wall(double d_m, double half_m = 1024.0) {
  scene::SceneParts parts;
  parts.name = "wall";
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("wall", scene::ObjectKind::kWall);
  mesh.quad({d_m, half_m, -half_m}, {d_m, -half_m, -half_m}, {d_m, -half_m, half_m}, {d_m, half_m, half_m},
            mesh.material("metal"));
  return std::make_unique<scene::Scene>(std::move(parts));
}

SignalPaths paths_of(const scene::Scene& scene, const Eigen::Vector3d& antenna, const Eigen::Vector3d& satellite) {
  PathParameters p;
  p.cutoff_m = 1e6, p.weakest_db = p.weakest_nlos_db = -200.0, p.finite_facets = false;
  const std::vector<Eigen::Vector3d> directions{satellite};
  std::vector<SignalPaths> out(1);
  GnssCounters counters;
  make_specular1(p)->trace(antenna, PlaneWaves(directions), scene::SceneAt(scene), out, counters);
  return out[0];
}

/// A wall at perpendicular distance d adds 2 d cos(incidence), and only for a satellite before it. Its plane and the
/// antenna are exact numbers; 32 eps of coordinates.
StressFigure excess(double d_m, double elevation_rad, double azimuth_rad) {
  const auto scene = wall(d_m, d_m > 100.0 ? 65536.0 : 1024.0);
  // The satellite stands to the west, the wall to the east.
  const Eigen::Vector3d satellite(-std::cos(elevation_rad) * std::cos(azimuth_rad),
                                  std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad));
  const SignalPaths found = paths_of(*scene, {0.0, 0.0, 0.0}, satellite);
  if (found.echoes.size() != 1 || !found.line_of_sight) return {kInfinity, 0.0};
  return {std::abs(found.echoes[0].excess_m - 2.0 * d_m * -satellite.x()), 32.0 * kEpsilon * std::max(d_m, 1.0)};
}

/// On the wall, in it, or along it nothing may come that is not finite; a figure counts.
StressFigure at_the_wall() {
  StressFigure out;
  const auto scene = wall(4.0);
  for (const double x : {4.0, std::nextafter(4.0, 0.0), std::nextafter(4.0, 5.0), 4.0 - 1e-9, 4.0 + 1e-9})
    for (const Eigen::Vector3d& s :
         {Eigen::Vector3d(-1, 0, 0), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(-0.6, 0, 0.8),
          Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(-1e-9, 0, 1)}) {
      const SignalPaths found = paths_of(*scene, {x, 0.0, 0.0}, s.normalized());
      out.figure += std::isfinite(std::abs(found.direct)) && std::isfinite(found.foliage_m) ? 0.0 : 1.0;
      for (const SignalPath& echo : found.echoes)
        out.figure += std::isfinite(echo.excess_m) && echo.excess_m >= 0.0 && std::isfinite(std::abs(echo.copolar)) &&
                              std::isfinite(std::abs(echo.crosspolar)) && echo.arrival_W.allFinite()
                          ? 0.0
                          : 1.0;
    }
  return out;
}

}  // namespace

std::vector<StressCase> wave_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "Fresnel integrals from nothing to far away",
           "a series that cancels, a phase of pi x^2 / 2 whose own digits are lost, an overflow of x^2",
           "at even whole x: C = 1/2, S = 1/2 - 1 / (pi x), to 1e-10 as documented", ""});
  for (const int k : {2, 5, 10, 20, 24, 30, 100, 600})
    rows.add("waves/fresnel_integral_at_2^" + std::to_string(k), [k] { return at_powers_of_two(k); });
  rows.add("waves/fresnel_integral_up_to_5", small_arguments);

  rows.of({StressGroup::kGeometry, "a knife edge from deep shadow to far lit",
           "1/2 (1 + j) less an integral that is nearly it; a sign of nu",
           "1 / (sqrt 2 pi nu) of the field, or ripples of it", ""});
  for (const double nu : {3.0, 30.0, 1e3, 1e5}) {
    const std::string name = printed("%g", nu);
    rows.add(std::string("waves/knife_edge_shadow_at_nu_") + name, [nu] { return deep_shadow(nu); });
    rows.add(std::string("waves/knife_edge_lit_at_nu_minus_") + name, [nu] { return far_lit(nu); });
  }
  rows.add("waves/knife_edge_at_the_border", shadow_border);

  rows.of({StressGroup::kGeometry, "a surface that does not reflect, at grazing",
           "1 - sin^2 loses all digits at grazing: air becomes a mirror", "none at permittivity 1: 32 eps", ""});
  rows.add("waves/air_reflects_nothing", air);
  rows.of({StressGroup::kGeometry, "reflection at grazing incidence",
           "a quotient of two small numbers; TM of the wrong sign",
           "-1 but for 2 c / root and 2 eps c / root; never above 1", "of the bounds"});
  rows.add("waves/grazing_glass", [] { return grazing(6.27); })
      .add("waves/grazing_wet_ground",
           [] {
             return grazing({20.0, -5.0});
           })
      .add("waves/grazing_nearly_air", [] { return grazing(1.0001); })
      .add("waves/grazing_metal", [] {
        return grazing({1.0, -1e7});
      });
  rows.of({StressGroup::kStiff, "a slab without thickness, or endless",
           "an exponential that overflows, a phase of a million turns",
           "none, none of half a wave, or the half-space; 64 eps", ""});
  rows.add("waves/slab_of_no_thickness", [] { return slab(0.0); })
      .add("waves/slab_of_10_m", [] { return slab(10.0); })
      .add("waves/slab_of_1e9_m", [] { return slab(1e9); });
  rows.of({StressGroup::kGeometry, "facets without area, at no distance, endlessly rough",
           "0 / 0 and overflows of squares", "factors between 0 and 1", "outside"});
  rows.add("waves/factors_at_their_ends", factors);
  rows.of({StressGroup::kGeometry, "mirrors endless, needles, met on a side, from their plane",
           "sides that no way passes, 0 / 0 on a corner, fields of sides that do not cancel",
           "finite, at most twice an endless mirror's; 1 and 0 at the ends", "outside"});
  rows.add("waves/mirrors_at_their_ends", mirrors_at_their_ends);
  rows.of({StressGroup::kGeometry, "power over several reflections in turned planes",
           "phases between planes of incidence that are no rotation", "power 1 off conductors: 64 eps a bounce", ""});
  rows.add("waves/three_bounces_off_conductors", conductor_bounces);

  rows.of({StressGroup::kGeometry, "a reflection off a wall near, far and grazing",
           "an excess as the difference of two long ways: all digits lost", "2 d cos(incidence) to 32 eps of d", "m"});
  struct Place {
    double d, e, a;
    const char* name;
  };
  for (const Place& p :
       {Place{0.0078125, 0.3, 0.2, "8_mm"}, Place{4.0, 0.0, 0.0, "square_on"},
        Place{4.0, 1.5, 0.0, "satellite_overhead"}, Place{512.0, 0.3, 1.0, "512_m"}, Place{4.0, 0.2, 1.56, "grazing"}})
    rows.add(std::string("waves/wall_") + p.name, [p] { return excess(p.d, p.e, p.a); });
  rows.of({StressGroup::kGeometry, "an antenna in the plane of a wall",
           "an image in the same place, a beam without opening", "finite ways and fields, or none", "not finite"});
  rows.add("waves/antenna_at_the_wall", at_the_wall);
  return rows.take();
}

}  // namespace canyon::gnss
