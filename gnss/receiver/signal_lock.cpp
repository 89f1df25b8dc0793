#include "canyon/gnss/receiver/signal_lock.h"

#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/units.h"
#include "canyon/gnss/receiver/carrier_noise.h"

namespace canyon::gnss {
namespace {

/// Logarithm of the modified Bessel function I0: its series below 12, the asymptotic expansion above (Abramowitz &
/// Stegun 9.6.12, 9.7.1); to 1e-6.
double log_bessel_i0(double x) {
  if (x < 12.0) {
    double term = 1.0, sum = 1.0;
    for (int k = 1; term > 1e-16 * sum; ++k) {
      term *= 0.25 * x * x / (static_cast<double>(k) * k);
      sum += term;
    }
    return std::log(sum);
  }
  const double y = 1.0 / (8.0 * x);
  return x - 0.5 * std::log(2.0 * kPi * x) + std::log1p(y * (1.0 + y * (4.5 + y * 37.5)));
}

}  // namespace

double mean_time_to_slip_s(double cn0_dbhz, double carrier_loop_hz, double integration_s) {
  const double sigma_rad = carrier_phase_noise_rad(cn0_dbhz, carrier_loop_hz, integration_s);
  const double rho = 0.25 / (sigma_rad * sigma_rad);
  const double log_s = std::log(kPi * kPi * rho / (2.0 * carrier_loop_hz)) + 2.0 * log_bessel_i0(rho);
  return std::exp(std::min(log_s, 600.0));
}

SignalLocks::SignalLocks(const SignalLockParameters& p)
    : p_(p),
      ambiguity_(p.seed, "gnss.carrier.ambiguity"),
      slip_(p.seed, "gnss.carrier.slip"),
      reacquisition_epochs_(static_cast<std::int64_t>(std::ceil(p.reacquisition_s / p.interval_s - 1e-9))) {
  CANYON_CHECK(p.interval_s > 0.0 && p.reacquisition_s >= 0.0, "interval_s = ", p.interval_s,
               ", reacquisition_s = ", p.reacquisition_s);
}

void SignalLocks::restart() {
  channels_.clear();
  first_ = true;
  index_ = -1;
}

void SignalLocks::begin_epoch(std::int64_t index) {
  first_ = index_ < 0;
  index_ = index;
}

SignalLocks::State SignalLocks::update(SatelliteId sv, double cn0_dbhz, std::uint64_t source) {
  Channel& c = channels_[sv];
  // Not looked at in the epoch before: it was out of view.
  if (c.updated != index_ - 1) c = Channel{};
  c.updated = index_;
  const auto sample = static_cast<std::uint64_t>(index_);
  State out;
  if (!(cn0_dbhz >= p_.threshold_dbhz)) {
    c.locked = false;
    c.seen_since = -1;
    return out;
  }
  const auto start = [&] {
    c.locked = true;
    c.ambiguity_cycles = std::floor(ambiguity_.uniform(-1e6, 1e6, sv.entity(), sample));
    out.slipped = true;
  };
  if (!c.locked) {
    if (!(first_ || cn0_dbhz >= p_.threshold_dbhz + p_.reacquisition_margin_db)) {
      c.seen_since = -1;
      return out;
    }
    if (c.seen_since < 0) c.seen_since = index_;
    if (!first_ && index_ - c.seen_since < reacquisition_epochs_) return out;
    start();
  } else if (source != c.source) {
    start();
  } else if (p_.slips) {
    const double mean_s = mean_time_to_slip_s(cn0_dbhz, p_.carrier_loop_hz, p_.integration_s);
    const double probability = 1.0 - std::exp(-p_.interval_s / mean_s);
    const double u = slip_.uniform(sv.entity(), sample);
    if (u < probability) {
      c.ambiguity_cycles += u < 0.5 * probability ? 1.0 : -1.0;
      out.slipped = true;
    }
  }
  c.source = source;
  out.tracked = true;
  out.ambiguity_cycles = c.ambiguity_cycles;
  return out;
}

void visit(FieldVisitor& f, LockConfig& c) {
  f.number("tracking_threshold_dbhz", c.tracking_threshold_dbhz, {0.0, 60.0},
           "signals weaker than this are not tracked");
  f.number("reacquisition_margin_db", c.reacquisition_margin_db, {0.0, 40.0},
           "a lost signal is found again only above the threshold by this");
  f.number("reacquisition_s", c.reacquisition_s, {0.0, 600.0}, "and after it has been there for so long");
}

}  // namespace canyon::gnss
