// Random streams by the papers that define them, number by number.
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "canyon/core/random/random.h"
#include "canyon/core/random/random_batch.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/stress/subjects.h"
#include "canyon/core/units.h"

namespace canyon {
namespace {

using stress::Looks;
using Words = std::array<std::uint32_t, 4>;

/// Salmon et al. (2011): Philox 4x32, ten rounds.
Words philox(Words counter, std::uint64_t key) {
  std::array<std::uint64_t, 2> k{key & 0xffffffffU, key >> 32};
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t left = 0xD2511F53ULL * counter[0], right = 0xCD9E8D57ULL * counter[2];
    counter = {static_cast<std::uint32_t>((right >> 32) ^ counter[1] ^ k[0]), static_cast<std::uint32_t>(right),
               static_cast<std::uint32_t>((left >> 32) ^ counter[3] ^ k[1]), static_cast<std::uint32_t>(left)};
    k = {(k[0] + 0x9E3779B9ULL) & 0xffffffffU, (k[1] + 0xBB67AE85ULL) & 0xffffffffU};
  }
  return counter;
}

/// splitmix64 of the seed, xor FNV-1a of the name.
std::uint64_t key_of(std::uint64_t seed, std::string_view name) {
  std::uint64_t z = seed + 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  z ^= z >> 31;
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return z ^ hash;
}

/// The published vectors of Random123's own test, and a generator of splitmix64 from 0: 0xE220A8397B1DCDAF.
StressFigure published_vectors() {
  int wrong = 0;
  wrong += philox({0, 0, 0, 0}, 0) == Words{0x6627e8d5U, 0xe169c58dU, 0xbc57ac4cU, 0x9b00dbd8U} ? 0 : 1;
  wrong += philox({0xffffffffU, 0xffffffffU, 0xffffffffU, 0xffffffffU}, 0xffffffffffffffffULL) ==
                   Words{0x408f276dU, 0x41c83b0eU, 0xa20bc7c6U, 0x6d5451fdU}
               ? 0
               : 1;
  wrong += key_of(0, "") == (0xE220A8397B1DCDAFULL ^ 0xCBF29CE484222325ULL) ? 0 : 1;
  for (const std::uint64_t seed : {0ULL, 1ULL, 77ULL, 0xffffffffffffffffULL})
    for (const std::string_view name : {"", "a", "gnss.code_noise", "\xff\x80"})
      wrong += RandomStream(seed, name).key() == key_of(seed, name) ? 0 : 1;
  // Tiles of many blocks, for this machine and for any.
  for (const std::uint64_t first : {0ULL, 0xfffffffaULL, 0x123456789abcdefULL}) {
    PhiloxTile any{}, own{};
    const std::uint64_t key = 0xdeadbeef12345678ULL;
    philox_tile_portable(key, 0x87654321U, first, 0x13572468U, any);
    philox_tile_of_this_machine()(key, 0x87654321U, first, 0x13572468U, own);
    for (std::uint64_t b = 0; b < kRandomTile / 2; ++b) {
      const std::uint64_t block = first + b;
      const Words exact = philox(
          {static_cast<std::uint32_t>(block), static_cast<std::uint32_t>(block >> 32), 0x87654321U, 0x13572468U}, key);
      for (std::size_t w = 0; w < 4; ++w) wrong += any.words[w][b] == exact[w] && own.words[w][b] == exact[w] ? 0 : 1;
    }
  }
  return {1.0 * wrong, 0.0};
}

/// Of the words of each block: 53 bits as they are, Box and Muller's two by the library's own functions, 4e-15 of
/// numbers below 9; directions by height and turn; ranges and triples; one by one and in long and short fills.
StressFigure numbers_of_words() {
  Looks looks;
  const std::uint64_t seed = 31;
  const RandomStream stream(seed, "stress.draws");
  const std::uint64_t key = key_of(seed, "stress.draws");
  const auto block_of = [&](std::uint32_t entity, std::uint64_t index, std::uint32_t n) {
    const std::uint64_t block = index / 2;
    return philox({static_cast<std::uint32_t>(block), static_cast<std::uint32_t>(block >> 32), entity, n}, key);
  };
  const auto bits_of = [](std::uint32_t low, std::uint32_t high) { return (std::uint64_t{high} << 32 | low) >> 11; };
  const auto uniform = [&](std::uint32_t entity, std::uint64_t index, std::uint32_t n) {
    const Words w = block_of(entity, index, n);
    return std::ldexp(static_cast<double>(index % 2 == 0 ? bits_of(w[0], w[1]) : bits_of(w[2], w[3])), -53);
  };
  const auto normal = [&](std::uint32_t entity, std::uint64_t index, std::uint32_t n) {
    const Words w = block_of(entity, index, n);
    const double u1 = std::ldexp(static_cast<double>(bits_of(w[0], w[1]) + 1), -53),
                 u2 = std::ldexp(static_cast<double>(bits_of(w[2], w[3])), -53);
    const double radius = std::sqrt(-2.0 * std::log(u1)), angle = 2.0 * kPi * u2;
    return radius * (index % 2 == 0 ? std::cos(angle) : std::sin(angle));
  };
  for (std::uint64_t k = 0; k < 300; ++k) {
    const auto entity = static_cast<std::uint32_t>(k % 7), n = static_cast<std::uint32_t>(k % 3);
    const std::uint64_t index = k * k * 977;
    looks.right(stream.uniform(entity, index, n) == uniform(entity, index, n));
    looks.near(stream.uniform(-3.0, 5.0, entity, index, n), -3.0 + 8.0 * uniform(entity, index, n), 2e-15);
    looks.near(stream.normal(entity, index, n), normal(entity, index, n), 1e-14);
    const auto three = stream.normal3(index, n);
    for (std::uint32_t i = 0; i < 3; ++i) looks.near(three[i], normal(i, index, n), 1e-14);
    const auto way = stream.direction(entity, index);
    const double z = 2.0 * uniform(entity, index, 0) - 1.0, turn = 2.0 * kPi * uniform(entity, index, 1);
    looks.near(way.z(), z, 1e-15);
    looks.near(way.x(), std::sqrt(1.0 - z * z) * std::cos(turn), 4e-15 / std::sqrt(1.0 - z * z));
    looks.near(way.y(), std::sqrt(1.0 - z * z) * std::sin(turn), 4e-15 / std::sqrt(1.0 - z * z));
    std::vector<double> normals(1 + k % 90), uniforms(1 + k % 90);
    stream.fill_normal(normals, entity, index, n), stream.fill_uniform(uniforms, entity, index, n);
    for (std::size_t i = 0; i < normals.size(); i += 1 + normals.size() / 9) {
      looks.near(normals[i], normal(entity, index + i, n), 1e-14);
      looks.right(uniforms[i] == uniform(entity, index + i, n));
    }
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> draw_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "the generator of all draws",
           "a round too few, a hash that is no longer the published one",
           "published vectors, and each word of tiles of either form: exact", "differences"});
  rows.add("draws/published_vectors", published_vectors);
  rows.of({StressGroup::kData, "numbers made of random words",
           "a lane for the other, a bit too many, a sine for a cosine",
           "the bits themselves, and Box and Muller's with the library's functions: roundings", "of the bound"});
  rows.add("draws/numbers_of_words", numbers_of_words);
  return rows.take();
}

}  // namespace canyon
