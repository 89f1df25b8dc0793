#include "canyon/lidar/receiver/return_choice.h"

#include <algorithm>

namespace canyon::lidar {
namespace {

const DetectedEcho* strongest(const DetectedEcho* begin, const DetectedEcho* end) {
  return std::max_element(begin, end,
                          [](const DetectedEcho& a, const DetectedEcho& b) { return a.strength < b.strength; });
}

}  // namespace

ModelTable<ReturnMode> return_modes() {
  static constexpr ModelRow<ReturnMode> kRows[] = {
      {"strongest", ReturnMode::kStrongest, "the one of most energy"},
      {"first", ReturnMode::kFirst, "the nearest"},
      {"last", ReturnMode::kLast, "the farthest"},
      {"dual", ReturnMode::kDual, "the last and the strongest, or second strongest"},
      {"all", ReturnMode::kAll, "every one"},
  };
  return kRows;
}

std::size_t choose_returns(ReturnMode mode, DetectedEcho* echoes, std::size_t count) {
  if (count <= 1 || mode == ReturnMode::kAll) return count;
  const DetectedEcho* const end = echoes + count;
  switch (mode) {
    case ReturnMode::kFirst:
      return 1;
    case ReturnMode::kLast:
      echoes[0] = end[-1];
      return 1;
    case ReturnMode::kStrongest:
      echoes[0] = *strongest(echoes, end);
      return 1;
    default: {
      const DetectedEcho last = end[-1];
      // If the last is the strongest, the strongest of the others is the second.
      echoes[0] = *strongest(echoes, end - 1);
      echoes[1] = last;
      return 2;
    }
  }
}

}  // namespace canyon::lidar
