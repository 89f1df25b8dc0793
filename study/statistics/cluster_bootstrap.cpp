#include "canyon/study/statistics/cluster_bootstrap.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/process/progress.h"
#include "canyon/core/random/random.h"

namespace canyon::study {
namespace {

constexpr std::uint64_t kClusterReplicates = 1000;

/// An infinite end is kept: a size that lies beyond all that were tried.
Interval percentiles(std::vector<double> values) {
  if (values.size() < kClusterReplicates / 2) return {};  // most replicates have none
  std::sort(values.begin(), values.end());
  const auto at = [&](double q) {
    return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
  };
  return {at(0.025), at(0.975)};
}

}  // namespace

std::vector<Interval> cluster_bootstrap(std::size_t clusters, std::uint64_t seed, const ClusterStatistics& statistics) {
  std::vector<double> times(clusters, 1.0);
  std::vector<std::vector<double>> values(statistics(times).size());
  if (clusters < kFewestClusters) return std::vector<Interval>(values.size());
  const RandomStream stream(seed, "study.clusters");
  for (std::uint64_t r = 0; r < kClusterReplicates; ++r) {
    throw_if_cancelled();
    std::fill(times.begin(), times.end(), 0.0);
    for (std::size_t k = 0; k < clusters; ++k)
      times[static_cast<std::size_t>(stream.uniform(static_cast<std::uint32_t>(k), r) *
                                     static_cast<double>(clusters))] += 1.0;
    const std::vector<double> replicate = statistics(times);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (!std::isnan(replicate[i])) values[i].push_back(replicate[i]);
  }
  std::vector<Interval> out;
  for (auto& of_one : values) out.push_back(percentiles(std::move(of_one)));
  return out;
}

}  // namespace canyon::study
