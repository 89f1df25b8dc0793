#include "lidar/return_choice.h"

#include <algorithm>

namespace canyon::lidar {
namespace {

float strength(const Echo& echo) {
  return echo.reflectivity / std::max(echo.range_m * echo.range_m, 1e-6f);
}

const Echo** strongest(const Echo** begin, const Echo** end) {
  return std::max_element(begin, end, [](const Echo* a, const Echo* b) { return strength(*a) < strength(*b); });
}

}  // namespace

const std::vector<ReturnModeRow>& return_modes() {
  static const std::vector<ReturnModeRow> kRows{
      {"strongest", ReturnMode::kStrongest, "the one of most energy"},
      {"first", ReturnMode::kFirst, "the nearest"},
      {"last", ReturnMode::kLast, "the farthest"},
      {"dual", ReturnMode::kDual, "the last and the strongest, or second strongest"},
      {"all", ReturnMode::kAll, "every one"},
  };
  return kRows;
}

std::size_t choose_of_several(ReturnMode mode, const Echo** echoes, std::size_t count) {
  const Echo** const end = echoes + count;
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
      const Echo* const last = end[-1];
      // If the last is the strongest, the strongest of the others is the second.
      echoes[0] = *strongest(echoes, end - 1);
      echoes[1] = last;
      return 2;
    }
  }
}

}  // namespace canyon::lidar
