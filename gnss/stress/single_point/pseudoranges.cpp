// What becomes of a recorded pseudorange: weights, delays, combinations, corrections, which code and clock, and a base.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/atmosphere/beidou_klobuchar.h"
#include "canyon/gnss/atmosphere/klobuchar.h"
#include "canyon/gnss/atmosphere/troposphere.h"
#include "canyon/gnss/rinex/observation/observation_file.h"
#include "canyon/gnss/satellites/navigation_data.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/single_point/base_station.h"
#include "canyon/gnss/single_point/code_choice.h"
#include "canyon/gnss/single_point/group_delay.h"
#include "canyon/gnss/single_point/range_corrections.h"
#include "canyon/gnss/sky_view.h"
#include "canyon/gnss/solver/receiver_clocks.h"
#include "canyon/gnss/solver/weighting.h"
#include "canyon/gnss/stress/single_point/stated_variance.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using stress::kEpsilon;
using stress::kInfinity;
using stress::Looks;

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
  // Of GLONASS two precise codes where they are, and the civil one for who has one frequency.
  std::vector<ObservationCode> both = codes;
  both.push_back({'C', '2', 'C'}), both.push_back({'C', '2', 'P'});
  const SatelliteObservations glonass = observed(GnssSystem::kGlonass, both.size());
  right(single_frequency_signal(both, glonass)->pseudorange_m == 101.0);
  const auto pair = dual_frequency_signals(both, glonass);
  right(pair && pair->first.pseudorange_m == 100.0 && pair->second.pseudorange_m == 111.0);
  const SatelliteObservations qzss = observed(GnssSystem::kQzss, codes.size());
  right(single_frequency_signal(codes, qzss)->pseudorange_m == 101.0);
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

}  // namespace

std::vector<StressCase> pseudorange_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kData,
           .mechanism = "what a range is trusted with, over all elevations, strengths and systems",
           .why = "a factor, a sign or a class's limit that makes a satellite count for another's",
           .expected = "the variance that the model's source states, to 40 epsilons",
           .unit = "of the bound"});
  for (const auto& row : range_weightings())
    rows.add(std::string("pseudoranges/weights_") + row.name,
             [name = std::string(row.name)] { return weights_of(name); });
  rows.of({.group = StressGroup::kData,
           .mechanism = "delays and corrections of one signal, or of two",
           .why = "weights of a combination exchanged, a lent delay of no uncertainty, a model of another elevation",
           .expected = "by hand, from carriers and the formulas that are cited: roundings",
           .unit = "of the bound"});
  rows.add("pseudoranges/group_delays", group_delays)
      .add("pseudoranges/combined_signals", combined_signals)
      .add("pseudoranges/corrections", corrections)
      .add("pseudoranges/epochs_of_a_base", base_epochs);
  rows.of({.group = StressGroup::kData,
           .mechanism = "which of a satellite's signals is taken, and which clock is its",
           .why = "phase of another band beside a range, an order of codes that ends early",
           .expected = "those that are said to be preferred, value by value",
           .unit = "wrong"});
  rows.add("pseudoranges/codes_chosen", codes_chosen).add("pseudoranges/clocks_of_systems", clocks_of_systems);
  return rows.take();
}

}  // namespace canyon::gnss
