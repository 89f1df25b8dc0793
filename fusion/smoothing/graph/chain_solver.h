#pragma once

#include "canyon/core/process/library_part.h"
#include "canyon/core/result.h"
#include "canyon/fusion/smoothing/graph/chain_graph.h"

namespace canyon::fusion {

/// What guards against fixes that have nothing to do with where the antenna is.
enum class Robustness { kNone, kHuber, kSwitchable };
ModelTable<Robustness> robustness_kinds();

struct SolveOptions {
  int most_iterations = 20;
  double least_gain = 1e-9;  ///< of the cost, relative; a step that gains less is the last
  Robustness robustness = Robustness::kNone;
  /// Switchable constraints: what it costs to switch a fix off, in the units of a squared, normalized residual; 1 /
  /// Xi^-1 of Sunderhauf & Protzel. An outlier then costs no more than this.
  double switch_cost = 30.0;
  /// Huber: from this normalized residual on, the norm counts and not its square.
  double huber_sigma = 3.0;
};

struct SolveReport {
  int iterations = 0;
  double initial_cost = 0.0, final_cost = 0.0;  ///< half the sum of squares
  bool converged = false;
};

/// Sets all switches to where they end if nothing else moves: what is least of s^2 chi^2 + cost (1 - s)^2.
void set_switches(ChainGraph& graph, NodeMeasurements& measurements, double switch_cost);

/// Moves nodes and constants to where the sum of squares is least, and sets the weights of the measurements of
/// position. Where a fix that is believed and the others do not go together, which of them is wrong cannot be seen from
/// where the graph is: after a gap the graph may be what is wrong. With switches all are then believed again, and what
/// switching off costs goes down, step by step, from where the sum of squares has one minimum (graduated non-convexity:
/// Yang, Antonante, Tzoumas & Carlone 2020, IEEE Robotics and Automation Letters 5(2)). An Error in a build without
/// Ceres.
Result<SolveReport> solve(ChainGraph& graph, NodeMeasurements& measurements, const SolveOptions& options);

/// Levenberg-Marquardt of Ceres on one thread, so that the same graph gives the same bits on any machine of a kind.
SolveReport solve_with_ceres(ChainGraph& graph, NodeMeasurements& measurements, const SolveOptions& options);
/// What stands on Ceres (core/process/library_part.h).
struct FactorGraphPart {
  decltype(&solve_with_ceres) solve;
};
extern "C" [[gnu::weak]] const FactorGraphPart canyon_factor_graph_part;

}  // namespace canyon::fusion
