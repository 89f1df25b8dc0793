#include <limits>

#include "canyon/mission/autonomy/self_check/self_check.h"

namespace canyon::mission {
namespace {

/// Whatever the estimate says is believed.
class Believes final : public SelfCheck {
 public:
  void count(const OdometerSample&) override {}
  void see(const LidarScan&, const Pose&, const NavEstimate&) override {}
  Trust trust() const override { return Trust::kGood; }
  double speed_limit_m_s() const override { return std::numeric_limits<double>::infinity(); }
  std::optional<KeptReturns> keeps() const override { return std::nullopt; }
};

std::unique_ptr<SelfCheck> make_believes(const ModelParameters&) {
  return std::make_unique<Believes>();
}

constexpr ModelRow<SelfCheckMaker> kSelfChecks[] = {
    {"none", {make_believes, false}, "the estimate is believed"},
    {"own_motion",
     {make_own_motion, true},
     "held against odometer and scan match: slower in doubt, lost where it lasts",
     own_motion_parameters},
};

}  // namespace

ModelTable<SelfCheckMaker> self_checks() {
  return kSelfChecks;
}

}  // namespace canyon::mission
