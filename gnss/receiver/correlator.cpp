#include <cmath>
#include <vector>

#include "canyon/core/units.h"
#include "canyon/gnss/receiver/multipath_rule.h"

namespace canyon::gnss {
namespace {

/// Tracking of the composite of direct signal and echoes by CodeTracking. C/N0 is the composite's, and below the
/// threshold nothing is tracked. Without a direct signal the composite of the echoes is: NLOS-only reception.
class Correlator final : public MultipathRule {
 public:
  explicit Correlator(const MultipathParameters& p) : threshold_dbhz_(p.threshold_dbhz), tracking_(p.design) {}

  Reception receive(const std::optional<ReceivedSignal>& direct, std::span<const ReceivedSignal> echoes,
                    double wavelength_m) const override {
    // Amplitude 1 is a C/N0 of 0 dB-Hz.
    std::vector<EchoSignal> signals;
    signals.reserve(echoes.size() + 1);
    const auto add = [&signals](const ReceivedSignal& s) {
      signals.push_back({s.excess_m, std::pow(10.0, s.cn0_dbhz / 20.0), s.phase_rad, s.doppler_hz});
    };
    if (direct) add(*direct);
    for (const auto& e : echoes) add(e);
    const auto lock = tracking_.track(signals);
    if (!lock) return {};

    Reception r;
    r.cn0_dbhz = 20.0 * std::log10(lock->amplitude);
    if (r.cn0_dbhz < threshold_dbhz_) return {};
    r.tracked = true;
    r.error_m = lock->delay_m;
    r.source = static_cast<int>(lock->reference) - (direct ? 1 : 0);
    // The reference's own way is counted in full; only the turn beyond it is ambiguous, and lies within half a cycle.
    const EchoSignal& reference = signals[lock->reference];
    const double own_rad = std::remainder(
        reference.phase_rad + 2.0 * kPi * std::remainder(reference.delay_m / wavelength_m, 1.0), 2.0 * kPi);
    r.carrier_error_m =
        reference.delay_m - wavelength_m / (2.0 * kPi) * (own_rad + lock->phase_rad - reference.phase_rad);
    r.range_rate_error_m_s = -wavelength_m * lock->doppler_hz;
    return r;
  }

  double reach_m() const override { return late_arm_m(tracking_.design()); }

 private:
  double threshold_dbhz_;
  CodeTracking tracking_;
};

}  // namespace

std::unique_ptr<MultipathRule> make_correlator(const MultipathParameters& p) {
  return std::make_unique<Correlator>(p);
}

}  // namespace canyon::gnss
