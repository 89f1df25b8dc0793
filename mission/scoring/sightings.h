#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "canyon/core/truth.h"

namespace canyon::mission {

/// What the LIDAR had shown of a thing.
struct Sighting {
  double range_m = 0.0;  ///< of the nearest return in the last scan that showed it
  double stood_s = 0.0;  ///< for how long scans had shown it without a gap, until that scan
  double ago_s = 0.0;    ///< how long before that scan was
};

/// Which objects the returns of each scan were off, on truth: what the autonomy could have known.
class Sightings {
 public:
  static constexpr double kGap_s = 0.5;  ///< longer out of sight a thing is seen anew

  void scan(GpsTime t, const std::vector<LidarPointTruth>& returns);
  /// Of an object, as SceneAt counts them; none: no return was ever off it.
  std::optional<Sighting> of(std::uint32_t object, GpsTime now) const;

 private:
  struct Seen {
    GpsTime since, last;
    float range_m = 0.0f;
    bool ever = false;
  };
  std::vector<Seen> seen_;
};

}  // namespace canyon::mission
