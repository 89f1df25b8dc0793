#include "canyon/mission/motion/actuators/actuator.h"

namespace canyon::mission {
namespace {

constexpr ModelRow<MakeActuator> kSteering[] = {
    {"rate_limit", make_rate_limit, "as asked for, within its rate"},
    {"first_order", make_lagged_steering, "it lags, within its rate", lagged_steering_parameters},
};

constexpr ModelRow<MakeActuator> kDrive[] = {
    {"direct", make_direct_drive, "as asked for"},
    {"first_order", make_lagged_drive, "it lags, and so do the brakes", lagged_drive_parameters},
};

}  // namespace

ModelTable<MakeActuator> steering_actuators() {
  return kSteering;
}

ModelTable<MakeActuator> drive_actuators() {
  return kDrive;
}

}  // namespace canyon::mission
