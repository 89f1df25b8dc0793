#include "canyon/fusion/smoothing/pose_graph/pose_graph.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/Cholesky>

#include "canyon/core/motion/adjoint.h"
#include "canyon/core/motion/se3_jacobian.h"

namespace canyon::fusion {
namespace {

/// L^-1 of the covariance L L'.
Matrix6d whitening(const Matrix6d& covariance) {
  return Eigen::LLT<Matrix6d>(covariance).matrixL().solve(Matrix6d::Identity());
}

bool usable(const Pose& X, const Matrix6d& covariance) {
  return X.matrix().allFinite() && covariance.allFinite() && Eigen::LLT<Matrix6d>(covariance).info() == Eigen::Success;
}

Status check(const PoseGraph& graph) {
  const std::size_t n = graph.X_WS.size();
  if (graph.absolute.empty())
    return Error{.what = "pose graph: no pose is known by itself, so that nothing holds the others"};
  for (std::size_t k = 0; k < n; ++k)
    if (!graph.X_WS[k].matrix().allFinite())
      return Error{.what = "pose graph: pose " + std::to_string(k) + " is not finite"};
  for (const PoseGraph::Absolute& known : graph.absolute) {
    if (known.node >= n)
      return Error{.what = "pose graph: pose " + std::to_string(known.node) + " of " + std::to_string(n)};
    if (!usable(known.X_WS, known.covariance))
      return Error{.what = "pose graph: what is known of pose " + std::to_string(known.node) +
                           " is not finite, or its covariance not positive definite"};
  }
  for (const PoseGraph::Relative& known : graph.relative) {
    const std::string of = std::to_string(known.target) + " and " + std::to_string(known.source);
    if (std::max(known.source, known.target) >= n || known.source == known.target)
      return Error{.what = "pose graph: poses " + of + " of " + std::to_string(n)};
    if (!usable(known.X_TS, known.covariance))
      return Error{.what = "pose graph: what is known of poses " + of +
                           " is not finite, or its covariance not positive definite"};
  }
  return Ok{};
}

}  // namespace

RelativeRows relative_rows(const PoseGraph::Relative& known, const Pose& X_WS, const Pose& X_WT) {
  const Pose X_TS = X_WT.inverse() * X_WS;
  const Vector6d e = (known.X_TS.inverse() * X_TS).log();
  const Matrix6d W = whitening(known.covariance), by_source = W * se3_right_jacobian_inverse(e);
  return {W * e, by_source, -by_source * adjoint(X_TS.inverse())};
}

AbsoluteRows absolute_rows(const PoseGraph::Absolute& known, const Pose& X_WS) {
  const Vector6d e = (known.X_WS.inverse() * X_WS).log();
  const Matrix6d W = whitening(known.covariance);
  return {W * e, W * se3_right_jacobian_inverse(e)};
}

#ifdef CANYON_WITH_CERES

namespace {

/// From one step of what switching off costs to the next.
constexpr double kHarderPoses = 4.0;

double squared(const PoseGraph& graph, const PoseGraph::Relative& known) {
  return relative_rows(known, graph.X_WS[known.source], graph.X_WS[known.target]).residual.squaredNorm();
}

/// Each switch to what is least of s^2 chi^2 + cost (1 - s)^2 where the poses are. Returns the largest change.
double set_pose_switches(PoseGraph& graph, double cost) {
  double changed = 0.0;
  for (PoseGraph::Relative& known : graph.relative) {
    if (!known.switchable) continue;
    const double weight = cost / (cost + squared(graph, known));
    changed = std::max(changed, std::abs(weight - known.weight));
    known.weight = weight;
  }
  return changed;
}

}  // namespace

Result<PoseGraphReport> solve(PoseGraph& graph, const PoseGraphOptions& options) {
  CANYON_TRY_STATUS(check(graph));
  const PoseGraphPart& part = library_part("pose_graph", &canyon_pose_graph_part);
  double worst = 0.0;
  for (PoseGraph::Relative& known : graph.relative) {
    known.weight = 1.0;
    if (known.switchable) worst = std::max(worst, squared(graph, known));
  }
  PoseGraphReport report = part.solve(graph, options);
  if (worst == 0.0) return report;
  const double initial_cost = report.initial_cost;
  int iterations = report.iterations;
  // At each cost as often as the switches still move; at the last one until they stand.
  constexpr int kMostRounds = 20;
  constexpr double kStands = 1e-6;
  for (double cost = std::max(worst, options.switch_cost);; cost = std::max(cost / kHarderPoses, options.switch_cost)) {
    const bool last = cost <= options.switch_cost;
    for (int round = 0; round < (last ? kMostRounds : 1); ++round) {
      if (set_pose_switches(graph, cost) < kStands) break;
      report = part.solve(graph, options);
      iterations += report.iterations;
    }
    if (last) break;
  }
  report.iterations = iterations;
  report.initial_cost = initial_cost;
  return report;
}

#else

Result<PoseGraphReport> solve(PoseGraph& graph, const PoseGraphOptions&) {
  CANYON_TRY_STATUS(check(graph));
  return Error{.what = "this build has no pose graphs", .expected = "a build with CANYON_WITH_CERES=ON"};
}

#endif

}  // namespace canyon::fusion
