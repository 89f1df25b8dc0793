#include "canyon/fusion/filter_config.h"

#include "canyon/core/config/config.h"
#include "canyon/fusion/acceptance/acceptance.h"
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
  return {.states = {"biases", "gains", "mounting", "wheel_scale", "fix_error"},
          .measurements = {"position", "velocity", "non_holonomic", "standstill", "odometer"},
          .acceptance = "innovation_adaptive"};
}

constexpr ModelRow<FilterParts (*)()> kSets[] = {
    {"naive", naive, "takes each fix as independent of the last one and as good as it says"},
    {"vehicle", vehicle, "knows that wheels roll, that fixes err for seconds, and what their Doppler shifts say"},
};

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
  f.choice("filter", c.filter, model_names(filter_sets()), "the set that stands where the next three name nothing");
  f.choices("states", c.states, model_names(state_blocks()),
            "what is estimated beside attitude, position and velocity; none: as the filter has it");
  f.choices("measurements", c.measurements, model_names(measurement_models()),
            "what corrects it; none: as the filter has it");
  std::vector<std::string> acceptance = model_names(acceptance_models());
  acceptance.insert(acceptance.begin(), kAsFilter);
  f.choice("acceptance", c.acceptance, acceptance, "how fixes are judged");
  f.old_key("imu_gains", "states, with or without \"gains\"");
  c.own.visit_all(f);
}

FilterParts filter_parts(const FilterConfig& config) {
  FilterParts parts = model_row(filter_sets(), config.filter).make();
  if (!config.states.empty()) parts.states = config.states;
  if (!config.measurements.empty()) parts.measurements = config.measurements;
  if (config.acceptance != kAsFilter) parts.acceptance = config.acceptance;
  return parts;
}

bool takes_all(const FilterConfig& config) {
  return model_row(acceptance_models(), filter_parts(config).acceptance).make(config.own)->takes_all();
}

}  // namespace canyon::fusion
