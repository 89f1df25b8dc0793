#pragma once

#include <span>
#include <vector>

#include "canyon/fusion/smoothing/graph/chain_graph.h"
#include "canyon/fusion/smoothing/run_filter.h"
#include "canyon/fusion/smoothing/smoother.h"

namespace canyon::fusion {

/// Makes the graph of a run, node by node: one at the start, one at the sample that comes with a fix, and one wherever
/// none has been for `node_interval_s`. Each has the filter's measurements of what came with its sample.
class ChainBuilder {
 public:
  ChainBuilder(const SmootherInput& run, std::span<const ImuSample> samples, double node_interval_s);

  ChainGraph& graph() { return graph_; }
  NodeMeasurements& measurements() { return measurements_; }

  /// How many samples there are before each node to come.
  const std::vector<std::size_t>& ends() const { return ends_; }
  bool done() const { return next_ == ends_.size(); }
  /// Adds the next node, where its predecessor and the IMU say that it is, or at `place`.
  void add_node(const GraphNode* place = nullptr);

  /// Integrates edges anew whose states have moved too far for a first-order change; whether there were any.
  bool integrate_again();
  /// Takes the first node out of the graph, with all that came before it.
  void marginalize_first();

  /// Node k with its covariance, and the fixes that the graph now holds.
  SmoothedState smoothed(std::size_t k, const Eigen::MatrixXd& P);
  std::vector<FixWeight> fix_weights(std::size_t k) const;

 private:
  struct Between {
    std::size_t first = 0, count = 0;  // samples
  };
  ImuFactor edge(const Between& between, const GraphNode& from);
  void measure(std::size_t end);

  double node_interval_s_;
  std::span<const ImuSample> samples_;
  Preintegrator preintegrator_;
  NodeMeasurements measurements_;
  ChainGraph graph_;
  std::vector<std::size_t> ends_;
  std::vector<std::vector<GnssFix>> fixes_;  // with each sample of ends_
  std::vector<std::vector<OdometerSample>> odometer_;
  std::size_t next_ = 0;
  std::vector<Between> between_;  // of each edge
};

}  // namespace canyon::fusion
