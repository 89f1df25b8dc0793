#include <cmath>
#include <vector>

#include <ceres/ceres.h>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/process/progress.h"
#include "canyon/fusion/smoothing/graph/chain_solver.h"

namespace canyon::fusion {
namespace {

using Index = ErrorIndex;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A node as Ceres moves it: [w, x, y, z, p - origin, v, walking].
constexpr int kAttitude = 4;

/// Derivative J of the quaternion by a right perturbation, 4 x 3; of the perturbation by the quaternion it is 4 J'.
Eigen::Matrix<double, 4, 3> by_turn(const double* q) {
  const Eigen::Vector3d v(q[1], q[2], q[3]);
  Eigen::Matrix<double, 4, 3> out;
  out << -0.5 * v.transpose(), 0.5 * (q[0] * Eigen::Matrix3d::Identity() + skew(v));
  return out;
}

/// R_EU by right perturbation, the rest additive.
class NodeManifold final : public ceres::Manifold {
 public:
  explicit NodeManifold(int tangent) : tangent_(tangent) {}
  int AmbientSize() const override { return tangent_ + 1; }
  int TangentSize() const override { return tangent_; }
  bool Plus(const double* x, const double* delta, double* out) const override {
    const Eigen::Quaterniond turned =
        (Eigen::Quaterniond(x[0], x[1], x[2], x[3]) * so3_exp(Eigen::Vector3d(delta[0], delta[1], delta[2])))
            .normalized();
    out[0] = turned.w();
    out[1] = turned.x();
    out[2] = turned.y();
    out[3] = turned.z();
    for (int i = 3; i < tangent_; ++i) out[i + 1] = x[i + 1] + delta[i];
    return true;
  }
  bool PlusJacobian(const double* x, double* jacobian) const override {
    Eigen::Map<Rows> J(jacobian, tangent_ + 1, tangent_);
    J.setZero();
    J.topLeftCorner<4, 3>() = by_turn(x);
    J.bottomRightCorner(tangent_ - 3, tangent_ - 3).setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* out) const override {
    const Eigen::Vector3d theta =
        so3_log(Eigen::Quaterniond(x[0], x[1], x[2], x[3]).conjugate() * Eigen::Quaterniond(y[0], y[1], y[2], y[3]));
    for (int i = 0; i < 3; ++i) out[i] = theta[i];
    for (int i = 3; i < tangent_; ++i) out[i] = y[i + 1] - x[i + 1];
    return true;
  }
  bool MinusJacobian(const double* x, double* jacobian) const override {
    Eigen::Map<Rows> J(jacobian, tangent_, tangent_ + 1);
    J.setZero();
    J.topLeftCorner<3, 4>() = 4.0 * by_turn(x).transpose();
    J.bottomRightCorner(tangent_ - 3, tangent_ - 3).setIdentity();
    return true;
  }

 private:
  int tangent_;
};

/// The graph and the numbers that Ceres moves.
class Solution {
 public:
  Solution(ChainGraph& graph, NodeMeasurements& measurements)
      : graph_(graph), measurements_(measurements), origin_E_(graph.nodes.front().nav.p_EU_E) {
    for (const GraphNode& node : graph.nodes) {
      std::vector<double>& x = nodes_.emplace_back(static_cast<std::size_t>(graph.layout.node_size()) + 1);
      const Eigen::Quaterniond& R = node.nav.R_EU;
      Eigen::Map<Eigen::VectorXd> to(x.data(), static_cast<Eigen::Index>(x.size()));
      to << R.w(), R.x(), R.y(), R.z(), node.nav.p_EU_E - origin_E_, node.nav.v_EU_E, node.walking;
    }
    constants_.assign(graph.constants.data(), graph.constants.data() + graph.constants.size());
  }

  const ChainGraph& graph() const { return graph_; }
  NodeMeasurements& measurements() { return measurements_; }
  double* node(std::size_t k) { return nodes_[k].data(); }
  double* constants() { return constants_.data(); }

  GraphNode node_at(std::size_t k, const double* x) const {
    GraphNode out = graph_.nodes[k];
    out.nav.R_EU = Eigen::Quaterniond(x[0], x[1], x[2], x[3]);
    out.nav.p_EU_E = origin_E_ + Eigen::Vector3d(x[kAttitude], x[kAttitude + 1], x[kAttitude + 2]);
    out.nav.v_EU_E = Eigen::Vector3d(x[kAttitude + 3], x[kAttitude + 4], x[kAttitude + 5]);
    out.walking = Eigen::Map<const Eigen::VectorXd>(x + kAttitude + 6, out.walking.size());
    return out;
  }
  Eigen::VectorXd constants_at(const double* x) const {
    return x == nullptr ? Eigen::VectorXd() : Eigen::Map<const Eigen::VectorXd>(x, graph_.constants.size()).eval();
  }
  void take() {
    for (std::size_t k = 0; k < nodes_.size(); ++k) graph_.nodes[k] = node_at(k, nodes_[k].data());
    if (!constants_.empty()) graph_.constants = constants_at(constants_.data());
  }

 private:
  ChainGraph& graph_;
  NodeMeasurements& measurements_;
  Eigen::Vector3d origin_E_;
  std::vector<std::vector<double>> nodes_;
  std::vector<double> constants_;
};

/// A derivative by a node's error as one by its numbers: times the derivative of the manifold's minus.
void put_node(const Eigen::MatrixXd& by_error, const double* x, double* jacobian) {
  Eigen::Map<Rows> J(jacobian, by_error.rows(), by_error.cols() + 1);
  J.leftCols<4>() = by_error.leftCols<3>() * (4.0 * by_turn(x).transpose());
  J.rightCols(by_error.cols() - 3) = by_error.rightCols(by_error.cols() - 3);
}

void put(const Eigen::MatrixXd& by, double* jacobian) {
  Eigen::Map<Rows>(jacobian, by.rows(), by.cols()) = by;
}

/// Common to all factors: blocks of nodes, then of the constants if there are any.
class Factor : public ceres::CostFunction {
 protected:
  Factor(Solution& solution, int rows, int nodes) : solution_(solution) {
    set_num_residuals(rows);
    const GraphLayout& layout = solution.graph().layout;
    for (int i = 0; i < nodes; ++i) mutable_parameter_block_sizes()->push_back(layout.node_size() + 1);
    if (layout.constants() > 0) mutable_parameter_block_sizes()->push_back(layout.constants());
  }
  const double* constants(double const* const* x, std::size_t at) const {
    return solution_.graph().layout.constants() > 0 ? x[at] : nullptr;
  }
  void put_residual(const Eigen::VectorXd& r, double* residuals) const {
    Eigen::Map<Eigen::VectorXd>(residuals, r.size()) = r;
  }
  Solution& solution_;
};

/// What is known of the first node.
class PriorFactor final : public Factor {
 public:
  explicit PriorFactor(Solution& s) : Factor(s, static_cast<int>(s.graph().prior.b.size()), 1) {}
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const ChainGraph& graph = solution_.graph();
    const FactorRows rows =
        prior_rows(graph.layout, graph.prior, solution_.node_at(0, x[0]), solution_.constants_at(constants(x, 1)));
    put_residual(rows.residual, residuals);
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) put_node(rows.by_first, x[0], jacobians[0]);
    if (constants(x, 1) != nullptr && jacobians[1] != nullptr) put(rows.by_constants, jacobians[1]);
    return true;
  }
};

class EdgeFactor final : public Factor {
 public:
  EdgeFactor(Solution& s, std::size_t k) : Factor(s, s.graph().layout.node_size(), 2), k_(k) {}
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const ChainGraph& graph = solution_.graph();
    const FactorRows rows =
        edge_rows(graph.layout, graph.edges[k_], solution_.node_at(k_, x[0]), solution_.node_at(k_ + 1, x[1]),
                  solution_.constants_at(constants(x, 2)), jacobians != nullptr, first_estimate_of(graph, k_));
    put_residual(rows.residual, residuals);
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) put_node(rows.by_first, x[0], jacobians[0]);
    if (jacobians[1] != nullptr) put_node(rows.by_second, x[1], jacobians[1]);
    if (constants(x, 2) != nullptr && jacobians[2] != nullptr) put(rows.by_constants, jacobians[2]);
    return true;
  }

 private:
  std::size_t k_;
};

class MeasurementFactor final : public Factor {
 public:
  MeasurementFactor(Solution& s, std::size_t k, const NodeMeasurement& m)
      : Factor(s, static_cast<int>(m.whiten.rows()), 1), k_(k), m_(m) {}
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const FactorRows rows = solution_.measurements().rows(m_, solution_.graph().layout, solution_.node_at(k_, x[0]),
                                                          solution_.constants_at(constants(x, 1)));
    put_residual(rows.residual, residuals);
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) put_node(rows.by_first, x[0], jacobians[0]);
    if (constants(x, 1) != nullptr && jacobians[1] != nullptr) put(rows.by_constants, jacobians[1]);
    return true;
  }

 private:
  std::size_t k_;
  const NodeMeasurement& m_;
};

/// A switch s on rows of the square chi^2, where it is best: the least of s^2 chi^2 + cost (1 - s)^2 over s, which is
/// at s = cost / (cost + chi^2). As a variable of its own beside the nodes it has the same optimum and takes several
/// times the iterations, since the rows are then products of two unknowns.
class SwitchLoss final : public ceres::LossFunction {
 public:
  explicit SwitchLoss(double cost) : cost_(cost) {}
  void Evaluate(double squared, double out[3]) const override {
    const double s = cost_ / (cost_ + squared);
    out[0] = s * squared;
    out[1] = s * s;
    out[2] = -2.0 * s * s / (cost_ + squared);
  }

 private:
  double cost_;
};

class CancelCallback final : public ceres::IterationCallback {
 public:
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    return cancel_requested() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }
};

ceres::LossFunction* loss_of(const NodeMeasurement& m, const SolveOptions& options) {
  if (!m.of_position) return nullptr;
  if (options.robustness == Robustness::kHuber) return new ceres::HuberLoss(options.huber_sigma);
  if (options.robustness == Robustness::kSwitchable) return new SwitchLoss(options.switch_cost);
  return nullptr;
}

/// Square root of the weight that Huber's loss gives at the solution.
void set_huber_weights(ChainGraph& graph, NodeMeasurements& measurements, double sigma) {
  for (std::size_t k = 0; k < graph.nodes.size(); ++k)
    for (NodeMeasurement& m : graph.measurements[k]) {
      if (!m.of_position) continue;
      const double norm = measurements.rows(m, graph.layout, graph.nodes[k], graph.constants).residual.norm();
      m.weight = norm <= sigma ? 1.0 : std::sqrt(sigma / norm);
    }
}

}  // namespace

SolveReport solve_with_ceres(ChainGraph& graph, NodeMeasurements& measurements, const SolveOptions& options) {
  Solution solution(graph, measurements);
  ceres::Problem::Options ownership;
  ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  NodeManifold manifold(graph.layout.node_size());
  ceres::Problem problem(ownership);
  std::vector<double*> constants;
  if (graph.layout.constants() > 0) constants.push_back(solution.constants());
  const auto with_constants = [&](std::vector<double*> blocks) {
    blocks.insert(blocks.end(), constants.begin(), constants.end());
    return blocks;
  };
  for (std::size_t k = 0; k < graph.nodes.size(); ++k)
    problem.AddParameterBlock(solution.node(k), graph.layout.node_size() + 1, &manifold);
  problem.AddResidualBlock(new PriorFactor(solution), nullptr, with_constants({solution.node(0)}));
  for (std::size_t k = 0; k < graph.edges.size(); ++k)
    problem.AddResidualBlock(new EdgeFactor(solution, k), nullptr,
                             with_constants({solution.node(k), solution.node(k + 1)}));
  for (std::size_t k = 0; k < graph.nodes.size(); ++k)
    for (const NodeMeasurement& m : graph.measurements[k])
      problem.AddResidualBlock(new MeasurementFactor(solution, k, m), loss_of(m, options),
                               with_constants({solution.node(k)}));

  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  solver.num_threads = 1;
  solver.logging_type = ceres::SILENT;
  solver.max_num_iterations = options.most_iterations;
  solver.initial_trust_region_radius = 1e12;  // the initial estimate is good: begin with Gauss and Newton's step
  solver.max_trust_region_radius = 1e20;
  solver.function_tolerance = options.least_gain;
  solver.gradient_tolerance = 1e-12;
  solver.parameter_tolerance = 1e-13;
  CancelCallback cancel;
  solver.callbacks.push_back(&cancel);
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  throw_if_cancelled();
  solution.take();
  if (options.robustness == Robustness::kHuber) set_huber_weights(graph, measurements, options.huber_sigma);
  if (options.robustness == Robustness::kSwitchable) set_switches(graph, measurements, options.switch_cost);
  return {.iterations = static_cast<int>(summary.iterations.size()) - 1,
          .initial_cost = summary.initial_cost,
          .final_cost = summary.final_cost,
          .converged = summary.termination_type == ceres::CONVERGENCE};
}

extern "C" const FactorGraphPart canyon_factor_graph_part{solve_with_ceres};

}  // namespace canyon::fusion
