#include "canyon/fusion/smoothing/graph/chain_graph.h"

#include <algorithm>
#include <initializer_list>
#include <utility>

#include <Eigen/LU>
#include <Eigen/QR>

#include "canyon/core/check.h"
#include "canyon/core/motion/rotation.h"

namespace canyon::fusion {
namespace {

/// Rows of some variables, J x + r, as triangular as they come. Square roots of the normal equations: what a double
/// keeps of a variable is then not half lost to what is known better.
struct Rows {
  Eigen::MatrixXd J;
  Eigen::VectorXd r;

  explicit Rows(Eigen::Index variables) : J(0, variables), r(0) {}

  void add(const Eigen::VectorXd& residual, double weight,
           std::initializer_list<std::pair<Eigen::Index, const Eigen::MatrixXd*>> pieces) {
    const Eigen::Index at = J.rows(), count = residual.size();
    J.conservativeResize(at + count, Eigen::NoChange);
    J.bottomRows(count).setZero();
    for (const auto& [column, by] : pieces) J.block(at, column, count, by->cols()) = weight * *by;
    r.conservativeResize(at + count);
    r.tail(count) = weight * residual;
  }
  void add(const Rows& other) {
    const Eigen::Index at = J.rows();
    J.conservativeResize(at + other.J.rows(), Eigen::NoChange);
    J.bottomRows(other.J.rows()) = other.J;
    r.conservativeResize(at + other.r.size());
    r.tail(other.r.size()) = other.r;
  }
  /// The same of the variables from `first` on, whatever those before them are: an upper triangle.
  Rows without(Eigen::Index first) const {
    const Eigen::Index variables = J.cols(), rest = variables - first;
    Eigen::MatrixXd all(J.rows(), variables + 1);
    all << J, r;
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(all);
    const Eigen::Index kept = std::min(J.rows(), variables) - first;
    Rows out(rest);
    if (kept <= 0) return out;
    out.J = qr.matrixQR().block(first, first, kept, rest).triangularView<Eigen::Upper>();
    out.r = qr.matrixQR().col(variables).segment(first, kept);
    return out;
  }
};

/// Of [node, constants].
void add_prior(const ChainGraph& graph, Rows& to) {
  const FactorRows rows = prior_rows(graph.layout, graph.prior, graph.nodes.front(), graph.constants);
  to.add(rows.residual, 1.0, {{0, &rows.by_first}, {rows.by_first.cols(), &rows.by_constants}});
}

void add_measurements(const ChainGraph& graph, NodeMeasurements& measurements, std::size_t k, Eigen::Index constants_at,
                      Rows& to) {
  for (const NodeMeasurement& m : graph.measurements[k]) {
    const FactorRows rows = measurements.rows(m, graph.layout, graph.nodes[k], graph.constants);
    to.add(rows.residual, m.weight, {{0, &rows.by_first}, {constants_at, &rows.by_constants}});
  }
}

FactorRows edge_of(const ChainGraph& graph, std::size_t k) {
  return edge_rows(graph.layout, graph.edges[k], graph.nodes[k], graph.nodes[k + 1], graph.constants, true,
                   first_estimate_of(graph, k));
}

/// Rows of [node, constants] as rows of [node, another node, constants].
Rows beside_another(const ChainGraph& graph, const Rows& of_one) {
  const Eigen::Index n = graph.layout.node_size(), c = graph.layout.constants();
  Rows all(2 * n + c);
  const Eigen::MatrixXd by_node = of_one.J.leftCols(n), by_constants = of_one.J.rightCols(c);
  all.add(of_one.r, 1.0, {{0, &by_node}, {2 * n, &by_constants}});
  return all;
}

/// Of [node, constants] before a node's measurements to the same of the next.
Rows forwards(const ChainGraph& graph, NodeMeasurements& measurements, std::size_t k, const Rows& before) {
  const Eigen::Index n = graph.layout.node_size();
  Rows all = beside_another(graph, before);
  add_measurements(graph, measurements, k, 2 * n, all);
  const FactorRows edge = edge_of(graph, k);
  all.add(edge.residual, 1.0, {{0, &edge.by_first}, {n, &edge.by_second}, {2 * n, &edge.by_constants}});
  return all.without(n);
}

/// Of [node k + 1, constants] after it to the same of node k, that node's measurements left out.
Rows backwards(const ChainGraph& graph, NodeMeasurements& measurements, std::size_t k, const Rows& after) {
  const Eigen::Index n = graph.layout.node_size();
  Rows all = beside_another(graph, after);
  add_measurements(graph, measurements, k + 1, 2 * n, all);
  const FactorRows edge = edge_of(graph, k);
  all.add(edge.residual, 1.0, {{0, &edge.by_second}, {n, &edge.by_first}, {2 * n, &edge.by_constants}});
  return all.without(n);
}

Eigen::MatrixXd node_covariance(const ChainGraph& graph, NodeMeasurements& measurements, std::size_t k,
                                const Rows& before, const Rows& after) {
  const Eigen::Index n = graph.layout.node_size(), all_of = n + graph.layout.constants();
  Rows all = before;
  all.add(after);
  add_measurements(graph, measurements, k, n, all);
  Eigen::MatrixXd root = Eigen::MatrixXd::Identity(all_of, all_of);
  all.without(0).J.triangularView<Eigen::Upper>().solveInPlace(root);
  return (root * root.transpose()).topLeftCorner(n, n);
}

Rows nothing(const ChainGraph& graph) {
  return Rows(graph.layout.node_size() + graph.layout.constants());
}

}  // namespace

LinearPrior prior_of(const GraphLayout& layout, const GraphNode& node, const Eigen::VectorXd& constants,
                     const Eigen::MatrixXd& P) {
  Eigen::MatrixXd order(P.rows(), layout.node_size() + layout.constants());
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(P.rows(), P.rows());
  order << layout.node_columns(one), layout.constant_columns(one);
  LinearPrior out{.node = node, .constants = constants, .A = whitening(order.transpose() * P * order), .b = {}};
  out.b.setZero(out.A.rows());
  return out;
}

const GraphNode* first_estimate_of(const ChainGraph& graph, std::size_t edge) {
  return edge == 0 && graph.prior.of_factors ? &graph.prior.node : nullptr;
}

FactorRows prior_rows(const GraphLayout& layout, const LinearPrior& prior, const GraphNode& node,
                      const Eigen::VectorXd& constants) {
  const Eigen::Index n = layout.node_size(), c = layout.constants();
  Eigen::VectorXd error(n + c);
  error << difference(prior.node, node), constants - prior.constants;
  FactorRows out;
  out.residual = prior.A * error + prior.b;
  out.by_first = prior.A.leftCols(n);
  // Log(R_0' R Exp(d)) = theta + Jr(theta)^-1 d.
  const Eigen::Matrix3d Jr_inverse = so3_right_jacobian(error.head<3>()).inverse();
  out.by_first.leftCols<3>() = (out.by_first.leftCols<3>() * Jr_inverse).eval();
  out.by_constants = prior.A.rightCols(c);
  return out;
}

FactorRows edge_rows(const GraphLayout& layout, const ImuFactor& edge, const GraphNode& first, const GraphNode& second,
                     const Eigen::VectorXd& constants, bool derivatives, const GraphNode* first_estimate) {
  if (first_estimate == nullptr || !derivatives) return edge.rows(layout, first, second, constants, derivatives);
  FactorRows out = edge.rows(layout, *first_estimate, second, constants, true);
  out.residual = edge.rows(layout, first, second, constants, false).residual;
  return out;
}

std::vector<Eigen::MatrixXd> marginal_covariances(const ChainGraph& graph, NodeMeasurements& measurements) {
  const std::size_t count = graph.nodes.size();
  std::vector<Rows> before{nothing(graph)};
  add_prior(graph, before.front());
  for (std::size_t k = 0; k + 1 < count; ++k) before.push_back(forwards(graph, measurements, k, before.back()));
  std::vector<Eigen::MatrixXd> out(count);
  Rows after = nothing(graph);
  for (std::size_t k = count; k-- > 0;) {
    out[k] = node_covariance(graph, measurements, k, before[k], after);
    if (k > 0) after = backwards(graph, measurements, k - 1, after);
  }
  return out;
}

Eigen::MatrixXd first_covariance(const ChainGraph& graph, NodeMeasurements& measurements) {
  Rows after = nothing(graph), before = nothing(graph);
  for (std::size_t k = graph.nodes.size() - 1; k-- > 0;) after = backwards(graph, measurements, k, after);
  add_prior(graph, before);
  return node_covariance(graph, measurements, 0, before, after);
}

void marginalize_first(ChainGraph& graph, NodeMeasurements& measurements) {
  CANYON_CHECK(graph.nodes.size() > 1, "the last node of a graph stays");
  Rows before = nothing(graph);
  add_prior(graph, before);
  const Rows next = forwards(graph, measurements, 0, before);
  graph.prior.A = next.J;
  graph.prior.b = next.r;
  graph.prior.node = graph.nodes[1];
  graph.prior.constants = graph.constants;
  graph.prior.of_factors = true;
  graph.nodes.erase(graph.nodes.begin());
  graph.edges.erase(graph.edges.begin());
  graph.measurements.erase(graph.measurements.begin());
}

}  // namespace canyon::fusion
