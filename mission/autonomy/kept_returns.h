#pragma once

namespace canyon::mission {

/// What an autonomy keeps of the scans that it is shown: returns between two heights over the ground plane of the
/// vehicle as it believes (along B's z, from B's origin), within a square about it. Of a scan of fewer returns than
/// `enough` it may keep none.
struct KeptReturns {
  double low_m = 0.0, high_m = 0.0;
  double half_size_m = 0.0;
  int enough = 0;
};

}  // namespace canyon::mission
