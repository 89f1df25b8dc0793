#pragma once

#include <string>

#include "apps/arguments.h"
#include "inertial/allan/log_noise.h"
#include "inertial/imu_log.h"

namespace canyon::apps {

/// Which log, and how it is to be read: what the verbs on recorded inertial data share.
struct ImuLogOptions {
  std::string log, columns;
  double rate_hz = 0.0;
};
void declare_imu_log(Arguments& arguments, ImuLogOptions& options);

/// Reads the log; `live` as in ImuLogFormat.
Result<inertial::ImuLog> read_log(const ImuLogOptions& options, bool live);

/// "rad/s" or "m/s^2": of channel 0..5.
const char* channel_unit(int channel);

}  // namespace canyon::apps
