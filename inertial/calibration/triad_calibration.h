#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/result.h"

namespace canyon::inertial {

/// What a triad measures of a true rate or specific force y: (I + gain) y + bias.
struct TriadCalibration {
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();  ///< rad/s or m/s^2
  Eigen::Matrix3d gain = Eigen::Matrix3d::Zero();  ///< diagonal: scale factors; else misalignment, rad
  Eigen::Vector3d bias_sigma = Eigen::Vector3d::Zero();
  Eigen::Matrix3d gain_sigma = Eigen::Matrix3d::Zero();
  double residual_rms = 0.0;      ///< of what was fitted, in the unit of the bias
  double uncalibrated_rms = 0.0;  ///< the same with neither bias nor gain taken off
  std::size_t used = 0;           ///< samples or positions

  /// The true value of a measured one.
  Eigen::Vector3d corrected(const Eigen::Vector3d& measured) const;
};

/// Bias, scale factors and misalignments from samples beside their true values: linear least squares, sigmas from the
/// residuals (white between samples). An Error if the true values do not excite all three axes.
Result<TriadCalibration> fit_to_reference(std::span<const Eigen::Vector3d> measured,
                                          std::span<const Eigen::Vector3d> truth);

/// The same of an accelerometer from the means of at least nine resting positions, each of which must show gravity's
/// magnitude (Ceres). `sigma_m_s2`: of each mean. Turning the whole triad changes no magnitude: the frame is that of
/// the sensitive axes, x along the x axis, y in the plane of x and y; so gain is lower triangular. An Error for too few
/// positions, or such as leave a parameter open, and if this build has no Ceres.
Result<TriadCalibration> fit_to_gravity(std::span<const Eigen::Vector3d> positions, double sigma_m_s2,
                                        double gravity_m_s2);

}  // namespace canyon::inertial
