#pragma once

#include <vector>

#include "canyon/core/stress_case.h"

/// One subject a file; stress_cases() joins them.
namespace canyon::lidar {

std::vector<StressCase> motion_cases();
std::vector<StressCase> light_cases();
std::vector<StressCase> receiver_cases();
std::vector<StressCase> packet_cases();
std::vector<StressCase> cloud_cases();
std::vector<StressCase> registration_cases();
std::vector<StressCase> chain_cases();
std::vector<StressCase> map_cases();
std::vector<StressCase> match_cases();
std::vector<StressCase> neighbour_cases();
std::vector<StressCase> pose_covariance_cases();
std::vector<StressCase> closure_cases();
std::vector<StressCase> offset_cases();
std::vector<StressCase> capture_cases();
std::vector<StressCase> volley_cases();
std::vector<StressCase> map_figure_cases();
std::vector<StressCase> aligner_cases();
std::vector<StressCase> placement_cases();
std::vector<StressCase> seen_through_cases();
std::vector<StressCase> shaken_beam_cases();
std::vector<StressCase> driven_meanwhile_cases();
std::vector<StressCase> kept_room_cases();
std::vector<StressCase> scan_drive_cases();
std::vector<StressCase> texture_cases();
std::vector<StressCase> unsaid_setting_cases();

}  // namespace canyon::lidar
