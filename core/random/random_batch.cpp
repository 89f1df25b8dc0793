#include "canyon/core/random/random_batch.h"

#include "canyon/core/random/random_math.h"

// The same source compiled for the plain instruction set, AVX2 and AVX-512 (without fused multiply-add), chosen when
// the program starts. Each operation rounds alike in all, so the bits do not depend on the choice.
#if defined(__x86_64__) && defined(__linux__)
#include <immintrin.h>
#define CANYON_VECTOR_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define CANYON_VECTOR_CLONES
#endif

namespace canyon {
namespace {

constexpr std::size_t kBlocks = kRandomTile / 2;

// Philox 4x32-10 (Salmon et al. 2011).
constexpr int kRounds = 10;
constexpr std::uint32_t kMultiplier0 = 0xD2511F53u, kMultiplier1 = 0xCD9E8D57u;
constexpr std::uint32_t kWeyl0 = 0x9E3779B9u, kWeyl1 = 0xBB67AE85u;  // golden ratio, sqrt(3) - 1

}  // namespace

void philox_tile_portable(std::uint64_t key, std::uint32_t entity, std::uint64_t first_block, std::uint32_t n,
                          PhiloxTile& tile) {
  for (std::size_t i = 0; i < kBlocks; ++i) {
    const std::uint64_t block = first_block + i;
    auto w0 = static_cast<std::uint32_t>(block), w1 = static_cast<std::uint32_t>(block >> 32), w2 = entity, w3 = n;
    auto k0 = static_cast<std::uint32_t>(key), k1 = static_cast<std::uint32_t>(key >> 32);
    for (int round = 0; round < kRounds; ++round) {
      const std::uint64_t product0 = std::uint64_t{w0} * kMultiplier0, product1 = std::uint64_t{w2} * kMultiplier1;
      w0 = static_cast<std::uint32_t>(product1 >> 32) ^ w1 ^ k0;
      w1 = static_cast<std::uint32_t>(product1);
      w2 = static_cast<std::uint32_t>(product0 >> 32) ^ w3 ^ k1;
      w3 = static_cast<std::uint32_t>(product0);
      k0 += kWeyl0;
      k1 += kWeyl1;
    }
    tile.words[0][i] = w0;
    tile.words[1][i] = w1;
    tile.words[2][i] = w2;
    tile.words[3][i] = w3;
  }
}

#if defined(__x86_64__) && defined(__linux__)
namespace {

/// Four blocks to a register, each word in the lower half of 64 bits: the 32 x 32 multiplication takes just that half,
/// so what is left in the upper one does no harm until the end.
[[gnu::target("avx2")]] void philox_tile_avx2(std::uint64_t key, std::uint32_t entity, std::uint64_t first_block,
                                              std::uint32_t n, PhiloxTile& tile) {
  constexpr std::size_t kVectors = kBlocks / 4;
  const __m256i multiplier0 = _mm256_set1_epi64x(kMultiplier0), multiplier1 = _mm256_set1_epi64x(kMultiplier1);
  __m256i w[4][kVectors];
  for (std::size_t v = 0; v < kVectors; ++v) {
    const auto first = static_cast<long long>(first_block + 4 * v);
    w[0][v] = _mm256_add_epi64(_mm256_set1_epi64x(first), _mm256_setr_epi64x(0, 1, 2, 3));
    w[1][v] = _mm256_srli_epi64(w[0][v], 32);
    w[2][v] = _mm256_set1_epi64x(entity);
    w[3][v] = _mm256_set1_epi64x(n);
  }
  auto k0 = static_cast<std::uint32_t>(key), k1 = static_cast<std::uint32_t>(key >> 32);
  for (int round = 0; round < kRounds; ++round) {
    const __m256i key0 = _mm256_set1_epi64x(k0), key1 = _mm256_set1_epi64x(k1);
    for (std::size_t v = 0; v < kVectors; ++v) {
      const __m256i product0 = _mm256_mul_epu32(w[0][v], multiplier0),
                    product1 = _mm256_mul_epu32(w[2][v], multiplier1);
      w[0][v] = _mm256_xor_si256(_mm256_xor_si256(_mm256_srli_epi64(product1, 32), key0), w[1][v]);
      w[1][v] = product1;
      w[2][v] = _mm256_xor_si256(_mm256_xor_si256(_mm256_srli_epi64(product0, 32), key1), w[3][v]);
      w[3][v] = product0;
    }
    k0 += kWeyl0;
    k1 += kWeyl1;
  }
  const __m256i lower = _mm256_set1_epi64x(0xFFFFFFFF);
  for (std::size_t word = 0; word < 4; ++word) {
    for (std::size_t v = 0; v < kVectors; ++v) {
      _mm256_store_si256(reinterpret_cast<__m256i*>(tile.words[word] + 4 * v), _mm256_and_si256(w[word][v], lower));
    }
  }
}

}  // namespace

PhiloxFunction philox_tile_of_this_machine() {
  return __builtin_cpu_supports("avx2") ? philox_tile_avx2 : philox_tile_portable;
}
#else
PhiloxFunction philox_tile_of_this_machine() {
  return philox_tile_portable;
}
#endif

namespace {

void philox_tile(std::uint64_t key, std::uint32_t entity, std::uint64_t first_block, std::uint32_t n,
                 PhiloxTile& tile) {
  static const PhiloxFunction kFunction = philox_tile_of_this_machine();
  kFunction(key, entity, first_block, n, tile);
}

CANYON_VECTOR_CLONES void normals_of(const PhiloxTile& tile, double* out) {
  const auto& w = tile.words;
  double radius[kBlocks];
  for (std::size_t i = 0; i < kBlocks; ++i) {
    radius[i] = random_math::box_muller_radius(random_math::uniform53_above_zero(w[0][i], w[1][i]));
  }
  for (std::size_t i = 0; i < kBlocks; ++i) {
    const auto angle = random_math::sin_cos_turns(random_math::uniform53(w[2][i], w[3][i]));
    out[2 * i] = radius[i] * angle.cosine;
    out[2 * i + 1] = radius[i] * angle.sine;
  }
}

CANYON_VECTOR_CLONES void uniforms_of(const PhiloxTile& tile, double* out) {
  const auto& w = tile.words;
  for (std::size_t i = 0; i < kBlocks; ++i) {
    out[2 * i] = random_math::uniform53(w[0][i], w[1][i]);
    out[2 * i + 1] = random_math::uniform53(w[2][i], w[3][i]);
  }
}

}  // namespace

void normal_tile(std::uint64_t key, std::uint32_t entity, std::uint64_t first_block, std::uint32_t n, double* out) {
  PhiloxTile tile;
  philox_tile(key, entity, first_block, n, tile);
  normals_of(tile, out);
}

void uniform_tile(std::uint64_t key, std::uint32_t entity, std::uint64_t first_block, std::uint32_t n, double* out) {
  PhiloxTile tile;
  philox_tile(key, entity, first_block, n, tile);
  uniforms_of(tile, out);
}

}  // namespace canyon
