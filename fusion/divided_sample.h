#pragma once

#include "canyon/core/messages.h"

namespace canyon::fusion {

/// Takes the first share (0 to 1) of an IMU sample off it: rate and force count as constant over the sample.
ImuSample take_share(ImuSample& sample, double share);

}  // namespace canyon::fusion
