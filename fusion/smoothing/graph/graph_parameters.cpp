#include "canyon/fusion/smoothing/graph/graph_parameters.h"

#include "canyon/core/model_choice.h"
#include "canyon/fusion/smoothing/smoother.h"

namespace canyon::fusion {

void visit(FieldVisitor& f, GraphParameters& p) {
  f.number("graph_node_interval_s", p.graph_node_interval_s, {0.01, 60},
           "between nodes of the graph where no fix makes one");
  f.choice("graph_robustness", p.graph_robustness, robustness_kinds(),
           with_rows("what guards the graph against fixes that are far off", robustness_kinds()).c_str());
  f.number("graph_switch_cost", p.graph_switch_cost, {0.01, 1e6},
           "squared normalized residual that switching a fix off costs; three axes exceed 30 once in 7e5");
  f.number("graph_huber_sigma", p.graph_huber_sigma, {0.1, 1e3},
           "normalized residual of a fix from which on its distance counts");
}

SolveOptions solve_options(const GraphParameters& p) {
  return {.robustness = p.graph_robustness, .switch_cost = p.graph_switch_cost, .huber_sigma = p.graph_huber_sigma};
}

void graph_parameters(ModelParameters& section) {
  section.add<GraphParameters>();
}

}  // namespace canyon::fusion
