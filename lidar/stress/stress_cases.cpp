#include "canyon/lidar/stress/stress_cases.h"

#include <utility>

#include "canyon/lidar/stress/search/subjects.h"
#include "canyon/lidar/stress/subjects.h"

namespace canyon::lidar {

std::vector<StressCase> stress_cases() {
  std::vector<StressCase> all;
  for (const auto& subject : {motion_cases,          light_cases,
                              receiver_cases,        packet_cases,
                              cloud_cases,           registration_cases,
                              chain_cases,           map_cases,
                              match_cases,           neighbour_cases,
                              pose_covariance_cases, closure_cases,
                              offset_cases,          capture_cases,
                              volley_cases,          map_figure_cases,
                              aligner_cases,         placement_cases,
                              seen_through_cases,    shaken_beam_cases,
                              texture_cases,         driven_meanwhile_cases,
                              kept_room_cases,       scan_drive_cases,
                              search_start_cases,    tree_border_cases,
                              old_shell_cases,       unsaid_setting_cases})
    for (StressCase& one : subject()) all.push_back(std::move(one));
  return all;
}

}  // namespace canyon::lidar
