#include "canyon/fusion/smoothing/graph/fixed_lag_graph.h"

#include <algorithm>

#include "canyon/fusion/smoothing/graph/graph_parameters.h"
#include "canyon/fusion/smoothing/run_filter.h"
#include "canyon/fusion/smoothing/smoother.h"

namespace canyon::fusion {
namespace {

struct FixedLagParameters {
  double graph_lag_s = 10.0;
};
void visit(FieldVisitor& f, FixedLagParameters& p) {
  f.number("graph_lag_s", p.graph_lag_s, {0.01, 3600}, "how far back the graph reaches");
}

/// The nodes of the last seconds, solved again with each new one; what gets older is told, and leaves a prior on the
/// next (marginalize_first).
class FixedLagGraph final : public Smoother {
 public:
  FixedLagGraph(const GraphParameters& p, const FixedLagParameters& lag) : p_(p), lag_s_(lag.graph_lag_s) {}

  Result<Smoothed> smooth(const SmootherInput& run) override {
    CANYON_TRY(const auto samples, samples_of(run));
    ChainBuilder builder(run, samples, p_.graph_node_interval_s);
    Smoothed out;
    const auto tell = [&](std::size_t k, const Eigen::MatrixXd& P) {
      out.states.push_back(builder.smoothed(k, P));
      for (const FixWeight& fix : builder.fix_weights(k)) out.fixes.push_back(fix);
    };
    CANYON_TRY_STATUS(solve_with_lag(builder, lag_s_, solve_options(p_),
                                     [&] { tell(0, first_covariance(builder.graph(), builder.measurements())); }));
    const auto covariances = marginal_covariances(builder.graph(), builder.measurements());
    for (std::size_t k = 0; k < covariances.size(); ++k) tell(k, covariances[k]);
    return out;
  }

 private:
  GraphParameters p_;
  double lag_s_;
};

/// What a step gains of the cost, when it is the last. Of a few dozen, 1e-6 are less than 0.01 sigma, and the next node
/// goes on from there.
constexpr double kLeastGain = 1e-6;

}  // namespace

Status solve_with_lag(ChainBuilder& builder, double lag_s, const SolveOptions& wanted,
                      const std::function<void()>& leaves) {
  SolveOptions options = wanted;
  options.least_gain = std::max(wanted.least_gain, kLeastGain);
  ChainGraph& graph = builder.graph();
  while (!builder.done()) {
    builder.add_node();
    CANYON_TRY_STATUS(solve(graph, builder.measurements(), options));
    builder.integrate_again();
    while (graph.nodes.size() > 1 && graph.nodes.back().nav.t - graph.nodes.front().nav.t > lag_s) {
      leaves();
      builder.marginalize_first();
    }
  }
  return Ok{};
}

std::unique_ptr<Smoother> make_fixed_lag_graph(const ModelParameters& own) {
  return std::make_unique<FixedLagGraph>(own.get<GraphParameters>(), own.get<FixedLagParameters>());
}

void fixed_lag_graph_parameters(ModelParameters& section) {
  graph_parameters(section);
  section.add<FixedLagParameters>();
}

}  // namespace canyon::fusion
