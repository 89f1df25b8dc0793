#pragma once

#include <vector>

#include "canyon/core/stress_case.h"

/// The cases of this room, a file for each subject.
namespace canyon::fusion {

std::vector<StressCase> acceptance_cases();
std::vector<StressCase> consistency_cases();
std::vector<StressCase> covariance_cases();
std::vector<StressCase> dead_reckoning_cases();
std::vector<StressCase> estimator_cases();
std::vector<StressCase> fix_cases();
std::vector<StressCase> graph_cases();
std::vector<StressCase> measurement_cases();
std::vector<StressCase> record_cases();
std::vector<StressCase> reference_track_cases();
std::vector<StressCase> sample_cases();
std::vector<StressCase> smoother_cases();
std::vector<StressCase> timeline_cases();
std::vector<StressCase> unaided_cases();
std::vector<StressCase> vehicle_filter_cases();
std::vector<StressCase> verdict_cases();

}  // namespace canyon::fusion
