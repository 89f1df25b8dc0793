#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"

namespace canyon::gnss {

/// Standard normal fields over a few coordinates, without state: normals at the corners of a lattice of cells of side
/// 1, by a hash of the corner, and between them
///
///   cos(theta) a + sin(theta) b,   theta = pi/2 (3 f^2 - 2 f^3),
///
/// along each coordinate, so that the variance is 1 everywhere and the field turns evenly, with its first derivative.
/// A value depends on seed, name, layer and place alone. Two places more than a cell apart in any coordinate, and on
/// different cells there, are independent.
class LatticeNoise {
 public:
  LatticeNoise(std::uint64_t seed, std::string_view name) : stream_(seed, name) {}

  /// `x` in cells, each below 2^52 in size; `layer` tells fields apart.
  template <std::size_t N>
  double at(const std::array<double, N>& x, std::uint32_t layer) const {
    std::array<std::int64_t, N> cell;
    std::array<double, N> near, far;  // weights of a coordinate's two corners
    for (std::size_t k = 0; k < N; ++k) {
      const double low = std::floor(x[k]), f = x[k] - low;
      const double theta = 0.5 * kPi * f * f * (3.0 - 2.0 * f);
      cell[k] = static_cast<std::int64_t>(low);
      near[k] = std::cos(theta);
      far[k] = std::sin(theta);
    }
    double sum = 0.0;
    for (unsigned corner = 0; corner < (1U << N); ++corner) {
      double weight = 1.0;
      std::uint64_t hash = 0;
      for (std::size_t k = 0; k < N; ++k) {
        const unsigned upper = corner >> k & 1U;
        weight *= upper != 0 ? far[k] : near[k];
        hash = mixed(hash ^ static_cast<std::uint64_t>(cell[k] + upper));
      }
      if (weight != 0.0) sum += weight * stream_.normal(layer, hash);
    }
    return sum;
  }

 private:
  /// splitmix64's finalizer (Steele, Lea & Flood 2014), a bijection.
  static std::uint64_t mixed(std::uint64_t z) {
    z += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
  }

  RandomStream stream_;
};

}  // namespace canyon::gnss
