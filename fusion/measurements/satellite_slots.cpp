#include "canyon/fusion/measurements/satellite_slots.h"

namespace canyon::fusion {

int SatelliteSlots::of(SatelliteId sv) const {
  for (std::size_t i = 0; i < slots_.size(); ++i)
    if (slots_[i].taken && slots_[i].sv == sv) return static_cast<int>(i);
  return -1;
}

void SatelliteSlots::assign(const GnssEpoch& epoch) {
  begun_.clear();
  for (const GnssObservation& o : epoch.observations)
    if (const int at = of(o.sv); at >= 0) slots_[static_cast<std::size_t>(at)].seen = epoch.t;
  for (const GnssObservation& o : epoch.observations) {
    if (of(o.sv) >= 0) continue;
    Slot* best = nullptr;
    for (Slot& slot : slots_) {
      if (slot.taken && slot.seen == epoch.t) continue;
      if (best == nullptr || (best->taken && (!slot.taken || slot.seen < best->seen))) best = &slot;
    }
    if (best == nullptr) return;
    *best = {o.sv, epoch.t, true};
    begun_.push_back(static_cast<int>(best - slots_.data()));
  }
}

}  // namespace canyon::fusion
