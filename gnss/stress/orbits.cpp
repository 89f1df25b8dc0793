// Satellite orbits: Kepler's equation, eccentric ellipses, decades from the epoch, GLONASS's integration.
#include <array>
#include <cmath>
#include <limits>

#include "canyon/core/check.h"
#include "canyon/core/output/printed.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/gnss/satellites/constellation.h"
#include "canyon/gnss/satellites/ephemerides/glonass_ephemeris.h"
#include "canyon/gnss/satellites/ephemerides/kepler.h"
#include "canyon/gnss/satellites/ephemerides/kepler_ephemeris.h"
#include "canyon/gnss/satellites/system_constants.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using stress::kEpsilon;

/// Worst error of E where M is that of a known E, in units of what rounding of M and of Newton's residual may make of
/// it: (eps / 2 M + 3 eps E) / (1 - e cos E) + 2 eps E.
StressFigure anomaly_error(double e) {
  StressFigure out{0.0, 1.0};
  for (int k = -80; k <= 4; ++k) {
    const double E = std::min(std::pow(10.0, k / 10.0), 3.1);
    const long double exact = static_cast<long double>(E) - static_cast<long double>(e) * sinl(E);
    const double M = static_cast<double>(exact);
    const double bound = (0.5 * kEpsilon * M + 3.0 * kEpsilon * E) / (1.0 - e * std::cos(E)) + 2.0 * kEpsilon * E;
    take_worst(out, std::abs(eccentric_anomaly(M, e) - E) / bound);
    take_worst(out, std::abs(eccentric_anomaly(-M, e) + E) / bound);
  }
  return out;
}

/// Residual |E - e sin E - M| after many whole turns, in units of 2 eps |M|: the double 2 pi by which M is reduced is
/// off by 2.4e-16 for each turn (4e-17 of M), and E itself rounds by eps / 2 of M, twice at most in the residual.
StressFigure residual_after_turns(double turns) {
  StressFigure out{0.0, 1.0};
  for (int k = 0; k < 64; ++k) {
    const double e = 0.999 * k / 63.0, M = 2.0 * kPi * turns + 0.1 * k - 3.0;
    const double E = eccentric_anomaly(M, e);
    const long double residual = static_cast<long double>(E) - e * sinl(E) - M;
    take_worst(out, static_cast<double>(fabsl(residual)) / (2.0 * kEpsilon * std::abs(M)));
  }
  return out;
}

/// How many of the impossible arguments were taken.
StressFigure taken_anomalies() {
  const double kInf = std::numeric_limits<double>::infinity(), kNotANumber = std::numeric_limits<double>::quiet_NaN();
  const std::array<std::array<double, 2>, 7> wrong{
      {{1.0, 1.0}, {1.0, 1.5}, {1.0, -1e-300}, {1.0, kNotANumber}, {kNotANumber, 0.1}, {kInf, 0.1}, {-kInf, 0.1}}};
  StressFigure out;
  for (const auto& pair : wrong) out.figure += stress::not_refused([&pair] { eccentric_anomaly(pair[0], pair[1]); });
  return out;
}

KeplerEphemeris ellipse(double e) {
  KeplerEphemeris r;
  r.sv = {GnssSystem::kGps, 1};
  r.toe = r.toc = GpsTime::from_week_sow(1617, 388800.0);
  r.sqrt_a = std::sqrt(26559.7e3);
  r.e = e;
  r.i0_rad = 0.96;
  return r;
}

/// Velocity against the central difference of fourth order of the position, h = 50 ms about the perigee. Of the
/// position a (1 - e) k eps / (1 - e) with k = 16 operations is rounding, of which the difference makes 3 / (2 h); its
/// truncation h^4 / 30 of the fifth derivative, r_p (v_p / r_p)^5, is below that.
StressFigure perigee_velocity(double e) {
  const KeplerEphemeris r = ellipse(e);
  constexpr double h = 0.05;
  const double a = r.sqrt_a * r.sqrt_a, rp = a * (1.0 - e);
  const double rate = std::sqrt(kGpsMu * (1.0 + e) / (rp * rp * rp));
  StressFigure out{0.0, 1.5 * 16.0 * kEpsilon * a / (1.0 - e) / h + std::pow(h, 4) / 30.0 * rp * std::pow(rate, 5)};
  for (int k = -5; k <= 5; ++k) {
    const GpsTime t = r.toe + 0.1 * k;
    const auto p = [&](double dt) { return r.at(t + dt).p_E; };
    const Eigen::Vector3d slope = (8.0 * (p(h) - p(-h)) - (p(2.0 * h) - p(-2.0 * h))) / (12.0 * h);
    take_worst(out, (slope - r.at(t).v_E).norm());
  }
  return out;
}

/// Radius of a circle, and the return of the ground track after a turn of the node, k turns from 2010. The turn is
/// known to 0.5 ns (2 um at 4 km/s). The rate of the node and its product with a day round by eps / 2 of 2 pi each,
/// that of the satellite, twice as fast, by twice as much: eps * 2 pi and eps * 4 pi a day, at a constant rate and so
/// smoothly.
StressFigure track_returns(std::int64_t turns) {
  const auto gps = make_nominal_gps();
  const long double rate = static_cast<long double>(kGpsEarthRate) + 4.4874e-7L * (kPi / 180.0L);
  const GpsTime t0 = GpsTime::from_calendar(2010, 7, 1, 13, 0, 0.0);
  const auto turn_ns = static_cast<std::int64_t>(llroundl(2e9L * std::numbers::pi_v<long double> / rate * turns));
  const double days = static_cast<double>(turn_ns) / 8.64e13;
  const double angle = 24.0 * kEpsilon * 2.0 * kPi + 3.0 * kEpsilon * 2.0 * kPi * days;
  StressFigure out{0.0, 26559.7e3 * angle + 4e3 * 1e-9};
  for (const SatelliteId sv : gps->satellites()) {
    const auto now = gps->state(sv, t0), then = gps->state(sv, GpsTime{t0.ns + turn_ns});
    take_worst(out, (now->p_E - then->p_E).norm());
    take_worst(out, std::abs(then->p_E.norm() - 26559.7e3));
  }
  return out;
}

/// Velocity against difference, all systems' built-in orbits, decades from their epochs. h = 1 s: h^4 / 30 r n^5 is
/// 1e-12 m/s, and positions round by angles of up to 2 pi: 16 eps 2 pi r, times 3 / (2 h).
StressFigure nominal_velocity(int year) {
  const auto all = make_nominal("GRECJ");
  const GpsTime t = GpsTime::from_calendar(year, 2, 28, 23, 59, 59.5);
  StressFigure out{0.0, 1.5 * 16.0 * kEpsilon * 2.0 * kPi * 42.2e6};
  for (const SatelliteId sv : all->satellites()) {
    const auto p = [&](double dt) { return all->state(sv, t + dt)->p_E; };
    const Eigen::Vector3d slope = (8.0 * (p(1.0) - p(-1.0)) - (p(2.0) - p(-2.0))) / 12.0;
    take_worst(out, (slope - all->state(sv, t)->v_E).norm());
  }
  return out;
}

GlonassEphemeris glonass() {
  GlonassEphemeris r;
  r.sv = {GnssSystem::kGlonass, 7};
  r.toe = GpsTime::from_week_sow(1617, 388800.0);
  r.p_E = {7003.008789e3, -12206.626953e3, 21280.765625e3};  // the example of ICD A.3.1.2
  r.v_E = {0.7835417e3, 2.8042530e3, 1.3525150e3};
  return r;
}

/// There and back over `span_s`. A Runge-Kutta step's error of h^5 changes its sign with h, so that on the way back it
/// undoes itself; what is left is of the next order, (n h)^5 n T r where each elementary differential has a weight
/// below one, with n = 1.55e-4 rad/s.
StressFigure there_and_back(double span_s) {
  GlonassEphemeris there = glonass();
  const SatelliteState far = there.at(there.toe + span_s);
  GlonassEphemeris back = there;
  back.toe = there.toe + span_s;
  back.p_E = far.p_E, back.v_E = far.v_E;
  const double n = 1.55e-4, radius_m = there.p_E.norm();
  return {(back.at(there.toe).p_E - there.p_E).norm(), std::pow(n * 60.0, 5) * n * std::abs(span_s) * radius_m};
}

StressFigure beyond_a_day() {
  StressFigure out;
  const GlonassEphemeris r = glonass();
  for (const double s : {86400.5, -86400.5, 1e6, -1e9})
    out.figure += stress::not_refused([&] { (void)r.at(r.toe + s); });
  return out;
}

}  // namespace

std::vector<StressCase> orbit_cases() {
  StressRows rows;
  rows.of(
      {StressGroup::kGeometry, "Kepler's equation near the parabola",
       "at e -> 1 the derivative 1 - e cos E vanishes at the perigee: Newton's step leaves the bracket or stops early",
       "E to the rounding of M, enlarged by 1 / (1 - e cos E); 86 anomalies from 1e-8 to 3.1 rad of either sign",
       "of the rounding bound"});
  for (const double e : {0.0, 0.1, 0.9, 0.99, 0.9999, 0.999999})
    rows.add("orbits/anomaly_at_e_" + printed("%g", e), [e] { return anomaly_error(e); });

  rows.of({StressGroup::kLong, "an anomaly after many whole turns",
           "reduction modulo 2 pi by a product, or a turn lost at the border of pi",
           "M = E - e sin E to 2 eps |M|, whole turns kept", "of 2 eps |M|"});
  for (const double turns : {1.0, 1e4, 1e8})
    rows.add("orbits/anomaly_after_turns_" + printed("%g", turns), [turns] { return residual_after_turns(turns); });

  rows.of({StressGroup::kData, "an orbit that is none", "e = 1 or NaN goes into an iteration that never meets its end",
           "each is refused by a check", "taken"});
  rows.add("orbits/impossible_anomalies_refused", taken_anomalies);

  rows.of({StressGroup::kGeometry, "velocity at the perigee of an eccentric orbit",
           "a velocity that neglects terms of e is right on near circles only, 1 / (1 - e) enlarges rounding",
           "derivative of the position: rounding 1.5 * 16 eps a / (1 - e) / h of the difference", "m/s"});
  for (const double e : {0.0, 0.02, 0.5, 0.9, 0.99})
    rows.add("orbits/velocity_at_e_" + printed("%g", e), [e] { return perigee_velocity(e); });

  rows.of({StressGroup::kLong, "an angle that grows for decades",
           "rate times seconds since the epoch loses digits: 0.4 mm after 17 years, and not smoothly",
           "the ground track returns after each turn of the node, at the same radius, but for 3 eps 2 pi a day of the "
           "rates' own rounding",
           "m"});
  for (const std::int64_t turns : {std::int64_t{1}, std::int64_t{366}, std::int64_t{36600}, std::int64_t{66000}})
    rows.add("orbits/ground_track_after_days_" + std::to_string(turns), [turns] { return track_returns(turns); });

  rows.of({StressGroup::kLong, "velocity decades from the epoch",
           "an angle rounded by its size makes the position jump from call to call; a rate without the frame's turning",
           "derivative of the position to 24 eps 2 pi r / 1 s, all five systems' built-in orbits", "m/s"});
  for (const int year : {1980, 2010, 2100, 2200})
    rows.add("orbits/velocity_in_" + std::to_string(year), [year] { return nominal_velocity(year); });

  rows.of({StressGroup::kLong, "Runge-Kutta steps there and back",
           "a last partial step with the wrong sign or length, a rest of rounding that makes one step too many",
           "the way back ends where it began but for (n h)^5 n T r", "m"});
  for (const double s : {59.999999999, 1200.0, -1200.0, 43201.5, 86400.0})
    rows.add(
        "orbits/glonass_there_and_back_" + std::string(s < 0 ? "minus_" : "") + printed("%.6g", std::abs(s)) + "_s",
        [s] { return there_and_back(s); });

  rows.of({StressGroup::kData, "an ephemeris far beyond its time", "steps of 60 s for years: a hang",
           "refused beyond a day", "taken"});
  rows.add("orbits/glonass_beyond_a_day_refused", beyond_a_day);
  return rows.take();
}

}  // namespace canyon::gnss
