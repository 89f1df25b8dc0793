#include "canyon/inertial/ceres_cancel_callback.h"

#include <ceres/iteration_callback.h>

#include "canyon/core/process/progress.h"

namespace canyon::inertial {
namespace {

class CancelCallback final : public ceres::IterationCallback {
 public:
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    return cancel_requested() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }
};

}  // namespace

std::unique_ptr<ceres::IterationCallback> make_cancel_callback() {
  return std::make_unique<CancelCallback>();
}

}  // namespace canyon::inertial
