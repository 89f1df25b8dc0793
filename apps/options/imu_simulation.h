#pragma once

#include <string>
#include <vector>

#include "canyon/apps/line/arguments.h"
#include "canyon/inertial/imu_model.h"
#include "canyon/inertial/motion/motion.h"

namespace canyon::apps {

/// Options that say which sensor moves how, for the verb that simulates an IMU by itself.
struct ImuSimulationOptions {
  std::string sensor, errors, at, path, points, trajectory, start;
  std::vector<std::string> settings;
  double rate_hz = 0.0;  ///< 0: the usual one
};
void declare_imu_simulation(Arguments& arguments, ImuSimulationOptions& options);
/// An Error if no option says how it moves.
Status check_motion_given(const ImuSimulationOptions& options);

/// The keys of a motion, and those of the sensor under `imu`.
struct LogConfig {
  inertial::MotionConfig motion;
  inertial::ImuConfig imu;

  LogConfig() {
    imu.rate_hz = 200.0;
    imu.lever_arm_m.setZero();
  }
};
void visit(FieldVisitor& f, LogConfig& c);

/// A TOML file (--path), then the other options, then each --set KEY=VALUE.
Result<LogConfig> log_config(const ImuSimulationOptions& options);

}  // namespace canyon::apps
