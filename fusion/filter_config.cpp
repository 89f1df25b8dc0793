#include "canyon/fusion/filter_config.h"

#include <algorithm>

#include "canyon/core/config/config.h"
#include "canyon/fusion/acceptance/acceptance.h"
#include "canyon/fusion/estimators/estimator.h"
#include "canyon/fusion/measurements/measurement.h"
#include "canyon/fusion/states/state_block.h"
#include "canyon/fusion/strapdown.h"

namespace canyon::fusion {
namespace {

constexpr const char* kAsFilter = "as_filter";

FilterParts naive() {
  return {.states = {"biases", "gains"}, .measurements = {"position"}, .acceptance = "gate"};
}

FilterParts vehicle() {
  return {.states = {"biases", "gains", "mounting", "wheel_scale", "fix_error", "velocity_error"},
          .measurements = {"position", "velocity", "non_holonomic", "standstill", "odometer"},
          .acceptance = "student_t"};
}

FilterParts tight() {
  return {.states = {"biases", "gains", "mounting", "wheel_scale", "receiver_clock", "range_errors"},
          .measurements = {"ranges", "non_holonomic", "standstill", "odometer"},
          .acceptance = "student_t"};
}

constexpr ModelRow<FilterParts (*)()> kSets[] = {
    {"naive", naive, "takes each fix as independent of the last one and as good as it says"},
    {"vehicle", vehicle, "knows that wheels roll, that fixes err for seconds, and what their Doppler shifts say"},
    {"tight", tight, "as vehicle, of each satellite's pseudorange and its rate in place of fixes"},
};

void add_missing(std::vector<std::string>& names, const char* name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.emplace_back(name);
}

template <class Make>
void add_parameters(ModelTable<Make> rows, ModelParameters& own) {
  for (const auto& row : rows)
    if (row.parameters != nullptr) row.parameters(own);
}

}  // namespace

ModelTable<FilterParts (*)()> filter_sets() {
  return kSets;
}

FilterConfig::FilterConfig() {
  add_parameters(state_blocks(), own);
  add_parameters(measurement_models(), own);
  add_parameters(acceptance_models(), own);
}

void visit(FieldVisitor& f, FilterConfig& c) {
  f.file("imu", c.imu, ".toml", "sensor whose datasheet the filter is told; empty: the one of [imu] sensor");
  f.number("initial_attitude_sigma_deg_roll_pitch", c.initial_attitude_sigma_deg_roll_pitch, {1e-6, 180},
           "1-sigma of roll and pitch at the start");
  f.number("initial_attitude_sigma_deg_heading", c.initial_attitude_sigma_deg_heading, {1e-6, 180},
           "1-sigma of heading at the start");
  f.number("initial_position_sigma_m", c.initial_position_sigma_m, {1e-6, 1e6},
           "1-sigma of position per axis at the start");
  f.number("initial_velocity_sigma_m_s", c.initial_velocity_sigma_m_s, {1e-6, 1e3},
           "1-sigma of velocity per axis at the start");
  f.choice("integrator", c.integrator, strapdown_names(), "strapdown integrator");
  f.choice("estimator", c.estimator, model_names(estimators()), "how the covariance is kept and a correction counted");
  f.choice("filter", c.filter, model_names(filter_sets()), "the set that stands where the next three name nothing");
  f.choices("states", c.states, model_names(state_blocks()),
            "what is estimated beside attitude, position and velocity; none: as the filter has it");
  f.choices("measurements", c.measurements, model_names(measurement_models()),
            "what corrects it; none: as the filter has it");
  std::vector<std::string> acceptance = model_names(acceptance_models());
  acceptance.insert(acceptance.begin(), kAsFilter);
  f.choice("acceptance", c.acceptance, acceptance, "what is made of each measurement's innovations");
  f.flag(
      "map_aiding", c.map_aiding,
      "registration corrects it: the motion between keyframes, by state \"clone\" and measurement \"relative_pose\"");
  f.old_key("imu_gains", "fusion.states = [\"biases\"] for \"ignore\"");
  c.own.visit_all(f);
}

FilterParts filter_parts(const FilterConfig& config) {
  FilterParts parts = model_row(filter_sets(), config.filter).make();
  if (!config.states.empty()) parts.states = config.states;
  if (!config.measurements.empty()) parts.measurements = config.measurements;
  if (config.acceptance != kAsFilter) parts.acceptance = config.acceptance;
  if (config.map_aiding) {
    add_missing(parts.states, "clone");
    add_missing(parts.measurements, "relative_pose");
  }
  return parts;
}

Status check_parts(const FilterParts& parts) {
  const auto has = [](const std::vector<std::string>& names, const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (has(parts.states, "biases") && (has(parts.states, "turn_on_biases") || has(parts.states, "in_run_biases")))
    return Error{.key = "fusion.states",
                 .what = "\"biases\" already holds what \"turn_on_biases\" and \"in_run_biases\" hold",
                 .expected = "\"biases\", or the other two"};
  struct Need {
    const char *measurement, *state;
  };
  for (const Need& need : {Need{"ranges", "receiver_clock"}, Need{"relative_pose", "clone"}}) {
    if (!has(parts.measurements, need.measurement) || has(parts.states, need.state)) continue;
    return Error{.key = "fusion.measurements",
                 .what = std::string("\"") + need.measurement + "\" without state \"" + need.state + "\"",
                 .expected = std::string("\"") + need.state + "\" in fusion.states"};
  }
  return Ok{};
}

bool measures_with(const FilterConfig& config, std::string_view measurement) {
  const std::vector<std::string> names = filter_parts(config).measurements;
  return std::find(names.begin(), names.end(), measurement) != names.end();
}

bool takes_all(const FilterConfig& config) {
  return model_row(acceptance_models(), filter_parts(config).acceptance).make(config.own)->takes_all();
}

}  // namespace canyon::fusion
