#pragma once

#include <cstdint>
#include <string_view>

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
class GaussMarkov {
 public:
  /// tau_s > 0.
  GaussMarkov(std::uint64_t seed, std::string_view name, double tau_s);
  double at(std::uint32_t entity, GpsTime t) const;

 private:
  RandomStream draws_;
  std::int64_t node_ns_;
};

}  // namespace canyon::gnss
