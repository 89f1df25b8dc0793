#pragma once

#include <functional>
#include <string>

#include "core/random.h"

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
