#include <cmath>
#include <vector>

#include "gnss/receiver/code_discriminator.h"
#include "gnss/receiver/multipath_rule.h"

namespace canyon::gnss {
namespace {

/// Coherent early-minus-late tracking of the composite signal, at rest at every epoch (no loop smoothing; the carrier
/// phases of the reflections turn as the antenna moves, so the error changes sign within decimetres). C/N0 is the
/// composite's.
class Correlator final : public MultipathRule {
 public:
  explicit Correlator(const MultipathParameters& p) : p_(p) {}

  Reception receive(std::optional<double> direct_cn0_dbhz,
                    std::span<const ReceivedReflection> reflections) const override {
    if (!direct_cn0_dbhz || *direct_cn0_dbhz < p_.threshold_dbhz)
      return strongest_reflection(reflections, p_.threshold_dbhz);
    std::vector<EchoSignal> echoes;
    for (const auto& r : reflections)
      echoes.push_back({r.excess_m, std::pow(10.0, (r.cn0_dbhz - *direct_cn0_dbhz) / 20.0), r.phase_rad});
    const auto error_m = coherent_early_late_error_m(echoes, p_.spacing_chips);
    const double amplitude = composite_amplitude(echoes);
    if (!error_m || amplitude <= 0.0) return {};
    const double cn0_dbhz = *direct_cn0_dbhz + 20.0 * std::log10(amplitude);
    if (cn0_dbhz < p_.threshold_dbhz) return {};
    return {true, *error_m, cn0_dbhz};
  }

 private:
  MultipathParameters p_;
};

}  // namespace

std::unique_ptr<MultipathRule> make_correlator(const MultipathParameters& p) {
  return std::make_unique<Correlator>(p);
}

}  // namespace canyon::gnss
