#include "gnss/receiver/multipath_rule.h"

namespace canyon::gnss {
namespace {

/// Only unblocked satellites are tracked, and reflections do not disturb them.
class NoMultipath final : public MultipathRule {
 public:
  explicit NoMultipath(const MultipathParameters& p) : threshold_dbhz_(p.threshold_dbhz) {}
  Reception receive(std::optional<double> direct_cn0_dbhz, std::span<const ReceivedReflection>) const override {
    if (!direct_cn0_dbhz || *direct_cn0_dbhz < threshold_dbhz_) return {};
    return {true, 0.0, *direct_cn0_dbhz};
  }

 private:
  double threshold_dbhz_;
};

std::unique_ptr<MultipathRule> make_none(const MultipathParameters& p) {
  return std::make_unique<NoMultipath>(p);
}

constexpr ModelRow<MakeMultipathRule> kRules[] = {
    {"none", make_none, "reflections are ignored; blocked satellites are not tracked"},
    {"paper_first_return", make_paper_first_return,
     "the paper's: the first reflected range if it comes within the cut-off"},
    {"correlator", make_correlator, "early-minus-late tracking of the composite of direct and reflected signals"},
};

}  // namespace

std::span<const ModelRow<MakeMultipathRule>> multipath_rules() {
  return kRules;
}

Reception strongest_reflection(std::span<const ReceivedReflection> reflections, double threshold_dbhz) {
  Reception best;
  for (const auto& r : reflections)
    if (r.cn0_dbhz >= threshold_dbhz && (!best.tracked || r.cn0_dbhz > best.cn0_dbhz))
      best = {true, r.excess_m, r.cn0_dbhz};
  return best;
}

}  // namespace canyon::gnss
