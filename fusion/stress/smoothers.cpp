// Whole runs: what later messages add to a filter's estimate, by recursion and by factor graphs.
#include <vector>

#include <Eigen/Eigenvalues>

#include "canyon/core/stress_rows.h"
#include "canyon/fusion/consistency.h"
#include "canyon/fusion/smoothing/graph/chain_builder.h"
#include "canyon/fusion/smoothing/graph/chain_solver.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/stress/simulated_drive.h"
#include "canyon/fusion/stress/subjects.h"

namespace canyon::fusion {
namespace {

using stress::kEpsilon;
using stress::Worst;

#ifdef CANYON_WITH_CERES
constexpr bool kGraphs = true;
#else
constexpr bool kGraphs = false;  // what solves them is not compiled in
#endif

NavState truth_at(const Drive& drive, const NavState& state) {
  const double t_s = state.t - drive.start;
  return drive.truth[static_cast<std::size_t>(std::lround(t_s / drive.imu.front().dt_s))];
}

/// With the filter's own variances as units the smoother has never more than the filter, in any direction, and always
/// something; where nothing comes later it is the filter. Elements of 1 round by an epsilon each, 9 x 9 of them.
StressFigure never_less_certain(const std::string& keys) {
  const Drive drive =
      simulated_drive(7, {.seconds = 12.0, .outage_from_s = 4.0, .outage_to_s = 8.0, .keys = keys.c_str()});
  const auto filtered = smoothed_by("none", drive).states, smoothed = smoothed_by("rts", drive).states;
  Worst worst;
  worst.look(filtered.size() == smoothed.size() && filtered.size() > 100 ? 0.0 : stress::kInfinity, 1.0);
  for (std::size_t i = 0; i < std::min(filtered.size(), smoothed.size()); ++i) {
    worst.look(filtered[i].nav.t == smoothed[i].nav.t ? 0.0 : stress::kInfinity, 1.0);
    const Eigen::VectorXd unit = filtered[i].covariance.diagonal().cwiseSqrt().cwiseInverse();
    const auto least = [&](const Eigen::MatrixXd& P) {
      return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(unit.asDiagonal() * P * unit.asDiagonal())
          .eigenvalues()
          .minCoeff<Eigen::PropagateNaN>();
    };
    const double gained = least(filtered[i].covariance - smoothed[i].covariance);
    worst.look(std::min(gained, 0.0), 81.0 * kEpsilon);
    worst.look(least(smoothed[i].covariance) > 0.0 ? 0.0 : stress::kInfinity, 1.0);
  }
  worst.look((filtered.back().nav.p_EU_E - smoothed.back().nav.p_EU_E).norm(), 1e-300);
  return worst.figure();
}

/// Errors within the outage and at the ends, twelve drives of which the model is exactly true: their mean NEES within
/// its band of 1e-6. Instants of one drive hang together, each has a band by itself.
StressFigure consistent(const char* smoother) {
  constexpr double kInstants[] = {1.0, 5.0, 11.0};
  ConsistencyMean nees[3];
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Drive drive =
        simulated_drive(seed, {.seconds = 12.0, .rate_hz = 20.0, .outage_from_s = 3.0, .outage_to_s = 8.0});
    for (const SmoothedState& s : smoothed_by(smoother, drive).states)
      for (std::size_t i = 0; i < 3; ++i)
        if (std::abs(s.nav.t - drive.start - kInstants[i]) < 1e-6)
          nees[i].add(normalized_squared(error_of(truth_at(drive, s.nav), s.nav), s.covariance), 9);
  }
  Worst worst;
  for (const ConsistencyMean& mean : nees) {
    if (mean.count() != 12) return {stress::kInfinity, 1.0};
    const Band band = mean_chi_square_band(9, mean.count(), 1e-6);
    const double middle = 0.5 * (band.low + band.high);
    worst.look(9.0 * mean.per_state() - middle, 1.01 * (band.high - middle));
  }
  return worst.figure();
}

/// By how many of the first one's sigmas two runs differ at most, and their variances, relative.
struct Apart {
  double sigmas = 0.0, variances = 0.0;
  std::size_t looks = 0;
};
Apart apart(const Smoothed& one, const Smoothed& other) {
  Apart out;
  std::size_t j = 0;
  for (const SmoothedState& a : one.states) {
    while (j < other.states.size() && other.states[j].nav.t - a.nav.t < -1e-6) ++j;
    if (j == other.states.size() || other.states[j].nav.t - a.nav.t > 1e-6) continue;
    const Eigen::ArrayXd e = error_of(a.nav, other.states[j].nav).array() / a.covariance.diagonal().array().sqrt();
    out.sigmas = worse(out.sigmas, e.abs().maxCoeff<Eigen::PropagateNaN>());
    const Eigen::ArrayXd ratio = other.states[j].covariance.diagonal().array() / a.covariance.diagonal().array();
    out.variances = worse(out.variances, (ratio - 1.0).abs().maxCoeff<Eigen::PropagateNaN>());
    ++out.looks;
  }
  return out;
}

/// Recursion and graph have the same information. What differs is where each linearizes, a share of a sigma that is
/// proportional to the errors: with a tenth of them it is a tenth, within a factor of two of it. And both become equal:
/// with a hundredth the places differ by 3 % of what the whole errors' do.
StressFigure graph_is_recursion() {
  const auto at = [](double scale) {
    const Drive drive =
        simulated_drive(11, {.seconds = 12.0, .outage_from_s = 4.0, .outage_to_s = 8.0, .noise_scale = scale});
    return apart(smoothed_by("rts", drive), smoothed_by("batch_graph", drive));
  };
  const Apart usual = at(1.0), small = at(0.1);
  if (usual.looks < 10 || small.looks != usual.looks) return {stress::kInfinity, 1.0};
  Worst worst;
  // Of a state some sigma off, what two linearizations make of it is a part of that sigma.
  worst.look(usual.sigmas, 1.0);
  worst.look(small.sigmas / usual.sigmas, 0.2);
  worst.look(small.variances / usual.variances, 0.2);
  return worst.figure();
}

/// A lag as long as the run is the whole graph: it ends where a step gains 1e-6 of the cost, which is of the order of
/// the fixes' number, sqrt(2e-6 n) sigma.
StressFigure lag_is_batch() {
  const Drive drive = simulated_drive(11, {.seconds = 12.0, .outage_from_s = 4.0, .outage_to_s = 8.0});
  const Apart d = apart(smoothed_by("batch_graph", drive), smoothed_by("fixed_lag_graph", drive, "graph_lag_s = 100"));
  Worst worst;
  worst.look(d.looks >= 10 ? 0.0 : stress::kInfinity, 1.0);
  worst.look(d.sigmas, std::sqrt(2e-6 * 3.0 * static_cast<double>(drive.fixes.size())));
  return worst.figure();
}

/// A short lag forgets nothing either: it ends as the filter does, which linearizes once, a part of a sigma off as the
/// recursion is (above), and with its variances, by as much.
StressFigure short_lag_is_filter() {
  const Drive drive = simulated_drive(11, {.seconds = 12.0, .outage_from_s = 1e9, .noise_scale = 0.1});
  Smoothed filtered = smoothed_by("none", drive), lag = smoothed_by("fixed_lag_graph", drive, "graph_lag_s = 1");
  filtered.states.erase(filtered.states.begin(), filtered.states.end() - 1);
  const Apart d = apart(filtered, lag);
  Worst worst;
  worst.look(d.looks == 1 ? 0.0 : stress::kInfinity, 1.0);
  worst.look(d.sigmas, 0.1);
  worst.look(d.variances, 0.1);
  return worst.figure();
}

/// A graph of a run whose fixes are good to 50 um: solved, then solved again from nodes that all stand aside by some of
/// those sigmas and are turned. Both end where a step gains less than 1e-9 of the cost c, so that each lacks at most
/// sqrt(2e-9 c) of a sigma, any way, to where it is least. A place on Earth rounds by half an epsilon of its radius in
/// each of the three residuals that it is in, along three axes, beside the sigma that as many fixes as nodes leave it:
/// one fix's over the root of their number, at least. What a turn of all nodes leaves after a first step is of its
/// square, a millionth of a metre beside a run of tens of metres: a step that counts all the same. Whether the solver
/// says that it has converged is not asked: such residuals round by more than the least gain.
StressFigure aside(double sigmas, double turn_rad) {
  constexpr double kSigma_m = 0.5e-4, kRadius_m = 6.4e6, kLeastGain = 1e-9;
  const Drive drive = simulated_drive(11, {.seconds = 12.0, .outage_from_s = 1e9, .noise_scale = 1e-4});
  const SmootherInput run = drive.input();
  ChainBuilder builder(run, *samples_of(run), 1.0);
  while (!builder.done()) builder.add_node();
  ChainGraph& graph = builder.graph();
  const SolveOptions options{.least_gain = kLeastGain};
  Worst worst;
  const auto first = solve(graph, builder.measurements(), options);
  worst.look(first.ok() ? 0.0 : stress::kInfinity, 1.0);
  const std::vector<GraphNode> before = graph.nodes;
  for (GraphNode& node : graph.nodes) {
    node.nav.p_EU_E += sigmas * kSigma_m * Eigen::Vector3d(0.6, -0.48, 0.64);
    node.nav.R_EU = node.nav.R_EU * so3_exp(turn_rad * Eigen::Vector3d(0.36, 0.48, -0.8));
  }
  const auto second = solve(graph, builder.measurements(), options);
  worst.look(second.ok() ? 0.0 : stress::kInfinity, 1.0);
  if (!first.ok() || !second.ok()) return worst.figure();
  const double rounding_m = 3.0 * std::sqrt(3.0) * 0.5 * kEpsilon * kRadius_m;
  const double least_sigma_m = kSigma_m / std::sqrt(static_cast<double>(graph.nodes.size()));
  const double bound = 2.0 * (std::sqrt(2.0 * kLeastGain * first->final_cost) + rounding_m / least_sigma_m);
  const auto covariances = marginal_covariances(graph, builder.measurements());
  for (std::size_t k = 0; k < graph.nodes.size(); ++k)
    worst.look(std::sqrt(normalized_squared(difference(before[k], graph.nodes[k]), covariances[k])), bound);
  return worst.figure();
}

/// One fix of `off_m` among many that are right. Its residual is its offset but for what it pulls: Huber's weight is
/// sqrt(3 sigma / offset), a switch's cost / (cost + (offset / sigma)^2), to the part of a sigma that the other fixes
/// leave the place uncertain by (one of 11 fixes, and of a switch twice it); those count in full but for their own
/// tails.
StressFigure outlier(const char* smoother, const std::string& robustness, double off_m) {
  Drive drive = simulated_drive(3, {.seconds = 12.0, .outage_from_s = 1e9, .noise_scale = 0.1, .outlier_m = 0.0});
  const double sigma_m = 0.05;
  GnssFix& bad = drive.fixes[6];
  bad.p_A_E += off_m * bad.p_A_E.normalized();
  const Smoothed found = smoothed_by(smoother, drive, "graph_robustness = \"" + robustness + "\"");
  const double ratio = off_m / sigma_m;
  const double expected = robustness == "huber" ? std::sqrt(3.0 / ratio) : 30.0 / (30.0 + ratio * ratio);
  // Other fixes leave the place there to some sigma, which the residual lacks or has more.
  const double unsure = 4.0 / ratio;
  Worst worst;
  worst.look(found.fixes.size() == drive.fixes.size() ? 0.0 : stress::kInfinity, 1.0);
  for (const FixWeight& fix : found.fixes) {
    if (fix.t == bad.t)
      worst.look(fix.weight / expected - 1.0, robustness == "huber" ? 0.5 * unsure + 0.1 : 2.0 * unsure + 0.1);
    else
      worst.look(fix.weight > 0.5 && fix.weight <= 1.0 ? 0.0 : stress::kInfinity, 1.0);
  }
  return worst.figure();
}

}  // namespace

std::vector<StressCase> smoother_cases() {
  const StressMechanism certain{StressGroup::kStiff, "what comes later, by recursion",
                                "an inverse of a covariance that has lost its rank, or a gain of another instant",
                                "never less certain than the filter in any direction; the filter at the end",
                                "of the bound"};
  const StressMechanism right{StressGroup::kData, "errors of whole runs whose model is exactly true",
                              "what was measured is counted twice, or its noise is lost on the way back",
                              "NEES within its band of 1e-6, within an outage too", "of the bound"};
  const StressMechanism forms{StressGroup::kStiff, "recursion and factor graph on one run",
                              "a factor whose derivative or covariance is not that of the filter's step",
                              "the same, but for linearization, which is of first order in the errors", "of the bound"};
  const StressMechanism robust{
      StressGroup::kData, "a fix that is far off in a graph of a run", "a loss that is not what the weights say it is",
      "Huber's weight and a switch's in closed form, by the part that others leave open", "of the bound"};
  const StressMechanism optimum{StressGroup::kStiff, "a graph that is begun beside where its cost is least",
                                "it ends at a step that is small beside the run's length, not beside its precision",
                                "the same place, to what a step that is left out gains, and to roundings on Earth",
                                "of the bound"};
  StressRows rows;
  rows.of(certain)
      .add("smoother/never_less_certain", [] { return never_less_certain("states = [\"biases\", \"gains\"]"); })
      .add("smoother/never_less_certain_with_all_of_a_vehicle", [] {
        return never_less_certain(
            "states = [\"turn_on_biases\", \"in_run_biases\", \"gains\", \"fix_error\"]\nfix_error_sigma_m = 0.2\n"
            "fix_error_scale = 0\nfix_error_tau_s = 10\n"
            "imu_gain_tau_s = 100");
      });
  rows.of(right);
  for (const char* smoother : {"none", "rts"})
    rows.add(std::string("smoother/errors_are_those_of_") + smoother, [=] { return consistent(smoother); });
  if (!kGraphs) return rows.take();
  for (const char* smoother : {"batch_graph", "fixed_lag_graph"})
    rows.add(std::string("smoother/errors_are_those_of_") + smoother, [=] { return consistent(smoother); });
  rows.of(forms)
      .add("smoother/graph_is_recursion", graph_is_recursion)
      .add("smoother/whole_lag_is_the_graph", lag_is_batch)
      .add("smoother/short_lag_is_the_filter", short_lag_is_filter);
  rows.of(optimum);
  rows.add("smoother/graph_begun_30_sigma_aside", [] { return aside(30.0, 0.0); });
  for (const double turn_rad : {1e-4, 3e-4, 1e-3, 3e-3, 1e-2})
    rows.add("smoother/graph_begun_turned_by_" + stress::text(turn_rad) + "_rad", [=] { return aside(0.0, turn_rad); });
  rows.of(robust);
  for (const double off_m : {1.0, 20.0}) {
    rows.add("smoother/huber_outlier_of_" + stress::text(off_m) + "_m",
             [=] { return outlier("batch_graph", "huber", off_m); });
    rows.add("smoother/switched_outlier_of_" + stress::text(off_m) + "_m",
             [=] { return outlier("batch_graph", "switchable", off_m); });
  }
  return rows.take();
}

}  // namespace canyon::fusion
