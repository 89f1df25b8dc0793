#pragma once

#include <limits>
#include <memory>
#include <span>

#include "canyon/core/model_choice.h"

namespace canyon::mission {

/// What lies ahead of the vehicle on the arc that it drives.
struct SpeedTask {
  double route_m_s = 0.0;  ///< what route and waypoints allow
  bool free_to_end = false;
  double free_m = 0.0;                     ///< that the vehicle may go before its body comes too near to something
  double seen_m = 0.0;                     ///< up to where the way ahead was seen, from the front bumper
  std::span<const float> curvature_1_m{};  ///< of the arc from here on, at every step of step_m
  double step_m = 0.25;
  double braking_m_s2 = 1.2, lateral_m_s2 = 1.2;
  double max_yaw_rate_rad_s = std::numeric_limits<double>::infinity();  ///< of the vehicle
};

/// How fast it may go. One-level interface; the models are in the table below, each in its own file with its own
/// parameters.
class SpeedRule {
 public:
  virtual ~SpeedRule() = default;
  virtual double allowed_m_s(const SpeedTask& task) const = 0;
};

using MakeSpeedRule = std::unique_ptr<SpeedRule>(const ModelParameters& own);
ModelTable<MakeSpeedRule> speed_rules();

/// Makers of the rows of the table in planning/speed_rules.cpp, and their parameters, each in the file of its model.
std::unique_ptr<SpeedRule> make_stopping_distance(const ModelParameters& own);
void stopping_distance_parameters(ModelParameters& section);

}  // namespace canyon::mission
