// Records that satellites send: each message's orbit, clock and delays by its interface document, and which is taken.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/satellites/contradictions.h"
#include "canyon/gnss/satellites/ephemerides/ephemeris_limits.h"
#include "canyon/gnss/satellites/navigation_data.h"
#include "canyon/gnss/satellites/system_constants.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Looks;
using Message = NavigationMessage;

const GpsTime kSentWeek = GpsTime::from_week_sow(2253, 0.0);

struct Kind {
  GnssSystem system;
  Message message;
  double mu, rate, ahead_s;
};
/// Constants as the interface documents print them: IS-GPS-200N 20-IV, OS SIS ICD 2.1 5.1.1, BDS-SIS-ICD-B1I 3.0.
constexpr Kind kKinds[] = {{GnssSystem::kGps, Message::kLnav, 3.986005e14, 7.2921151467e-5, 0.0},
                           {GnssSystem::kGps, Message::kCnav, 3.986005e14, 7.2921151467e-5, 0.0},
                           {GnssSystem::kQzss, Message::kCnav2, 3.986005e14, 7.2921151467e-5, 0.0},
                           {GnssSystem::kGalileo, Message::kInav, 3.986004418e14, 7.2921151467e-5, 0.0},
                           {GnssSystem::kGalileo, Message::kFnav, 3.986004418e14, 7.2921151467e-5, 0.0},
                           {GnssSystem::kBeidou, Message::kD1, 3.986004418e14, 7.2921150e-5, 14.0},
                           {GnssSystem::kBeidou, Message::kD2, 3.986004418e14, 7.2921150e-5, 14.0},
                           {GnssSystem::kBeidou, Message::kBcnav1, 3.986004418e14, 7.2921150e-5, 14.0},
                           {GnssSystem::kBeidou, Message::kBcnav2, 3.986004418e14, 7.2921150e-5, 14.0}};

/// With every term that a message may have.
KeplerEphemeris some_record(const Kind& kind, const RandomStream& draws, std::uint64_t k) {
  const auto u = [&](std::uint32_t i, double most) { return draws.uniform(-most, most, i, k); };
  KeplerEphemeris r;
  r.sv = {kind.system, static_cast<std::uint8_t>(1 + k % 30)};
  r.message = kind.message;
  r.toe = kSentWeek + 7200.0 * static_cast<double>(1 + k % 80);
  r.toc = r.toe - 960.0;
  r.af0_s = u(0, 4e-4), r.af1 = u(1, 1e-11), r.af2_per_s = u(2, 1e-17);
  r.sqrt_a = 5153.7 + u(3, 3.0), r.e = draws.uniform(0.0, 0.03, 4, k);
  r.a_dot_m_s = u(5, 0.02), r.delta_n_dot_rad_s2 = u(6, 1e-13);
  r.i0_rad = kind.message == Message::kD2 ? 0.1 + u(7, 0.02) : 0.96 + u(7, 0.05), r.idot_rad_s = u(8, 5e-10);
  r.omega0_rad = u(9, kPi), r.omega_dot_rad_s = u(10, 9e-9);
  r.argument_of_perigee_rad = u(11, kPi), r.m0_rad = u(12, kPi), r.delta_n_rad_s = u(13, 5e-9);
  r.cuc_rad = u(14, 1e-5), r.cus_rad = u(15, 1e-5), r.cic_rad = u(16, 1e-6), r.cis_rad = u(17, 1e-6);
  r.crc_m = u(18, 400.0), r.crs_m = u(19, 400.0);
  r.tgd_s = u(20, 2e-8), r.tgd2_s = u(21, 2e-8);
  for (std::uint32_t b = 0; b < 10; ++b) r.isc_s[b] = u(30 + b, 5e-9);
  r.accuracy_m = 2.0;
  return r;
}

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

/// Delays of each band as its document has them, in seconds: roundings.
StressFigure delays_of_messages() {
  Looks looks;
  const RandomStream draws(9, "stress.sent");
  const double g2 = std::pow(1575.42 / 1227.60, 2), g5 = std::pow(1575.42 / 1176.45, 2),
               g7 = std::pow(1575.42 / 1207.14, 2);
  for (const Kind& kind : kKinds) {
    const KeplerEphemeris r = some_record(kind, draws, 3);
    std::array<double, 10> exact{};
    unsigned lent = 0;
    switch (kind.message) {
      case Message::kLnav:
        exact[1] = r.tgd_s, exact[2] = g2 * r.tgd_s;
        break;
      case Message::kCnav:
      case Message::kCnav2:
        for (const std::size_t b : {1U, 2U, 5U}) exact[b] = r.tgd_s - r.isc_s[b];
        break;
      case Message::kInav:
        // E5a through E1: what differs of the two bands is (g5 - 1) of the group delay of E1 and E5a.
        exact[1] = r.tgd2_s, exact[7] = g7 * r.tgd2_s, exact[5] = r.tgd2_s + (g5 - 1.0) * r.tgd_s;
        break;
      case Message::kFnav:
        exact[1] = r.tgd_s, exact[5] = g5 * r.tgd_s;
        break;
      case Message::kD1:
      case Message::kD2:
        exact[1] = exact[2] = r.tgd_s, exact[7] = r.tgd2_s, lent = 2;
        break;
      default:
        exact[1] = exact[2] = r.tgd_s, exact[5] = r.tgd2_s, lent = 4;
    }
    const SatelliteState s = r.at(r.toe);
    for (std::size_t b = 0; b < 10; ++b) {
      looks.near(s.group_delay_s[b], exact[b], 8.0 * kEpsilon * 5e-8);
      looks.near(s.clock_of_band_s(static_cast<int>(b)), s.clock_s - exact[b], 8.0 * kEpsilon * 1e-3);
    }
    looks.right(s.borrowed_delay_bands == lent);
    looks.right(r.geostationary_frame() == (kind.message == Message::kD2));
  }
  return looks.figure();
}

/// Health and validity, message by message: what counts of the bits, both ends of each interval, the default ones.
StressFigure health_and_validity() {
  int wrong = 0;
  const RandomStream draws(9, "stress.sent");
  for (const Kind& kind : kKinds) {
    KeplerEphemeris r = some_record(kind, draws, 1);
    const bool lowest = kind.message == Message::kCnav || kind.message == Message::kCnav2;
    for (int health = 0; health < 64; ++health) {
      r.health = health;
      wrong += r.healthy() == (health == 0 || (lowest && health == 1)) ? 0 : 1;
    }
    r.health = 0, r.accuracy_m = -1.0;
    wrong += r.healthy() == (kind.system != GnssSystem::kGalileo) ? 0 : 1;
    r.valid_before_s = 3600.0, r.valid_after_s = 5000.0;
    for (const auto& [dt, good] : {std::pair{-3600.0, true}, {-3600.5, false}, {5000.0, true}, {5000.5, false}})
      wrong += r.valid_at(r.toe + dt) == good ? 0 : 1;
    const Validity found = default_validity(kind.system, kind.message);
    const double hours[2] = {kind.system == GnssSystem::kGps ? (kind.message == Message::kLnav ? 2.0 : 1.5) : 1.0,
                             kind.system == GnssSystem::kGps       ? (kind.message == Message::kLnav ? 2.0 : 1.5)
                             : kind.system == GnssSystem::kGalileo ? 4.0
                             : kind.system == GnssSystem::kBeidou  ? 2.0
                                                                   : 1.0};
    wrong += found.before_s == 3600.0 * hours[0] && found.after_s == 3600.0 * hours[1] ? 0 : 1;
  }
  KeplerEphemeris qzss = some_record(kKinds[2], draws, 1);
  qzss.message = Message::kLnav;
  for (int health = 0; health < 64; ++health) {
    qzss.health = health;
    wrong += qzss.healthy() == (health < 2) ? 0 : 1;
  }
  GlonassEphemeris g;
  g.toe = kSentWeek + 900.0;
  for (const auto& [dt, good] : {std::pair{-1200.0, true}, {-1200.5, false}, {1200.0, true}, {1200.5, false}})
    wrong += g.valid_at(g.toe + dt) == good ? 0 : 1;
  for (int prn = 1; prn < 64; ++prn)
    wrong += beidou_message(prn) == (prn < 6 || prn > 58 ? Message::kD2 : Message::kD1) ? 0 : 1;
  // What messages can hold stays below the limits, and eight times as much does not, but for clocks.
  using namespace ephemeris_limits;
  const auto fits = [&](double limit, double most, double room = 8.0) {
    wrong += limit >= most && limit <= room * most ? 0 : 1;
  };
  fits(kAngleRad, kPi), fits(kRateRadS, kPi * std::ldexp(1.0, -23)), fits(kHarmonicM, std::ldexp(1.0, 15));
  fits(kHarmonicRad, std::ldexp(1.0, -10)), fits(kGrowthMS, std::ldexp(1.0, 24 - 21));
  fits(kClockRate, std::ldexp(1.0, -26)), fits(kClockRateOfRate, std::ldexp(1.0, -48), 300.0);
  fits(kRateOfRateRadS2, kPi * std::ldexp(1.0, -35)), fits(kClockS, std::ldexp(1.0, -4), 20.0);
  wrong += is_sane_radius(6.4e6) && is_sane_radius(4.3e7) && !is_sane_radius(6.2e6) && !is_sane_radius(1.01e8) ? 0 : 1;
  wrong += is_sane_radius(std::nan("")) ? 1 : 0;
  const KeplerEphemeris r = some_record(kKinds[0], draws, 2);
  wrong += std::abs(radius_at_toe_m(r) - r.at(r.toe).p_E.norm()) > 0.0 ? 1 : 0;
  KlobucharCoefficients c = kBuiltInKlobuchar;
  wrong += is_sane(c) ? 0 : 1;
  for (std::size_t i = 0; i < 4; ++i)
    for (const double bad : {1.1, -1.1, std::nan("")}) {
      KlobucharCoefficients alpha = c, beta = c;
      alpha.alpha[i] = 1e-4 * bad, beta.beta[i] = 1e8 * bad;
      wrong += is_sane(alpha) || is_sane(beta) ? 1 : 0;
    }
  c.alpha = {std::ldexp(1.0, -23), std::ldexp(1.0, -20), std::ldexp(1.0, -17), -std::ldexp(1.0, -17)};
  c.beta = {1.8e5, -2.1e6, 8.4e6, -8.4e6};
  wrong += is_sane(c) ? 0 : 1;
  return {1.0 * wrong, 0.0};
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

/// Which record a state is by, of 40 in disorder: their clocks say. By definition over all of them, at times to both
/// sides of toe, between them and far off.
StressFigure records_chosen() {
  int wrong = 0;
  const RandomStream draws(11, "stress.sent");
  NavigationData data;
  for (const std::size_t kind : {0U, 1U, 3U, 5U, 4U})
    for (std::uint64_t k = 0; k < 12; ++k) {
      const std::uint64_t at = 20 * kind + k;
      KeplerEphemeris r = some_record(kKinds[kind], draws, at);
      r.sv.prn = static_cast<std::uint8_t>(kind == 1 ? 1 + k % 2 : kind == 4 ? 7 + k % 3 : 7 + k % 2);
      r.toe = kSentWeek + 1800.0 * std::floor(draws.uniform(0.0, 24.0, 60, at));
      r.toc = r.toe, r.af0_s = 1e-6 * static_cast<double>(data.kepler.size() + 1), r.af1 = r.af2_per_s = 0.0, r.e = 0.0;
      r.health = k % 6 == 5 ? 63 : 0;
      const Validity validity = default_validity(r.sv.system, r.message);
      r.valid_before_s = validity.before_s, r.valid_after_s = validity.after_s;
      if (k % 3 == 0) r.transmitted = r.toe + draws.uniform(-7200.0, 1200.0, 61, at);
      data.kepler.push_back(r);
    }
  for (std::uint64_t k = 0; k < 12; ++k) {
    GlonassEphemeris g;
    g.sv = {GnssSystem::kGlonass, static_cast<std::uint8_t>(1 + k % 2)};
    g.toe = kSentWeek + 1800.0 * std::floor(draws.uniform(0.0, 12.0, 62, k));
    g.p_E = {2.55e7, 0.0, 0.0}, g.v_E = {0.0, 2000.0, 3000.0}, g.clock_s = 1e-6 * static_cast<double>(500 + k);
    g.health = k == 7 ? 1 : 0;
    data.glonass.push_back(g);
  }
  for (const EphemerisChoice choice : {EphemerisChoice::kNearestToe, EphemerisChoice::kTransmitted})
    for (const std::string systems : {"GRECJ", "GE"}) {
      BroadcastOptions options;
      options.systems = systems, options.choice = choice;
      const auto all = make_broadcast(data, options);
      const NavigationData used = used_records(data, options);
      for (const SatelliteId sv : all->satellites())
        wrong += systems.find(system_letter(sv.system)) == std::string::npos;
      wrong += used.glonass.empty() == (systems == "GE") ? 0 : 1;
      for (const SatelliteId sv : {SatelliteId{GnssSystem::kGps, 1},
                                   {GnssSystem::kGps, 7},
                                   {GnssSystem::kGps, 8},
                                   {GnssSystem::kGalileo, 7},
                                   {GnssSystem::kGalileo, 8},
                                   {GnssSystem::kGalileo, 9},
                                   {GnssSystem::kBeidou, 7},
                                   {GnssSystem::kGlonass, 1},
                                   {GnssSystem::kGlonass, 2}}) {
        // CNAV is not among the preferred messages, F/NAV comes after I/NAV.
        const bool inav = sv.system == GnssSystem::kGalileo && sv.prn != 9;
        for (double t_s = -9000.0; t_s < 55000.0; t_s += 450.0) {
          const GpsTime t = kSentWeek + t_s;
          std::optional<double> best_clock;
          bool healthy = false;
          double best = choice == EphemerisChoice::kNearestToe ? 1e9 : -1e9;
          bool earlier = false;
          const auto consider = [&](const auto& r, double sent_s, double clock_s) {
            if (r.sv != sv || !r.valid_at(t)) return;
            const double toe_s = r.toe - kSentWeek;
            bool better = false;
            if (choice == EphemerisChoice::kTransmitted) {
              better = sent_s <= t_s && toe_s >= best;
              if (better) best = toe_s;
            } else {
              // Nearest; of two the later, of the same the last given; of Galileo a past one before all others.
              const bool past = sv.system == GnssSystem::kGalileo && toe_s < t_s;
              const double away = std::abs(toe_s - t_s) - (toe_s > t_s ? 1e-6 : 0.0);
              better = (past && !earlier) || (past == earlier && away <= best);
              if (better) best = away, earlier = past;
            }
            if (better) best_clock = clock_s, healthy = r.healthy();
          };
          if (systems.find(system_letter(sv.system)) != std::string::npos) {
            for (const KeplerEphemeris& r : data.kepler) {
              if (r.message == Message::kCnav || (inav && r.message == Message::kFnav)) continue;
              const double sent = r.transmitted ? *r.transmitted - kSentWeek
                                                : r.toe - kSentWeek - (r.message == Message::kLnav ? 7200.0 : 0.0);
              consider(r, sent, r.af0_s);
            }
            for (const GlonassEphemeris& g : data.glonass) consider(g, g.toe - kSentWeek - 900.0, g.clock_s);
          }
          const auto found = all->state(sv, t), received = all->state_received(sv, t - 0.07, t);
          const bool expected = best_clock && healthy;
          wrong += found.has_value() == expected && received.has_value() == expected ? 0 : 1;
          if (found && expected)
            wrong += std::abs(found->clock_s - *best_clock) < 1e-9 && std::abs(received->clock_s - *best_clock) < 1e-9
                         ? 0
                         : 1;
        }
      }
    }
  wrong += stress::not_refused([&] { return make_broadcast(data, {.systems = "GX"}); });
  return {1.0 * wrong, 0.0};
}

/// A record that stands against its neighbours is told where they agree: by an orbit far off, at its own toe; not for
/// want of neighbours, where those disagree too, or by less than 5 km.
StressFigure records_against_others() {
  int wrong = 0;
  const RandomStream draws(12, "stress.sent");
  const auto one_orbit = [&](int count, double step_s) {
    std::vector<KeplerEphemeris> out;
    for (int k = 0; k < count; ++k) {
      KeplerEphemeris r = some_record(kKinds[0], draws, 1);
      r.delta_n_dot_rad_s2 = r.a_dot_m_s = r.idot_rad_s = 0.0, r.cuc_rad = r.cus_rad = r.crc_m = r.crs_m = 0.0;
      const double n = std::sqrt(3.986005e14 / std::pow(r.sqrt_a, 6)) + r.delta_n_rad_s, dt = step_s * k;
      r.toe = kSentWeek + 10000.0 + dt, r.m0_rad += n * dt;
      r.omega0_rad += r.omega_dot_rad_s * dt;
      out.push_back(r);
    }
    return out;
  };
  auto records = one_orbit(7, 7200.0);
  wrong += contradictions(records).empty() ? 0 : 1;
  for (const double off_m : {4e3, 6e3, 1e6}) {
    auto odd = records;
    odd[3].m0_rad += off_m / 2.656e7;
    const auto found = contradictions(odd);
    wrong += found.size() == (off_m > 5e3 ? 1U : 0U) ? 0 : 1;
    if (found.size() == 1)
      wrong += found[0].index == 3 &&
                       std::abs(found[0].distance_m / (2.656e7 * 2.0 * std::sin(0.5 * off_m / 2.656e7)) - 1.0) < 0.05
                   ? 0
                   : 1;
    std::reverse(odd.begin(), odd.end());
    std::swap(odd[0], odd[5]);
    wrong += contradictions(odd).size() == found.size() ? 0 : 1;
    odd = records;
    odd[3].m0_rad += off_m / 2.656e7, odd[3].health = 1;
    wrong += contradictions(odd).empty() ? 0 : 1;
    odd[3].health = 0, odd[3].sv.prn += 1;
    wrong += contradictions(odd).empty() ? 0 : 1;
    // Two against two: nobody can say.
    odd = records;
    odd.resize(4), odd[0].m0_rad += 0.2, odd[1].m0_rad += 0.2;
    wrong += contradictions(odd).empty() ? 0 : 1;
  }
  // Beyond 4 h they are no neighbours; at the list's ends two are enough.
  auto far = one_orbit(3, 14401.0);
  far[1].m0_rad += 0.5;
  wrong += contradictions(far).empty() ? 0 : 1;
  auto near = one_orbit(3, 7000.0);
  near[0].m0_rad += 0.5;
  const auto first = contradictions(near);
  wrong += first.size() == 1 && first[0].index == 0 ? 0 : 1;
  std::vector<GlonassEphemeris> vectors;
  for (int k = 0; k < 3; ++k) {
    GlonassEphemeris g;
    g.toe = kSentWeek + 1800.0 * k;
    const GlonassEphemeris& before = k == 0 ? g : vectors.back();
    g.p_E = k == 0 ? Vector3d(2.55e7, 0.0, 0.0) : before.at(g.toe).p_E;
    g.v_E = k == 0 ? Vector3d(0.0, 1500.0, 3300.0) : before.at(g.toe).v_E;
    vectors.push_back(g);
  }
  wrong += contradictions(vectors).empty() ? 0 : 1;
  vectors[2].p_E.x() += 6e3;
  const auto last = contradictions(vectors);
  wrong += last.size() == 1 && last[0].index == 2 ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

/// Four satellites at every five minutes of a span within the records' own, and letters of systems.
StressFigure coverage_of_spans() {
  int wrong = 0;
  const RandomStream draws(13, "stress.sent");
  NavigationData data;
  for (std::uint64_t k = 0; k < 5; ++k) {
    KeplerEphemeris r = some_record(kKinds[0], draws, k);
    r.sv.prn = static_cast<std::uint8_t>(1 + k);
    r.toe = r.toc = kSentWeek + 20000.0 + (k == 0 ? -7200.0 : 0.0);
    data.kepler.push_back(r);
  }
  const auto covers = [&](const NavigationData& some, double from_s, double to_s, const char* systems = "G") {
    return check_coverage(some, systems, kSentWeek + from_s, kSentWeek + to_s, "key").ok();
  };
  wrong += covers(data, 12800.0, 27200.0) ? 0 : 1;
  wrong += covers(data, 12799.0, 20000.0) || covers(data, 20000.0, 27201.0) || covers(data, 5600.0, 6000.0) ? 1 : 0;
  wrong += covers(data, 20000.0, 20000.0) && !covers(data, 20000.0, 20001.0, "E") ? 0 : 1;
  NavigationData gap = data;
  for (KeplerEphemeris& r : gap.kepler) r.valid_after_s = 1000.0;
  for (std::size_t k = 0; k < 5; ++k)
    gap.kepler.push_back(data.kepler[k]), gap.kepler.back().toe = kSentWeek + 29000.0,
                                          gap.kepler.back().valid_before_s = 7000.0;
  wrong += covers(gap, 14000.0, 20900.0) && !covers(gap, 14000.0, 22500.0) && covers(gap, 22100.0, 30000.0) ? 0 : 1;
  NavigationData few = data;
  few.kepler[1].health = few.kepler[2].health = 1;
  wrong += covers(few, 14000.0, 15000.0) ? 1 : 0;
  for (const auto& [letters, good] : {std::pair{"G", true},
                                      {"GRECJ", true},
                                      {"JCERG", true},
                                      {"", false},
                                      {"GG", false},
                                      {"GX", false},
                                      {"GRG", false},
                                      {"g", false}})
    wrong += check_systems(letters, "key").ok() == good ? 0 : 1;
  NavigationData both = data;
  both.leap_seconds = 18, both.skipped_records["EPH SBAS"] = 2, both.files.push_back({"one", 3.0});
  NavigationData other = data;
  other.leap_seconds = 17, other.skipped_records["EPH SBAS"] = 3, other.files.push_back({"two", 4.0});
  both.append(other);
  wrong += both.kepler.size() == 10 && both.leap_seconds == 18 && both.skipped() == "5 EPH SBAS" &&
                   both.names() == "one, two"
               ? 0
               : 1;
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> sent_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "orbits and clocks of every navigation message",
           "a harmonic of the other function, a rate of the node's in the inclined frame, a week of BeiDou's 14 s off",
           "frames turned one after the other, anomalies by bisection, velocities by differences: rounding of angles",
           "of the bound"});
  rows.add("sent/orbits", orbits_of_messages).add("sent/glonass_accelerations", accelerations_of_glonass);
  rows.of({StressGroup::kData, "group delays of every navigation message",
           "a ratio of the other band, a delay of E5b's for E5a's", "as the interface documents have them: roundings",
           "of the bound"});
  rows.add("sent/delays", delays_of_messages);
  rows.of({StressGroup::kData, "which record of a satellite is taken",
           "a later one where two are as near, one that was not yet sent", "the definition over all records: exact",
           "wrong"});
  rows.add("sent/health_and_validity", health_and_validity)
      .add("sent/records_chosen", records_chosen)
      .add("sent/records_against_others", records_against_others)
      .add("sent/coverage_of_spans", coverage_of_spans);
  return rows.take();
}

}  // namespace canyon::gnss
