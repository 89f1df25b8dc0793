// Settings that stand where nobody gives any, and sets of rows that fit together.
#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/fusion/filter_config.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/stress/parts/subjects.h"
#include "canyon/fusion/timeline/filter_timeline.h"

namespace canyon::fusion {
namespace {

using stress::kInfinity;

/// What stands where nobody says otherwise: the start of a filter, what arrives at it, and the rows of its sets.
StressFigure given_settings() {
  int wrong = 0;
  const auto is = [&](double found, double expected) { wrong += found == expected ? 0 : 1; };
  const FilterConfig c;
  is(c.initial_attitude_sigma_deg_roll_pitch, 0.1), is(c.initial_attitude_sigma_deg_heading, 1.0);
  is(c.initial_position_sigma_m, 0.5), is(c.initial_velocity_sigma_m_s, 0.05);
  const TimelineConfig t;
  is(t.wait_s, 1.0), is(t.held_s, 0.1), is(t.gap_rate_deg_s, 20.0), is(t.gap_force_m_s2, 2.0),
      is(t.frozen_speed_m_s, 0.5), is(t.same_instant_s, 1e-6);
  const TimelineConfig recorded = TimelineConfig::as_recorded();
  is(recorded.wait_s, 0.0), is(recorded.gap_rate_deg_s, 0.0), is(recorded.gap_force_m_s2, 0.0),
      is(recorded.same_instant_s, 0.0);
  is(recorded.frozen_speed_m_s, kInfinity), is(recorded.held_s, 0.1);
  wrong += takes_all(c) && takes_all(configured("acceptance = \"accept_all\"")) &&
                   !takes_all(configured("gate_sigma = 3")) && !takes_all(configured("acceptance = \"huber\"")) &&
                   !takes_all(configured("filter = \"vehicle\""))
               ? 0
               : 1;
  wrong += measures_with(c, "position") && !measures_with(c, "odometer") &&
                   measures_with(configured("filter = \"tight\""), "ranges") &&
                   measures_with(configured("map_aiding = true"), "relative_pose")
               ? 0
               : 1;
  wrong += check_parts(filter_parts(c)).ok() && check_parts(filter_parts(configured("filter = \"tight\""))).ok() &&
                   check_parts(filter_parts(configured("map_aiding = true"))).ok()
               ? 0
               : 1;
  for (const char* keys : {"states = [\"biases\", \"in_run_biases\"]", "states = [\"biases\", \"turn_on_biases\"]",
                           "measurements = [\"ranges\"]", "measurements = [\"relative_pose\"]"})
    wrong += check_parts(filter_parts(configured(keys))).ok() ? 1 : 0;
  wrong += filter_parts(configured("map_aiding = true\nstates = [\"clone\"]")).states.size() == 1 ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> given_setting_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "settings that nobody gives", "a setting of another unit",
           "as the documentation has them: exact", "wrong"});
  rows.add("states/given_settings", given_settings);
  return rows.take();
}

}  // namespace canyon::fusion
