#include "canyon/core/math/key_select.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"

namespace canyon {
namespace {

using Keys = std::vector<std::uint64_t>;

/// The key at its place, the others on their side of it, and none lost.
void expect_selected(const Keys& given, std::size_t at, const std::string& what) {
  Keys keys = given, scratch(given.size()), sorted = given;
  select_key(keys, at, scratch);
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(keys[at], sorted[at]) << what;
  EXPECT_TRUE(std::all_of(keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(at), [&](std::uint64_t key) {
    return key < sorted[at];
  })) << what;
  std::sort(keys.begin(), keys.end());
  EXPECT_EQ(keys, sorted) << what;
}

void expect_selected_anywhere(const Keys& given, const std::string& what) {
  const std::size_t n = given.size();
  for (const std::size_t at : {std::size_t{0}, std::size_t{1}, n / 3, n / 2, n - 1})
    if (at < n) expect_selected(given, at, what + ", " + std::to_string(at) + " of " + std::to_string(n));
}

TEST(KeySelect, DrawnKeys) {
  const RandomStream draws(1, "tests.key_select");
  std::uint32_t entity = 0;
  for (const std::size_t n : {1, 2, 9, 16, 17, 18, 100, 1000, 5000}) {
    Keys keys(n);
    ++entity;
    for (std::size_t i = 0; i < n; ++i)
      keys[i] = static_cast<std::uint64_t>(draws.uniform(0.0, 4e9, entity, i)) << 32 | i;
    expect_selected_anywhere(keys, "drawn");
  }
}

TEST(KeySelect, SortedKeys) {
  Keys rising(3000);
  std::iota(rising.begin(), rising.end(), 0);
  expect_selected_anywhere(rising, "rising");
  expect_selected_anywhere({rising.rbegin(), rising.rend()}, "falling");
}

}  // namespace
}  // namespace canyon
