#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "canyon/core/random/random.h"

namespace canyon::gnss {

/// Noise of unit variance that a first-order loop of noise bandwidth B has let through, sampled at a receiver's epochs:
/// correlated by rho = exp(-4 B dt) from epoch to epoch. A function of (seed, name, entity, epoch index): the
/// normalised sum of this epoch's draw and those before it, weighted by powers of rho until they are below 1e-8.
class LoopNoise {
 public:
  LoopNoise(std::uint64_t seed, std::string_view name, double loop_hz, double interval_s);
  double at(std::uint32_t entity, std::int64_t index) const;
  double correlation() const { return rho_; }

 private:
  RandomStream draws_;
  double rho_;
  std::vector<double> weights_;  ///< of this epoch's draw, the one before, ...
};

}  // namespace canyon::gnss
