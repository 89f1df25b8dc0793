#pragma once

#include <string>
#include <vector>

#include "canyon/core/model_choice.h"

namespace canyon::fusion {

/// [fusion] of a mission file. What is chosen by name stands in tables: filter_sets(), strapdown_models(),
/// state_blocks(), measurement_models(), acceptance_models().
struct FilterConfig {
  FilterConfig();

  std::string imu;  ///< catalogue entry whose datasheet it is told; empty: that of [imu] sensor
  double initial_attitude_sigma_deg_roll_pitch = 0.1;
  double initial_attitude_sigma_deg_heading = 1.0;
  double initial_position_sigma_m = 0.5;
  double initial_velocity_sigma_m_s = 0.05;
  std::string integrator = "two_sample";
  std::string filter = "naive";           ///< the set of rows that stands where one of the next three names none
  std::vector<std::string> states;        ///< empty: those of the set
  std::vector<std::string> measurements;  ///< empty: those of the set
  std::string acceptance = "as_filter";   ///< of the fixes' positions and velocities
  ModelParameters own;                    ///< of all rows of the tables
};
void visit(FieldVisitor& f, FilterConfig& c);

/// The rows that a filter is made of, by their names.
struct FilterParts {
  std::vector<std::string> states, measurements;
  std::string acceptance;
};
ModelTable<FilterParts (*)()> filter_sets();
/// The set that is chosen, with what is named beside it.
FilterParts filter_parts(const FilterConfig& config);
/// Whether every measurement is taken as it is, so that estimates are linear in what is measured.
bool takes_all(const FilterConfig& config);

}  // namespace canyon::fusion
