// Orbits and clocks of every navigation message, by its interface document.
#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/satellites/navigation_data.h"
#include "canyon/gnss/satellites/system_constants.h"
#include "canyon/gnss/stress/satellites/drawn_records.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;
using made::Kind;
using made::kKinds;
using made::kSentWeek;
using made::some_record;
using stress::kEpsilon;
using stress::Looks;
using Message = NavigationMessage;

/// Position by turns of frames instead of the table's products, and the eccentric anomaly by bisection.
struct SentPlace {
  Vector3d p_E;
  double sine = 0.0;  ///< of the eccentric anomaly
};
SentPlace place_of_record(const KeplerEphemeris& r, const Kind& kind, double tk_s) {
  const double a0 = r.sqrt_a * r.sqrt_a, a = a0 + r.a_dot_m_s * tk_s;
  const double n = std::sqrt(kind.mu / std::pow(a0, 3)) + r.delta_n_rad_s + 0.5 * r.delta_n_dot_rad_s2 * tk_s;
  const double M = r.m0_rad + n * tk_s;
  double low = M - 0.1, high = M + 0.1;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (middle - r.e * std::sin(middle) < M ? low : high) = middle;
  }
  const double E = 0.5 * (low + high);
  const double nu =
      2.0 * std::atan2(std::sqrt(1.0 + r.e) * std::sin(0.5 * E), std::sqrt(1.0 - r.e) * std::cos(0.5 * E));
  const double phi = nu + r.argument_of_perigee_rad, s2 = std::sin(2.0 * phi), c2 = std::cos(2.0 * phi);
  const double u = phi + r.cus_rad * s2 + r.cuc_rad * c2;
  const double radius = a * (1.0 - r.e * std::cos(E)) + r.crs_m * s2 + r.crc_m * c2;
  const double i = r.i0_rad + r.idot_rad_s * tk_s + r.cis_rad * s2 + r.cic_rad * c2;
  const double sow = (r.toe - kSentWeek) - kind.ahead_s;
  const bool inclined = kind.message == Message::kD2;
  const double node = r.omega0_rad + (r.omega_dot_rad_s - (inclined ? 0.0 : kind.rate)) * tk_s - kind.rate * sow;
  Vector3d p = AngleAxisd(node, Vector3d::UnitZ()) *
               (AngleAxisd(i, Vector3d::UnitX()) * (AngleAxisd(u, Vector3d::UnitZ()) * Vector3d(radius, 0.0, 0.0)));
  // Table 5-11 of BeiDou's turns the axes: Rx(-5 deg), then Rz(w t).
  if (inclined)
    p = AngleAxisd(-kind.rate * tk_s, Vector3d::UnitZ()) * (AngleAxisd(5.0 * kDegree, Vector3d::UnitX()) * p);
  return {p, std::sin(E)};
}

/// The node of up to 46 rad is a product and a sum, here and there: four roundings of 16 epsilons; other angles are
/// below 8 rad, twelve roundings of 2 epsilons each way; of 2.7e7 m. Velocities by central differences of fourth order
/// over 20 s: 18 places over 12 h, and h^4 / 30 m^5 a with m = 2.2e-4 rad/s in E, 7.3e-8 m/s.
StressFigure orbits_of_messages() {
  Looks looks;
  const RandomStream draws(8, "stress.sent");
  const double grain_m = (4.0 * 16.0 + 24.0 * 2.0) * kEpsilon * 2.7e7;
  for (const Kind& kind : kKinds) {
    const SystemConstants& constants = constants_of(kind.system);
    looks.right(constants.mu_m3_s2 == kind.mu && constants.earth_rate_rad_s == kind.rate);
    looks.right(constants.ahead_s == kind.ahead_s);
    // -2 sqrt(mu) / c^2, of which documents print ten digits.
    looks.near(constants.relativity_s_per_sqrt_m, -2.0 * std::sqrt(kind.mu) / (kSpeedOfLight * kSpeedOfLight),
               5.01e-20);
    for (std::uint64_t k = 0; k < 30; ++k) {
      const KeplerEphemeris r = some_record(kind, draws, k);
      const double tk_s = draws.uniform(-7200.0, 7200.0, 50, k);
      const GpsTime t = r.toe + tk_s;
      const double exact_tk_s = t - r.toe;
      const SatelliteState s = r.at(t);
      const SentPlace place = place_of_record(r, kind, exact_tk_s);
      looks.near((s.p_E - place.p_E).norm(), 0.0, grain_m);
      const auto moved = [&](double dt) { return place_of_record(r, kind, exact_tk_s + dt).p_E; };
      constexpr double h = 20.0;
      const Vector3d v = (8.0 * (moved(h) - moved(-h)) - (moved(2.0 * h) - moved(-2.0 * h))) / (12.0 * h);
      looks.near((s.v_E - v).norm(), 0.0, 1.5 * grain_m / h + 7.3e-8);
      const double tc_s = t - r.toc;
      const auto clock = [&](double dt) {
        const double x = tc_s + dt, sine = place_of_record(r, kind, exact_tk_s + dt).sine;
        return r.af0_s + r.af1 * x + r.af2_per_s * x * x -
               2.0 * std::sqrt(kind.mu) / std::pow(kSpeedOfLight, 2) * r.e * r.sqrt_a * sine;
      };
      // F of ten digits by e sqrt(a) = 155, 7.8e-18 s, and 8 roundings of 4e-4 s; of its rate h^2 / 6 n^3 of 6.9e-8 s,
      // of which 4 e and 10 e^2 more are of higher harmonics.
      looks.near(s.clock_s, clock(0.0), 8.2e-18);
      looks.near(s.clock_rate, (clock(h) - clock(-h)) / (2.0 * h), 1.7e-17);
      looks.right(s.accuracy_m == r.accuracy_m && s.frequency_channel == 0);
    }
  }
  return looks.figure();
}

/// A GLONASS state vector moves by the gradient of its potential and the turning of E: accelerations as differences of
/// the potential in inertial space, mu / r (1 - J2 (R / r)^2 (3 sin^2 - 1) / 2), against second differences of the
/// orbit, both of fourth order.
///
/// In E it turns with up to m = 2.28e-4 rad/s: differences leave h^4 / 90 m^6 r = 5.2e-10 m/s^2 and h^4 / 30 m^5 r =
/// 6.8e-6 m/s. Steps of 60 s go by a motion that is off by h^4 / 120 m^5 r = 1.7e-6 m/s and by m times that, each of
/// which is 3.9e-10 m/s^2 of a second difference, as long as its five places lie on one side of toe, with last steps of
/// one length; places round by 4 eps 2.6e7 m and potentials by 4 eps 1.6e7, 1e-10 m/s^2. Around toe last steps differ:
/// each place is off by up to (m 60 s)^5 r / 120 = 1.02e-4 m, those two steps away by twice that, 36 of it in 12 h^2
/// and 20 of it in 12 h.
StressFigure accelerations_of_glonass() {
  Looks looks;
  const RandomStream draws(10, "stress.sent");
  constexpr double kMu = 3.9860044e14, kRate = 7.292115e-5, kJ2 = 1.08262575e-3, kRadius = 6378136.0;
  const auto potential = [&](const Vector3d& p) {
    const double r = p.norm(), sine = p.z() / r;
    return kMu / r * (1.0 - kJ2 * (kRadius / r) * (kRadius / r) * 0.5 * (3.0 * sine * sine - 1.0));
  };
  for (std::uint64_t k = 0; k < 40; ++k) {
    GlonassEphemeris g;
    g.sv = {GnssSystem::kGlonass, 3};
    g.toe = kSentWeek + 900.0 * static_cast<double>(k);
    g.p_E = 2.55e7 * draws.direction(0, k);
    // Across the radius at the speed of a circle, seen from the turning Earth.
    const Vector3d w(0.0, 0.0, kRate), across = g.p_E.unitOrthogonal();
    g.v_E =
        std::sqrt(kMu / 2.55e7) * (AngleAxisd(draws.uniform(0, 6, 1, k), g.p_E.normalized()) * across) - w.cross(g.p_E);
    g.a_E = 3e-6 * draws.direction(2, k);
    g.clock_s = 1e-4, g.clock_rate = draws.uniform(-1e-11, 1e-11, 3, k), g.delta_tau_s = 5e-9, g.frequency_channel = -4;
    const bool around = k % 4 == 0;
    const double away_s = draws.uniform(around ? 0.0 : 121.0, around ? 119.0 : 800.0, 4, k);
    const double at_s = k % 2 == 0 ? away_s : -away_s;
    const auto p = [&](double dt) { return g.at(g.toe + at_s + dt).p_E; };
    constexpr double h = 60.0;
    const SatelliteState now = g.at(g.toe + at_s);
    const Vector3d second = (16.0 * (p(h) + p(-h)) - (p(2.0 * h) + p(-2.0 * h)) - 30.0 * p(0.0)) / (12.0 * h * h);
    const Vector3d first = (8.0 * (p(h) - p(-h)) - (p(2.0 * h) - p(-2.0 * h))) / (12.0 * h);
    Vector3d pull;
    for (int i = 0; i < 3; ++i) {
      const Vector3d step = 1000.0 * Vector3d::Unit(i);
      pull[i] = (8.0 * (potential(now.p_E + step) - potential(now.p_E - step)) -
                 (potential(now.p_E + 2.0 * step) - potential(now.p_E - 2.0 * step))) /
                12e3;
    }
    const Vector3d expected = pull + g.a_E - 2.0 * w.cross(now.v_E) - w.cross(w.cross(now.p_E));
    looks.near((second - expected).norm(), 0.0, 1.4e-9 + (around ? 8.5e-8 : 0.0));
    looks.near((first - now.v_E).norm(), 0.0, 6.9e-6 + (around ? 2.9e-6 : 0.0));
    looks.near(now.clock_s, 1e-4 + g.clock_rate * at_s, 2.0 * kEpsilon * 1e-4);
    looks.right(now.clock_rate == g.clock_rate && now.group_delay_s[2] == 5e-9 && now.group_delay_s[1] == 0.0);
    looks.right(now.frequency_channel == -4 && g.at(g.toe).p_E == g.p_E && g.at(g.toe).v_E == g.v_E);
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> sent_orbit_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "orbits and clocks of every navigation message",
           "a harmonic of the other function, a rate of the node's in the inclined frame, a week of BeiDou's 14 s off",
           "frames turned one after the other, anomalies by bisection, velocities by differences: rounding of angles",
           "of the bound"});
  rows.add("sent/orbits", orbits_of_messages).add("sent/glonass_accelerations", accelerations_of_glonass);
  return rows.take();
}

}  // namespace canyon::gnss
