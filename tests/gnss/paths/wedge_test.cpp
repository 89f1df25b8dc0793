#include "canyon/gnss/paths/diffraction/wedge.h"

#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/gnss/paths/diffraction/diffraction.h"
#include "canyon/gnss/paths/diffraction/knife_edge.h"
#include "canyon/gnss/paths/propagation.h"
#include "canyon/gnss/signal.h"
#include "canyon/scene/scene_at.h"
#include "canyon/tests/gnss/paths/wall_scene.h"

namespace canyon::gnss {
namespace {

using testing::WallScene;
using Wave = std::complex<double>;
const double kWave_m = kL1WavelengthM;
const double kK = 2.0 * kPi / kWave_m;

/// Geometric optics and the edge, relative to the incident wave at the edge, at (s, phi) about a conducting wedge.
Wave uniform(double n, double phi_in, double phi_out, double s_m, double mirror, double sine_beta = 1.0) {
  const double reach = kK * s_m * sine_beta * sine_beta;
  Wave u = WedgeBorders({n, phi_in, phi_out, sine_beta, s_m, kWave_m}).field(mirror, mirror) *
           std::polar(1.0, -kK * s_m * sine_beta * sine_beta);
  if (phi_out - phi_in < kPi && phi_in - phi_out < kPi) u += std::polar(1.0, reach * std::cos(phi_out - phi_in));
  if (phi_out + phi_in < kPi) u += mirror * std::polar(1.0, reach * std::cos(phi_out + phi_in));
  if (phi_out + phi_in > 2.0 * n * kPi - kPi)
    u += mirror * std::polar(1.0, reach * std::cos(2.0 * n * kPi - phi_out - phi_in));
  return u;
}

// Sommerfeld's exact solution of the conducting half-plane (Born & Wolf, section 11.5), time factor exp(+j w t).
Wave sommerfeld(double phi_in, double phi_out, double s_m, double mirror) {
  const auto half = [&](double angle) {
    // exp(j pi / 4) / sqrt(pi) times the integral of exp(-j t^2) from -sqrt(2 k s) cos(angle / 2) on.
    const double from = -std::sqrt(2.0 * kK * s_m) * std::cos(0.5 * angle);
    const Wave tail = std::sqrt(0.5 * kPi) * std::conj(Wave(0.5, 0.5) - fresnel_integral(from * std::sqrt(2.0 / kPi)));
    return std::polar(1.0, 0.25 * kPi) / std::sqrt(kPi) * std::polar(1.0, kK * s_m * std::cos(angle)) * tail;
  };
  return half(phi_out - phi_in) + mirror * half(phi_out + phi_in);
}

TEST(Wedge, HalfPlaneIsSommerfelds) {
  for (const double s_m : {0.1, 1.0, 20.0})
    for (const double mirror : {-1.0, 1.0})
      for (double phi_in = 0.15; phi_in < kPi; phi_in += 0.37)
        for (double phi_out = 0.03; phi_out < 2.0 * kPi; phi_out += 0.0517)
          EXPECT_NEAR(std::abs(uniform(2.0, phi_in, phi_out, s_m, mirror) - sommerfeld(phi_in, phi_out, s_m, mirror)),
                      0.0, 1e-8)  // of the Fresnel integrals, 1e-10, times 2 sqrt(k s)
              << s_m << " " << phi_in << " " << phi_out;
}

// The exact series of the conducting wedge (Balanis, Advanced Engineering Electromagnetics, section 11.6): for n = 3/2
// the theory is asymptotic, off by its next order, which falls faster than the diffracted field's own 1 / sqrt(k s).
TEST(Wedge, RightAngledCornerIsTheSeries) {
  const double n = 1.5;
  const auto series = [&](double phi_in, double phi_out, double rho, double mirror) {
    Wave u = 0.0;
    for (int m = 0; m < 200; ++m) {
      const double v = m / n;
      if (v > rho + 40.0) break;
      const double weight = m == 0 ? 0.5 : 1.0;
      const double terms = std::cos(v * (phi_out - phi_in)) + mirror * std::cos(v * (phi_out + phi_in));
      u += weight * std::polar(1.0, 0.5 * kPi * v) * std::cyl_bessel_j(v, rho) * terms;
    }
    return 2.0 / n * u;
  };
  double worst_near = 0.0, worst_far = 0.0;
  for (const double mirror : {-1.0, 1.0})
    for (double phi_in = 0.2; phi_in < n * kPi; phi_in += 0.61)
      for (double phi_out = 0.05; phi_out < n * kPi; phi_out += 0.073) {
        const auto off = [&](double rho) {
          return std::abs(uniform(n, phi_in, phi_out, rho / kK, mirror) - series(phi_in, phi_out, rho, mirror));
        };
        worst_near = std::max(worst_near, off(12.0));
        worst_far = std::max(worst_far, off(48.0));
      }
  EXPECT_LT(worst_near, 0.02);             // K&P's figures, at a wavelength or two, show no difference to draw
  EXPECT_LT(worst_far, 0.5 * worst_near);  // between (1/4)^(1/2), which is the field's own, and (1/4)^(3/2)
}

// Across each border the geometric field jumps by the whole wave; what is left of it is the step in the angle, 2e-7,
// times the field's slope in it, k s.
TEST(Wedge, TotalIsContinuousOverAllBorders) {
  const double s_m = 15.0, step = 1e-7;
  for (const double n : {1.5, 1.2, 2.0}) {
    for (const double mirror : {-1.0, 1.0}) {
      for (const double phi_in : {0.4, 1.1, 0.6 * n * kPi, n * kPi - 0.3}) {
        for (const double border : {phi_in + kPi, phi_in - kPi, kPi - phi_in, 2.0 * n * kPi - kPi - phi_in}) {
          if (border < 0.1 || border > n * kPi - 0.1) continue;
          const Wave one = uniform(n, phi_in, border - step, s_m, mirror);
          const Wave two = uniform(n, phi_in, border + step, s_m, mirror);
          EXPECT_LT(std::abs(one - two), 4.0 * step * kK * s_m) << n << " " << phi_in << " " << border;
          // Also through the closed form of the limit, which takes over within 1e-5 rad.
          const Wave outside = uniform(n, phi_in, border + 1.001e-5, s_m, mirror);
          EXPECT_LT(std::abs(outside - two), 4.0 * 1e-5 * kK * s_m);
        }
      }
    }
  }
}

TEST(Wedge, SameBothWays) {
  WedgeWay there{1.5, 0.7, 3.9, 0.8, 12.0, kWave_m};
  WedgeWay back = there;
  std::swap(back.phi_in_rad, back.phi_out_rad);
  const Wave face_0(-0.8, 0.1), face_n(-0.6, 0.2);
  EXPECT_NEAR(std::abs(WedgeBorders(there).field(face_0, face_n) - WedgeBorders(back).field(face_0, face_n)), 0.0,
              1e-14);
}

/// The upright corner at x = y = 0 of a house, 80 m up and down from z = 0, with a material of its own on each side.
std::unique_ptr<scene::Scene> corner_of(const std::string& east, const std::string& north) {
  const Eigen::Vector3d low(-60, -60, -80), x(60, 0, 0), y(0, 60, 0), z(0, 0, 160);
  return WallScene()
      .wall(low, y, x)
      .face(low + z, x, y, "concrete")
      .face(low, x, z, "concrete")
      .face(low, z, y, "concrete")
      .face(low + y, z, x, north)
      .face(low + x, y, z, east)
      .build();
}

/// What bends around that corner at z = `up_m`, from a wave that comes from s to the place that lies `distance_m` off
/// in the direction u.
SignalPath bent(const scene::Scene& scene, double up_m, const Eigen::Vector3d& s, const Eigen::Vector3d& u,
                double distance_m) {
  PathParameters p;
  p.weakest_db = p.weakest_nlos_db = -60.0;
  const auto model = find_model(diffraction_models(), "wedge")->make({}, p);
  std::vector<SignalPaths> out(1);
  GnssCounters counters;
  model->trace(Eigen::Vector3d(0, 0, up_m) + distance_m * u, std::vector{s}, scene::SceneAt(scene), out, counters);
  const double detour_m = distance_m * (1.0 + u.dot(s));
  for (const SignalPath& e : out[0].echoes)
    if (std::abs(e.excess_m - detour_m) < 1e-9) return e;
  ADD_FAILURE() << "nothing bends with a detour of " << detour_m << " m";
  return {};
}

// Source and antenna change places about an edge whose faces differ and lose: both hands of the field are the same, in
// the shadow and on the lit side, straight across the edge and askew to it. With coefficients at the wave's own grazing
// angle (Luebbers) they would not be; those of wedges.cpp are taken at half the bend, which has no direction. 1e-12 is
// ten times the rounding of a phase k s of 400.
TEST(Wedge, AHouseOfTwoMaterialsIsTheSameBothWays) {
  for (const auto& [east, north] : {std::pair{"concrete", "brick"}, std::pair{"glass", "concrete"}}) {
    const auto house = corner_of(east, north), turned = corner_of(north, east);
    for (const double askew_deg : {0.0, 25.0})
      for (const double from_deg : {105.0, 130.0, 170.0})    // of the source, from north, eastwards
        for (const double to_deg : {-85.0, -60.0, -30.0}) {  // and of the antenna
          const Eigen::Vector3d s = testing::direction(from_deg, askew_deg), u = testing::direction(to_deg, -askew_deg);
          const SignalPath there = bent(*house, 3.0, s, u, 12.0), back = bent(*house, 3.0, u, s, 12.0);
          const std::string where = std::string(east) + " " + std::to_string(askew_deg) + " " +
                                    std::to_string(from_deg) + " " + std::to_string(to_deg);
          EXPECT_NEAR(std::abs(there.copolar - back.copolar), 0.0, 1e-12) << where;
          EXPECT_NEAR(std::abs(there.crosspolar - back.crosspolar), 0.0, 1e-12) << where;
          // It is not the same of a house whose walls have changed places: each face does count by its own.
          const SignalPath other = bent(*turned, 3.0, s, u, 12.0);
          EXPECT_GT(std::abs(there.copolar - other.copolar) + std::abs(there.crosspolar - other.crosspolar), 1e-6)
              << where;
        }
  }
}

// The line integral of Maggi and Rubinowicz of an endless edge is the knife edge's Fresnel integral; a long edge is
// one, and a wall cut into pieces is the sum of its pieces.
TEST(Wedge, EdgesOfFiniteLength) {
  for (const double nu : {0.01, 0.3, 1.0, 4.0, 12.0}) {
    EXPECT_NEAR(std::abs(finite_edge_factor(nu, -300.0, 300.0) - 1.0), 0.0, 1e-3) << nu;
    EXPECT_NEAR(std::abs(finite_edge_factor(nu, -2.9, 2.9) + 2.0 * finite_edge_factor(nu, 2.9, 300.0) - 1.0), 0.0, 1e-3)
        << nu;
    EXPECT_NEAR(std::abs(finite_edge_factor(nu, 0.0, 300.0) - 0.5), 0.0, 1e-3) << nu;
    const Wave whole = finite_edge_factor(nu, -0.7, 2.1);
    EXPECT_NEAR(std::abs(whole - finite_edge_factor(nu, -0.7, 0.4) - finite_edge_factor(nu, 0.4, 2.1)), 0.0, 1e-12);
    EXPECT_NEAR(std::abs(finite_edge_factor(nu, 1.0, 2.9999) - finite_edge_factor(nu, 1.0, 3.0001)), 0.0, 1e-3);
  }
  EXPECT_EQ(finite_edge_factor(0.0, -1.0, 2.0), Wave(1.0));
  EXPECT_EQ(finite_edge_factor(0.0, 1.0, 2.0), Wave(0.0));
}

// A screen's corner over the straight way: Kirchhoff's quarter plane lets three quarters of the field through, on
// whichever side of the two edges' borders one stands.
TEST(Wedge, CornerOfAScreenLetsThreeQuartersThrough) {
  const double off = 1e-4;
  for (const double x : {-off, off})
    for (const double z : {-off, off}) {
      // Blocked: x > 0 and z > 0, u along each edge from the point beside the way.
      const Wave screen_x = (x > 0.0 ? 1.0 : -1.0) * knife_edge_field(off) * finite_edge_factor(off, -z, 1e3);
      const Wave screen_z = (z > 0.0 ? 1.0 : -1.0) * knife_edge_field(off) * finite_edge_factor(off, -x, 1e3);
      const double lit = x > 0.0 && z > 0.0 ? 0.0 : 1.0;
      EXPECT_NEAR(std::abs(lit + screen_x + screen_z - 0.75), 0.0, 2e-3) << x << " " << z;
    }
}

/// All fields of one satellite added up, with the phases of their ways.
Wave total(const scene::Scene& scene, const Eigen::Vector3d& p_W, const Eigen::Vector3d& s) {
  const PathParameters p;
  const auto model = make_propagation(find_model(path_models(), "visibility")->make({}, p),
                                      find_model(diffraction_models(), "wedge")->make({}, p), false, p);
  std::vector<SignalPaths> out(1);
  GnssCounters counters;
  model->trace(p_W, std::vector{s}, scene::SceneAt(scene), out, counters);
  Wave sum = out[0].line_of_sight ? out[0].direct : 0.0;
  for (const SignalPath& e : out[0].echoes) sum += e.copolar * std::polar(1.0, -kK * e.excess_m);
  return sum;
}

// A long metal roof 20 m higher and 20 m away: the field across the border is the exact wedge's, and a centimetre
// changes it by little: the knife edge's slope, 1 / sqrt(2), times sqrt(2 / (wavelength s)) = 0.6 a metre, 0.004; twice
// over for the mirrors' terms, and three times over where a field fades out, 0.03. No place stands on the border
// itself.
TEST(Wedge, RoofInASceneIsTheWedgeAndContinuous) {
  const auto scene = WallScene().box({-40, -500, 0}, {-20, 500, 22.0}, "metal").build();
  const Eigen::Vector3d s = testing::direction(270, 45.0);
  Wave before = total(*scene, {-4.005, 0.0, 2.0}, s);
  double least = 1e9, most = 0.0;
  for (double x = -3.995; x < 4.0; x += 0.01) {
    const Eigen::Vector3d p(x, 0.0, 2.0);
    const Wave now = total(*scene, p, s);
    EXPECT_LT(std::abs(now - before), 0.03) << x;
    before = now;
    least = std::min(least, std::abs(now));
    most = std::max(most, std::abs(now));
    // The edge about its upper face: the wave comes 135 deg from the roof's own direction.
    const Eigen::Vector3d way = p - Eigen::Vector3d(-20.0, 0.0, 22.0);
    const double s_m = way.norm(), phi_in = 0.25 * kPi, phi_out = kPi + std::atan2(20.0, x + 20.0);
    const Wave soft = uniform(1.5, phi_in, phi_out, s_m, -1.0), hard = uniform(1.5, phi_in, phi_out, s_m, 1.0);
    const WedgeWay edge{1.5, phi_in, phi_out, 1.0, s_m, kWave_m};
    // A field between 0.1, the weakest that is followed, and 0.15 fades; the others are there whole.
    EXPECT_NEAR(std::abs(0.5 * (soft + hard)), std::abs(now),
                std::abs(WedgeBorders(edge).field(0.0, 0.0)) > 0.16 ? 0.01 : 0.15)
        << x;
  }
  EXPECT_LT(least, 0.25);
  EXPECT_GT(most, 1.05);
}

// Around the upper corner of a house, where the ends of two edges meet: no jump either.
TEST(Wedge, CornerOfAHouseIsContinuous) {
  const auto scene = WallScene().box({-40, 0, 0}, {-20, 500, 22.0}).build();
  // Not along the gable, which would be neither lit nor dark: the corner's shadow lies at y = 0.7 m. (Its mirror's
  // border, at -0.7 m, is not continuous without the mirror.)
  const Eigen::Vector3d s = testing::direction(268, 45.0);
  for (const double x : {-0.7, -0.1, 0.2, 1.0}) {
    Wave before = total(*scene, {x, -0.305, 2.0}, s);
    for (double y = -0.295; y < 2.7; y += 0.01) {
      const Wave now = total(*scene, {x, y, 2.0}, s);
      EXPECT_LT(std::abs(now - before), 0.04) << x << " " << y;
      before = now;
    }
  }
}

// The transition function as published in tables (McNamara, Pistorius & Malherbe, Introduction to the Uniform
// Geometrical Theory of Diffraction, 1990, appendix B), to the four digits that they are usually printed with.
TEST(Wedge, TransitionFunctionIsAsPublished) {
  struct Row {
    double x, real, imaginary;
  };
  for (const Row& row :
       {Row{0.3, 0.5717, 0.2730}, Row{0.5, 0.6768, 0.2682}, Row{0.7, 0.7440, 0.2549}, Row{1.0, 0.8095, 0.2322},
        Row{1.5, 0.8730, 0.1982}, Row{2.3, 0.9240, 0.1577}, Row{4.0, 0.9658, 0.1073}, Row{5.5, 0.9797, 0.0828}}) {
    EXPECT_NEAR(wedge_transition(row.x).real(), row.real, 0.5001e-4) << row.x;
    EXPECT_NEAR(wedge_transition(row.x).imag(), row.imaginary, 0.5001e-4) << row.x;
  }
}

}  // namespace
}  // namespace canyon::gnss
