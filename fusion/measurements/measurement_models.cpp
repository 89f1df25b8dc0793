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
};

}  // namespace

Measurement::Measurement(int dimension, const ErrorState& state)
    : residual(Vector::Zero(dimension)),
      R(Square::Zero(dimension, dimension)),
      H(Rows::Zero(dimension, state.padded_size())) {}

ModelTable<MakeMeasurementModel> measurement_models() {
  return kModels;
}

}  // namespace canyon::fusion
