#pragma once

#include <cstddef>
#include <cstdint>

namespace canyon {

/// Numbers computed together by the batch form of RandomStream. A private header of core/.
inline constexpr std::size_t kRandomTile = 32;

/// out[2 b + lane] of kRandomTile / 2 consecutive counter blocks, to the bit what RandomStream gives one by one.
void normal_tile(std::uint64_t key, std::uint32_t entity, std::uint64_t first_block, std::uint32_t n, double* out);
void uniform_tile(std::uint64_t key, std::uint32_t entity, std::uint64_t first_block, std::uint32_t n, double* out);

/// Words of kRandomTile / 2 Philox blocks side by side: word j of block b in words[j][b], in the lower 32 bits; the
/// upper ones are zero.
struct PhiloxTile {
  alignas(64) std::uint64_t words[4][kRandomTile / 2];
};
using PhiloxFunction = void (*)(std::uint64_t key, std::uint32_t entity, std::uint64_t first_block, std::uint32_t n,
                                PhiloxTile& tile);
/// The generator for any machine, and the one that this machine's instruction set allows; the words are the same.
void philox_tile_portable(std::uint64_t key, std::uint32_t entity, std::uint64_t first_block, std::uint32_t n,
                          PhiloxTile& tile);
PhiloxFunction philox_tile_of_this_machine();

}  // namespace canyon
