#pragma once

#include <string>

#include "canyon/apps/line/arguments.h"
#include "canyon/inertial/allan/log_noise.h"
#include "canyon/inertial/allan/motion_check.h"
#include "canyon/inertial/imu_log.h"

namespace canyon::apps {

/// Which log, and how it is to be read: what the verbs on recorded inertial data share.
struct ImuLogOptions {
  std::string log, columns;
  double rate_hz = 0.0;
};
void declare_imu_log(Arguments& arguments, ImuLogOptions& options);

/// Reads the log; `live` as in ImuLogFormat.
Result<inertial::ImuLog> read_log(const ImuLogOptions& options, bool live);

/// Warns on stderr of units that look mistaken.
void tell_doubts(const inertial::ImuLog& log);

/// Warns on stderr where a log that ought to rest moves.
void tell_motion(const std::string& path, const inertial::MotionFound& motion);

}  // namespace canyon::apps
