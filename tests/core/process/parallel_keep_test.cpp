#include "canyon/core/process/parallel_keep.h"

#include <gtest/gtest.h>

namespace canyon {
namespace {

std::vector<int> kept_below(std::size_t n, std::size_t chunk, int of_seven) {
  std::vector<int> out(5, -1);  // what stood there is gone
  parallel_keep(n, chunk, out, [&](std::size_t begin, std::size_t end, int* to) {
    for (std::size_t k = begin; k < end; ++k)
      if (static_cast<int>(k * k % 7) < of_seven) *to++ = static_cast<int>(k);
    return to;
  });
  return out;
}

TEST(ParallelKeep, KeepsTheOrderForAnyChunksAndThreads) {
  for (const int of_seven : {0, 1, 3, 7}) {
    std::vector<int> expected;
    for (int k = 0; k < 1000; ++k)
      if (k * k % 7 < of_seven) expected.push_back(k);
    for (const int count : {1, 2, 8}) {
      set_threads(count);
      for (const std::size_t chunk : {1U, 10U, 333U, 1000U, 5000U})
        EXPECT_EQ(kept_below(1000, chunk, of_seven), expected) << of_seven << " " << count << " " << chunk;
    }
  }
  set_threads(0);
}

TEST(ParallelKeep, OfNothingIsNothing) {
  EXPECT_TRUE(kept_below(0, 10, 7).empty());
}

}  // namespace
}  // namespace canyon
