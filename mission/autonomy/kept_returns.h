#pragma once

#include <algorithm>

namespace canyon::mission {

/// What an autonomy keeps of the scans that it is shown: returns between two heights over the ground plane of the
/// vehicle as it believes (along B's z, from B's origin), within a square about it. Of a scan of fewer returns than
/// `enough` it may keep none.
struct KeptReturns {
  double low_m = 0.0, high_m = 0.0;
  double half_size_m = 0.0;
  int enough = 0;
};

/// What keeps whatever either does.
inline KeptReturns both(const KeptReturns& a, const KeptReturns& b) {
  return {.low_m = std::min(a.low_m, b.low_m),
          .high_m = std::max(a.high_m, b.high_m),
          .half_size_m = std::max(a.half_size_m, b.half_size_m),
          .enough = std::max(a.enough, b.enough)};
}

}  // namespace canyon::mission
