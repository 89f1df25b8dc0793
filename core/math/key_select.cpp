#include "canyon/core/math/key_select.h"

#include <algorithm>
#include <utility>

namespace canyon {
namespace {

using Key = std::uint64_t;

constexpr std::size_t kFew = 16;  // sorted by insertion
constexpr int kMostRounds = 64;   // so many bad pivots somebody must have looked for: std::nth_element takes over

Key median(Key a, Key b, Key c) {
  return std::max(std::min(a, b), std::min(std::max(a, b), c));
}

/// Of nine keys, evenly apart.
Key pivot_of(const Key* first, std::size_t n) {
  const std::size_t step = (n - 1) / 8;
  const auto of_three = [first, step](std::size_t k) {
    return median(first[k * step], first[(k + 1) * step], first[(k + 2) * step]);
  };
  return median(of_three(0), of_three(3), of_three(6));
}

/// Smaller ones first, the others in the order they had; returns how many are smaller.
std::size_t part(Key* first, std::size_t n, Key pivot, Key* scratch) {
  std::size_t left = 0, right = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Key key = first[i];
    const std::size_t smaller = key < pivot ? 1 : 0;
    first[left] = key;
    scratch[right] = key;
    left += smaller;
    right += 1 - smaller;
  }
  std::copy_n(scratch, right, first + left);
  return left;
}

void sort_few(Key* first, std::size_t n) {
  for (std::size_t i = 1; i < n; ++i) {
    const Key key = first[i];
    std::size_t k = i;
    for (; k > 0 && key < first[k - 1]; --k) first[k] = first[k - 1];
    first[k] = key;
  }
}

}  // namespace

void select_key(std::span<Key> keys, std::size_t at, std::span<Key> scratch) {
  Key* first = keys.data();
  std::size_t n = keys.size();
  for (int round = 0; n > kFew; ++round) {
    if (round == kMostRounds) {
      std::nth_element(first, first + at, first + n);
      return;
    }
    const Key pivot = pivot_of(first, n);
    const std::size_t left = part(first, n, pivot, scratch.data());
    if (at < left) {
      n = left;
    } else if (left > 0) {
      first += left, n -= left, at -= left;
    } else {  // the pivot is the smallest
      std::iter_swap(first, std::find(first, first + n, pivot));
      if (at == 0) return;
      ++first, --n, --at;
    }
  }
  sort_few(first, n);
}

}  // namespace canyon
