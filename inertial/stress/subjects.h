#pragma once

#include <vector>

#include "canyon/core/stress_case.h"

/// The cases of this room, a file for each subject.
namespace canyon::inertial {

std::vector<StressCase> aiding_cases();
std::vector<StressCase> allan_cases();
std::vector<StressCase> average_cases();
std::vector<StressCase> calibration_cases();
std::vector<StressCase> deviation_cases();
std::vector<StressCase> sensing_element_cases();
std::vector<StressCase> unit_mass_cases();
std::vector<StressCase> told_of_chain_cases();
std::vector<StressCase> paper_place_cases();
std::vector<StressCase> error_chain_cases();
std::vector<StressCase> gauss_markov_cases();
std::vector<StressCase> given_figure_cases();
std::vector<StressCase> imu_log_cases();
std::vector<StressCase> increment_cases();
std::vector<StressCase> input_link_cases();
std::vector<StressCase> noise_link_cases();
std::vector<StressCase> stamp_and_loss_cases();
std::vector<StressCase> link_of_figure_cases();
std::vector<StressCase> motion_cases();
std::vector<StressCase> paper_recursion_cases();
std::vector<StressCase> path_cases();
std::vector<StressCase> proof_mass_cases();
std::vector<StressCase> spline_cases();
std::vector<StressCase> unit_log_cases();
std::vector<StressCase> simulated_log_cases();
std::vector<StressCase> noise_parameter_cases();
std::vector<StressCase> unsaid_setting_cases();

}  // namespace canyon::inertial
