// Which of the records that satellites have sent is taken: by health and age, against its neighbours, over a span.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/random/random.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/gnss/satellites/contradictions.h"
#include "canyon/gnss/satellites/ephemerides/ephemeris_limits.h"
#include "canyon/gnss/satellites/navigation_data.h"
#include "canyon/gnss/stress/satellites/drawn_records.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using made::Kind;
using made::kKinds;
using made::kSentWeek;
using made::some_record;
using Message = NavigationMessage;

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

std::vector<StressCase> taken_record_cases() {
  StressRows rows;
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
