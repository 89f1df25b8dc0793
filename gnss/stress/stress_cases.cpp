#include "canyon/gnss/stress/stress_cases.h"

#include <utility>

#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {

std::vector<StressCase> stress_cases() {
  std::vector<StressCase> all;
  for (const auto& subject : {orbit_cases,         light_time_cases,
                              dilution_cases,      solver_cases,
                              filter_cases,        atmosphere_cases,
                              paper_cases,         process_cases,
                              correlator_cases,    lock_cases,
                              wave_cases,          product_cases,
                              time_border_cases,   place_cases,
                              way_cases,           sensor_cases,
                              file_cases,          fitted_orbit_cases,
                              street_cases,        pseudorange_cases,
                              accuracy_cases,      recording_cases,
                              reception_cases,     clutter_cases,
                              need_cases,          nominal_cases,
                              edge_cases,          tracking_cases,
                              considered_cases,    receiver_drive_cases,
                              sent_orbit_cases,    sent_delay_cases,
                              taken_record_cases,  row_cases,
                              skyline_cases,       traced_way_cases,
                              wedge_bound_cases,   carrier_cases,
                              wall_cases,          air_cases,
                              fit_cases,           fault_cases,
                              epoch_cases,         printed_antenna_cases,
                              default_cases,       lock_rule_cases,
                              verdict_cases,       point_sight_cases,
                              nominal_table_cases, precise_product_cases,
                              orbit_error_cases,   fitted_record_cases,
                              signal_cases,        observer_cases,
                              curved_ground_cases, sentence_cases})
    for (StressCase& one : subject()) all.push_back(std::move(one));
  return all;
}

}  // namespace canyon::gnss
