#include "canyon/fusion/states/state_block.h"

namespace canyon::fusion {
namespace {

/// Attitude and position of the IMU at an earlier instant, whose errors are those that the estimate had then and are
/// correlated with today's (stochastic cloning, Roumeliotis & Burdick 2002, IEEE Int. Conf. Robotics and Automation,
/// 1788-1795): right perturbation, rad, and E, m, as of the present pose. Until it is taken it is known for certain.
class Clone final : public StateBlock {
 public:
  int size() const override { return 6; }
  double variance(int) const override { return 0.0; }
};

}  // namespace

std::unique_ptr<StateBlock> make_clone(const StateSetup&) {
  return std::make_unique<Clone>();
}

}  // namespace canyon::fusion
