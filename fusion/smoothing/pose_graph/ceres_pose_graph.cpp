#include <array>
#include <vector>

#include <ceres/ceres.h>

#include "canyon/core/motion/se3_jacobian.h"
#include "canyon/core/process/progress.h"
#include "canyon/fusion/smoothing/pose_graph/pose_graph.h"

namespace canyon::fusion {
namespace {

using Tangent = std::array<double, 6>;
using Block = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

/// A pose is moved by a right perturbation of where it stood when Ceres was called.
Pose moved_pose(const Pose& X, const double* xi) {
  return X * Pose::exp(Eigen::Map<const Vector6d>(xi));
}

void put_block(const Matrix6d& by_perturbation, const double* xi, double weight, double* jacobian) {
  Eigen::Map<Block>{jacobian} = weight * by_perturbation * se3_right_jacobian(Eigen::Map<const Vector6d>(xi));
}

class RelativeCost final : public ceres::SizedCostFunction<6, 6, 6> {
 public:
  RelativeCost(const PoseGraph& graph, const PoseGraph::Relative& known) : graph_(graph), known_(known) {}
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const RelativeRows rows = relative_rows(known_, moved_pose(graph_.X_WS[known_.source], x[0]),
                                            moved_pose(graph_.X_WS[known_.target], x[1]));
    Eigen::Map<Vector6d>{residuals} = known_.weight * rows.residual;
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) put_block(rows.by_source, x[0], known_.weight, jacobians[0]);
    if (jacobians[1] != nullptr) put_block(rows.by_target, x[1], known_.weight, jacobians[1]);
    return true;
  }

 private:
  const PoseGraph& graph_;
  const PoseGraph::Relative& known_;
};

class AbsoluteCost final : public ceres::SizedCostFunction<6, 6> {
 public:
  AbsoluteCost(const PoseGraph& graph, const PoseGraph::Absolute& known) : graph_(graph), known_(known) {}
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const AbsoluteRows rows = absolute_rows(known_, moved_pose(graph_.X_WS[known_.node], x[0]));
    Eigen::Map<Vector6d>{residuals} = rows.residual;
    if (jacobians != nullptr && jacobians[0] != nullptr) put_block(rows.by_node, x[0], 1.0, jacobians[0]);
    return true;
  }

 private:
  const PoseGraph& graph_;
  const PoseGraph::Absolute& known_;
};

class CancelPoses final : public ceres::IterationCallback {
 public:
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    return cancel_requested() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }
};

}  // namespace

PoseGraphReport solve_poses_with_ceres(PoseGraph& graph, const PoseGraphOptions& options) {
  std::vector<Tangent> moved(graph.X_WS.size(), Tangent{});
  ceres::Problem problem;
  for (Tangent& xi : moved) problem.AddParameterBlock(xi.data(), 6);
  for (const PoseGraph::Absolute& known : graph.absolute)
    problem.AddResidualBlock(new AbsoluteCost(graph, known), nullptr, moved[known.node].data());
  for (const PoseGraph::Relative& known : graph.relative)
    problem.AddResidualBlock(new RelativeCost(graph, known), nullptr, moved[known.source].data(),
                             moved[known.target].data());
  CancelPoses cancel;
  ceres::Solver::Options how;
  how.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  how.num_threads = 1;
  how.max_num_iterations = options.most_iterations;
  how.function_tolerance = options.least_gain;
  how.gradient_tolerance = 1e-12;
  how.parameter_tolerance = 1e-13;
  how.logging_type = ceres::SILENT;
  how.callbacks.push_back(&cancel);
  ceres::Solver::Summary summary;
  ceres::Solve(how, &problem, &summary);
  throw_if_cancelled();
  for (std::size_t k = 0; k < moved.size(); ++k) graph.X_WS[k] = moved_pose(graph.X_WS[k], moved[k].data());
  return {.iterations = static_cast<int>(summary.iterations.size()) - 1,
          .initial_cost = summary.initial_cost,
          .final_cost = summary.final_cost,
          .converged = summary.termination_type == ceres::CONVERGENCE};
}

extern "C" const PoseGraphPart canyon_pose_graph_part{solve_poses_with_ceres};

}  // namespace canyon::fusion
