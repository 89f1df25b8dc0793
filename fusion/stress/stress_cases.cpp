#include "canyon/fusion/stress/stress_cases.h"

#include "canyon/fusion/stress/integrators/subjects.h"
#include "canyon/fusion/stress/measurement_models/subjects.h"
#include "canyon/fusion/stress/parts/subjects.h"
#include "canyon/fusion/stress/subjects.h"

namespace canyon::fusion {

std::vector<StressCase> stress_cases() {
  std::vector<StressCase> all;
  for (auto* const subject : {acceptance_cases,
                              arrival_cases,
                              consistency_cases,
                              covariance_cases,
                              dead_reckoning_cases,
                              estimator_cases,
                              fix_cases,
                              graph_cases,
                              integrator_step_cases,
                              integrator_path_cases,
                              omission_cases,
                              integrator_log_cases,
                              rounding_growth_cases,
                              measurement_cases,
                              vehicle_motion_cases,
                              single_reading_cases,
                              measured_fix_cases,
                              range_cases,
                              lever_arm_cases,
                              record_cases,
                              reference_track_cases,
                              run_graph_cases,
                              run_message_cases,
                              body_estimate_cases,
                              sample_cases,
                              smoother_cases,
                              start_cases,
                              state_block_cases,
                              lasting_error_cases,
                              satellite_place_cases,
                              process_cases,
                              error_step_cases,
                              given_setting_cases,
                              timeline_cases,
                              trust_cases,
                              unaided_cases,
                              vehicle_filter_cases,
                              verdict_cases,
                              known_start_cases,
                              renewed_state_cases})
    for (StressCase& one : subject()) all.push_back(std::move(one));
  return all;
}

}  // namespace canyon::fusion
