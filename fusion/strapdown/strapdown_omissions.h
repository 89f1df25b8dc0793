#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/imu_noise.h"
#include "canyon/core/need.h"

namespace canyon::fusion {

/// What an integrator leaves out of its steps.
struct StrapdownOmissions {
  bool coning = false;      ///< what it makes of the increments before: coning and sculling
  bool earth_rate = false;  ///< the turning of E, Coriolis with it; gravity keeps its centrifugal part

  bool any() const { return coning || earth_rate; }
  bool operator==(const StrapdownOmissions&) const = default;
};

/// The names of the effects.
inline constexpr const char* kConing = "coning and sculling";
inline constexpr const char* kEarthRate = "turning of the Earth";

/// Those that are not needed.
StrapdownOmissions strapdown_omissions_of(const std::vector<Need>& needs);

/// A step of an integrator: the increments over it and over the step before, and the motion at its start.
struct StrapdownStep {
  double dt_s = 0.0, dt_before_s = 0.0;  ///< before: 0 = there was none
  Eigen::Vector3d dtheta_U = Eigen::Vector3d::Zero(), dv_U = Eigen::Vector3d::Zero();
  Eigen::Vector3d dtheta_before_U = Eigen::Vector3d::Zero(), dv_before_U = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_EU = Eigen::Matrix3d::Identity();
  Eigen::Vector3d v_EU_E = Eigen::Vector3d::Zero();
};

/// What an effect does in one step: by what the motion at its end is off without it, attitude as a right perturbation.
/// First order.
struct StepMove {
  Eigen::Vector3d theta_U = Eigen::Vector3d::Zero();  ///< rad
  Eigen::Vector3d p_E = Eigen::Vector3d::Zero(), v_E = Eigen::Vector3d::Zero();
};

/// An effect that an integrator can leave out; a row's are listed beside its model.
struct StrapdownEffect {
  const char* name;
  StepMove (*of_step)(const StrapdownStep& step);
};

/// The Need of an effect along a motion in whose steps it turned the attitude by `turned_rad` in all (the sum of their
/// |theta|): the bound is the rate of that, deg/h. Whatever the signs, the attitude of a free integration without the
/// effect is off by no more than this rate times its time, since rotations add up to no more than the sum of their
/// angles. The reason has beside it what the unit's white noise turns the attitude by over that time (1-sigma, per
/// axis): white / sqrt(time).
Need strapdown_need(const StrapdownEffect& effect, double turned_rad, double time_s, const ImuNoise& noise);

/// Of all rows whose E turns by w_IE dt (move()). Without it the attitude is off by -R_UE w_IE dt, and the velocity by
/// Coriolis and by half that turn of the force: -(2 w_IE x v dt + w_IE x R_EU dv dt / 2).
StepMove earth_rate_of(const StrapdownStep& step);
std::span<const StrapdownEffect> earth_rate_alone();
/// Of two_sample: its terms of the increments before, in the file of the model.
std::span<const StrapdownEffect> two_sample_effects();

}  // namespace canyon::fusion
