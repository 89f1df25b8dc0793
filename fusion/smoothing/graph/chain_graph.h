#pragma once

#include <vector>

#include <Eigen/Core>

#include "canyon/fusion/smoothing/graph/graph_layout.h"
#include "canyon/fusion/smoothing/graph/imu_factor.h"
#include "canyon/fusion/smoothing/graph/node_measurements.h"

namespace canyon::fusion {

/// What is known of a node and of the constants beside the factors: A [node_now - node; constants_now - constants] + b,
/// in units of 1-sigma. Linearized where it was made, once and for all.
struct LinearPrior {
  GraphNode node;
  Eigen::VectorXd constants;
  Eigen::MatrixXd A;
  Eigen::VectorXd b;
  bool of_factors = false;  ///< stands for factors that left the graph
};

/// A factor graph over time: nodes in turn, between each and the next the IMU, at each its measurements, a prior on the
/// first. Every factor may also depend on the constants of the graph.
struct ChainGraph {
  GraphLayout layout;
  LinearPrior prior;
  Eigen::VectorXd constants;
  std::vector<GraphNode> nodes;
  std::vector<ImuFactor> edges;                            ///< one less than nodes
  std::vector<std::vector<NodeMeasurement>> measurements;  ///< as many as nodes
};

/// The prior of a Gaussian with that covariance of all states of the filter, [theta, p, v, values].
LinearPrior prior_of(const GraphLayout& layout, const GraphNode& node, const Eigen::VectorXd& constants,
                     const Eigen::MatrixXd& P);

/// Where the first edge is linearized; null: where its first node is.
const GraphNode* first_estimate_of(const ChainGraph& graph, std::size_t edge);
/// Rows of the prior (first: the node) and of an edge. Where the prior stands for factors that left, those of the
/// first edge are linearized where it is (first estimates: Huang, Mourikis & Roumeliotis 2010, Int. J. Robotics
/// Research 29(5)), so that what left the graph and what is still in it agree about what was measured.
FactorRows prior_rows(const GraphLayout& layout, const LinearPrior& prior, const GraphNode& node,
                      const Eigen::VectorXd& constants);
/// `first_estimate`: of the first node, where the derivatives are taken; null: where it is.
FactorRows edge_rows(const GraphLayout& layout, const ImuFactor& edge, const GraphNode& first, const GraphNode& second,
                     const Eigen::VectorXd& constants, bool derivatives, const GraphNode* first_estimate);

/// Covariance of [theta, p, v, walking] of each node, given everything in the graph, linearized where it is, with the
/// weights that the measurements have: eliminates the chain from both sides, in time and memory proportional to its
/// length.
std::vector<Eigen::MatrixXd> marginal_covariances(const ChainGraph& graph, NodeMeasurements& measurements);
/// The same of the first node alone.
Eigen::MatrixXd first_covariance(const ChainGraph& graph, NodeMeasurements& measurements);

/// Takes the first node out: what it and its factors say of the next becomes the prior there (the Schur complement, by
/// orthogonal transformations of the rows).
void marginalize_first(ChainGraph& graph, NodeMeasurements& measurements);

}  // namespace canyon::fusion
