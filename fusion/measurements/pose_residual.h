#pragma once

#include "canyon/core/motion/adjoint.h"
#include "canyon/fusion/measurements/body_motion.h"

namespace canyon::fusion {

using PoseRows = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor, 6, kMostStates>;

/// Pose of B in E, and the xi = [rotation; translation] in B by which the errors move it.
struct BodyPose {
  Pose X_EB;
  PoseRows H;
};
BodyPose body_pose(const FilterView& filter);
/// The same of the clone, which must have been taken.
BodyPose cloned_body_pose(const FilterView& filter);

/// What was measured against what is predicted, in the source frame: [Log(R^ R_measured); R^ (p_measured - p)], R^
/// being that of what is predicted, transposed; `H`: the xi by which the errors move what is predicted.
Measurement pose_residual(const ErrorState& state, const Pose& predicted, const PoseRows& H, const Pose& measured,
                          const Matrix6d& covariance);

}  // namespace canyon::fusion
