#include "canyon/gnss/receiver/multipath_rule.h"

#include "canyon/core/units.h"
#include "canyon/gnss/signal.h"

namespace canyon::gnss {
namespace {

/// Only unblocked satellites are tracked, and reflections do not disturb them.
class NoMultipath final : public MultipathRule {
 public:
  explicit NoMultipath(const MultipathParameters& p)
      : threshold_dbhz_(p.threshold_dbhz), reach_m_(late_arm_m(p.design)) {}
  Reception receive(const std::optional<ReceivedSignal>& direct, std::span<const ReceivedSignal>,
                    double) const override {
    if (!direct || direct->cn0_dbhz < threshold_dbhz_) return {};
    Reception r;
    r.tracked = true;
    r.cn0_dbhz = direct->cn0_dbhz;
    return r;
  }

  double reach_m() const override { return reach_m_; }

 private:
  double threshold_dbhz_, reach_m_;
};

std::unique_ptr<MultipathRule> make_no_rule(const MultipathParameters& p) {
  return std::make_unique<NoMultipath>(p);
}

constexpr ModelRow<MakeMultipathRule> kRules[] = {
    {"none", without_keys<make_no_rule>, "reflections are ignored; blocked satellites are not tracked"},
    {"paper_first_return", without_keys<make_paper_first_return>,
     "the paper's: the first reflected range if it comes within the cut-off"},
    {"correlator", without_keys<make_correlator>,
     "early-minus-late tracking of the composite of direct and reflected signals"},
};

}  // namespace

double late_arm_m(const CorrelatorDesign& design) {
  return (1.0 + 0.5 * design.spacing_chips) * kCaChipM;
}

double ReceptionConfig::cutoff_m() const {
  return cutoff_ns * 1e-9 * kSpeedOfLight;
}

void visit(FieldVisitor& f, ReceptionConfig& c) {
  visit_choice(f, "multipath_rule", c.multipath_rule, "range error from direct and reflected signals");
  f.number("cutoff_ns", c.cutoff_ns, {0.0, 10000.0}, "reflections later than this do not disturb a direct signal");
}

ModelTable<MakeMultipathRule> multipath_rules() {
  return kRules;
}

Reception strongest_reflection(std::span<const ReceivedSignal> echoes, double threshold_dbhz, double wavelength_m) {
  Reception best;
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    const ReceivedSignal& e = echoes[i];
    if (e.cn0_dbhz >= threshold_dbhz && (!best.tracked || e.cn0_dbhz > best.cn0_dbhz))
      best = {true, e.excess_m, e.cn0_dbhz, e.excess_m, -wavelength_m * e.doppler_hz, static_cast<int>(i)};
  }
  return best;
}

}  // namespace canyon::gnss
