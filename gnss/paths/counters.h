#pragma once

#include <cstdint>

namespace canyon::gnss {

/// Work done, for reports of cost and of what was left out.
struct GnssCounters {
  std::int64_t epochs = 0;
  std::int64_t occlusion_rays = 0;
  std::int64_t path_searches = 0;  ///< for the ways of one signal to one place of the antenna
  std::int64_t facets_tested = 0;
  std::int64_t reflected_paths = 0;
  std::int64_t diffracted_paths = 0;
  std::int64_t delays_computed = 0;  ///< models of atmosphere, ephemeris and differences to a base, asked for a signal
  std::int64_t epochs_in_full = 0;   ///< measured again, with the delays that had been left out
};

}  // namespace canyon::gnss
