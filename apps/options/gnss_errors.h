#pragma once

#include <string>
#include <vector>

#include "canyon/core/result.h"
#include "canyon/gnss/sensor/sensor.h"

namespace canyon::apps {

/// Names that --errors takes beside "all" and "none".
std::vector<std::string> gnss_error_names();

/// Leaves on only the errors of a comma-separated list: "none", "all", or names out of gnss_error_names(). Satellite
/// clock, group delay, relativity and the Earth's rotation under way are no errors and stay.
Status keep_errors(const std::string& list, gnss::GnssConfig& config);

}  // namespace canyon::apps
