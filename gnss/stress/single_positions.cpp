// What recorded observations become positions with: weights, delays, combinations, statistics, and the whole of it.
#include "canyon/gnss/single_point/single_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/LU>

#include "canyon/core/earth/earth.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/atmosphere/beidou_klobuchar.h"
#include "canyon/gnss/atmosphere/troposphere.h"
#include "canyon/gnss/rinex/observation/observation_writer.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/single_point/position_statistics.h"
#include "canyon/gnss/solver/fault_exclusion.h"
#include "canyon/gnss/solver/receiver_clocks.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Looks;

// --- Weights ---

double squared(double x) {
  return x * x;
}

/// The variance that weighting.h and the models' sources state, from the sine of the elevation and the noise power over
/// that at 45 dB-Hz.
double stated_variance(const std::string& model, const RangeQuality& q, double zenith_m) {
  const double degrees = q.elevation_rad < 5.0 * kPi / 180.0 ? 5.0 : q.elevation_rad * 180.0 / kPi;
  const double s = std::sin(degrees * kPi / 180.0);
  const double cn0 = q.cn0_dbhz == q.cn0_dbhz ? q.cn0_dbhz : 45.0 - 7.0 * (1.0 - s);
  const double noise = std::exp((45.0 - cn0) * std::log(10.0) / 10.0);
  const double code2 = squared(q.code_factor * zenith_m);
  const bool glonass = q.system == GnssSystem::kGlonass;
  if (model == "uniform") return code2;
  if (model == "elevation") return code2 / (s * s);
  if (model == "cn0") return code2 * noise;
  const double tracking = code2 * (1.0 / (s * s) + noise) / 2.0;
  if (model == "elevation_cn0") return tracking;
  if (model == "budget")
    return q.differential ? tracking
                          : tracking + (glonass ? 4.0 : 0.64) + squared(q.ionosphere_m) / 25.0 +
                                squared(1.0 / (20.0 * (s + 0.01)));
  double satellite = 5.0;
  if (q.system == GnssSystem::kGalileo && q.accuracy_m == q.accuracy_m) {
    satellite = q.accuracy_m;
  } else if (!glonass) {
    // Limits of the classes of IS-GPS-200: 2.4, 3.4, 4.85, ... doubled from 24 m on.
    double limits[15] = {2.4, 3.4, 4.85, 6.85, 9.65, 13.65};
    for (int k = 6; k < 15; ++k) limits[k] = 24.0 * (1 << (k - 6));
    satellite = limits[14];
    const double announced = q.accuracy_m == q.accuracy_m ? q.accuracy_m : 0.0;
    for (int k = 14; k >= 0; --k)
      if (announced <= limits[k]) satellite = limits[k];
  }
  const double factor = glonass ? 1.5 : q.system == GnssSystem::kSbas ? 3.0 : 1.0;
  return squared(0.3 * q.code_factor * factor) * (1.0 + 1.0 / s) + 0.09 + squared(q.ionosphere_m / 2.0) +
         squared(0.3 / (s + 0.1)) + satellite * satellite;
}

/// Sine, exponential and root leave some 40 roundings between two ways to write it.
StressFigure weights_of(const std::string& model) {
  Looks looks;
  for (const GnssSystem system : {GnssSystem::kGps, GnssSystem::kGlonass, GnssSystem::kGalileo, GnssSystem::kSbas})
    for (const double elevation_deg : {-3.0, 0.0, 4.9, 7.0, 30.0, 61.0, 90.0})
      for (const double cn0 : {kNaN, 12.0, 33.0, 51.0})
        for (const double ionosphere_m : {0.0, 9.0})
          for (const double accuracy_m : {kNaN, 0.1, 2.0, 3.0, 4.0, 6.0, 9.0, 12.0, 23.0, 700.0, 9e3})
            for (const bool differential : {false, true}) {
              const RangeQuality q{.system = system,
                                   .elevation_rad = elevation_deg * kDegree,
                                   .cn0_dbhz = cn0,
                                   .ionosphere_m = ionosphere_m,
                                   .code_factor = differential ? 1.0 : 2.6,
                                   .accuracy_m = accuracy_m,
                                   .differential = differential};
              const double found = model_row(range_weightings(), model).make({}, {0.7})->sigma_m(q);
              looks.close(found, std::sqrt(stated_variance(model, q, 0.7)), 40.0);
            }
  return looks.figure();
}

// --- Group delays, codes, combinations ---

/// By hand: the first band's, or f1^2 / (f1^2 - f2^2) of it and -f2^2 / (f1^2 - f2^2) of the second; a lent one is
/// 3.3 ns of light off.
StressFigure group_delays() {
  const NavigationData none;
  SatelliteState state;
  for (std::size_t b = 0; b < 10; ++b) state.group_delay_s[b] = 1e-9 * (3.0 * static_cast<double>(b) - 7.5);
  const double lent_m = 299792458.0 * 3.3e-9;
  Looks looks;
  const struct {
    SatelliteId sv;
    int first, second;
    double ratio;  // of the squares of the two carriers
  } pairs[] = {{{GnssSystem::kGps, 3}, 1, 2, squared(77.0 / 60.0)},
               {{GnssSystem::kGps, 3}, 1, 5, squared(154.0 / 115.0)},
               {{GnssSystem::kGalileo, 3}, 1, 5, squared(154.0 / 115.0)},
               {{GnssSystem::kGlonass, 3}, 1, 2, squared(9.0 / 7.0)},
               {{GnssSystem::kBeidou, 23}, 2, 6, squared(763.0 / 620.0)},
               {{GnssSystem::kBeidou, 23}, 2, 7, squared(763.0 / 590.0)}};
  for (const auto& p : pairs) {
    const double first = p.ratio / (p.ratio - 1.0), second = -1.0 / (p.ratio - 1.0);
    const double d1 = state.group_delay_s[static_cast<std::size_t>(p.first)],
                 d2 = state.group_delay_s[static_cast<std::size_t>(p.second)];
    for (const unsigned lent : {0u, 1u << p.first, 1u << p.second, 1u << p.first | 1u << p.second}) {
      state.borrowed_delay_bands = lent;
      const double s1 = (lent >> p.first & 1u) != 0 ? lent_m : 0.0, s2 = (lent >> p.second & 1u) != 0 ? lent_m : 0.0;
      const GroupDelays broadcast(GroupDelayModel::kBroadcast, none), nothing(GroupDelayModel::kNone, none);
      looks.close(broadcast.delay_s(state, p.sv, p.first, std::nullopt), d1, 4.0);
      // A difference of two terms of up to 30 ns.
      looks.near(broadcast.delay_s(state, p.sv, p.first, p.second), first * d1 + second * d2, 32.0 * kEpsilon * 3e-8);
      looks.near(broadcast.sigma_m(state, p.sv, p.first, std::nullopt), s1, 4.0 * kEpsilon * lent_m);
      looks.near(broadcast.sigma_m(state, p.sv, p.first, p.second), std::hypot(first * s1, second * s2),
                 64.0 * kEpsilon * lent_m);
      looks.right(nothing.delay_s(state, p.sv, p.first, p.second) == 0.0 &&
                  nothing.sigma_m(state, p.sv, p.first, p.second) == 0.0);
    }
    if (p.sv.system == GnssSystem::kGlonass) {
      // As RTKLIB: the clock is that of the combination, whose delay is then nothing, and G2 is late by delta tau.
      const GroupDelays rtklib(GroupDelayModel::kRtklib, none);
      looks.near(rtklib.delay_s(state, p.sv, 1, 2), 0.0, 64.0 * kEpsilon * 1e-8);
      looks.near(rtklib.delay_s(state, p.sv, 2, std::nullopt) - rtklib.delay_s(state, p.sv, 1, std::nullopt),
                 -state.group_delay_s[2], 64.0 * kEpsilon * 1e-8);
    }
  }
  // The satellite's first record in the order of transmission counts for rtklib, and of Galileo its second delay.
  NavigationData data;
  for (const int k : {2, 0, 1}) {
    KeplerEphemeris r;
    r.sv = {GnssSystem::kGalileo, 5};
    r.message = NavigationMessage::kInav;
    r.toe = r.toc = GpsTime::from_week_sow(2000, 3600.0 * k);
    r.transmitted = r.toe;
    r.tgd_s = 1e-9;
    r.tgd2_s = 1e-9 * (4 + k);
    data.kepler.push_back(r);
  }
  looks.close(GroupDelays(GroupDelayModel::kRtklib, data).delay_s(state, {GnssSystem::kGalileo, 5}, 1, std::nullopt),
              4e-9, 4.0);
  return looks.figure();
}

/// A satellite's values run with these codes, value k being 100 + k.
SatelliteObservations observed(GnssSystem system, std::size_t n) {
  SatelliteObservations out{.sv = {system, 5}, .values = std::vector<ObservationValue>(n)};
  for (std::size_t k = 0; k < n; ++k) out.values[k].value = 100.0 + static_cast<double>(k);
  return out;
}

/// The signal that code_choice.h says, with what belongs to it; counts what differs.
StressFigure codes_chosen() {
  const std::vector<ObservationCode> codes{{'C', '1', 'P'}, {'C', '1', 'C'}, {'L', '1', 'C'}, {'D', '1', 'C'},
                                           {'S', '1', 'C'}, {'C', '2', 'W'}, {'L', '2', 'W'}, {'C', '5', 'Q'},
                                           {'C', '2', 'I'}, {'C', '6', 'I'}};
  StressFigure out;
  const auto right = [&](bool holds) { out.figure += holds ? 0.0 : 1.0; };
  SatelliteObservations gps = observed(GnssSystem::kGps, codes.size());
  const auto one = single_frequency_signal(codes, gps);
  right(one && one->pseudorange_m == 101.0 && one->phase_cycles == 102.0 && one->doppler_hz == 103.0 &&
        one->cn0_dbhz == 104.0 && !one->loss_of_lock);
  const auto two = dual_frequency_signals(codes, gps);
  right(two && two->first.pseudorange_m == 100.0 && two->second.pseudorange_m == 105.0 &&
        two->second.phase_cycles == 106.0 && std::isnan(two->second.doppler_hz));
  gps.values[2].loss_of_lock = 1;
  right(single_frequency_signal(codes, gps)->loss_of_lock);
  gps.values[2].loss_of_lock = 2;
  right(!single_frequency_signal(codes, gps)->loss_of_lock);
  gps.values[1].value = kNaN;
  right(single_frequency_signal(codes, gps)->pseudorange_m == 100.0);
  gps.values[5].value = kNaN;
  right(dual_frequency_signals(codes, gps)->second.pseudorange_m == 107.0);
  for (ObservationValue& v : gps.values) v.value = kNaN;
  right(!single_frequency_signal(codes, gps) && !dual_frequency_signals(codes, gps));
  const SatelliteObservations beidou = observed(GnssSystem::kBeidou, codes.size());
  right(single_frequency_signal(codes, beidou)->pseudorange_m == 108.0);
  right(dual_frequency_signals(codes, beidou)->second.pseudorange_m == 109.0);
  const SatelliteObservations galileo = observed(GnssSystem::kGalileo, codes.size());
  right(single_frequency_signal(codes, galileo)->pseudorange_m == 101.0);
  right(dual_frequency_signals(codes, galileo)->second.pseudorange_m == 107.0);
  return out;
}

/// A range of 23 000 km with an ionosphere of I / f^2, early in phase: without it to the weights' roundings of the
/// range, 8 eps of 3 ranges; and noise by the root of the squared weights.
StressFigure combined_signals() {
  Looks looks;
  for (const auto& [system, b1, b2, channel] :
       {std::tuple(GnssSystem::kGps, '1', '2', 0), std::tuple(GnssSystem::kGlonass, '1', '2', -3),
        std::tuple(GnssSystem::kGalileo, '1', '5', 0), std::tuple(GnssSystem::kBeidou, '2', '6', 0)}) {
    const double range_m = 2.3e7, f1 = carrier_hz(system, b1 - '0', channel),
                 f2 = carrier_hz(system, b2 - '0', channel);
    const double delay1_m = 31.0, delay2_m = 31.0 * f1 * f1 / (f2 * f2);
    SignalPair pair;
    pair.first = {{'C', b1, 'C'}, range_m + delay1_m, (range_m - delay1_m) * f1 / kSpeedOfLight, 0.0, 45.0, false};
    pair.second = {{'C', b2, 'C'}, range_m + delay2_m, (range_m - delay2_m) * f2 / kSpeedOfLight, 0.0, 45.0, false};
    const CodeMeasurement both = ionosphere_free_measurement(pair, {system, 5}, channel);
    const double w1 = f1 * f1 / (f1 * f1 - f2 * f2);
    looks.near(both.pseudorange_m, range_m, 8.0 * kEpsilon * 3.0 * range_m);
    looks.near(both.phase_m, range_m, 16.0 * kEpsilon * 3.0 * range_m);
    looks.close(both.hz, f1, 1.0);
    looks.close(both.noise_factor, std::hypot(w1, 1.0 - w1), 64.0);
    const CodeMeasurement one = single_measurement(pair.first, {system, 5}, channel);
    looks.right(one.pseudorange_m == range_m + delay1_m && one.hz == f1 && one.noise_factor == 1.0);
    looks.near(one.phase_m, range_m - delay1_m, 8.0 * kEpsilon * range_m);
  }
  return looks.figure();
}

/// Saastamoinen's zenith delays as RTKLIB writes them, over the sine of the elevation; Klobuchar of BeiDou for B1I
/// brought to L1; below 5 degrees as at 5. Powers and exponentials of ten operations: 100 eps.
StressFigure corrections() {
  Looks looks;
  const auto cosecant = model_row(troposphere_corrections(), "saastamoinen_cosecant").make;
  const auto ladder = model_row(troposphere_corrections(), "saastamoinen_niell").make;
  const auto nothing = model_row(troposphere_corrections(), "none").make;
  const KlobucharCoefficients k{{2.1e-8, 7.4e-9, -1.0e-7, 8.0e-8}, {1.3e5, -2.0e4, 2.5e5, -3.0e5}};
  for (const double lat_deg : {-80.0, -20.0, 0.0, 33.0, 71.0})
    for (const double h_m : {-300.0, 0.0, 450.0, 8800.0, 15000.0})
      for (const double elevation_deg : {1.0, 5.0, 12.0, 47.0, 90.0}) {
        SkyView v;
        v.t = GpsTime::from_week_sow(2000, 50000.0);
        v.receiver = {lat_deg * kDegree, 0.7, h_m};
        v.elevation_rad = elevation_deg * kDegree;
        v.azimuth_rad = 1.1;
        const double h = h_m < 0.0 ? 0.0 : h_m > 1e4 ? 1e4 : h_m;
        const double pressure = 1013.25 * std::exp(5.2568 * std::log1p(-2.2557e-5 * h)), kelvin = 288.16 - 0.0065 * h;
        const double vapour = 0.7 * 6.108 * std::exp((17.15 * kelvin - 4684.0) / (kelvin - 38.45));
        const double dry = 0.0022768 * pressure / (1.0 - 0.00266 * std::cos(2.0 * lat_deg * kDegree) - 2.8e-7 * h);
        const double wet = 0.002277 * (1255.0 / kelvin + 0.05) * vapour;
        const double held_deg = elevation_deg < 5.0 ? 5.0 : elevation_deg;
        looks.close(cosecant(v), (dry + wet) / std::sin(held_deg * kDegree), 400.0);
        SkyView held = v;
        held.elevation_rad = held_deg * kDegree;
        looks.close(ladder(v), standard_troposphere_m(held), 1.0);
        looks.right(nothing(v) == 0.0);
        const double b1_over_l1 = 763.0 / 770.0;
        looks.close(klobuchar_correction_m(GnssSystem::kBeidou, k, v),
                    squared(b1_over_l1) * beidou_klobuchar_delay_m(k, held), 16.0);
        looks.close(
            klobuchar_correction_m(GnssSystem::kGalileo, k, v),
            klobuchar_delay_m(k, v.t, v.receiver.lat_rad, v.receiver.lon_rad, v.azimuth_rad, held.elevation_rad), 1.0);
      }
  return looks.figure();
}

/// The epoch nearest to an instant, within an age, of epochs an odd time apart, against a look at each; and the base's
/// noise by its own formula.
StressFigure base_epochs() {
  Looks looks;
  BaseDifferences base;
  for (int k = 0; k < 40; ++k)
    base.epochs.push_back({GpsTime::from_week_sow(2000, 1000.0 + 7.3 * k + (k % 3 == 0 ? 2.0 : 0.0)), {}});
  for (int k = -20; k < 1300; ++k)
    for (const double age_s : {0.3, 4.0, 30.0}) {
      const GpsTime t = GpsTime::from_week_sow(2000, 990.0 + 0.251 * k);
      double nearest_s = kInfinity;
      GpsTime of;
      for (const auto& e : base.epochs)
        if (std::abs(e.t - t) < nearest_s) nearest_s = std::abs(e.t - t), of = e.t;
      const BaseDifferences::Epoch* found = base.near(t, age_s);
      looks.right(nearest_s <= age_s ? found != nullptr && std::abs(found->t - t) == nearest_s : found == nullptr);
    }
  for (double e_deg = 0.0; e_deg <= 90.0; e_deg += 5.0)
    looks.close(base_code_sigma_m(e_deg * kDegree), 0.16 + 1.07 * std::exp(-e_deg / 15.5), 32.0);
  return looks.figure();
}

// --- Statistics of positions ---

double rank(std::vector<double> x, double share) {
  std::sort(x.begin(), x.end());
  const double at = share * static_cast<double>(x.size() - 1), below = std::floor(at);
  const auto i = static_cast<std::size_t>(below);
  return i + 1 < x.size() ? (1.0 - (at - below)) * x[i] + (at - below) * x[i + 1] : x[i];
}

/// n fixes about a place: means, deviations about them, percentiles, ellipses and velocities against sums over the
/// errors that were put in, to the rounding of places in E, 4 eps of 6.4e6 m, and a thousandth of it for velocities.
StressFigure statistics_of(int n) {
  const Vector3d truth_E = ecef_from_geodetic({0.5, 1.0, 10.0}), v_E(3.0, -2.0, 7.0);
  const Matrix3d R = rotation_E_from_enu(geodetic_from_ecef(truth_E));
  const RandomStream draws(3, "stress.positions");
  std::vector<GnssFix> fixes;
  std::vector<Vector3d> errors, velocity_errors;
  std::vector<double> level, upright, squares;
  double log_sum = 0.0;
  for (int k = 0; k < n; ++k) {
    const auto i = static_cast<std::uint64_t>(k);
    GnssFix fix;
    fix.t = GpsTime::from_week_sow(2000, 1.0 * k);
    fixes.push_back(fix);  // none
    fix.status = FixStatus::kSingle;
    const Vector3d e(1.0 + 2.0 * draws.normal(0, i), -3.0 + draws.normal(1, i), 5.0 * draws.normal(2, i));
    const Vector3d u(0.1 * draws.normal(3, i), 0.3 + 0.1 * draws.normal(4, i), 0.2 * draws.normal(5, i));
    Matrix3d P;
    P << 4.0, 0.6, 0.1, 0.6, 2.0, -0.2, 0.1, -0.2, 20.0;
    fix.p_A_E = truth_E + R * e;
    fix.v_A_E = v_E + R * u;
    fix.covariance_E = R * P * R.transpose();
    fixes.push_back(fix);
    errors.push_back(e), velocity_errors.push_back(u);
    level.push_back(std::sqrt(e.x() * e.x() + e.y() * e.y()));
    upright.push_back(std::abs(e.z()));
    const double det = 4.0 * 2.0 - 0.36;
    squares.push_back((2.0 * e.x() * e.x() - 1.2 * e.x() * e.y() + 4.0 * e.y() * e.y()) / det);
    log_sum -= 0.5 * squares.back() + 0.5 * std::log(4.0 * kPi * kPi * det);
    fix.t = fix.t + 0.5;
    fixes.push_back(fix);  // without a truth
  }
  const PositionStatistics s = position_statistics(fixes, [&](GpsTime t) {
    return t.ns % 1'000'000'000 == 0 ? std::optional(TruePlace{truth_E, v_E}) : std::nullopt;
  });
  Looks looks;
  looks.right(s.epochs == 3 * n && s.solved == 2 * n && s.compared == n);
  Vector3d mean = Vector3d::Zero(), about = Vector3d::Zero(), square = Vector3d::Zero(), fast = Vector3d::Zero();
  for (const Vector3d& e : errors) mean += e / n;
  for (int k = 0; k < n; ++k) {
    const auto i = static_cast<std::size_t>(k);
    for (int a = 0; a < 3; ++a) {
      about[a] += squared(errors[i][a] - mean[a]) / n;
      square[a] += squared(errors[i][a]) / n;
      fast[a] += squared(velocity_errors[i][a]) / n;
    }
  }
  const double grain_m = 4.0 * kEpsilon * 6.4e6;
  for (int a = 0; a < 3; ++a) {
    looks.near(s.mean_enu_m[a], mean[a], grain_m);
    looks.near(s.std_enu_m[a], std::sqrt(about[a]), grain_m);
    looks.near(s.velocity_rms_enu_m_s[a], std::sqrt(fast[a]), 1e-3 * grain_m);
  }
  looks.near(s.rms_3d_m, std::sqrt(square.sum()), grain_m);
  looks.near(s.h50_m, rank(level, 0.5), grain_m);
  looks.near(s.h95_m, rank(level, 0.95), grain_m);
  looks.near(s.v95_m, rank(upright, 0.95), grain_m);
  for (const double share : {0.3, 0.5, 0.95, 0.997}) {
    const double within = -2.0 * std::log1p(-share);
    const auto inside = std::count_if(squares.begin(), squares.end(), [&](double q) { return q <= within; });
    looks.near(s.reported.inside(share), static_cast<double>(inside) / n, 1e-12);
  }
  const auto beyond3 = std::count_if(squares.begin(), squares.end(), [](double q) { return q > 9.0; });
  looks.near(s.reported.beyond_3_sigma(), static_cast<double>(beyond3) / n, 1e-12);
  // Squares of errors over 1.4 m of sigma, each to 10 grains.
  looks.near(s.reported.log_score(), log_sum / n, 20.0 * grain_m);
  return looks.figure();
}

// --- What a receiver says of its fix ---

/// Ranges from eight directions, with errors of known size; sigmas that differ.
std::vector<RangeMeasurement> eight_ranges(const Vector3d& at_E, double error_m, std::uint64_t k) {
  const Matrix3d R = rotation_E_from_enu(geodetic_from_ecef(at_E));
  const RandomStream draws(7, "stress.ranges");
  const double sky[8][2] = {{10, 70}, {60, 25}, {120, 40}, {190, 15}, {230, 55}, {300, 30}, {340, 12}, {90, 80}};
  std::vector<RangeMeasurement> out;
  for (std::uint32_t i = 0; i < 8; ++i) {
    const double a = sky[i][0] * kDegree, e = sky[i][1] * kDegree;
    RangeMeasurement r;
    r.p_E = at_E + 2.2e7 * (R * Vector3d(std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e)));
    r.sigma_m = 1.0 + 0.2 * i;
    r.range_m = line_of_sight(r.p_E, at_E).range_m + 300.0 + error_m * draws.normal(i, k);
    out.push_back(r);
  }
  return out;
}

/// Sigmas by hand from z = Q' e: an environment's are the root of the weighted mean of three variances, with the
/// likelihoods exp(-(z' S^-1 z + ln det S) / 2); inflated ones all larger by the root of z' S^-1 z over its degrees.
/// Solutions of 4 x 4 systems of condition 1e3: 1e-10.
StressFigure reported_sigmas() {
  Looks looks;
  const Vector3d at_E = ecef_from_geodetic({0.56, -1.58, 60.0});
  for (const double error_m : {0.3, 4.0, 25.0})
    for (const double cn0 : {48.0, 36.0, kNaN}) {
      const auto ranges = eight_ranges(at_E, error_m, 5);
      const PositionSolution s = make_least_squares({})->solve(ranges, at_E);
      if (!s.ok) return {kInfinity, 1.0};
      std::vector<RangeSignal> signals;
      for (std::uint32_t i = 0; i < 8; ++i) signals.push_back({i, cn0, i % 2 == 0 ? 1.0 : 2.6});
      const RangeEvidence e = evidence_of(ranges, signals, s);
      looks.right(e.z.size() == 4 && e.B.rows() == 4 && e.B.cols() == 8);
      // Parity: what no position and no clock can make.
      for (int row = 0; row < 4; ++row) {
        double common = 0.0, own = 0.0;
        Vector3d moved = Vector3d::Zero();
        for (int i = 0; i < 8; ++i) {
          const auto k = static_cast<std::size_t>(i);
          common += e.B(row, i);
          moved += e.B(row, i) * line_of_sight(ranges[k].p_E, s.p_E).line;
          own += e.B(row, i) * s.residuals_m[k];
        }
        looks.near(common, 0.0, 1e-13);
        looks.near(moved.norm(), 0.0, 1e-13);
        looks.near(e.z[row], own, 1e-13 * (1.0 + 100.0 * error_m));
      }
      const auto likelihood = [&](const std::vector<double>& sigma, double& squares) {
        Eigen::MatrixXd S = Eigen::MatrixXd::Zero(4, 4);
        for (int i = 0; i < 8; ++i)
          S += squared(sigma[static_cast<std::size_t>(i)]) * e.B.col(i) * e.B.col(i).transpose();
        squares = e.z.dot(S.inverse() * e.z);
        return -0.5 * (squares + std::log(S.determinant()));
      };
      std::vector<double> by[3];
      double squares = 0.0, log_of[3];
      for (int m = 0; m < 3; ++m) {
        for (std::size_t i = 0; i < 8; ++i) {
          const double noise = std::exp(-0.1 * cn0 * std::log(10.0));
          const double degraded =
              signals[i].code_factor * std::sqrt(m == 1 ? 10.0 + 22500.0 * noise : 500.0 + 1e6 * noise);
          by[m].push_back(m == 0 || degraded < ranges[i].sigma_m ? ranges[i].sigma_m : degraded);
        }
        log_of[m] = likelihood(by[m], squares);
        if (m == 0) {
          looks.near(log_likelihood(e, by[0]), log_of[0], 1e-9 * (1.0 + squares));
          const auto inflated = (*ModelChoice<reported_covariances>("residual_inflated").make("stress"))->sigma_m(e);
          const double factor = squares > 4.0 ? std::sqrt(squares / 4.0) : 1.0;
          for (std::size_t i = 0; i < 8; ++i) looks.near(inflated[i] / ranges[i].sigma_m, factor, 1e-9 * factor);
        }
      }
      const double top = worse(worse(log_of[0], log_of[1]), log_of[2]);
      if (cn0 == cn0) {
        const auto found = (*ModelChoice<reported_covariances>("environment").make("stress"))->sigma_m(e);
        double sum = 0.0;
        for (const double l : log_of) sum += std::exp(l - top);
        for (std::size_t i = 0; i < 8; ++i) {
          double variance = 0.0;
          for (int m = 0; m < 3; ++m) variance += std::exp(log_of[m] - top) / sum * squared(by[m][i]);
          looks.near(found[i], std::sqrt(variance), 1e-8 * (1.0 + squares) * found[i]);
        }
      }
      looks.near((covariance_of_fit(ranges, e.assumed_m, s) - s.covariance_E).norm(), 0.0,
                 1e-10 * s.covariance_E.norm());
      // The gain by differences: a range that is a metre longer.
      std::vector<double> ones(8, 1.0);
      const Eigen::MatrixXd gain = spread_of_fit(ranges, ones, s);
      double total = 0.0;
      for (int i = 0; i < 8; ++i) {
        auto longer = ranges;
        longer[static_cast<std::size_t>(i)].range_m += 1.0;
        const Vector3d by_1_m = make_least_squares({})->solve(longer, at_E).p_E - s.p_E;
        // Curvature of a range of 2.2e7 m: 1e-7 m; rounding of places in E.
        looks.near((by_1_m - gain.col(i)).norm(), 0.0, 1e-6);
        total += by_1_m.norm();
      }
      looks.near(s.range_gain, total, 1e-5);
    }
  return looks.figure();
}

/// Clocks in the order of systems, those of QZSS and SBAS being GPS's; and an index for each.
StressFigure clocks_of_systems() {
  StressFigure out;
  const auto right = [&](bool holds) { out.figure += holds ? 0.0 : 1.0; };
  const std::vector<GnssSystem> mixed{GnssSystem::kBeidou,  GnssSystem::kSbas, GnssSystem::kGalileo,
                                      GnssSystem::kGlonass, GnssSystem::kQzss, GnssSystem::kGalileo};
  const ReceiverClocks clocks(mixed);
  right(clocks.size() == 4);
  right(std::is_sorted(clocks.systems().begin(), clocks.systems().end()));
  for (const GnssSystem s : mixed) right(clocks.systems().at(clocks.index(s)) == clock_system(s));
  right(clock_system(GnssSystem::kQzss) == GnssSystem::kGps && clock_system(GnssSystem::kSbas) == GnssSystem::kGps);
  return out;
}

// --- The whole ---

const GpsTime kNoon = GpsTime::from_calendar(2020, 6, 25, 12, 0, 0);

NavigationData day_of_four_systems() {
  NavigationData data;
  data.files.push_back({"stress", 3.04});
  const struct {
    GnssSystem system;
    NavigationMessage message;
    int satellites, planes;
    double a_m, inclination_deg;
  } shells[] = {{GnssSystem::kGps, NavigationMessage::kLnav, 24, 6, 26559.7e3, 55.0},
                {GnssSystem::kGalileo, NavigationMessage::kInav, 18, 3, 29600.0e3, 56.0},
                {GnssSystem::kBeidou, NavigationMessage::kD1, 18, 3, 27906.0e3, 55.0}};
  for (const auto& shell : shells)
    for (int k = 0; k < shell.satellites; ++k) {
      KeplerEphemeris r;
      r.sv = {shell.system, static_cast<std::uint8_t>(shell.system == GnssSystem::kBeidou ? 19 + k : 1 + k)};
      r.message = shell.message;
      r.toe = r.toc = kNoon;
      r.transmitted = r.toe - 3600.0;
      r.af0_s = 1e-4 * std::sin(1.0 + k);
      r.af1 = 1e-12 * std::cos(2.0 * k);
      r.sqrt_a = std::sqrt(shell.a_m);
      r.e = 0.012;
      r.i0_rad = shell.inclination_deg * kDegree;
      r.omega0_rad = 2.0 * kPi * (k % shell.planes) / shell.planes + 0.3 * static_cast<double>(shell.system);
      r.omega_dot_rad_s = -8e-9;
      r.argument_of_perigee_rad = 0.4;
      r.m0_rad = 2.0 * kPi * (k / shell.planes) * shell.planes / shell.satellites + 0.7 * (k % shell.planes);
      r.accuracy_m = 2.0;
      r.tgd_s = 1e-9 * (k % 7 - 3);
      r.tgd2_s = shell.system == GnssSystem::kGps ? 0.0 : 1.3e-9 * (k % 5 - 2);
      r.iode = 10 + k;
      const Validity valid = default_validity(shell.system, shell.message);
      r.valid_before_s = valid.before_s;
      r.valid_after_s = valid.after_s;
      data.kepler.push_back(r);
    }
  data.klobuchar.push_back({GnssSystem::kGps, kNoon, kBuiltInKlobuchar});
  return data;
}

/// Ten epochs of a receiver on two bands whose ranges have this ionosphere (m at L1), and a troposphere, on them, and a
/// clock that runs; moved with v. Written as a file and read again.
ObservationFile recorded(const NavigationData& navigation, const Vector3d& from_E, const Vector3d& v_E,
                         const std::function<double(GnssSystem, const SkyView&)>& ionosphere_m,
                         const std::function<double(const SkyView&)>& troposphere_m) {
  const auto constellation = make_broadcast(navigation);
  const GpsTime first = kNoon + 30.0;
  ObservationWriter writer(
      {.first = first,
       .bands = {{GnssSystem::kGps, {1, 2}}, {GnssSystem::kGalileo, {1, 5}}, {GnssSystem::kBeidou, {2, 6}}}});
  std::string text = writer.header();
  for (int k = 0; k < 10; ++k) {
    const double clock_s = 2e-7 + 1e-9 * k, drift = 1e-9 / 30.0;
    const GpsTime t = first + 30.0 * k;
    const Vector3d p_E = from_E + 30.0 * k * v_E;
    const Horizon horizon(p_E);
    GnssEpoch epoch;
    epoch.t = t + clock_s;
    for (const SatelliteId sv : constellation->satellites()) {
      const auto signal = transmission_to(*constellation, sv, t, p_E);
      if (!signal) continue;
      const SkyView view = horizon.view(t, signal->p_E());
      if (view.elevation_rad < 8.0 * kDegree) continue;
      const auto before = transmission_to(*constellation, sv, t - 0.5, p_E - 0.5 * v_E);
      const auto after = transmission_to(*constellation, sv, t + 0.5, p_E + 0.5 * v_E);
      const double rate_m_s =
          after->range_m - before->range_m + kSpeedOfLight * (drift - (after->state.clock_s - before->state.clock_s));
      GnssObservation o;
      o.sv = sv;
      o.band = first_band(sv.system);
      o.second.band = sv.system == GnssSystem::kGps ? 2 : sv.system == GnssSystem::kGalileo ? 5 : 6;
      const auto fill = [&](int band, double& code_m, double& phase, double& doppler_hz, double& cn0_dbhz) {
        const double hz = carrier_hz(sv.system, band), scale = kL1Hz / hz;
        const double delay_m = scale * scale * ionosphere_m(sv.system, view);
        const double clear_m =
            signal->range_m + kSpeedOfLight * (clock_s - signal->state.clock_of_band_s(band)) + troposphere_m(view);
        code_m = clear_m + delay_m;
        phase = (clear_m - delay_m) * hz / kSpeedOfLight + 1000.0 * band;
        doppler_hz = -rate_m_s * hz / kSpeedOfLight;
        cn0_dbhz = 45.0;
      };
      fill(o.band, o.pseudorange_m, o.carrier_phase_cycles, o.doppler_hz, o.cn0_dbhz);
      fill(o.second.band, o.second.pseudorange_m, o.second.carrier_phase_cycles, o.second.doppler_hz,
           o.second.cn0_dbhz);
      epoch.observations.push_back(o);
    }
    text += writer.epoch(epoch);
  }
  return *parse_observation_file(text, "stress.rnx");
}

/// What was put on is taken off again: the place to the millimetre that a file's ranges have, over the geometry, and
/// velocity to the file's millihertz.
StressFigure whole(const std::string& how) {
  const NavigationData navigation = day_of_four_systems();
  const auto constellation = make_broadcast(navigation);
  const Vector3d place_E = ecef_from_geodetic({48.0 * kDegree, 11.0 * kDegree, 520.0});
  const Vector3d v_E = how == "moving" ? Vector3d(9.0, -14.0, 3.0) : Vector3d::Zero();
  SinglePointConfig c;
  c.systems = "GEC";
  c.smoothing_s = how == "smoothed" ? 300.0 : 0.0;
  c.shared_ionosphere = 0.0;
  c.ionosphere = IonosphereCorrection::kKlobuchar;
  const bool dual = how == "dual";
  if (dual) c.frequencies = Frequencies::kDual;
  const auto ionosphere_m = [&](GnssSystem system, const SkyView& v) {
    // Any at all for two frequencies; GPS's model for one.
    if (dual) return 20.0 + 5.0 * std::cos(v.azimuth_rad);
    static_cast<void>(system);
    return klobuchar_delay_m(kBuiltInKlobuchar, v.t, v.receiver.lat_rad, v.receiver.lon_rad, v.azimuth_rad,
                             v.elevation_rad);
  };
  const ObservationFile file = recorded(navigation, place_E, v_E, ionosphere_m, standard_troposphere_m);
  std::optional<BaseRecording> base;
  if (how == "differential") {
    // A base 300 m off, whose errors, of whatever size, are those of the rover.
    const auto strange = [](GnssSystem, const SkyView& v) { return 30.0 * std::sin(v.azimuth_rad); };
    const Vector3d base_E = place_E + Vector3d(200.0, 200.0, 100.0);
    base = BaseRecording{recorded(navigation, base_E, Vector3d::Zero(), strange, standard_troposphere_m), base_E};
  }
  const ObservationFile at_rover =
      base ? recorded(
                 navigation, place_E, v_E, [](GnssSystem, const SkyView& v) { return 30.0 * std::sin(v.azimuth_rad); },
                 standard_troposphere_m)
           : file;
  if (how == "filtered") c.estimator = Estimator::kKalman;
  const auto r = solve_observations(at_rover, {*constellation, navigation, nullptr, base ? &*base : nullptr}, c);
  if (!r.ok()) return {kInfinity, 1.0};
  Looks looks;
  looks.right(r->solved() == 10 && r->epochs.size() == 10);
  for (std::size_t k = 0; k < r->epochs.size(); ++k) {
    const SinglePointEpoch& e = r->epochs[k];
    const Vector3d truth_E = place_E + 30.0 * static_cast<double>(k) * v_E;
    // Combinations have three times the error of a range, a base's azimuths differ by 1e-5 rad of 30 m.
    const double range_m = dual ? 4e-3 : base ? 4e-3 : 1.5e-3;
    looks.near((e.fix.p_A_E - truth_E).norm(), 0.0, range_m * e.fix.dop.pdop);
    looks.near((e.fix.v_A_E - v_E).norm(), 0.0, 1e-3 * e.fix.dop.pdop);
    if (how != "filtered") {
      // Ranges and the clock: 200 ns and what it runs.
      looks.near(e.fix.clock_m, kSpeedOfLight * (2e-7 + 1e-9 * static_cast<double>(k)),
                 2.0 * range_m * e.fix.dop.gdop + (base ? 1e3 : 0.0));  // a base's own clock is in its ranges
      for (const double residual : e.residuals_m) looks.near(residual, 0.0, 3.0 * range_m);
    }
    looks.right(e.fix.status == (base ? FixStatus::kDifferential : FixStatus::kSingle) && e.excluded == 0);
    const Horizon horizon(truth_E);
    for (const GnssObservation& o : e.epoch.observations) {
      const SkyView view = horizon.view(e.fix.t, o.p_E);
      looks.right(view.elevation_rad >= 10.0 * kDegree - 1e-6 && o.used);
      // Sigma as the budget has it.
      RangeQuality q;
      q.system = o.sv.system;
      q.elevation_rad = view.elevation_rad;
      q.cn0_dbhz = 45.0;
      const double scale = kL1Hz / carrier_hz(o.sv.system, o.band);
      q.ionosphere_m = dual ? 0.0 : scale * scale * ionosphere_m(o.sv.system, view);
      const double f1 = carrier_hz(o.sv.system, o.band),
                   f2 = carrier_hz(o.sv.system, o.sv.system == GnssSystem::kGps       ? 2
                                                : o.sv.system == GnssSystem::kGalileo ? 5
                                                                                      : 6);
      const double w1 = f1 * f1 / (f1 * f1 - f2 * f2);
      q.code_factor = dual ? std::hypot(w1, 1.0 - w1) : 1.0;
      q.differential = base.has_value();
      const double own = std::sqrt(stated_variance("budget", q, 0.5));
      const double expected =
          base ? std::hypot(own, 0.16 + 1.07 * std::exp(-view.elevation_rad / (15.5 * kDegree))) : own;
      // Elevations of the fix and of the truth, mm over 2e7 m, and of a base 300 m off.
      looks.near(o.sigma_m / expected, 1.0, base ? 2e-4 : 1e-6);
    }
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> single_position_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kData,
           .mechanism = "what a range is trusted with, over all elevations, strengths and systems",
           .why = "a factor, a sign or a class's limit that makes a satellite count for another's",
           .expected = "the variance that the model's source states, to 40 epsilons",
           .unit = "of the bound"});
  for (const auto& row : range_weightings())
    rows.add(std::string("single_position/weights_") + row.name,
             [name = std::string(row.name)] { return weights_of(name); });
  rows.of({.group = StressGroup::kData,
           .mechanism = "delays and corrections of one signal, or of two",
           .why = "weights of a combination exchanged, a lent delay of no uncertainty, a model of another elevation",
           .expected = "by hand, from carriers and the formulas that are cited: roundings",
           .unit = "of the bound"});
  rows.add("single_position/group_delays", group_delays)
      .add("single_position/combined_signals", combined_signals)
      .add("single_position/corrections", corrections)
      .add("single_position/epochs_of_a_base", base_epochs);
  rows.of({.group = StressGroup::kData,
           .mechanism = "which of a satellite's signals is taken, and which clock is its",
           .why = "phase of another band beside a range, an order of codes that ends early",
           .expected = "those that are said to be preferred, value by value",
           .unit = "wrong"});
  rows.add("single_position/codes_chosen", codes_chosen).add("single_position/clocks_of_systems", clocks_of_systems);
  rows.of({.group = StressGroup::kData,
           .mechanism = "figures of a list of fixes",
           .why = "deviations about no mean, a percentile's rank off by one, epochs without a truth that count",
           .expected = "sums over the errors that were put in, to the rounding of places on Earth",
           .unit = "of the bound"});
  for (const int n : {1, 2, 7, 400})
    rows.add("single_position/statistics_of_" + std::to_string(n), [n] { return statistics_of(n); });
  rows.of({.group = StressGroup::kData,
           .mechanism = "what a receiver says its ranges are good for",
           .why = "a likelihood without its determinant, a variance in the place of a sigma",
           .expected = "the same from parity, likelihoods and differences: conditioning of four equations",
           .unit = "of the bound"});
  rows.add("single_position/reported_sigmas", reported_sigmas);
  rows.of({.group = StressGroup::kData,
           .mechanism = "a recording whose errors are just those that are modelled",
           .why = "a delay that is added, the clock of another band, a velocity by the wrong carrier",
           .expected = "place and velocity of the receiver to what a file's digits leave over the geometry",
           .unit = "of the bound"});
  for (const char* how : {"single", "smoothed", "dual", "moving", "filtered", "differential"})
    rows.add(std::string("single_position/whole_") + how, [name = std::string(how)] { return whole(name); });
  return rows.take();
}

}  // namespace canyon::gnss
