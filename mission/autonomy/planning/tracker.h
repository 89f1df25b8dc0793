#pragma once

#include <memory>

#include "canyon/core/model_choice.h"
#include "canyon/mission/autonomy/planning/plan_line.h"

namespace canyon::mission {

/// Steers a vehicle along a line. It keeps no state, so that a plan can be driven in thought by the very tracker that
/// will drive it. One-level interface; the models are in the table below, each in its own file with its own parameters.
class Tracker {
 public:
  virtual ~Tracker() = default;
  /// Curvature of the rear axle's path to ask for, 1/m, left positive; `nearest` is the line's point nearest to the
  /// rear axle. More than the vehicle can steer where the line asks for it.
  virtual double curvature_1_m(const PlanLine& line, std::size_t nearest, const PlanPose& body,
                               double speed_m_s) const = 0;
};

using MakeTracker = std::unique_ptr<Tracker>(const ModelParameters& own, const KnownVehicle& vehicle);
ModelTable<MakeTracker> trackers();

/// Makers of the rows of the table in planning/trackers.cpp, and their parameters, each in the file of its model.
std::unique_ptr<Tracker> make_pure_pursuit(const ModelParameters& own, const KnownVehicle& vehicle);
void pure_pursuit_parameters(ModelParameters& section);
/// How far ahead it steers for a point, whatever the speed.
struct Lookahead {
  double min_m, max_m;
};
Lookahead pure_pursuit_lookahead(const ModelParameters& own);
std::unique_ptr<Tracker> make_stanley(const ModelParameters& own, const KnownVehicle& vehicle);
void stanley_parameters(ModelParameters& section);

}  // namespace canyon::mission
