#pragma once

#include <memory>

#include "canyon/core/model_choice.h"

namespace canyon::mission {

/// What stands between what is asked of the steering or of the drive, and what they do. One-level interface; models are
/// in two tables, each in its own file with its own parameters. A value is asked for over a whole step, and what is
/// there at the step's end is told exactly, whatever the step.
class Actuator {
 public:
  virtual ~Actuator() = default;
  /// After dt_s > 0 in which `wanted` was asked for, from `now` on.
  virtual double after(double now, double wanted, double dt_s) const = 0;
  /// Time constant of its answer, s; 0: it answers at once.
  virtual double lag_s() const { return 0.0; }
};

using MakeActuator = std::unique_ptr<Actuator>(const ModelParameters& own, double most_per_s);

/// [vehicle] steering: from the steering angle that is asked for, rad, to that of the wheels. `most_per_s` is [vehicle]
/// max_steering_rate_deg_s, in rad/s.
ModelTable<MakeActuator> steering_actuators();
/// [vehicle] drive: from the acceleration that is asked for, m/s^2, to that of the vehicle. `most_per_s` is infinite.
ModelTable<MakeActuator> drive_actuators();

/// y' = (wanted - y) / lag, but never faster than `most_per_s`: at that rate until what is missing is less than the
/// rate times the lag, then by the exponential. Exact for any dt_s. lag_s >= 0 (0: the rate alone), most_per_s > 0.
double first_order_after(double now, double wanted, double dt_s, double lag_s, double most_per_s);

/// Makers of the rows of the tables in actuators.cpp, and their parameters, each in the file of its model.
std::unique_ptr<Actuator> make_rate_limit(const ModelParameters& own, double most_per_s);
std::unique_ptr<Actuator> make_direct_drive(const ModelParameters& own, double most_per_s);
std::unique_ptr<Actuator> make_lagged_steering(const ModelParameters& own, double most_per_s);
std::unique_ptr<Actuator> make_lagged_drive(const ModelParameters& own, double most_per_s);
void lagged_steering_parameters(ModelParameters& section);
void lagged_drive_parameters(ModelParameters& section);

}  // namespace canyon::mission
