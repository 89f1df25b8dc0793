#pragma once

#include <memory>

namespace ceres {
class IterationCallback;
}

namespace canyon::inertial {

/// Ends a solution at its next iteration once the user has asked to stop; call throw_if_cancelled() after it.
std::unique_ptr<ceres::IterationCallback> make_cancel_callback();

}  // namespace canyon::inertial
