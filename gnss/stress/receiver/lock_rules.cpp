// Locks over many epochs: how they are won, slip and are lost.
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "canyon/core/random/random.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/gnss/receiver/signal_lock.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

/// Locks by their rules, one state for each satellite, over 400 epochs of strengths that come and go, sources that
/// change and satellites that set: exact, cycles drawn by their streams.
StressFigure locks_by_their_rules() {
  int wrong = 0, slips = 0;
  const RandomStream draws(2, "stress.asked");
  SignalLockParameters p;
  p.seed = 6, p.interval_s = 0.5, p.threshold_dbhz = 21.0, p.reacquisition_margin_db = 2.0, p.reacquisition_s = 1.6;
  const RandomStream ambiguity(6, "gnss.carrier.ambiguity"), slip(6, "gnss.carrier.slip");
  SignalLocks locks(p);
  struct Own {
    bool locked = false;
    int since = -1, last = -10;
    std::uint64_t source = 0;
    double cycles = 0.0;
  };
  std::map<std::uint8_t, Own> own;
  int begun = 0;
  for (int k = 0; k < 400; ++k) {
    if (k == 250) locks.restart(), own.clear(), begun = k;
    locks.begin_epoch(k);
    const bool first = k == begun;
    for (std::uint8_t prn = 1; prn <= 6; ++prn) {
      const auto at = static_cast<std::uint64_t>(8 * k + prn);
      if (draws.uniform(0, at) < 0.02) continue;  // not in view
      const SatelliteId sv{GnssSystem::kGps, prn};
      const double cn0 = draws.uniform(1, at) < 0.02
                             ? kNaN
                             : 20.0 + 0.7 * prn + 3.0 * std::sin(0.05 * k * prn) + draws.uniform(-0.5, 0.5, 2, at);
      const std::uint64_t source = draws.uniform(3, at) < 0.05 ? 7 : 1;
      const auto found = locks.update(sv, cn0, source);
      Own& o = own[prn];
      if (o.last != k - 1) o = Own{};
      o.last = k;
      bool tracked = false, slipped = false, fresh = false;
      if (!(cn0 >= 21.0)) {
        o.locked = false, o.since = -1;
      } else if (!o.locked) {
        if (first || cn0 >= 23.0) {
          if (o.since < 0) o.since = k;
          // 1.6 s are four epochs of half a second.
          fresh = first || k - o.since >= 4;
        } else {
          o.since = -1;
        }
        tracked = fresh;
      } else {
        tracked = true;
        fresh = source != o.source;
        const double share = 1.0 - std::exp(-0.5 / mean_time_to_slip_s(cn0, 15.0, 0.02)),
                     u = slip.uniform(sv.entity(), static_cast<std::uint64_t>(k));
        if (!fresh && u < share) o.cycles += u < 0.5 * share ? 1.0 : -1.0, slipped = true, ++slips;
      }
      if (fresh)
        o.locked = slipped = true,
        o.cycles = std::floor(ambiguity.uniform(-1e6, 1e6, sv.entity(), static_cast<std::uint64_t>(k)));
      if (tracked) o.source = source;
      wrong +=
          found.tracked == tracked && found.slipped == slipped && found.ambiguity_cycles == (tracked ? o.cycles : 0.0)
              ? 0
              : 1;
    }
  }
  wrong += slips > 5 ? 0 : 1;
  // A Costas loop's mean time by quadrature of Bessel's function, I0(x) = mean of exp(x cos): to its own 1e-6.
  for (const double cn0 : {18.0, 21.0, 23.0, 25.0, 27.0}) {
    const double hz = std::pow(10.0, 0.1 * cn0), sigma2 = 15.0 / hz * (1.0 + 1.0 / (2.0 * 0.02 * hz)),
                 rho = 0.25 / sigma2;
    double bessel = 0.0;  // times exp(-rho)
    for (int k = 0; k < 4000; ++k) bessel += std::exp(rho * (std::cos(2.0 * kPi * k / 4000.0) - 1.0)) / 4000.0;
    const double log_s = std::log(kPi * kPi * rho / 30.0) + 2.0 * (rho + std::log(bessel));
    wrong += std::abs(std::log(mean_time_to_slip_s(cn0, 15.0, 0.02)) - log_s) < 4e-6 ? 0 : 1;
  }
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> lock_rule_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "locks over many epochs",
           "a margin that is taken off, a wait of an epoch too many, a slip the other way",
           "the rules for each satellite by itself: exact; slips by Bessel's function to its 1e-6", "differences"});
  rows.add("asked/locks_by_their_rules", locks_by_their_rules);
  return rows.take();
}

}  // namespace canyon::gnss
