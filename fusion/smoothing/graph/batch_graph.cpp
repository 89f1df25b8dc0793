#include <algorithm>

#include "canyon/fusion/smoothing/graph/chain_builder.h"
#include "canyon/fusion/smoothing/graph/fixed_lag_graph.h"
#include "canyon/fusion/smoothing/graph/graph_parameters.h"
#include "canyon/fusion/smoothing/rts_smoother.h"
#include "canyon/fusion/smoothing/run_filter.h"

namespace canyon::fusion {
namespace {

/// Each round linearizes the IMU anew where its biases have moved; the second seldom finds one.
constexpr int kMostRounds = 4;
constexpr double kLagOfGuess_s = 10.0;

/// All nodes of a run at once, begun where the filter and its Rauch-Tung-Striebel smoother put them, or with switches
/// the graph of a lag.
class BatchGraph final : public Smoother {
 public:
  explicit BatchGraph(const GraphParameters& p) : p_(p) {}

  Result<Smoothed> smooth(const SmootherInput& run) override {
    CANYON_TRY(const auto samples, samples_of(run));
    ChainBuilder builder(run, samples, p_.graph_node_interval_s);
    std::vector<GraphNode> places;
    if (p_.graph_robustness == Robustness::kSwitchable) {
      CANYON_TRY(places, by_lag(run, samples, builder));
    } else {
      places = by_rts(run, samples, builder);
    }
    builder.graph().nodes.front() = places.front();
    for (std::size_t k = 1; !builder.done(); ++k) builder.add_node(&places[k]);
    if (p_.graph_robustness == Robustness::kSwitchable)
      set_switches(builder.graph(), builder.measurements(), p_.graph_switch_cost);
    for (int round = 0; round < kMostRounds; ++round) {
      CANYON_TRY_STATUS(solve(builder.graph(), builder.measurements(), solve_options(p_)));
      if (!builder.integrate_again()) break;
    }
    Smoothed out;
    const auto covariances = marginal_covariances(builder.graph(), builder.measurements());
    for (std::size_t k = 0; k < covariances.size(); ++k) {
      out.states.push_back(builder.smoothed(k, covariances[k]));
      for (const FixWeight& fix : builder.fix_weights(k)) out.fixes.push_back(fix);
    }
    return out;
  }

 private:
  /// Where a filter that takes every fix as it is has been far off, switches would follow it.
  Result<std::vector<GraphNode>> by_lag(const SmootherInput& run, std::span<const ImuSample> samples,
                                        ChainBuilder& builder) const {
    ChainBuilder first(run, samples, p_.graph_node_interval_s);
    std::vector<GraphNode> out;
    CANYON_TRY_STATUS(
        solve_with_lag(first, kLagOfGuess_s, solve_options(p_), [&] { out.push_back(first.graph().nodes.front()); }));
    for (const GraphNode& node : first.graph().nodes) out.push_back(node);
    builder.graph().constants = first.graph().constants;
    return out;
  }

  std::vector<GraphNode> by_rts(const SmootherInput& run, std::span<const ImuSample> samples,
                                ChainBuilder& builder) const {
    ErrorStateFilter filter = started_filter(run);
    RtsSmoother recorder;
    filter.watch(&recorder);
    recorder.keep(filter);
    std::size_t taken = 0, node = 0;
    run_filter(run, samples, filter, [&](const ImuSample&) {
      if (++taken != builder.ends()[node]) return;
      recorder.keep(filter);
      ++node;
    });
    const GraphLayout& layout = builder.graph().layout;
    std::vector<GraphNode> out;
    recorder.smooth([&](const SmoothedState& state, const Eigen::VectorXd& values, const Eigen::MatrixXd&) {
      if (out.empty()) builder.graph().constants = layout.constants_of(values);
      out.push_back({.nav = state.nav, .walking = layout.walking_of(values)});
    });
    std::reverse(out.begin(), out.end());
    return out;
  }

  GraphParameters p_;
};

}  // namespace

std::unique_ptr<Smoother> make_batch_graph(const ModelParameters& own) {
  return std::make_unique<BatchGraph>(own.get<GraphParameters>());
}

}  // namespace canyon::fusion
