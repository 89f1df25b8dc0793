#pragma once

#include <cstdint>
#include <string_view>

#include "canyon/core/random/random.h"

namespace canyon::lidar::trials {

/// Numbers of one trial, one after the other, from a stream of their own name.
class Draws {
 public:
  Draws(std::uint64_t seed, std::string_view name, std::uint64_t trial) : stream_(seed, name), trial_(trial) {}
  double uniform(double low, double high) { return stream_.uniform(low, high, drawn_++, trial_); }
  double normal(double sigma) { return sigma * stream_.normal(drawn_++, trial_); }
  double side() { return uniform(0, 1) < 0.5 ? -1.0 : 1.0; }

 private:
  RandomStream stream_;
  std::uint64_t trial_;
  std::uint32_t drawn_ = 0;
};

}  // namespace canyon::lidar::trials
