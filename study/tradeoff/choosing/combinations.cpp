#include "canyon/study/tradeoff/choosing/combinations.h"

#include <algorithm>

namespace canyon::study {
namespace {

/// Keeps the front, by growing cost and falling change.
void keep_front(std::vector<Combination>& all, std::size_t largest) {
  std::stable_sort(all.begin(), all.end(), [](const Combination& a, const Combination& b) {
    return a.cpu_s != b.cpu_s ? a.cpu_s < b.cpu_s : a.change < b.change;
  });
  std::vector<Combination> front;
  for (Combination& one : all)
    if (front.empty() || one.change < front.back().change) front.push_back(std::move(one));
  if (front.size() > largest) {
    std::vector<Combination> fewer;
    for (std::size_t i = 0; i < largest; ++i) fewer.push_back(std::move(front[i * (front.size() - 1) / (largest - 1)]));
    front = std::move(fewer);
  }
  all = std::move(front);
}

}  // namespace

std::vector<Combination> best_combinations(const std::vector<std::vector<Option>>& keys, std::size_t largest) {
  std::vector<Combination> front(1);
  for (const std::vector<Option>& options : keys) {
    std::vector<Combination> next;
    for (const Combination& before : front) {
      for (std::size_t i = 0; i < options.size(); ++i) {
        Combination one = before;
        one.options.push_back(i);
        one.cpu_s += options[i].cpu_s;
        one.change += options[i].change;
        next.push_back(std::move(one));
      }
    }
    keep_front(next, largest);
    front = std::move(next);
  }
  return front;
}

}  // namespace canyon::study
