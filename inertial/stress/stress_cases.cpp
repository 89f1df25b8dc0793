#include "canyon/inertial/stress/stress_cases.h"

#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {

std::vector<StressCase> stress_cases() {
  std::vector<StressCase> all;
  for (auto* const subject : {aiding_cases,         allan_cases,           average_cases,       calibration_cases,
                              deviation_cases,      sensing_element_cases, unit_mass_cases,     told_of_chain_cases,
                              paper_place_cases,    error_chain_cases,     gauss_markov_cases,  given_figure_cases,
                              imu_log_cases,        increment_cases,       input_link_cases,    noise_link_cases,
                              stamp_and_loss_cases, link_of_figure_cases,  motion_cases,        paper_recursion_cases,
                              path_cases,           proof_mass_cases,      spline_cases,        unit_log_cases,
                              simulated_log_cases,  noise_parameter_cases, unsaid_setting_cases})
    for (StressCase& one : subject()) all.push_back(std::move(one));
  return all;
}

}  // namespace canyon::inertial
