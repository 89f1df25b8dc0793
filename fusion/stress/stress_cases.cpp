#include "canyon/fusion/stress/stress_cases.h"

#include "canyon/fusion/stress/subjects.h"

namespace canyon::fusion {

std::vector<StressCase> stress_cases() {
  std::vector<StressCase> all;
  for (auto* const subject :
       {acceptance_cases, consistency_cases, covariance_cases, dead_reckoning_cases, estimator_cases, fix_cases,
        graph_cases, measurement_cases, record_cases, reference_track_cases, sample_cases, smoother_cases,
        timeline_cases, unaided_cases, vehicle_filter_cases, verdict_cases})
    for (StressCase& one : subject()) all.push_back(std::move(one));
  return all;
}

}  // namespace canyon::fusion
