#include "canyon/mission/scoring/sightings.h"

#include <algorithm>

#include "canyon/lidar/beam/no_surface.h"

namespace canyon::mission {

void Sightings::scan(GpsTime t, const std::vector<LidarPointTruth>& returns) {
  for (const LidarPointTruth& point : returns) {
    if (point.object == lidar::kNoObject) continue;  // a drop, another sensor's pulse
    if (point.object >= seen_.size()) seen_.resize(point.object + 1);
    Seen& seen = seen_[point.object];
    if (seen.ever && seen.last == t) {
      seen.range_m = std::min(seen.range_m, point.range_m);
      continue;
    }
    if (!seen.ever || t - seen.last > kGap_s) seen.since = t;
    seen.ever = true;
    seen.last = t;
    seen.range_m = point.range_m;
  }
}

std::optional<Sighting> Sightings::of(std::uint32_t object, GpsTime now) const {
  if (object >= seen_.size() || !seen_[object].ever) return std::nullopt;
  const Seen& seen = seen_[object];
  return Sighting{static_cast<double>(seen.range_m), seen.last - seen.since, now - seen.last};
}

}  // namespace canyon::mission
