#pragma once

#include <cstdint>

#include "canyon/core/random/random.h"

namespace canyon::scene::city {

/// The draws of one thing (one block, one parking slot, one tree) in order. Each thing has its own, so that adding or
/// leaving out one changes no other.
class Draws {
 public:
  Draws(const RandomStream& stream, std::size_t entity, std::size_t index = 0)
      : stream_(stream), entity_(static_cast<std::uint32_t>(entity)), index_(index) {}

  double between(double low, double high) { return stream_.uniform(low, high, entity_, index_, n_++); }
  bool chance(double probability) { return stream_.uniform(entity_, index_, n_++) < probability; }

 private:
  const RandomStream& stream_;
  std::uint32_t entity_;
  std::uint64_t index_;
  std::uint32_t n_ = 0;
};

}  // namespace canyon::scene::city
