#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "canyon/core/earth/earth.h"
#include "canyon/core/earth/gravity.h"
#include "canyon/core/time.h"
#include "canyon/fusion/copied.h"
#include "canyon/fusion/strapdown/strapdown_omissions.h"

namespace canyon::fusion {

/// Motion of the IMU frame U relative to the Earth, in E.
struct NavState {
  GpsTime t;
  Eigen::Quaterniond R_EU = Eigen::Quaterniond::Identity();
  Eigen::Vector3d p_EU_E = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d v_EU_E = Eigen::Vector3d::Zero();  ///< m/s, velocity over ground
};

/// Increments over one interval, free of known errors: integrals of w_IU_U (rad) and f_U (m/s) in the turning frame U.
struct Increments {
  double dt_s = 0.0;
  Eigen::Vector3d dtheta_U = Eigen::Vector3d::Zero();
  Eigen::Vector3d dv_U = Eigen::Vector3d::Zero();
};

/// What an integrator makes of increments: the rotation of U over the interval, as a rotation vector against inertial
/// space, and the velocity change by specific force, expressed in U as it stood at the interval's start.
struct InertialStep {
  Eigen::Vector3d rotation_U = Eigen::Vector3d::Zero();
  Eigen::Vector3d dv_start_U = Eigen::Vector3d::Zero();
};

/// Integrates increments to attitude, velocity and position in E. One-level interface; the models are in the table
/// below.
///
/// All share the frame: E turns by w_IE dt exactly, gravity is WGS84 normal gravity (or what is given). They differ in
/// how they treat the turning of U within the interval (coning and sculling), and in the order to which they take
/// gravity, Coriolis and position.
class Strapdown {
 public:
  virtual ~Strapdown() = default;
  virtual std::unique_ptr<Strapdown> clone() const = 0;
  /// Forgets past increments, as at a start or after a gap.
  virtual void reset() = 0;
  /// Moves `state` (its time too) over one interval and returns what was integrated, for linearization.
  virtual InertialStep advance(NavState& state, const Increments& increments) = 0;
  /// From now on without these; throws for a row that has no such effect.
  virtual void leave_out(const StrapdownOmissions& omissions) = 0;
};

/// One row of the table of integrators. The orders are those of the global error in the interval, for smooth motion
/// and exact increments, once the integrator has seen the increments it looks back to.
struct StrapdownModel {
  std::unique_ptr<Strapdown> (*make)(GravityFunction gravity);
  int velocity_order, attitude_order;  ///< the row's `order` is that of position, the lowest
  /// What it can leave out (fusion/strapdown/strapdown_omissions.h); null: it does not say, and leaves out nothing.
  std::span<const StrapdownEffect> (*effects)() = nullptr;
};
using StrapdownRow = ModelRow<StrapdownModel>;

ModelTable<StrapdownModel> strapdown_models();
inline std::vector<std::string> strapdown_names() {
  return model_names(strapdown_models());
}
/// A model by name; throws ProgramError for a name that is not in the table (check user input against
/// strapdown_names()). Why gravity is exchangeable is told in core/earth/gravity.h.
std::unique_ptr<Strapdown> make_strapdown(std::string_view name, GravityFunction gravity = gravity_E);

}  // namespace canyon::fusion
