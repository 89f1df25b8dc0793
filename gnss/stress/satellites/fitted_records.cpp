// Records that are fitted to orbits, and that cannot be.
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "canyon/core/stress/looks.h"
#include "canyon/gnss/satellites/constellation.h"
#include "canyon/gnss/satellites/ephemerides/ephemeris_fit.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using stress::Looks;

/// What cannot be fitted is not: satellites that have no such record, spans with too few samples, channels that nobody
/// knows; a fit says what it leaves, and its clock is the satellite's straight line.
class Patchy final : public Constellation {
 public:
  Patchy(const Constellation& sky, GpsTime from, GpsTime to, int channel)
      : sky_(sky), from_(from), to_(to), channel_(channel) {}
  const std::vector<SatelliteId>& satellites() const override { return sky_.satellites(); }
  std::optional<SatelliteState> state(SatelliteId sv, GpsTime t) const override {
    auto s = sky_.state(sv, t);
    if (!s || t < from_ || to_ < t) return std::nullopt;
    s->clock_s = 3e-5 + 4e-11 * (t - from_);
    s->group_delay_s[1] = 4e-9, s->group_delay_s[2] = 6e-9, s->group_delay_s[7] = -2e-9;
    if (sv.system == GnssSystem::kGlonass) s->frequency_channel = channel_;
    return s;
  }

 private:
  const Constellation& sky_;
  GpsTime from_, to_;
  int channel_;
};

StressFigure fits_and_none() {
  Looks looks;
  const auto sky = make_nominal("GREC");
  const GpsTime toe = GpsTime::from_week_sow(2000, 36000.0);
  const Patchy whole(*sky, toe - 7200.0, toe + 7200.0, 4), half(*sky, toe - 3500.0, toe + 3500.0, 4),
      some(*sky, toe - 3900.0, toe + 3700.0, kUnknownChannel);
  const auto fits = [&](const Constellation& of, SatelliteId sv) { return fit_ephemeris(of, sv, toe).has_value(); };
  looks.right(fits(whole, {GnssSystem::kGps, 3}) && !fits(whole, {GnssSystem::kGlonass, 3}) &&
              !fits(whole, {GnssSystem::kSbas, 3}));
  // 25 samples of 5 minutes: two hours of them.
  looks.right(!fits(half, {GnssSystem::kGps, 3}) && fits(some, {GnssSystem::kGps, 3}) &&
              !fits(whole, {GnssSystem::kGps, 99}));
  looks.right(fit_state_vector(whole, {GnssSystem::kGlonass, 3}, toe).has_value());
  looks.right(!fit_state_vector(some, {GnssSystem::kGlonass, 3}, toe) &&
              !fit_state_vector(whole, {GnssSystem::kGps, 3}, toe));
  const Patchy brief(*sky, toe - 300.0, toe + 300.0, 4);
  looks.right(!fit_state_vector(brief, {GnssSystem::kGlonass, 3}, toe));
  for (const SatelliteId sv : {SatelliteId{GnssSystem::kGps, 3},
                               {GnssSystem::kGalileo, 5},
                               {GnssSystem::kBeidou, 20},
                               {GnssSystem::kBeidou, 59}}) {
    const auto fit = fit_ephemeris(whole, sv, toe);
    if (!fit) return {stress::kInfinity, 1.0};
    const KeplerEphemeris& r = fit->ephemeris;
    double squares = 0.0, most = 0.0;
    int n = 0;
    for (double s = -7200.0; s <= 7200.0; s += 300.0, ++n) {
      const double off = (r.at(toe + s).p_E - sky->state(sv, toe + s)->p_E).norm();
      squares += off * off, most = worse(most, off);
      looks.near(r.at(toe + s).clock_s, 3e-5 + 4e-11 * (7200.0 + s), 1e-15);
    }
    looks.near(fit->rms_m, std::sqrt(squares / n), 1e-6), looks.near(fit->max_m, most, 1e-6);
    looks.right(r.toe == toe && r.toc == toe && r.sv == sv && fit->max_m < 1e-3);
    const bool galileo = sv.system == GnssSystem::kGalileo, beidou = sv.system == GnssSystem::kBeidou;
    looks.near(r.tgd_s, beidou ? 6e-9 : 4e-9, 1e-22), looks.near(r.tgd2_s,
                                                                 galileo  ? 4e-9
                                                                 : beidou ? -2e-9
                                                                          : 0.0,
                                                                 1e-22);
    looks.right(r.message == (galileo  ? NavigationMessage::kInav
                              : beidou ? beidou_message(sv.prn)
                                       : NavigationMessage::kLnav));
  }
  const auto vector = fit_state_vector(whole, {GnssSystem::kGlonass, 3}, toe);
  looks.near(vector->ephemeris.delta_tau_s, 2e-9, 1e-22),
      looks.near(vector->ephemeris.clock_s, 3e-5 + 4e-11 * 7200.0, 1e-15);
  looks.near(vector->ephemeris.clock_rate, 4e-11, 1e-16), looks.right(vector->ephemeris.frequency_channel == 4);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> fitted_record_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "records that are fitted, and that cannot be", "a guard that lets an empty span through",
           "what is left as stated, and none where there is too little", "of the bound"});
  rows.add("made/fits_and_none", fits_and_none);
  return rows.take();
}

}  // namespace canyon::gnss
