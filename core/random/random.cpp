#include "canyon/core/random/random.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Random123/philox.h>

#include "canyon/core/random/random_batch.h"
#include "canyon/core/random/random_math.h"

namespace canyon {
namespace {

/// Output of the splitmix64 generator (Steele, Lea & Flood 2014) with this state: spreads small seeds over all 64 bits.
std::uint64_t splitmix64(std::uint64_t state) {
  std::uint64_t z = state + 0x9E3779B97F4A7C15;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
  return z ^ (z >> 31);
}

/// 64-bit FNV-1a hash (Fowler, Noll & Vo).
std::uint64_t fnv1a64(std::string_view text) {
  std::uint64_t hash = 0xCBF29CE484222325;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3;
  return hash;
}

std::array<std::uint32_t, 4> philox_block(std::uint64_t key, std::uint32_t entity, std::uint64_t index,
                                          std::uint32_t n) {
  const std::uint64_t block = index / 2;
  const r123::Philox4x32::ctr_type counter = {
      {static_cast<std::uint32_t>(block), static_cast<std::uint32_t>(block >> 32), entity, n}};
  const r123::Philox4x32::ukey_type words = {{static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32)}};
  const auto out = r123::Philox4x32_R<10>()(counter, words);
  return {out[0], out[1], out[2], out[3]};
}

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, std::string_view name) : key_(splitmix64(seed) ^ fnv1a64(name)) {}

double RandomStream::uniform(std::uint32_t entity, std::uint64_t index, std::uint32_t n) const {
  const auto w = philox_block(key_, entity, index, n);
  return index % 2 == 0 ? random_math::uniform53(w[0], w[1]) : random_math::uniform53(w[2], w[3]);
}

double RandomStream::uniform(double low, double high, std::uint32_t entity, std::uint64_t index,
                             std::uint32_t n) const {
  return low + (high - low) * uniform(entity, index, n);
}

double RandomStream::normal(std::uint32_t entity, std::uint64_t index, std::uint32_t n) const {
  const auto w = philox_block(key_, entity, index, n);
  const double radius = random_math::box_muller_radius(random_math::uniform53_above_zero(w[0], w[1]));
  const auto angle = random_math::sin_cos_turns(random_math::uniform53(w[2], w[3]));
  return radius * (index % 2 == 0 ? angle.cosine : angle.sine);
}

Eigen::Vector3d RandomStream::normal3(std::uint64_t index, std::uint32_t n) const {
  return {normal(0, index, n), normal(1, index, n), normal(2, index, n)};
}

Eigen::Vector3d RandomStream::direction(std::uint32_t entity, std::uint64_t index) const {
  // Archimedes: the height of a uniform point of the sphere is uniform.
  const double z = 2.0 * uniform(entity, index, 0) - 1.0;
  const auto azimuth = random_math::sin_cos_turns(uniform(entity, index, 1));
  const double radius = std::sqrt((1.0 - z) * (1.0 + z));
  return {radius * azimuth.cosine, radius * azimuth.sine, z};
}

namespace {

using TileFunction = void (*)(std::uint64_t key, std::uint32_t entity, std::uint64_t first_block, std::uint32_t n,
                              double* out);

/// Whole tiles in place, the two ends through a tile of their own.
void fill_by_tiles(TileFunction tile, std::uint64_t key, std::span<double> out, std::uint32_t entity,
                   std::uint64_t first_index, std::uint32_t n) {
  std::array<double, kRandomTile> buffer;
  std::size_t done = 0;
  while (done < out.size()) {
    const std::uint64_t index = first_index + done;
    const std::size_t skip = index % 2;
    std::size_t take = std::min(out.size() - done, kRandomTile - skip);
    const std::uint64_t left = 0 - index;  // until the last index, which 0 follows
    if (left != 0 && left < take) take = left;
    double* const target = take == kRandomTile ? out.data() + done : buffer.data();
    tile(key, entity, index / 2, n, target);
    if (target == buffer.data()) std::copy_n(buffer.data() + skip, take, out.data() + done);
    done += take;
  }
}

/// Below this length computing a whole tile costs more than it saves.
constexpr std::size_t kShortFill = 6;

}  // namespace

void RandomStream::fill_normal(std::span<double> out, std::uint32_t entity, std::uint64_t first_index,
                               std::uint32_t n) const {
  if (out.size() < kShortFill) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = normal(entity, first_index + i, n);
    return;
  }
  fill_by_tiles(normal_tile, key_, out, entity, first_index, n);
}

void RandomStream::fill_uniform(std::span<double> out, std::uint32_t entity, std::uint64_t first_index,
                                std::uint32_t n) const {
  if (out.size() < kShortFill) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = uniform(entity, first_index + i, n);
    return;
  }
  fill_by_tiles(uniform_tile, key_, out, entity, first_index, n);
}

}  // namespace canyon
