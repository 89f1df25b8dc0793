#pragma once

#include <cstddef>
#include <cstdint>

namespace canyon {

/// Numbers computed together by the batch form of RandomStream. A private header of core/.
inline constexpr std::size_t kRandomTile = 32;

/// out[2 b + lane] of kRandomTile / 2 consecutive counter blocks, to the bit what RandomStream gives one by one.
void normal_tile(std::uint64_t key, std::uint32_t entity, std::uint64_t first_block, std::uint32_t n, double* out);
void uniform_tile(std::uint64_t key, std::uint32_t entity, std::uint64_t first_block, std::uint32_t n, double* out);

}  // namespace canyon
