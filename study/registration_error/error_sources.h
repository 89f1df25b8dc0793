#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "canyon/mission/config/mission_config.h"

namespace canyon::study {

/// What is meant by a world without multipath where a satellite is hidden: two answers that can give opposite verdicts.
enum class HiddenRemoval {
  kHealed,  ///< its signal is measured as it was, without what the echoes make of it
  kDropped  ///< it is not measured, nor would it be by a perfect receiver
};

/// A group of errors that a replayed run can be made without. Everything else is drawn as before: to the bit where it
/// depends on draws alone.
struct ErrorSource {
  const char* name;
  const char* doc;
  const char* without;  ///< keys of the mission that take it away, as TOML
};
const std::vector<ErrorSource>& error_sources();

/// The configuration without the sources whose bit is set, by their place in error_sources().
mission::MissionConfig without_sources(const mission::MissionConfig& config, std::uint32_t removed,
                                       HiddenRemoval hidden);

/// What tells two configurations apart: every key of every section.
std::string configuration_text(const mission::MissionConfig& config);
/// The same of what a fix depends on, beside the true motion.
std::string gnss_text(const mission::MissionConfig& config);

}  // namespace canyon::study
