#pragma once

#include <vector>

#include "canyon/core/need.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/mission/omissions.h"
#include "canyon/study/plan/outputs.h"

namespace canyon::study {

/// The names of what a whole run makes or does not.
inline constexpr const char* kRegistration = "registration of keyframes";
inline constexpr const char* kMaps = "maps, kept and scored";
inline constexpr const char* kKeyframes = "keyframes";
inline constexpr const char* kScans = "LIDAR scans";
inline constexpr const char* kUnkeptRays = "LIDAR rays that nobody keeps";
inline constexpr const char* kAutonomy = "autonomy";
inline constexpr const char* kMovedScene = "moving things, placed anew";

/// Who reads what a run makes, followed along its data (docs/design.md, "One step of a mission"): what nobody reads is
/// not needed, and leaving it out changes nothing that is asked for (bound 0). Only what the configuration would make
/// is spoken of. `open_loop`: of runs on a tape, which go on whatever the autonomy asks for.
std::vector<Need> reader_needs(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                               const std::vector<Output>& outputs, bool open_loop = false);

/// Adds to `omissions` what these needs allow to leave out.
void leave_out_unread(const std::vector<Need>& needs, mission::Omissions& omissions);

}  // namespace canyon::study
