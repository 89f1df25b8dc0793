#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "canyon/core/model_choice.h"
#include "canyon/core/result.h"

namespace canyon::fusion {

/// [fusion] of a mission file. What is chosen by name stands in tables: filter_sets(), strapdown_models(),
/// state_blocks(), measurement_models(), acceptance_models(), estimators().
struct FilterConfig {
  FilterConfig();

  std::string imu;  ///< catalogue entry whose datasheet it is told; empty: that of [imu] sensor
  double initial_attitude_sigma_deg_roll_pitch = 0.1;
  double initial_attitude_sigma_deg_heading = 1.0;
  double initial_position_sigma_m = 0.5;
  double initial_velocity_sigma_m_s = 0.05;
  std::string integrator = "two_sample";
  std::string estimator = "joseph";
  std::string filter = "naive";           ///< the set of rows that stands where one of the next three names none
  std::vector<std::string> states;        ///< empty: those of the set
  std::vector<std::string> measurements;  ///< empty: those of the set
  std::string acceptance = "as_filter";   ///< of each measurement by itself
  bool map_aiding = false;                ///< "clone" and "relative_pose" beside the rest
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
bool measures_with(const FilterConfig& config, std::string_view measurement);
/// A row that another one needs beside it must be there, and nothing may be estimated twice.
Status check_parts(const FilterParts& parts);
/// Whether every measurement is taken as it is, so that estimates are linear in what is measured.
bool takes_all(const FilterConfig& config);

}  // namespace canyon::fusion
