#pragma once

#include <cstdint>
#include <string_view>
#include <unordered_map>

#include "canyon/core/random/random.h"
#include "canyon/core/time.h"

namespace canyon::gnss {

/// Unit-variance first-order Gauss-Markov processes, one per entity, as functions of time: the value at t depends only
/// on (seed, name, entity, t), not on what was asked before nor on when a run started.
///
/// Nodes stand every tau/8 since the GPS epoch. The value of a node is the weighted sum of its own and the 127
/// preceding draws, w_j ~ exp(-j/8), normalised: what is cut off carries e^-32 of the variance. Between nodes it is
/// interpolated linearly and rescaled, so that the variance is 1 at every t; the correlation at lag L follows
/// exp(-L/tau) to within 0.02.
///
/// An object keeps the nodes around the last time that it was asked for, of each entity: epochs come far more often
/// than nodes. So it is not thread-safe.
class GaussMarkov {
 public:
  /// tau_s > 0.
  GaussMarkov(std::uint64_t seed, std::string_view name, double tau_s);
  double at(std::uint32_t entity, GpsTime t) const;

  /// What a bound takes for the largest value: the chance of more is 8e-11 per node, 1e-6 in a run of 12,000 nodes.
  static constexpr double kMostSigmas = 6.5;

 private:
  struct Nodes {
    std::int64_t first = -1;
    double now = 0.0, next = 0.0;
  };
  Nodes nodes_of(std::uint32_t entity, std::int64_t first) const;

  RandomStream draws_;
  std::int64_t node_ns_;
  mutable std::unordered_map<std::uint32_t, Nodes> last_;
};

}  // namespace canyon::gnss
