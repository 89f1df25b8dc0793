#include "canyon/study/registration_error/events/event_regression.h"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>

#include "canyon/study/statistics/cluster_bootstrap.h"

namespace canyon::study {
namespace {

constexpr std::size_t kRanges = kLagEdges_s.size() - 1;

/// The range that a time since an event lies in; kRanges: none.
std::size_t range_of(double since_s) {
  for (std::size_t j = 0; j < kRanges; ++j)
    if (since_s > kLagEdges_s[j] && since_s <= kLagEdges_s[j + 1]) return j;
  return kRanges;
}

struct NormalEquations {
  Eigen::MatrixXd A;
  Eigen::VectorXd b;
  explicit NormalEquations(Eigen::Index n) : A(Eigen::MatrixXd::Zero(n, n)), b(Eigen::VectorXd::Zero(n)) {}
};

Eigen::VectorXd regressors(const ErrorSeries& run, double t_s, const std::vector<MapEventKind>& kinds) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(kinds.size() * kRanges));
  for (const MapEvent& event : run.events) {
    const std::size_t range = range_of(t_s - event.t_s);
    const auto kind = std::find(kinds.begin(), kinds.end(), event.kind);
    if (range < kRanges && kind != kinds.end())
      x[static_cast<Eigen::Index>(static_cast<std::size_t>(kind - kinds.begin()) * kRanges + range)] += 1.0;
  }
  return x;
}

/// A seed's part: at each second of the tape the runs less their mean there.
NormalEquations seed_equations(const SeedSeries& runs, std::size_t series, const std::vector<MapEventKind>& kinds) {
  NormalEquations out(static_cast<Eigen::Index>(kinds.size() * kRanges));
  double end_s = 0.0;
  for (const ErrorSeries& run : runs)
    if (!run.t_s.empty()) end_s = std::max(end_s, run.t_s.back());
  for (double t_s = 0.0; t_s <= end_s; t_s += 1.0) {
    std::vector<Eigen::VectorXd> xs;
    std::vector<double> ys;
    for (const ErrorSeries& run : runs) {
      const double y = run.at(series, t_s);
      if (std::isnan(y)) continue;
      xs.push_back(regressors(run, t_s, kinds));
      ys.push_back(y);
    }
    if (ys.size() < 2) continue;
    const auto n = static_cast<double>(ys.size());
    Eigen::VectorXd x_mean = Eigen::VectorXd::Zero(out.b.size());
    double y_mean = 0.0;
    for (std::size_t i = 0; i < ys.size(); ++i) {
      x_mean += xs[i] / n;
      y_mean += ys[i] / n;
    }
    for (std::size_t i = 0; i < ys.size(); ++i) {
      const Eigen::VectorXd x = xs[i] - x_mean;
      out.A += x * x.transpose();
      out.b += x * (ys[i] - y_mean);
    }
  }
  return out;
}

/// By kind its ranges after the event, less the one before, then their mean over (0, kEffect_s].
std::vector<double> coefficients(const std::vector<NormalEquations>& seeds, std::span<const double> times,
                                 std::size_t kinds) {
  NormalEquations all(static_cast<Eigen::Index>(kinds * kRanges));
  for (std::size_t s = 0; s < seeds.size(); ++s) {
    all.A += times[s] * seeds[s].A;
    all.b += times[s] * seeds[s].b;
  }
  const Eigen::VectorXd beta = Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(all.A).solve(all.b);
  std::vector<double> out;
  for (std::size_t k = 0; k < kinds; ++k) {
    const auto at = [&](std::size_t j) { return static_cast<Eigen::Index>(k * kRanges + j); };
    double effect = 0.0;
    for (std::size_t j = 1; j < kRanges; ++j) {
      // Nothing was seen at that time since such an event.
      const bool seen = all.A(at(j), at(j)) > 0.0 && all.A(at(0), at(0)) > 0.0;
      out.push_back(seen ? beta[at(j)] - beta[at(0)] : kNaN);
      if (kLagEdges_s[j + 1] <= kEffect_s) effect += out.back() * (kLagEdges_s[j + 1] - kLagEdges_s[j]) / kEffect_s;
    }
    out.push_back(effect);
  }
  return out;
}

std::vector<MapEventKind> kinds_seen(const std::vector<SeedSeries>& seeds) {
  std::vector<MapEventKind> out;
  for (const auto& row : map_event_kinds()) {
    bool seen = false;
    for (const SeedSeries& seed : seeds)
      for (const ErrorSeries& run : seed)
        for (const MapEvent& event : run.events) seen = seen || event.kind == row.make;
    if (seen) out.push_back(row.make);
  }
  return out;
}

}  // namespace

std::vector<EventRegression> regress_events(const std::vector<SeedSeries>& seeds, std::size_t series,
                                            std::uint64_t bootstrap_seed) {
  const std::vector<MapEventKind> kinds = kinds_seen(seeds);
  if (kinds.empty()) return {};
  std::vector<NormalEquations> equations;
  for (const SeedSeries& seed : seeds) equations.push_back(seed_equations(seed, series, kinds));
  const auto statistics = [&](std::span<const double> times) { return coefficients(equations, times, kinds.size()); };
  const std::vector<double> values = statistics(std::vector<double>(seeds.size(), 1.0));
  const std::vector<Interval> bands = cluster_bootstrap(seeds.size(), bootstrap_seed, statistics);
  std::vector<EventRegression> out;
  std::size_t next = 0;
  for (const MapEventKind kind : kinds) {
    EventRegression one{.kind = kind, .by_lag = {}, .effect_m = {}};
    for (std::size_t j = 1; j < kRanges; ++j, ++next) one.by_lag.push_back({values[next], bands[next]});
    one.effect_m = {values[next], bands[next]};
    ++next;
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace canyon::study
