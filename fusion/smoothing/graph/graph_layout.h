#pragma once

#include <vector>

#include <Eigen/Core>

#include "canyon/fusion/error_state.h"

namespace canyon::fusion {

/// State at one instant of a factor graph: motion of the IMU, and the values of the filter's states that wander.
struct GraphNode {
  NavState nav;
  Eigen::VectorXd walking;
};

/// The node with an error [theta, p, v, walking] added, as the filter injects it; and the error of `to` as seen from
/// `from`.
GraphNode moved(const GraphNode& node, const Eigen::Ref<const Eigen::VectorXd>& error);
Eigen::VectorXd difference(const GraphNode& from, const GraphNode& to);

/// Where the states of a filter are in a graph: what noise drives is in each node, what only starts uncertain and never
/// changes once in the graph, and what is known to be zero nowhere.
class GraphLayout {
 public:
  explicit GraphLayout(const ErrorState& state);

  int states() const { return states_; }
  int node_size() const { return ErrorIndex::kMoving + static_cast<int>(walking_.size()); }
  int constants() const { return static_cast<int>(constant_.size()); }
  const std::vector<int>& walking() const { return walking_; }
  const std::vector<int>& constant() const { return constant_; }

  /// Values of the filter's states after its first nine, and the parts of such a vector.
  Eigen::VectorXd values(const Eigen::VectorXd& walking, const Eigen::VectorXd& constants) const;
  Eigen::VectorXd walking_of(const Eigen::VectorXd& values) const;
  Eigen::VectorXd constants_of(const Eigen::VectorXd& values) const;

  /// Columns of the filter's n states that belong to a node, and to the constants.
  Eigen::MatrixXd node_columns(const Eigen::MatrixXd& columns) const;
  Eigen::MatrixXd constant_columns(const Eigen::MatrixXd& columns) const;

 private:
  int states_;
  std::vector<int> walking_, constant_;  // of the filter's states
};

}  // namespace canyon::fusion
