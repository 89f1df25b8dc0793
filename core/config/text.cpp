#include "canyon/core/config/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace canyon {

std::string number_text(double value) {
  char buffer[64];
  const auto [end, status] = std::to_chars(buffer, buffer + sizeof buffer, value);
  return std::string(buffer, end);
}

std::string range_text(Range range, bool whole) {
  if (!std::isnan(range.unset)) return range_text({range.min, range.max}, whole) + ", or " + number_text(range.unset);
  const std::string number = whole ? "whole number" : "number";
  if (range.min == kPositive.min && range.max >= kPositive.max) return "a positive " + number;
  const bool below = range.min > kAnyNumber.min;
  const bool above = range.max < kAnyNumber.max;
  if (below && above) return "a " + number + " from " + number_text(range.min) + " to " + number_text(range.max);
  if (below) return "a " + number + " of " + number_text(range.min) + " or more";
  if (above) return "a " + number + " of " + number_text(range.max) + " or less";
  return "a " + number;
}

std::string plain_list(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string quoted_list(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "\"" : ", \"") + word + "\"";
  return text;
}

namespace {

/// Letters to insert, delete, replace or swap with their neighbour to turn one word into the other (Damerau's distance,
/// each letter touched once).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      const std::size_t replaced = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replaced});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

std::string nearest_word(std::string_view word, const std::vector<std::string>& known) {
  std::string best;
  // Near: at most a third of the letters wrong, and at least one may be.
  std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : known) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  if (!best.empty()) return best;
  // Else a word that is part of the other: the longest common part, then the shortest word.
  constexpr std::size_t kLeastPart = 3;
  std::size_t best_part = kLeastPart - 1;
  for (const std::string& candidate : known) {
    const bool holds = candidate.find(word) != std::string::npos || word.find(candidate) != std::string_view::npos;
    const std::size_t part = std::min(word.size(), candidate.size());
    if (!holds || part < best_part || (part == best_part && (best.empty() || candidate.size() >= best.size())))
      continue;
    best_part = part;
    best = candidate;
  }
  return best;
}

}  // namespace canyon
