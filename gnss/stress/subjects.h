#pragma once

#include <vector>

#include "canyon/core/stress_case.h"

/// One subject a file; stress_cases() joins them.
namespace canyon::gnss {

std::vector<StressCase> orbit_cases();
std::vector<StressCase> light_time_cases();
std::vector<StressCase> dilution_cases();
std::vector<StressCase> solver_cases();
std::vector<StressCase> filter_cases();
std::vector<StressCase> atmosphere_cases();
std::vector<StressCase> paper_cases();
std::vector<StressCase> process_cases();
std::vector<StressCase> correlator_cases();
std::vector<StressCase> lock_cases();
std::vector<StressCase> tracking_cases();
std::vector<StressCase> considered_cases();
std::vector<StressCase> receiver_drive_cases();
std::vector<StressCase> sent_orbit_cases();
std::vector<StressCase> sent_delay_cases();
std::vector<StressCase> taken_record_cases();
std::vector<StressCase> row_cases();
std::vector<StressCase> skyline_cases();
std::vector<StressCase> traced_way_cases();
std::vector<StressCase> wedge_bound_cases();
std::vector<StressCase> carrier_cases();
std::vector<StressCase> wall_cases();
std::vector<StressCase> air_cases();
std::vector<StressCase> fit_cases();
std::vector<StressCase> fault_cases();
std::vector<StressCase> epoch_cases();
std::vector<StressCase> printed_antenna_cases();
std::vector<StressCase> default_cases();
std::vector<StressCase> lock_rule_cases();
std::vector<StressCase> verdict_cases();
std::vector<StressCase> point_sight_cases();
std::vector<StressCase> nominal_table_cases();
std::vector<StressCase> precise_product_cases();
std::vector<StressCase> orbit_error_cases();
std::vector<StressCase> fitted_record_cases();
std::vector<StressCase> signal_cases();
std::vector<StressCase> wave_cases();
std::vector<StressCase> product_cases();
std::vector<StressCase> time_border_cases();
std::vector<StressCase> place_cases();
std::vector<StressCase> way_cases();
std::vector<StressCase> sensor_cases();
std::vector<StressCase> pseudorange_cases();
std::vector<StressCase> accuracy_cases();
std::vector<StressCase> recording_cases();
std::vector<StressCase> reception_cases();
std::vector<StressCase> clutter_cases();
std::vector<StressCase> need_cases();
std::vector<StressCase> nominal_cases();
std::vector<StressCase> file_cases();
std::vector<StressCase> fitted_orbit_cases();
std::vector<StressCase> street_cases();
std::vector<StressCase> edge_cases();
std::vector<StressCase> observer_cases();
std::vector<StressCase> curved_ground_cases();
std::vector<StressCase> sentence_cases();

}  // namespace canyon::gnss
