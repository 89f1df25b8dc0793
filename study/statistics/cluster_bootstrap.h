#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "canyon/study/statistics/interval.h"

namespace canyon::study {

/// Statistics of a sample in which cluster c, a seed or a place with all that was seen of it, stands `times[c]` times.
using ClusterStatistics = std::function<std::vector<double>(std::span<const double> times)>;

/// Fewer clusters leave intervals that are too short by far: they then have none.
inline constexpr std::size_t kFewestClusters = 6;

/// 95 % intervals of several statistics, by percentiles, when whole clusters are drawn anew with replacement, so that
/// what hangs together within one stays together (the cluster bootstrap: Davison & Hinkley, Bootstrap Methods and their
/// Application, 1997, section 3.8). 1000 replicates of the stream "study.clusters", drawn for all statistics at once. A
/// replicate without a value counts for nothing, an infinite one counts as such. Undefined with fewer clusters than
/// kFewestClusters.
std::vector<Interval> cluster_bootstrap(std::size_t clusters, std::uint64_t seed, const ClusterStatistics& statistics);

}  // namespace canyon::study
