#include "canyon/fusion/states/state_block.h"

namespace canyon::fusion {
namespace {

struct WheelScaleParameters {
  double wheel_scale_sigma_percent = 1.0;
};
void visit(FieldVisitor& f, WheelScaleParameters& p) {
  f.number("wheel_scale_sigma_percent", p.wheel_scale_sigma_percent, {1e-6, 100},
           "1-sigma of the wheel's radius against the nominal one, where it is estimated");
}

/// Relative error of what the wheel shows, a constant.
class WheelScale final : public StateBlock {
 public:
  explicit WheelScale(const WheelScaleParameters& p) : sigma_(0.01 * p.wheel_scale_sigma_percent) {}
  int size() const override { return 1; }
  double variance(int) const override { return sigma_ * sigma_; }

 private:
  double sigma_;
};

}  // namespace

std::unique_ptr<StateBlock> make_wheel_scale(const ModelParameters& own, const StateSetup&) {
  return std::make_unique<WheelScale>(own.get<WheelScaleParameters>());
}

void wheel_scale_parameters(ModelParameters& section) {
  section.add<WheelScaleParameters>();
}

}  // namespace canyon::fusion
