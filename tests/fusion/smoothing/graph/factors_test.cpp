// Derivatives of every factor against differences, and what is done with their rows against the whole system at once.
#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "canyon/core/motion/rotation.h"
#include "canyon/fusion/smoothing/graph/chain_builder.h"
#include "canyon/fusion/smoothing/graph/chain_solver.h"
#include "canyon/fusion/stress/simulated_drive.h"

namespace canyon::fusion {
namespace {

/// Gains are constants of the graph, biases wander from node to node; all measurements that a graph takes, of a vehicle
/// that is not one.
constexpr const char* kKeys =
    "states = [\"biases\", \"gains\", \"mounting\", \"wheel_scale\", \"fix_error\"]\n"
    "measurements = [\"position\", \"velocity\", \"non_holonomic\", \"odometer\"]";

/// The drive with what its other sensors say.
struct Aided {
  Drive drive;
  std::vector<OdometerSample> odometer;
  Aided() : drive(simulated_drive(2, {.seconds = 6.0, .outage_from_s = 1e9, .keys = kKeys})) {
    for (GnssFix& fix : drive.fixes) {
      fix.v_A_E = drive.truth[static_cast<std::size_t>(std::lround(50.0 * (fix.t - drive.start)))].v_EU_E;
      fix.velocity_covariance_E = 0.01 * Eigen::Matrix3d::Identity();
    }
    for (const ImuSample& imu : drive.imu) {
      const NavState& at = drive.truth[static_cast<std::size_t>(&imu - drive.imu.data()) + 1];
      odometer.push_back(
          {.t = imu.t, .dt_s = imu.dt_s, .ticks = 0, .speed_m_s = (at.R_EU.conjugate() * at.v_EU_E).x()});
    }
  }
  SmootherInput input() const {
    SmootherInput in = drive.input();
    in.odometer = odometer;
    return in;
  }
};

ChainBuilder built(const Aided& aided) {
  const SmootherInput in = aided.input();
  ChainBuilder builder(in, *samples_of(in), 1.0);
  while (!builder.done()) builder.add_node();
  // Away from where everything was linearized.
  for (GraphNode& node : builder.graph().nodes) {
    Eigen::VectorXd error(builder.graph().layout.node_size());
    for (Eigen::Index i = 0; i < error.size(); ++i) error[i] = 1e-3 * std::sin(static_cast<double>(i) + 1.0);
    node = moved(node, error);
  }
  builder.graph().constants.setConstant(1e-3);
  return builder;
}

/// rad, m, m/s and what the values have: 16 m beside 6.4e6 m, so that what is rounded there is 1e-10 of the step.
Eigen::VectorXd node_steps(Eigen::Index size) {
  Eigen::VectorXd out = Eigen::VectorXd::Constant(size, 1e-4);
  out.segment<3>(3).setConstant(16.0);
  out.segment<3>(6).setConstant(0.5);
  return out;
}
Eigen::VectorXd constant_steps(Eigen::Index size) {
  return Eigen::VectorXd::Constant(size, 1e-4);
}

/// Central differences of a residual by an error.
template <class Residual>
Eigen::MatrixXd differences(const Eigen::VectorXd& steps, const Residual& residual) {
  Eigen::MatrixXd out;
  for (Eigen::Index i = 0; i < steps.size(); ++i) {
    const Eigen::VectorXd step = steps[i] * Eigen::VectorXd::Unit(steps.size(), i);
    const Eigen::VectorXd column = (residual(step) - residual(-step)) / (2.0 * steps[i]);
    if (out.size() == 0) out.resize(column.size(), steps.size());
    out.col(i) = column;
  }
  return out;
}

/// What the rounding of a residual of a hundred sigma makes of the least step.
constexpr double kRounding = 1e-10;
/// The same of a residual that is a difference of two positions in E, half a metre being a sigma.
constexpr double kRoundingOfPlace = 1.4e-9 / 0.5 / 1e-4;

/// To 1e-7 of the largest derivative in the same row.
void expect_same(const Eigen::MatrixXd& exact, const Eigen::MatrixXd& numeric, const char* what,
                 double rounding = kRounding) {
  ASSERT_EQ(exact.rows(), numeric.rows());
  ASSERT_EQ(exact.cols(), numeric.cols());
  for (Eigen::Index i = 0; i < exact.rows(); ++i) {
    const double scale = exact.row(i).cwiseAbs().maxCoeff();
    EXPECT_LE((exact.row(i) - numeric.row(i)).cwiseAbs().maxCoeff(), 1e-7 * scale + rounding) << what << ", row " << i;
  }
}

TEST(Factors, DerivativesAreThoseOfDifferences) {
  const Aided aided;
  ChainBuilder builder = built(aided);
  ChainGraph& graph = builder.graph();
  const GraphLayout& layout = graph.layout;
  const GraphNode &a = graph.nodes[2], &b = graph.nodes[3];
  const Eigen::VectorXd& c = graph.constants;
  ASSERT_EQ(layout.node_size(), 9 + 6 + 3 + 3);  // biases, mounting, fix_error
  ASSERT_EQ(layout.constants(), 6 + 1);          // scale factors, of the wheel too; the unit has no misalignments

  const ImuFactor& edge = graph.edges[2];
  const FactorRows rows = edge.rows(layout, a, b, c, true);
  const auto edge_at = [&](const GraphNode& i, const GraphNode& j, const Eigen::VectorXd& constants) {
    return edge.rows(layout, i, j, constants, false).residual;
  };
  const Eigen::VectorXd n = node_steps(layout.node_size()), m_c = constant_steps(c.size());
  expect_same(rows.by_first, differences(n, [&](const auto& e) { return edge_at(moved(a, e), b, c); }), "IMU, first");
  expect_same(rows.by_second, differences(n, [&](const auto& e) { return edge_at(a, moved(b, e), c); }), "IMU, second");
  expect_same(rows.by_constants, differences(m_c, [&](const auto& e) { return edge_at(a, b, c + e); }),
              "IMU, constants");

  NodeMeasurements& measurements = builder.measurements();
  ASSERT_EQ(graph.measurements[3].size(), 4u);
  for (const NodeMeasurement& m : graph.measurements[3]) {
    const FactorRows at = measurements.rows(m, layout, b, c);
    expect_same(at.by_first,
                differences(n, [&](const auto& e) { return measurements.rows(m, layout, moved(b, e), c).residual; }),
                "measurement, node", m.of_position ? kRoundingOfPlace : kRounding);
    expect_same(at.by_constants,
                differences(m_c, [&](const auto& e) { return measurements.rows(m, layout, b, c + e).residual; }),
                "measurement, constants");
  }

  LinearPrior prior = graph.prior;
  prior.node.nav.R_EU = (prior.node.nav.R_EU * so3_exp(Eigen::Vector3d(0.1, -0.2, 0.3))).normalized();
  const GraphNode& first = graph.nodes.front();
  const FactorRows known = prior_rows(layout, prior, first, c);
  expect_same(known.by_first,
              differences(n, [&](const auto& e) { return prior_rows(layout, prior, moved(first, e), c).residual; }),
              "prior, node");
  expect_same(known.by_constants,
              differences(m_c, [&](const auto& e) { return prior_rows(layout, prior, first, c + e).residual; }),
              "prior, constants");
}

/// Normal equations of all nodes and the constants.
Eigen::MatrixXd whole_information(ChainBuilder& builder) {
  const ChainGraph& graph = builder.graph();
  const Eigen::Index n = graph.layout.node_size(), c = graph.layout.constants(),
                     nodes = static_cast<Eigen::Index>(graph.nodes.size());
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(nodes * n + c, nodes * n + c);
  const auto add = [&](Eigen::Index first, const FactorRows& rows, double weight) {
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(rows.residual.size(), H.cols());
    J.middleCols(first * n, n) = rows.by_first;
    if (rows.by_second.size() > 0) J.middleCols((first + 1) * n, n) = rows.by_second;
    J.rightCols(c) = rows.by_constants;
    H += weight * weight * J.transpose() * J;
  };
  add(0, prior_rows(graph.layout, graph.prior, graph.nodes.front(), graph.constants), 1.0);
  for (Eigen::Index k = 0; k < nodes; ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (k + 1 < nodes)
      add(k,
          edge_rows(graph.layout, graph.edges[at], graph.nodes[at], graph.nodes[at + 1], graph.constants, true,
                    first_estimate_of(graph, at)),
          1.0);
    for (const NodeMeasurement& m : graph.measurements[at])
      add(k, builder.measurements().rows(m, graph.layout, graph.nodes[at], graph.constants), m.weight);
  }
  return H;
}

/// Relative to the sigmas of rows and columns.
double off(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const Eigen::VectorXd unit = b.diagonal().cwiseSqrt().cwiseInverse();
  return (unit.asDiagonal() * (a - b) * unit.asDiagonal()).cwiseAbs().maxCoeff();
}

// Node by node from both sides, as the inverse of the whole; with weights that are not one. Rounding: eps times the
// condition of the scaled normal equations, some 1e9.
TEST(ChainGraph, MarginalsAreThoseOfTheWholeSystem) {
  const Aided aided;
  ChainBuilder builder = built(aided);
  builder.graph().measurements[2][0].weight = 0.3;
  const Eigen::MatrixXd H = whole_information(builder);
  const Eigen::VectorXd unit = H.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = unit.asDiagonal() * H * unit.asDiagonal();
  const Eigen::MatrixXd inverse = unit.asDiagonal() * scaled.inverse() * unit.asDiagonal();
  const auto marginals = marginal_covariances(builder.graph(), builder.measurements());
  const int n = builder.graph().layout.node_size();
  for (std::size_t k = 0; k < marginals.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k) * n;
    EXPECT_LT(off(marginals[k], inverse.block(at, at, n, n)), 1e-6) << k;
  }
  EXPECT_LT(off(first_covariance(builder.graph(), builder.measurements()), inverse.topLeftCorner(n, n)), 1e-6);
}

// A node that leaves a graph which is solved changes neither where the others are nor how well they are known.
TEST(ChainGraph, WhatLeavesItStaysKnown) {
  const Aided aided;
  const SmootherInput in = aided.input();
  ChainBuilder builder(in, *samples_of(in), 1.0);
  while (!builder.done()) builder.add_node();
  const SolveOptions options{.most_iterations = 50};
  ASSERT_TRUE(solve(builder.graph(), builder.measurements(), options).ok());
  const auto covariances = marginal_covariances(builder.graph(), builder.measurements());
  const std::vector<GraphNode> nodes = builder.graph().nodes;
  for (int left = 1; left <= 3; ++left) {
    builder.marginalize_first();
    ASSERT_TRUE(solve(builder.graph(), builder.measurements(), options).ok());
    const auto now = marginal_covariances(builder.graph(), builder.measurements());
    for (std::size_t k = 0; k < now.size(); ++k) {
      const Eigen::MatrixXd& P = covariances[k + static_cast<std::size_t>(left)];
      const Eigen::VectorXd moved_by = difference(nodes[k + static_cast<std::size_t>(left)], builder.graph().nodes[k])
                                           .cwiseQuotient(P.diagonal().cwiseSqrt());
      // The solver stops where a step gains 1e-9 of the cost, of a few hundred: 1e-3 sigma.
      EXPECT_LT(moved_by.cwiseAbs().maxCoeff(), 1e-3) << left << " " << k;
      EXPECT_LT(off(now[k], P), 1e-3) << left << " " << k;
    }
  }
}

}  // namespace
}  // namespace canyon::fusion
