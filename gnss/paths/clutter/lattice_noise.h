#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

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
    std::array<std::uint64_t, (1U << N)> hash{};  // of the corners; bit k of their index: the upper one of coordinate k
    std::array<double, (1U << N)> weight{1.0};
    for (std::size_t k = 0, corners = 1; k < N; ++k, corners *= 2) {
      const double low = std::floor(x[k]), f = x[k] - low;
      const double theta = 0.5 * kPi * f * f * (3.0 - 2.0 * f), near = std::cos(theta), far = std::sin(theta);
      const auto cell = static_cast<std::int64_t>(low);
      for (std::size_t i = 0; i < corners; ++i) {
        hash[i + corners] = mixed(hash[i] ^ static_cast<std::uint64_t>(cell + 1));
        weight[i + corners] = weight[i] * far;
        hash[i] = mixed(hash[i] ^ static_cast<std::uint64_t>(cell));
        weight[i] *= near;
      }
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < hash.size(); ++i)
      if (weight[i] != 0.0) sum += weight[i] * corner(layer, hash[i]);
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

  /// The normal at a corner. What was drawn lately is remembered by each thread, since neighbours share corners.
  double corner(std::uint32_t layer, std::uint64_t hash) const {
    struct Drawn {
      std::uint64_t key = 0, hash = 0;
      std::uint32_t layer = 0;
      bool is = false;
      double value = 0.0;
    };
    constexpr std::size_t kDrawn = 16384;
    thread_local std::vector<Drawn> drawn(kDrawn);
    Drawn& at = drawn[(hash ^ mixed(stream_.key() + layer)) % kDrawn];
    if (!at.is || at.hash != hash || at.layer != layer || at.key != stream_.key())
      at = {stream_.key(), hash, layer, true, stream_.normal(layer, hash)};
    return at.value;
  }

  RandomStream stream_;
};

}  // namespace canyon::gnss
