#include "canyon/gnss/receiver/multipath_rule.h"

namespace canyon::gnss {
namespace {

/// Durst & Goodin (2012, section 2.1): "The first return multipath range for an SV is used when the time difference
/// between the first and second returns is less than the cut-off time for the modeled receiver (typically 150ns or
/// 45-meter path difference)."
///
/// Read as: the returns of a satellite are ordered by arrival. The first is the direct one, the second the shortest
/// reflected one. If they are closer than the cut-off the receiver cannot tell them apart, and the range used is the
/// first multipath range, that is the reflected one, whole; else the direct range stands. A reflection counts as a
/// return only if it could be tracked by itself (material reflectance is in its C/N0). The result is an error of up to
/// 45 m with no regard to how weak the reflection is, which is far more than a correlator gives.
class PaperFirstReturn final : public MultipathRule {
 public:
  explicit PaperFirstReturn(const MultipathParameters& p) : p_(p) {}

  Reception receive(const std::optional<ReceivedSignal>& direct, std::span<const ReceivedSignal> echoes,
                    double wavelength_m) const override {
    if (!direct || direct->cn0_dbhz < p_.threshold_dbhz)
      return strongest_reflection(echoes, p_.threshold_dbhz, wavelength_m);
    for (std::size_t i = 0; i < echoes.size(); ++i) {
      const ReceivedSignal& e = echoes[i];
      if (e.cn0_dbhz < p_.threshold_dbhz) continue;
      if (e.excess_m >= p_.cutoff_m) break;
      return {true, e.excess_m, direct->cn0_dbhz, e.excess_m, -wavelength_m * e.doppler_hz, static_cast<int>(i)};
    }
    return {true, 0.0, direct->cn0_dbhz, 0.0, 0.0, -1};
  }

  double reach_m() const override { return p_.cutoff_m; }

 private:
  MultipathParameters p_;
};

}  // namespace

std::unique_ptr<MultipathRule> make_paper_first_return(const MultipathParameters& p) {
  return std::make_unique<PaperFirstReturn>(p);
}

}  // namespace canyon::gnss
