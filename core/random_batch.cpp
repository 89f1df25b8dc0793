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

struct Block {
  std::uint32_t w0, w1, w2, w3, k0, k1;
};

[[gnu::always_inline]] inline Block philox_round(const Block& b) {
  const std::uint64_t product0 = std::uint64_t{b.w0} * 0xD2511F53u;
  const std::uint64_t product1 = std::uint64_t{b.w2} * 0xCD9E8D57u;
  return {static_cast<std::uint32_t>(product1 >> 32) ^ b.w1 ^ b.k0,
          static_cast<std::uint32_t>(product1),
          static_cast<std::uint32_t>(product0 >> 32) ^ b.w3 ^ b.k1,
          static_cast<std::uint32_t>(product0),
          b.k0 + 0x9E3779B9u,   // golden ratio
          b.k1 + 0xBB67AE85u};  // sqrt(3) - 1
}

[[gnu::always_inline]] inline void philox_tile(std::uint64_t key, std::uint32_t entity, std::uint64_t first_block,
                                               std::uint32_t n, Words& w) {
  for (std::size_t i = 0; i < kBlocks; ++i) {
    const std::uint64_t block = first_block + i;
    Block b = {static_cast<std::uint32_t>(block), static_cast<std::uint32_t>(block >> 32), entity, n,
               static_cast<std::uint32_t>(key),   static_cast<std::uint32_t>(key >> 32)};
    // Written out: a loop in here would keep compilers from working on several blocks at once.
    b = philox_round(philox_round(philox_round(philox_round(philox_round(b)))));
    b = philox_round(philox_round(philox_round(philox_round(philox_round(b)))));
    w.w0[i] = b.w0;
    w.w1[i] = b.w1;
    w.w2[i] = b.w2;
    w.w3[i] = b.w3;
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
