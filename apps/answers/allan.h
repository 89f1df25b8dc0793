#pragma once

#include <string>

#include "canyon/core/output/json.h"
#include "canyon/inertial/allan/log_analysis.h"

/// What `imu allan` says of a log: as JSON, as text, as a drawing. `path`: of the log.
namespace canyon::apps {

Json allan_json(const inertial::LogAnalysis& analysis);
void print_allan(const inertial::LogAnalysis& analysis, const std::string& path);
std::string allan_svg(const inertial::LogAnalysis& analysis, const std::string& path);

}  // namespace canyon::apps
