#pragma once

#include <functional>
#include <string>

#include "canyon/core/random/random.h"

/// Ways to damage a text file, for readers that must survive arbitrary bytes.
namespace canyon::gnss::testing {

/// Calls `read` with the text cut before every line, and in the middle of every line.
inline void for_each_truncation(const std::string& text, const std::function<void(const std::string&)>& read) {
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin) == std::string::npos ? text.size() : text.find('\n', begin) + 1;
    read(text.substr(0, begin));
    read(text.substr(0, (begin + end) / 2));
    begin = end;
  }
}

/// Calls `read` with each number of D19.12, in turn, replaced by numbers that no message can hold and by ones that look
/// innocent but are too large for their place: bytes at random hardly ever change an exponent.
inline void for_each_extreme_number(const std::string& text, const std::function<void(const std::string&)>& read) {
  for (std::size_t at = 18; at + 4 < text.size(); ++at) {
    const bool exponent = (text[at - 3] == 'D' || text[at - 3] == 'E') && (text[at - 2] == '+' || text[at - 2] == '-');
    if (!exponent || text[at] < '0' || text[at] > '9') continue;
    for (const char* extreme : {" 1.00000000000D+306", "-1.00000000000D+300", " 1.000000000000D+09",
                                "-1.000000000000D+01", " 4.000000000000D+00", " 0.000000000000D+00"}) {
      std::string damaged = text;
      read(damaged.replace(at - 18, 19, extreme));
    }
  }
}

/// Calls `read` `trials` times with `bytes` random bytes written at random places, every fifth time also cut at random.
inline void for_each_damage(const std::string& text, int trials, int bytes,
                            const std::function<void(const std::string&)>& read) {
  const RandomStream random(11, "test.damage");
  for (std::uint64_t trial = 0; trial < static_cast<std::uint64_t>(trials); ++trial) {
    std::string damaged = text;
    const double size = static_cast<double>(text.size());
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(bytes); ++i) {
      // Half of them digits, signs and letters that numbers are made of: they reach further into a reader.
      const double byte = random.uniform(i, trial, 1);
      const char plausible[] = "0123456789.-+DE ";
      damaged[static_cast<std::size_t>(random.uniform(i, trial) * size)] =
          i % 2 == 0 ? static_cast<char>(256.0 * byte) : plausible[static_cast<std::size_t>(16.0 * byte)];
    }
    if (trial % 5 == 0) damaged.resize(static_cast<std::size_t>(random.uniform(0, trial, 2) * size));
    read(damaged);
  }
}

}  // namespace canyon::gnss::testing
