#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include <Eigen/Core>

namespace canyon {

/// A named stream of random numbers without state: a draw depends only on (seed, name, entity, index, n).
///
/// `entity` tells apart axes, satellites or lasers; `index` is the sample number of that sensor; `n` numbers the draws
/// within one sample. So switching one error off shifts no other draw, and paired runs share their noise.
///
/// Generator: Philox 4x32-10 (Salmon et al. 2011). Key = splitmix64(seed) xor FNV-1a-64(name).
/// Counter words = {low(index / 2), high(index / 2), entity, n}; lane = index % 2.
/// uniform: lane 0 takes output words 0-1, lane 1 words 2-3 (the second is the high one); the upper 53 bits, in [0, 1).
/// normal: Box-Muller of the two uniforms of the block, u1 in (0, 1]; lane 0 the cosine, lane 1 the sine branch; log,
/// sine and cosine are our own, of + - * / sqrt only, so that the same bits come out on every machine and in vector
/// code.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name);

  double uniform(std::uint32_t entity, std::uint64_t index, std::uint32_t n = 0) const;
  double uniform(double low, double high, std::uint32_t entity, std::uint64_t index, std::uint32_t n = 0) const;
  double normal(std::uint32_t entity, std::uint64_t index, std::uint32_t n = 0) const;
  /// Three normals: entities 0, 1, 2 of the same sample.
  Eigen::Vector3d normal3(std::uint64_t index, std::uint32_t n = 0) const;
  /// Uniformly distributed unit vector; uses draws 0 and 1 of the entity.
  Eigen::Vector3d direction(std::uint32_t entity, std::uint64_t index) const;

  /// out[i] = normal(entity, first_index + i, n), to the bit, several times faster.
  void fill_normal(std::span<double> out, std::uint32_t entity, std::uint64_t first_index, std::uint32_t n = 0) const;
  void fill_uniform(std::span<double> out, std::uint32_t entity, std::uint64_t first_index, std::uint32_t n = 0) const;

  std::uint64_t key() const { return key_; }

 private:
  std::uint64_t key_;
};

}  // namespace canyon
