#pragma once

#include "canyon/core/config/config.h"
#include "canyon/fusion/smoothing/graph/chain_solver.h"

namespace canyon::fusion {

/// What both factor graphs are told.
struct GraphParameters {
  double graph_node_interval_s = 1.0;
  Robustness graph_robustness = Robustness::kNone;
  double graph_switch_cost = 30.0;
  double graph_huber_sigma = 3.0;
};
void visit(FieldVisitor& f, GraphParameters& p);
SolveOptions solve_options(const GraphParameters& p);

}  // namespace canyon::fusion
