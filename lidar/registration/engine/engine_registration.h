#pragma once

#include <memory>

#include "canyon/lidar/registration/engine/match_form.h"
#include "canyon/lidar/registration/registration.h"

namespace canyon::lidar {

/// Keys of the own methods, beside MatchingParameters.
struct EngineParameters {
  std::string kernel = "geman_mcclure";
  double kernel_width_m = 0.5;
  double start_correspondence_m = 4.0;
  std::string covariance = "calibrated";
  double point_sigma_m = 0.02;
  double range_bias_m = 0.01;
  double least_overlap = 0.2;
};
void visit(FieldVisitor& f, EngineParameters& c);
/// As a row's `parameters`: both structs.
void engine_parameters(ModelParameters& section);

/// What tells the own methods apart.
struct EngineKind {
  MatchForm* form;
  double voxel_leaves = 0;  ///< edge of the target's voxels in leaf_m; 0: points
};
std::unique_ptr<Registration> make_engine(const EngineKind& kind, const ModelParameters& own);

}  // namespace canyon::lidar
