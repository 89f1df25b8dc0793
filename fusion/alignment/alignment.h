#pragma once

#include <span>

#include "canyon/core/imu_noise.h"
#include "canyon/core/messages.h"
#include "canyon/core/model_choice.h"
#include "canyon/core/result.h"
#include "canyon/fusion/strapdown.h"

namespace canyon::fusion {

/// What an alignment looks at: a recording from its beginning on. Axes of U are parallel to B.
struct AlignmentInputs {
  std::span<const ImuSample> imu;
  std::span<const GnssFix> fixes;
  ImuNoise noise;
  Eigen::Vector3d lever_U_B = Eigen::Vector3d::Zero();  ///< IMU in B, m
  Eigen::Vector3d lever_A_B = Eigen::Vector3d::Zero();  ///< antenna in B, m
};

/// Where navigation can start, and how well that is known, 1-sigma. NaN: the alignment cannot say, and the filter's own
/// initial uncertainty stands. A heading that nobody knows has pi.
struct Aligned {
  NavState nav;
  double tilt_rad = kNaN;  ///< of roll and pitch
  double heading_rad = kNaN;
  double position_m = kNaN;    ///< per axis
  double velocity_m_s = kNaN;  ///< per axis
};

/// Finds the first state of a recording. The models are in the table below, each in its own file with its own keys. An
/// Error where it cannot: nothing moved fast enough, or there is no fix.
using Align = Result<Aligned>(const ModelParameters& own, const AlignmentInputs& inputs);
ModelTable<Align> alignments();

/// Attitude of U in E whose z axis answers `force_U` with `force_E`, and whose x axis has that heading (from north,
/// clockwise) at the place p_E. Both forces longer than zero.
Eigen::Quaterniond attitude_from_force(const Eigen::Vector3d& p_E, const Eigen::Vector3d& force_U,
                                       const Eigen::Vector3d& force_E, double heading_rad);

/// Makers of the rows of the table in alignment/alignments.cpp, and their parameters.
Result<Aligned> align_given(const ModelParameters& own, const AlignmentInputs& inputs);
void given_parameters(ModelParameters& section);
Result<Aligned> align_static(const ModelParameters& own, const AlignmentInputs& inputs);
void static_parameters(ModelParameters& section);
Result<Aligned> align_in_motion(const ModelParameters& own, const AlignmentInputs& inputs);
void in_motion_parameters(ModelParameters& section);

}  // namespace canyon::fusion
