#pragma once

#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "canyon/core/imu_noise.h"
#include "canyon/core/model_choice.h"
#include "canyon/fusion/calibration.h"
#include "canyon/fusion/strapdown.h"

namespace canyon::fusion {

/// How one error state moves of itself: x' = -x / tau_s + w, w white of the two-sided density `density` (unit^2 / s).
/// An infinite tau is a random walk, without density a constant.
struct StateProcess {
  double tau_s = std::numeric_limits<double>::infinity();
  double density = 0.0;

  /// The process of correlation time tau_s whose stationary variance is `variance`.
  static StateProcess gauss_markov(double variance, double tau_s) { return {tau_s, 2.0 * variance / tau_s}; }
};

/// The IMU's output on `axis` (0..2 gyro, 3..5 accelerometer) is off by `rate` (rad/s or m/s^2) per unit of `state`.
struct Feed {
  int axis = 0;
  int state = 0;  ///< counted from the block's first
  double rate = 0.0;
};

/// Error states that are estimated beside attitude, position and velocity, as truth minus estimate: a group that is
/// chosen as one. One-level interface; the models are in the table below, each in its own file.
class StateBlock {
 public:
  virtual ~StateBlock() = default;
  virtual int size() const = 0;
  /// At the start: the estimate is zero, and its error has this variance, unit^2.
  virtual double variance(int state) const = 0;
  virtual StateProcess process(int /*state*/) const { return {}; }
  /// The state, a random walk or a constant, whose integral over time this one is, beside its own process; -1: none.
  virtual int integral_of(int /*state*/) const { return -1; }
  /// Appends what the states do to the IMU's output while it measures `in`; which axis each state feeds never changes.
  virtual void feed(const Increments& /*in*/, std::vector<Feed>& /*feeds*/) const {}
  /// Adds what the estimates `values` say of the IMU to what is taken out of its increments.
  virtual void calibrate(std::span<const double> /*values*/, Calibration& /*imu*/) const {}
};

/// What the states are told of the IMU.
struct StateSetup {
  ImuNoise noise;
};

/// Makes the block; null if there is nothing to estimate, as where the IMU has no such error. `own`: the parameters of
/// all rows of the table.
using MakeStateBlock = std::unique_ptr<StateBlock>(const ModelParameters& own, const StateSetup& setup);
ModelTable<MakeStateBlock> state_blocks();

/// Makers of the rows of the table in states/state_blocks.cpp, and their parameters, each in the file of its model.
std::unique_ptr<StateBlock> make_biases(const StateSetup& setup);
std::unique_ptr<StateBlock> make_turn_on_biases(const StateSetup& setup);
std::unique_ptr<StateBlock> make_in_run_biases(const StateSetup& setup);
std::unique_ptr<StateBlock> make_gains(const ModelParameters& own, const StateSetup& setup);
void gains_parameters(ModelParameters& section);
std::unique_ptr<StateBlock> make_mounting(const ModelParameters& own, const StateSetup& setup);
void mounting_parameters(ModelParameters& section);
std::unique_ptr<StateBlock> make_antenna_lever(const ModelParameters& own, const StateSetup& setup);
void antenna_lever_parameters(ModelParameters& section);
std::unique_ptr<StateBlock> make_time_offset(const ModelParameters& own, const StateSetup& setup);
void time_offset_parameters(ModelParameters& section);
std::unique_ptr<StateBlock> make_receiver_clock(const ModelParameters& own, const StateSetup& setup);
void receiver_clock_parameters(ModelParameters& section);
std::unique_ptr<StateBlock> make_range_errors(const ModelParameters& own, const StateSetup& setup);
void range_errors_parameters(ModelParameters& section);
std::unique_ptr<StateBlock> make_barometer_bias(const ModelParameters& own, const StateSetup& setup);
void barometer_bias_parameters(ModelParameters& section);
std::unique_ptr<StateBlock> make_hard_iron(const ModelParameters& own, const StateSetup& setup);
void hard_iron_parameters(ModelParameters& section);
std::unique_ptr<StateBlock> make_clone(const StateSetup& setup);
std::unique_ptr<StateBlock> make_wheel_scale(const ModelParameters& own, const StateSetup& setup);
void wheel_scale_parameters(ModelParameters& section);
std::unique_ptr<StateBlock> make_fix_error(const ModelParameters& own, const StateSetup& setup);
void fix_error_parameters(ModelParameters& section);
std::unique_ptr<StateBlock> make_velocity_error(const ModelParameters& own, const StateSetup& setup);
void velocity_error_parameters(ModelParameters& section);

}  // namespace canyon::fusion
