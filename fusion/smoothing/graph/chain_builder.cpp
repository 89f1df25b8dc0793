#include "canyon/fusion/smoothing/graph/chain_builder.h"

#include <utility>

namespace canyon::fusion {
namespace {

/// A change of the rotation between two nodes, from which the first order of its effect is not enough: what it leaves
/// out is half its square, 5e-9 rad.
constexpr double kFarther_rad = 1e-4;

bool has_fix(std::span<const GnssFix> fixes) {
  for (const GnssFix& fix : fixes)
    if (fix.status != FixStatus::kNone) return true;
  return false;
}

}  // namespace

ChainBuilder::ChainBuilder(const SmootherInput& run, std::span<const ImuSample> samples, double node_interval_s)
    : node_interval_s_(node_interval_s),
      samples_(samples),
      preintegrator_(run.config, run.noise),
      measurements_(run.config, run.noise, run.frame, run.lever_U_B, run.lever_A_B),
      graph_{.layout = GraphLayout(measurements_.state()),
             .prior = {},
             .constants = {},
             .nodes = {},
             .edges = {},
             .measurements = {}} {
  Queue fixes(run.fixes);
  Queue odometer(run.odometer);
  fixes.begin(samples.front());
  odometer.begin(samples.front());
  double since_s = 0.0;
  std::vector<OdometerSample> counted;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto here = fixes.with(samples, i);
    for (const OdometerSample& sample : odometer.with(samples, i)) counted.push_back(sample);
    since_s += samples[i].dt_s;
    if (!has_fix(here) && since_s < (1.0 - 1e-9) * node_interval_s_ && i + 1 < samples.size()) continue;
    since_s = 0.0;
    ends_.push_back(i + 1);
    fixes_.emplace_back(here.begin(), here.end());
    odometer_.push_back(std::exchange(counted, {}));
  }

  const ErrorStateFilter filter = started_filter(run);
  graph_.constants.setZero(graph_.layout.constants());
  const Eigen::VectorXd walking = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(graph_.layout.walking().size()));
  graph_.nodes.push_back({.nav = filter.nav_state(), .walking = walking});
  graph_.measurements.emplace_back();
  graph_.prior = prior_of(graph_.layout, graph_.nodes.front(), graph_.constants, filter.covariance());
}

ImuFactor ChainBuilder::edge(const Between& between, const GraphNode& from) {
  const ImuSample* before = between.first > 0 ? &samples_[between.first - 1] : nullptr;
  const PreintegratedImu imu = preintegrator_.integrate(samples_.subspan(between.first, between.count), before,
                                                        graph_.layout.values(from.walking, graph_.constants));
  return {graph_.layout, imu, from.nav.p_EU_E};
}

void ChainBuilder::add_node(const GraphNode* place) {
  const std::size_t end = ends_[next_], first = next_ > 0 ? ends_[next_ - 1] : 0;
  between_.push_back({.first = first, .count = end - first});
  graph_.edges.push_back(edge(between_.back(), graph_.nodes.back()));
  graph_.nodes.push_back(
      place != nullptr ? *place : graph_.edges.back().predict(graph_.layout, graph_.nodes.back(), graph_.constants));
  graph_.nodes.back().nav.t = samples_[end - 1].t;
  graph_.measurements.emplace_back();
  measure(end);
  ++next_;
}

void ChainBuilder::measure(std::size_t end) {
  const ImuSample& imu = samples_[end - 1];
  const GraphNode& node = graph_.nodes.back();
  std::vector<NodeMeasurement>& to = graph_.measurements.back();
  const auto take = [&](std::vector<NodeMeasurement> all) {
    for (NodeMeasurement& m : all) to.push_back(std::move(m));
  };
  for (const GnssFix& fix : fixes_[next_]) take(measurements_.of_fix(fix, imu, graph_.layout, node, graph_.constants));
  if (!odometer_[next_].empty())
    take(measurements_.of_odometer(odometer_[next_], imu, graph_.layout, node, graph_.constants));
  take(measurements_.of_motion(imu, graph_.layout, node, graph_.constants));
}

bool ChainBuilder::integrate_again() {
  bool any = false;
  for (std::size_t k = 0; k < graph_.edges.size(); ++k) {
    const PreintegratedImu& imu = graph_.edges[k].imu();
    const Eigen::VectorXd change = graph_.layout.values(graph_.nodes[k].walking, graph_.constants) - imu.values;
    if ((imu.by_values.topRows<3>() * change).norm() < kFarther_rad) continue;
    graph_.edges[k] = edge(between_[k], graph_.nodes[k]);
    any = true;
  }
  return any;
}

void ChainBuilder::marginalize_first() {
  fusion::marginalize_first(graph_, measurements_);
  between_.erase(between_.begin());
}

SmoothedState ChainBuilder::smoothed(std::size_t k, const Eigen::MatrixXd& P) {
  const GraphNode& node = graph_.nodes[k];
  const std::size_t in_all = next_ + 1 - graph_.nodes.size() + k;  // counted from the first there ever was
  const ImuSample& imu = samples_[in_all > 0 ? ends_[in_all - 1] - 1 : 0];
  const Calibration known = measurements_.calibration(graph_.layout, node, graph_.constants);
  return {.nav = node.nav,
          .w_EU_U = measurements_.angular_rate(imu, graph_.layout, node, graph_.constants),
          .gyro_bias_U = known.gyro_bias,
          .accel_bias_U = known.accel_bias,
          .covariance = P.topLeftCorner<9, 9>()};
}

std::vector<FixWeight> ChainBuilder::fix_weights(std::size_t k) const {
  std::vector<FixWeight> out;
  for (const NodeMeasurement& m : graph_.measurements[k])
    if (m.of_position) out.push_back({.t = std::get<GnssFix>(m.messages.front()).t, .weight = m.weight});
  return out;
}

}  // namespace canyon::fusion
