// Signal locks at their threshold, cycle slips from the weakest to the strongest signal.
#include <cmath>
#include <limits>

#include "canyon/core/output/printed.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/gnss/receiver/carrier_noise.h"
#include "canyon/gnss/receiver/link_budget.h"
#include "canyon/gnss/receiver/signal_lock.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

const SatelliteId kG09{GnssSystem::kGps, 9};

/// Exactly at the threshold a signal is held, a rounding below it is not; lost, it is found again exactly
/// ceil(reacquisition / interval) epochs after it stands a margin above, and not a rounding below that margin.
/// A figure counts what differs.
StressFigure at_threshold(double rate_hz, double reacquisition_s, std::int64_t epochs) {
  SignalLocks locks({.interval_s = 1.0 / rate_hz,
                     .threshold_dbhz = 25.0,
                     .reacquisition_margin_db = 3.0,
                     .reacquisition_s = reacquisition_s,
                     .slips = false});
  std::int64_t index = 0;
  const auto tracked = [&](double cn0) {
    locks.begin_epoch(index++);
    return locks.update(kG09, cn0, 0).tracked;
  };
  StressFigure out;
  out.figure += tracked(25.0) ? 0.0 : 1.0;
  out.figure += tracked(std::nextafter(25.0, 0.0)) ? 1.0 : 0.0;
  for (std::int64_t k = 0; k < 3 + 2 * epochs; ++k) out.figure += tracked(std::nextafter(28.0, 0.0)) ? 1.0 : 0.0;
  for (std::int64_t k = 0; k < epochs; ++k) out.figure += tracked(28.0) ? 1.0 : 0.0;
  out.figure += tracked(28.0) ? 0.0 : 1.0;
  out.figure += tracked(std::numeric_limits<double>::quiet_NaN()) ? 1.0 : 0.0;
  out.figure += tracked(-std::numeric_limits<double>::infinity()) ? 1.0 : 0.0;
  return out;
}

/// Finite, positive, and longer for the stronger signal, from none to 120 dB-Hz: Bessel functions of 1e10 overflow. A
/// figure counts what is not. Beyond e^600 s it is held.
StressFigure slip_times() {
  StressFigure out;
  for (const double hz : {0.5, 15.0, 50.0})
    for (const double s : {0.001, 0.02, 0.04}) {
      double before = 0.0;
      for (double cn0 = -50.0; cn0 <= 120.0; cn0 += 0.25) {
        const double now = mean_time_to_slip_s(cn0, hz, s);
        out.figure += std::isfinite(now) && now > 0.0 && (now > before || now > 1e260) ? 0.0 : 1.0;
        before = now;
      }
    }
  return out;
}

/// Across the seam of the Bessel function's two forms, rho = 12: steps of 1e-6 dB change the logarithm by 2 d rho <
/// 1e-5 and its documented 1e-6.
StressFigure bessel_seam() {
  StressFigure out{0.0, 2e-5 + 2e-6};
  // rho = C/N0 / (4 B) for long integrations.
  const double cn0 = 10.0 * std::log10(12.0 * 4.0 * 15.0);
  for (int k = -4000; k < 4000; ++k) {
    const double a = std::log(mean_time_to_slip_s(cn0 + 1e-4 * k, 15.0, 0.04)),
                 b = std::log(mean_time_to_slip_s(cn0 + 1e-4 * k + 1e-6, 15.0, 0.04));
    take_worst(out, std::abs(b - a));
  }
  return out;
}

/// The share of epochs with a slip, in N signals over one epoch, is 1 - exp(-dt / mean): five deviations of a binomial.
StressFigure slip_share(double cn0_dbhz, double interval_s) {
  SignalLocks locks({.seed = 4, .interval_s = interval_s, .threshold_dbhz = 0.0, .carrier_loop_hz = 15.0});
  constexpr int kEpochs = 20000;
  int slips = 0;
  for (int k = 0; k <= kEpochs; ++k) {
    locks.begin_epoch(k);
    slips += k > 0 && locks.update(kG09, cn0_dbhz, 0).slipped;
    if (k == 0) locks.update(kG09, cn0_dbhz, 0);
  }
  const double p = 1.0 - std::exp(-interval_s / mean_time_to_slip_s(cn0_dbhz, 15.0, 0.02));
  return {std::abs(static_cast<double>(slips) / kEpochs - p), 5.0 * std::sqrt(p * (1.0 - p) / kEpochs) + 1e-9};
}

/// Of no field, no foliage and endless foliage the link is finite: A_m is the most that leaves take. A figure counts
/// what is not within its closed form to 1e-12 dB.
StressFigure link() {
  LinkBudget budget;
  StressFigure out;
  const auto wrong = [&](double found, double exact) {
    out.figure += std::abs(found - exact) <= 1e-12 * 200.0 ? 0.0 : 1.0;
  };
  wrong(budget.direct_cn0_dbhz(0.5 * kPi, 0.0), 45.0);
  wrong(budget.direct_cn0_dbhz(0.5 * kPi, 1e9), 45.0 - 28.0);
  wrong(budget.direct_cn0_dbhz(0.5 * kPi, 0.0, 0.0), 45.0 - 200.0);
  wrong(budget.foliage_db(0.0), 0.0);
  wrong(budget.direct_cn0_dbhz(-0.5 * kPi, 0.0), 45.0 - 14.0);
  SignalPath none;
  out.figure += std::isfinite(receive(none, budget, Eigen::Vector3d::UnitZ()).cn0_dbhz) ? 0.0 : 1.0;
  SignalPath far;
  far.excess_m = 1e12, far.copolar = 1e-30;
  const ReceivedSignal r = receive(far, budget, Eigen::Vector3d::UnitZ());
  out.figure += std::isfinite(r.cn0_dbhz) && std::abs(r.phase_rad) <= 3.0 * kPi ? 0.0 : 1.0;
  return out;
}

}  // namespace

std::vector<StressCase> lock_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "a signal exactly at its threshold",
           "a count of epochs from a quotient that rounds: 1 s at 10 Hz becomes 9 or 11; >= for >; NaN compares false",
           "held at the threshold, lost a rounding below, found after ceil(T rate) epochs exactly", "differences"});
  struct Rate {
    double hz, s;
    std::int64_t epochs;
  };
  for (const Rate& r : {Rate{0.01, 1.0, 1}, Rate{1.0, 1.0, 1}, Rate{3.0, 1.0, 3}, Rate{10.0, 1.0, 10},
                        Rate{10.0, 0.3, 3}, Rate{10.0, 0.0, 0}, Rate{1000.0, 0.7, 700}, Rate{1.0, 600.0, 600}}) {
    rows.add(printed("locks/threshold_at_%g_hz_after_%g_s", r.hz, r.s),
             [r] { return at_threshold(r.hz, r.s, r.epochs); });
  }
  rows.of({StressGroup::kStiff, "time to a cycle slip over seventeen decades of signal",
           "I0 of 1e10 overflows, the exponential of its logarithm too; weak signals give a rho of zero",
           "finite, positive, rising with the signal from -50 to 120 dB-Hz", "wrong"});
  rows.add("locks/slip_times", slip_times);
  rows.of({StressGroup::kStiff, "a Bessel function where its series and its expansion meet", "a jump at the seam",
           "2 d rho < 2e-5, and 2e-6 of its documented error", ""});
  rows.add("locks/bessel_seam", bessel_seam);
  rows.of({StressGroup::kLong, "counts of rare and of frequent slips",
           "a probability taken as dt / mean: above 1 for long epochs",
           "1 - exp(-dt / mean), five deviations of 20,000", ""});
  rows.add("locks/slips_at_20_db_hz", [] { return slip_share(20.0, 0.1); })
      .add("locks/slips_at_20_db_hz_and_100_s", [] { return slip_share(20.0, 100.0); })
      .add("locks/slips_at_24_db_hz", [] { return slip_share(24.0, 1.0); });
  rows.of({StressGroup::kGeometry, "a link of no field or endless foliage", "the logarithm of nothing",
           "finite; -200 dB of no field, A_m of endless leaves, twice the loss from below", "wrong"});
  rows.add("locks/link_at_its_ends", link);
  return rows.take();
}

}  // namespace canyon::gnss
