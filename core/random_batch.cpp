#include "core/random_batch.h"

#include "core/random_math.h"

// The same source compiled for the plain instruction set and for AVX2 (without fused multiply-add), chosen when the
// program starts. Each operation rounds alike in both, so the bits do not depend on the choice.
#if defined(__x86_64__) && defined(__linux__)
#define CANYON_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define CANYON_VECTOR_CLONES
#endif

namespace canyon {
namespace {

constexpr std::size_t kBlocks = kRandomTile / 2;

/// Words of kBlocks Philox 4x32-10 blocks side by side (Salmon et al. 2011), in loops that compilers turn into vector
/// code.
struct Words {
  std::uint32_t w0[kBlocks], w1[kBlocks], w2[kBlocks], w3[kBlocks];
};

[[gnu::always_inline]] inline void philox_tile(std::uint64_t key, std::uint32_t entity, std::uint64_t first_block,
                                               std::uint32_t n, Words& w) {
  for (std::size_t i = 0; i < kBlocks; ++i) {
    w.w0[i] = static_cast<std::uint32_t>(first_block + i);
    w.w1[i] = static_cast<std::uint32_t>((first_block + i) >> 32);
    w.w2[i] = entity;
    w.w3[i] = n;
  }
  std::uint32_t k0 = static_cast<std::uint32_t>(key);
  std::uint32_t k1 = static_cast<std::uint32_t>(key >> 32);
  for (int round = 0; round < 10; ++round) {
    for (std::size_t i = 0; i < kBlocks; ++i) {
      const std::uint64_t product0 = std::uint64_t{w.w0[i]} * 0xD2511F53u;
      const std::uint64_t product1 = std::uint64_t{w.w2[i]} * 0xCD9E8D57u;
      w.w0[i] = static_cast<std::uint32_t>(product1 >> 32) ^ w.w1[i] ^ k0;
      w.w1[i] = static_cast<std::uint32_t>(product1);
      w.w2[i] = static_cast<std::uint32_t>(product0 >> 32) ^ w.w3[i] ^ k1;
      w.w3[i] = static_cast<std::uint32_t>(product0);
    }
    k0 += 0x9E3779B9u;  // golden ratio
    k1 += 0xBB67AE85u;  // sqrt(3) - 1
  }
}

}  // namespace

CANYON_VECTOR_CLONES void normal_tile(std::uint64_t key, std::uint32_t entity, std::uint64_t first_block,
                                      std::uint32_t n, double* out) {
  Words w;
  philox_tile(key, entity, first_block, n, w);
  double radius[kBlocks];
  for (std::size_t i = 0; i < kBlocks; ++i) {
    radius[i] = random_math::box_muller_radius(random_math::uniform53_above_zero(w.w0[i], w.w1[i]));
  }
  for (std::size_t i = 0; i < kBlocks; ++i) {
    const auto angle = random_math::sin_cos_turns(random_math::uniform53(w.w2[i], w.w3[i]));
    out[2 * i] = radius[i] * angle.cosine;
    out[2 * i + 1] = radius[i] * angle.sine;
  }
}

CANYON_VECTOR_CLONES void uniform_tile(std::uint64_t key, std::uint32_t entity, std::uint64_t first_block,
                                       std::uint32_t n, double* out) {
  Words w;
  philox_tile(key, entity, first_block, n, w);
  for (std::size_t i = 0; i < kBlocks; ++i) {
    out[2 * i] = random_math::uniform53(w.w0[i], w.w1[i]);
    out[2 * i + 1] = random_math::uniform53(w.w2[i], w.w3[i]);
  }
}

}  // namespace canyon
