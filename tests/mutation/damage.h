#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// Seeded damage of a file's bytes: what disks, transfers, editors, other programs and ill will do to one.
namespace canyon::testing {

struct Damaged {
  std::size_t seed = 0;  ///< which of the seeds was damaged
  std::string bytes;
  std::string how;  ///< for messages: "bits flipped, cut short"
};

/// Damages one of `seeds`. The same format, variant and seeds give the same bytes on every machine. The first
/// kWholeFileVariants variants are damage that is the same for every format: nothing in the file, one byte, a hundred
/// thousand brackets, and the like; the others are one to three kinds of damage at random places, among them numbers
/// that no reader may trust (1e308, -1, 2147483648, nan, ...), blocks and lines left out, doubled and exchanged between
/// files, deep nesting, bytes that are no UTF-8, keys that occur twice, and very long lines.
Damaged damage(const std::vector<std::string>& seeds, std::string_view format, std::uint64_t variant);

inline constexpr std::uint64_t kWholeFileVariants = 10;

}  // namespace canyon::testing
