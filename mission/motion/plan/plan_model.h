#pragma once

#include <memory>

#include <Eigen/Core>

#include "canyon/core/messages.h"
#include "canyon/core/model_choice.h"

namespace canyon::mission {

struct VehicleConfig;

/// Motion of B, the middle of the rear axle, in the plane at an instant: forward along B's x, across along its y (left
/// positive), turns counter-clockwise.
struct PlanState {
  Eigen::Vector2d p_W{0, 0};
  double yaw_rad = 0.0;                                 ///< may be beyond pi by what a step turns
  double forward_m_s = 0.0, forward_change_m_s2 = 0.0;  ///< and its derivative
  double across_m_s = 0.0, across_change_m_s2 = 0.0;
  double turn_rad_s = 0.0, turn_change_rad_s2 = 0.0;
  double distance_m = 0.0;  ///< driven along B's x, either way
};

/// How a vehicle moves in the plane under its commands. One-level interface; the models are in the table below, each in
/// its own file with its own parameters. Ends of steps are what a model says; velocities are exact derivatives of
/// places all along a step.
class PlanModel {
 public:
  virtual ~PlanModel() = default;
  /// By dt_s > 0 under a finite command, within the limits of the configuration.
  virtual void advance(const DriveCommand& command, double dt_s) = 0;
  virtual const PlanState& state() const = 0;
  /// False: B goes where it points, and `across` is 0 at all times.
  virtual bool slips() const = 0;
};

/// Stands at the configuration's start.
using MakePlanModel = std::unique_ptr<PlanModel>(const ModelParameters& own, const VehicleConfig& config);
ModelTable<MakePlanModel> plan_models();

/// Makers of the rows of the table in plan_models.cpp, and their parameters, each in the file of its model.
std::unique_ptr<PlanModel> make_kinematic_bicycle(const ModelParameters& own, const VehicleConfig& config);
std::unique_ptr<PlanModel> make_dynamic_bicycle(const ModelParameters& own, const VehicleConfig& config);
std::unique_ptr<PlanModel> make_skid_steer(const ModelParameters& own, const VehicleConfig& config);
void kinematic_bicycle_parameters(ModelParameters& section);
void dynamic_bicycle_parameters(ModelParameters& section);
void skid_steer_parameters(ModelParameters& section);

}  // namespace canyon::mission
