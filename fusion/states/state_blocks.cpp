#include "canyon/fusion/states/state_block.h"

namespace canyon::fusion {
namespace {

constexpr ModelRow<MakeStateBlock> kBlocks[] = {
    {"biases", without_keys<make_biases>, "of gyroscopes and accelerometers, turn-on and in-run in one state per axis"},
    {"turn_on_biases", without_keys<make_turn_on_biases>, "the constant part of the biases in states of its own"},
    {"in_run_biases", without_keys<make_in_run_biases>, "the wandering part of the biases in states of its own"},
    {"gains", make_gains, "scale factors and misalignments of both triads, if the IMU is said to have any",
     gains_parameters},
    {"mounting", make_mounting, "angles between the axes of the IMU and of the vehicle", mounting_parameters},
    {"antenna_lever", make_antenna_lever, "error of the antenna's place in the vehicle", antenna_lever_parameters},
    {"time_offset", make_time_offset, "by how much fixes are stamped too early", time_offset_parameters},
    {"wheel_scale", make_wheel_scale, "scale of the wheel", wheel_scale_parameters},
    {"fix_error", make_fix_error, "the part of the fixes' errors that lasts from one to the next",
     fix_error_parameters},
    {"velocity_error", make_velocity_error, "the part of the errors of the fixes' velocities that lasts",
     velocity_error_parameters},
    {"receiver_clock", make_receiver_clock,
     "clock of the receiver and its rate, and each system's own time against GPS", receiver_clock_parameters},
    {"range_errors", make_range_errors, "the part of the pseudoranges' errors that lasts, satellite by satellite",
     range_errors_parameters},
    {"barometer_bias", make_barometer_bias, "height of the air's pressure against the standard atmosphere",
     barometer_bias_parameters},
    {"hard_iron", make_hard_iron, "magnetic field of the vehicle", hard_iron_parameters},
    {"clone", without_keys<make_clone>, "the pose at an earlier instant, that a relative pose is counted from"},
};

}  // namespace

ModelTable<MakeStateBlock> state_blocks() {
  return kBlocks;
}

}  // namespace canyon::fusion
