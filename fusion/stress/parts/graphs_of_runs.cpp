// The graph of a run beside one dense system, and the prior that it starts from.
#include <cmath>
#include <vector>

#include <Eigen/LU>

#include "canyon/core/stress/looks.h"
#include "canyon/fusion/smoothing/graph/chain_builder.h"
#include "canyon/fusion/smoothing/graph/chain_graph.h"
#include "canyon/fusion/smoothing/run_filter.h"
#include "canyon/fusion/stress/drawn_numbers.h"
#include "canyon/fusion/stress/parts/covariance_distance.h"
#include "canyon/fusion/stress/parts/subjects.h"
#include "canyon/fusion/stress/simulated_drive.h"

namespace canyon::fusion {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using stress::Looks;

/// All factors of a graph as one system in [node 0, node 1, ..., constants]: rows and residuals.
struct Dense {
  MatrixXd J;
  VectorXd r;
};
Dense dense_of(const ChainGraph& graph, NodeMeasurements& measurements) {
  const Eigen::Index n = graph.layout.node_size(), c = graph.layout.constants();
  const auto count = static_cast<Eigen::Index>(graph.nodes.size());
  Dense out{MatrixXd(0, count * n + c), VectorXd(0)};
  const auto add = [&](const FactorRows& rows, double weight, Eigen::Index first) {
    const Eigen::Index at = out.J.rows(), more = rows.residual.size();
    out.J.conservativeResize(at + more, Eigen::NoChange);
    out.J.bottomRows(more).setZero();
    out.J.block(at, first * n, more, n) = weight * rows.by_first;
    if (rows.by_second.cols() > 0) out.J.block(at, (first + 1) * n, more, n) = weight * rows.by_second;
    if (c > 0) out.J.block(at, count * n, more, c) = weight * rows.by_constants;
    out.r.conservativeResize(at + more);
    out.r.tail(more) = weight * rows.residual;
  };
  add(prior_rows(graph.layout, graph.prior, graph.nodes[0], graph.constants), 1.0, 0);
  for (std::size_t k = 0; k < graph.edges.size(); ++k)
    add(edge_rows(graph.layout, graph.edges[k], graph.nodes[k], graph.nodes[k + 1], graph.constants, true,
                  first_estimate_of(graph, k)),
        1.0, static_cast<Eigen::Index>(k));
  for (std::size_t k = 0; k < graph.nodes.size(); ++k)
    for (const NodeMeasurement& m : graph.measurements[k])
      add(measurements.rows(m, graph.layout, graph.nodes[k], graph.constants), m.weight, static_cast<Eigen::Index>(k));
  return out;
}

/// A graph of seven nodes: the covariance of each node is that block of the whole system's inverse, weights and all;
/// the first one taken out leaves the same of the others, and the same gradient. The system has a condition of some
/// 1e10, and its roots half the digits of that: 1e-9 of a sigma squared.
StressFigure dense_graph(const char* keys) {
  Looks looks;
  const Drive drive = simulated_drive(9, {.seconds = 3.4, .rate_hz = 20.0, .outage_from_s = 1e9, .keys = keys});
  const SmootherInput run = drive.input();
  ChainBuilder builder(run, *samples_of(run), 0.6);
  while (!builder.done()) builder.add_node();
  ChainGraph& graph = builder.graph();
  NodeMeasurements& measurements = builder.measurements();
  looks.right(graph.nodes.size() == graph.edges.size() + 1 && graph.measurements.size() == graph.nodes.size());
  double weight = 1.0;
  for (auto& all : graph.measurements)
    for (NodeMeasurement& m : all) m.weight = weight *= 0.8;
  // Away from where residuals vanish.
  DrawnNumbers draw(2);
  for (GraphNode& node : graph.nodes) {
    VectorXd off = 1e-3 * draw.any(graph.layout.node_size(), 1);
    node = moved(node, off);
  }
  const Eigen::Index n = graph.layout.node_size(), c = graph.layout.constants();
  const auto covariance_of = [](const MatrixXd& J) {
    // By scaled columns, so that units do not count.
    const VectorXd scale = J.colwise().norm().cwiseInverse().transpose();
    const MatrixXd S = J * scale.asDiagonal();
    return MatrixXd(scale.asDiagonal() * (S.transpose() * S).inverse() * scale.asDiagonal());
  };
  const Dense all = dense_of(graph, measurements);
  const MatrixXd P = covariance_of(all.J);
  const auto found = marginal_covariances(graph, measurements);
  looks.right(found.size() == graph.nodes.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k) * n;
    looks.near(apart_by_sigma(P.block(at, at, n, n), found[k]), 0.0, 1e-6);
  }
  looks.near(apart_by_sigma(found[0], first_covariance(graph, measurements)), 0.0, 1e-7);
  // What is left by elimination: information and gradient of the rest.
  const MatrixXd H = all.J.transpose() * all.J;
  const VectorXd g = all.J.transpose() * all.r;
  const Eigen::Index rest = H.rows() - n;
  const MatrixXd gain = H.bottomLeftCorner(rest, n) * H.topLeftCorner(n, n).inverse(),
                 left = H.bottomRightCorner(rest, rest) - gain * H.topRightCorner(n, rest);
  const VectorXd left_g = g.tail(rest) - gain * g.head(n);
  builder.marginalize_first();
  looks.right(graph.prior.of_factors && first_estimate_of(graph, 0) == &graph.prior.node &&
              first_estimate_of(graph, 1) == nullptr);
  const Dense after = dense_of(graph, measurements);
  const MatrixXd H_after = after.J.transpose() * after.J;
  looks.near(apart_by_sigma(left, H_after), 0.0, 1e-6);
  const VectorXd size = left.diagonal().cwiseSqrt();
  looks.near((after.J.transpose() * after.r - left_g).cwiseQuotient(size).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(),
             0.0, 1e-6 * (1.0 + g.norm() / size.norm()));
  looks.right(c == graph.layout.constants());
  return looks.figure();
}

/// The prior of a filter's own covariance: whitened it is the error's square over that covariance, node and constants
/// in whatever order; its derivative is that of its residual.
StressFigure priors() {
  Looks looks;
  const Drive drive = simulated_drive(
      3,
      {.seconds = 0.5, .keys = "states = [\"gains\", \"in_run_biases\", \"wheel_scale\", \"fix_error\", \"clone\"]"});
  const SmootherInput run = drive.input();
  const ErrorStateFilter filter = started_filter(run);
  const GraphLayout layout(filter.state());
  // Gains and the wheel never change; biases and the fixes' errors wander; the clone is known.
  looks.right(layout.states() == 9 + 18 + 6 + 1 + 3 + 6 && layout.node_size() == 9 + 9 && layout.constants() == 7);
  DrawnNumbers draw(7);
  const MatrixXd P = draw.positive(layout.states(), 0.5);
  const GraphNode node{filter.nav_state(), draw.any(9, 1)};
  const VectorXd constants = draw.any(layout.constants(), 1);
  const LinearPrior prior = prior_of(layout, node, constants, P);
  const VectorXd error = 0.1 * draw.any(layout.node_size(), 1), more = 0.1 * draw.any(layout.constants(), 1);
  const GraphNode off = moved(node, error);
  const FactorRows rows = prior_rows(layout, prior, off, constants + more);
  std::vector<int> order;
  for (int i = 0; i < 9; ++i) order.push_back(i);
  for (const int i : layout.walking()) order.push_back(i);
  for (const int i : layout.constant()) order.push_back(i);
  const auto size = static_cast<Eigen::Index>(order.size());
  MatrixXd Q(size, size);
  VectorXd e(size);
  e << error, more;
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index j = 0; j < size; ++j)
      Q(i, j) = P(order[static_cast<std::size_t>(i)], order[static_cast<std::size_t>(j)]);
  looks.near(rows.residual.squaredNorm() / e.dot(Q.inverse() * e), 1.0, 1e-8);
  for (Eigen::Index i = 0; i < layout.node_size(); ++i) {
    const VectorXd step = 1e-4 * VectorXd::Unit(layout.node_size(), i);
    const VectorXd by = (prior_rows(layout, prior, moved(off, step), constants + more).residual -
                         prior_rows(layout, prior, moved(off, -step), constants + more).residual) /
                        2e-4;
    // A place of 6e6 m rounds by 1e-9 over the step.
    looks.near((rows.by_first.col(i) - by).norm() / (1.0 + by.norm()), 0.0, 1e-4);
  }
  looks.near((rows.by_constants - prior.A.rightCols(layout.constants())).norm(), 0.0, 1e-300);
  // Values in parts and whole again, columns where they belong.
  const VectorXd values = draw.any(layout.states() - 9, 1);
  VectorXd again = layout.values(layout.walking_of(values), layout.constants_of(values));
  const MatrixXd columns = draw.any(4, layout.states()), nodes = layout.node_columns(columns),
                 fixed = layout.constant_columns(columns);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    looks.right((at < layout.node_size() ? nodes.col(at) : fixed.col(at - layout.node_size())) ==
                columns.col(order[i]));
    if (i >= 9) looks.right(again[order[i] - 9] == values[order[i] - 9]), again[order[i] - 9] = 0.0;
  }
  looks.right(again.isZero(0.0));
  return looks.figure();
}

}  // namespace

std::vector<StressCase> run_graph_cases() {
  StressRows rows;
  rows.of({StressGroup::kStiff, "a graph against one dense system",
           "a row of another node, a weight that counts twice, a term lost in elimination",
           "blocks of the inverse, and the Schur complement: a millionth of a sigma", "of the bound"});
  rows.add("runs/dense_graph", [] { return dense_graph("states = [\"biases\", \"gains\"]"); });
  rows.add("runs/dense_graph_of_a_vehicle", [] {
    return dense_graph(
        "states = [\"turn_on_biases\", \"in_run_biases\", \"fix_error\"]\nmeasurements = [\"position\", "
        "\"non_holonomic\"]\nfix_error_sigma_m = 0.2");
  });
  rows.add("runs/priors", priors);
  return rows.take();
}

}  // namespace canyon::fusion
