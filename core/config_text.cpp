#include "core/config_text.h"

#include <algorithm>
#include <charconv>

namespace canyon {

std::string number_text(double value) {
  char buffer[64];
  const auto [end, status] = std::to_chars(buffer, buffer + sizeof buffer, value);
  return std::string(buffer, end);
}

std::string range_text(Range range, bool whole) {
  const std::string number = whole ? "whole number" : "number";
  if (range.min == kPositive.min && range.max >= kPositive.max) return "a positive " + number;
  const bool below = range.min > kAnyNumber.min;
  const bool above = range.max < kAnyNumber.max;
  if (below && above) return "a " + number + " from " + number_text(range.min) + " to " + number_text(range.max);
  if (below) return "a " + number + " of " + number_text(range.min) + " or more";
  if (above) return "a " + number + " of " + number_text(range.max) + " or less";
  return "a " + number;
}

std::string quoted_list(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "\"" : ", \"") + word + "\"";
  return text;
}

std::string nearest_word(std::string_view word, const std::vector<std::string>& known) {
  std::string best;
  // Near: at most a third of the letters wrong, and at least one may be.
  std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
  std::vector<std::size_t> row;
  for (const std::string& candidate : known) {
    // Levenshtein distance, one row at a time.
    row.resize(candidate.size() + 1);
    for (std::size_t j = 0; j <= candidate.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= word.size(); ++i) {
      std::size_t diagonal = row[0];
      row[0] = i;
      for (std::size_t j = 1; j <= candidate.size(); ++j) {
        const std::size_t substituted = diagonal + (word[i - 1] == candidate[j - 1] ? 0 : 1);
        diagonal = row[j];
        row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
      }
    }
    if (row.back() < best_distance) {
      best_distance = row.back();
      best = candidate;
    }
  }
  return best;
}

}  // namespace canyon
