#include "canyon/gnss/solver/receiver_clocks.h"

#include <algorithm>

#include "canyon/core/check.h"

namespace canyon::gnss {

GnssSystem clock_system(GnssSystem system) {
  return system == GnssSystem::kQzss || system == GnssSystem::kSbas ? GnssSystem::kGps : system;
}

ReceiverClocks::ReceiverClocks(std::span<const RangeMeasurement> ranges) {
  for (const auto& r : ranges) add(r.system);
}

ReceiverClocks::ReceiverClocks(std::span<const GnssSystem> systems) {
  for (const GnssSystem s : systems) add(s);
}

void ReceiverClocks::add(GnssSystem system) {
  const GnssSystem clock = clock_system(system);
  const auto at = std::lower_bound(systems_.begin(), systems_.end(), clock);
  if (at == systems_.end() || *at != clock) systems_.insert(at, clock);
}

std::size_t ReceiverClocks::index(GnssSystem system) const {
  const auto at = std::find(systems_.begin(), systems_.end(), clock_system(system));
  CANYON_CHECK(at != systems_.end(), "no clock of system ", system_letter(system));
  return static_cast<std::size_t>(at - systems_.begin());
}

}  // namespace canyon::gnss
