#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace canyon {

/// Puts the key that is `at` places behind the smallest at its place, smaller ones before it and larger ones behind it,
/// as std::nth_element would, but without a branch for each key, which nobody can foretell. No key stands twice,
/// 0 <= at < keys.size(), and the scratch is as long as the keys.
void select_key(std::span<std::uint64_t> keys, std::size_t at, std::span<std::uint64_t> scratch);

}  // namespace canyon
