#include "canyon/core/stress/stress_cases.h"

#include "canyon/core/stress/subjects.h"

namespace canyon {

std::vector<StressCase> stress_cases() {
  std::vector<StressCase> all;
  for (auto* const subject : {chi_square_cases, configuration_cases, date_cases, draw_cases, earth_cases, geoid_cases,
                              motion_cases, number_cases, path_file_cases, random_cases, rotation_cases,
                              state_table_cases, summary_cases, time_cases, true_motion_cases})
    for (StressCase& one : subject()) all.push_back(std::move(one));
  return all;
}

}  // namespace canyon
