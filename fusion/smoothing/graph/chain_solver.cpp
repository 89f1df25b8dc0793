#include "canyon/fusion/smoothing/graph/chain_solver.h"

#include <algorithm>

namespace canyon::fusion {
namespace {

constexpr ModelRow<Robustness> kKinds[] = {
    {"none", Robustness::kNone, "every fix counts as it says"},
    {"huber", Robustness::kHuber, "far off, a fix counts by its distance and no longer by its square"},
    {"switchable", Robustness::kSwitchable, "each fix has a switch, which is estimated with the rest"},
};

/// From one step of what switching off costs to the next, and the iterations at each but the last.
constexpr double kHarder = 4.0;
constexpr int kRoughly = 3;

/// Every fix's position with its squared, normalized residual.
template <class Take>
void for_each_position(ChainGraph& graph, NodeMeasurements& measurements, const Take& take) {
  for (std::size_t k = 0; k < graph.nodes.size(); ++k)
    for (NodeMeasurement& m : graph.measurements[k])
      if (m.of_position)
        take(m, measurements.rows(m, graph.layout, graph.nodes[k], graph.constants).residual.squaredNorm());
}

}  // namespace

ModelTable<Robustness> robustness_kinds() {
  return kKinds;
}

void set_switches(ChainGraph& graph, NodeMeasurements& measurements, double switch_cost) {
  for_each_position(graph, measurements,
                    [&](NodeMeasurement& m, double squared) { m.weight = switch_cost / (switch_cost + squared); });
}

#ifdef CANYON_WITH_CERES

Result<SolveReport> solve(ChainGraph& graph, NodeMeasurements& measurements, const SolveOptions& options) {
  const FactorGraphPart& part = library_part("factor_graph", &canyon_factor_graph_part);
  if (options.robustness != Robustness::kSwitchable) return part.solve(graph, measurements, options);
  bool conflict = false;
  double worst = 0.0;
  for_each_position(graph, measurements, [&](const NodeMeasurement& m, double squared) {
    conflict = conflict || (m.weight > 0.5 && squared > options.switch_cost);
    worst = std::max(worst, squared);
  });
  if (conflict) {
    SolveOptions easier = options;
    easier.most_iterations = kRoughly;
    for (double ease = 2.0 * worst / options.switch_cost; ease > 1.0; ease /= kHarder) {
      easier.switch_cost = ease * options.switch_cost;
      part.solve(graph, measurements, easier);
    }
  }
  return part.solve(graph, measurements, options);
}

#else

Result<SolveReport> solve(ChainGraph&, NodeMeasurements&, const SolveOptions&) {
  return Error{.what = "this build has no factor graphs", .expected = "a build with CANYON_WITH_CERES=ON"};
}

#endif

}  // namespace canyon::fusion
