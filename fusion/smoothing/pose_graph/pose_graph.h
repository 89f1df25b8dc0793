#pragma once

#include <cstddef>
#include <vector>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/process/library_part.h"
#include "canyon/core/result.h"

namespace canyon::fusion {

/// Poses of one body S over time, what is known of them one by one, and of two of them together. Covariances are of xi,
/// right perturbation, [rotation; translation] in the frame of S (rad, m), and positive definite.
struct PoseGraph {
  struct Absolute {
    std::size_t node;
    Pose X_WS;
    Matrix6d covariance;
  };
  struct Relative {
    std::size_t source, target;
    Pose X_TS;  ///< of the source in the frame of the target
    Matrix6d covariance;
    /// It may be wrong as a whole, as one of two places that only look alike: it has a switch.
    bool switchable = false;
    double weight = 1.0;  ///< of its residual, in [0, 1]; solve() sets that of what is switchable
  };
  std::vector<Pose> X_WS;
  std::vector<Absolute> absolute;
  std::vector<Relative> relative;
};

struct PoseGraphOptions {
  int most_iterations = 100;
  double least_gain = 1e-10;  ///< of the cost, relative; a step that gains less is the last
  /// What it costs to switch a relation off, in the units of a squared, normalized residual (Sunderhauf & Protzel
  /// 2012): one whose residual is as large has the weight 1/2. The default is the 99.9 % point of six degrees of
  /// freedom.
  double switch_cost = 22.5;
};

struct PoseGraphReport {
  int iterations = 0;
  double initial_cost = 0.0, final_cost = 0.0;  ///< half the weighted sum of squares
  bool converged = false;
};

/// Residual of a relation, normalized by its covariance (not weighted), and its derivatives by right perturbations.
struct RelativeRows {
  Vector6d residual;
  Matrix6d by_source, by_target;
};
RelativeRows relative_rows(const PoseGraph::Relative& known, const Pose& X_WS, const Pose& X_WT);
struct AbsoluteRows {
  Vector6d residual;
  Matrix6d by_node;
};
AbsoluteRows absolute_rows(const PoseGraph::Absolute& known, const Pose& X_WS);

/// Moves the poses to where the sum of squares is least. Switches: all relations are believed first, at a cost of
/// switching off as large as the worst of them; it then goes down, step by step, to the one asked for (graduated
/// non-convexity, Yang et al. 2020), so that of relations that contradict one another those win that more agree with.
/// Errors: no absolute relation (the graph would float), an index beyond the poses, a covariance that is not positive
/// definite, a value that is not finite, a build without Ceres.
Result<PoseGraphReport> solve(PoseGraph& graph, const PoseGraphOptions& options);

/// Levenberg-Marquardt of Ceres on one thread, weights as they are: the same graph gives the same bits.
PoseGraphReport solve_poses_with_ceres(PoseGraph& graph, const PoseGraphOptions& options);
/// What stands on Ceres (core/process/library_part.h).
struct PoseGraphPart {
  decltype(&solve_poses_with_ceres) solve;
};
extern "C" [[gnu::weak]] const PoseGraphPart canyon_pose_graph_part;

}  // namespace canyon::fusion
