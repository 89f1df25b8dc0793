#include "gnss/receiver/multipath_rule.h"

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

  Reception receive(std::optional<double> direct_cn0_dbhz,
                    std::span<const ReceivedReflection> reflections) const override {
    if (!direct_cn0_dbhz || *direct_cn0_dbhz < p_.threshold_dbhz)
      return strongest_reflection(reflections, p_.threshold_dbhz);
    for (const auto& r : reflections) {
      if (r.cn0_dbhz < p_.threshold_dbhz) continue;
      if (r.excess_m >= p_.cutoff_m) break;
      return {true, r.excess_m, *direct_cn0_dbhz};
    }
    return {true, 0.0, *direct_cn0_dbhz};
  }

 private:
  MultipathParameters p_;
};

}  // namespace

std::unique_ptr<MultipathRule> make_paper_first_return(const MultipathParameters& p) {
  return std::make_unique<PaperFirstReturn>(p);
}

}  // namespace canyon::gnss
