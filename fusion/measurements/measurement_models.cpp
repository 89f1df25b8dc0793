#include "canyon/fusion/measurements/measurement.h"

namespace canyon::fusion {
namespace {

constexpr ModelRow<MakeMeasurementModel> kModels[] = {
    {"position", make_position, "where the fix says that the antenna is", position_parameters},
    {"velocity", make_velocity, "the velocity of the antenna, where the fix has one", velocity_parameters},
    {"non_holonomic", make_non_holonomic, "the rear axle moves neither sideways nor up", non_holonomic_parameters},
    {"standstill", make_standstill, "no velocity while IMU and estimate say that the vehicle stands",
     standstill_parameters},
    {"odometer", make_odometer, "the speed of the wheel", odometer_parameters},
    {"heading", make_heading, "the heading that two antennas give", heading_parameters},
    {"barometer", make_barometer, "height by the air's pressure", barometer_parameters},
    {"magnetometer", make_magnetometer, "the Earth's magnetic field", magnetometer_parameters},
    {"relative_pose", make_relative_pose, "motion since the clone, as scans registered to one another give it",
     relative_pose_parameters},
    {"map_pose", make_map_pose, "the pose of a scan in a map that was there before", map_pose_parameters},
    {"ranges", make_ranges, "pseudoranges and their rates, satellite by satellite (tight coupling)", ranges_parameters},
};

}  // namespace

Measurement::Measurement(int dimension, const ErrorState& state, int about_states)
    : residual(Vector::Zero(dimension)),
      R(Square::Zero(dimension, dimension)),
      H(Rows::Zero(dimension, state.padded_size())),
      about(about_states) {}

GpsTime time_of(const AidingMessage& message) {
  return std::visit(
      [](const auto& m) {
        if constexpr (std::is_same_v<std::decay_t<decltype(m)>, RelativePose>)
          return m.source;
        else
          return m.t;
      },
      message);
}

ModelTable<MakeMeasurementModel> measurement_models() {
  return kModels;
}

}  // namespace canyon::fusion
