#pragma once

#include <vector>

#include "canyon/core/messages.h"

namespace canyon::fusion {

/// Which of a few states is which satellite's. One that is seen keeps its place; one that is new takes a place that
/// nobody has had, or that of the one not seen for the longest.
class SatelliteSlots {
 public:
  explicit SatelliteSlots(int count) : slots_(static_cast<std::size_t>(count)) {}

  void clear() { slots_.assign(slots_.size(), {}); }
  /// Finds a place for each satellite of the epoch, as far as there are some, in the epoch's order.
  void assign(const GnssEpoch& epoch);
  /// -1: it has none.
  int of(SatelliteId sv) const;
  /// Places that have got a new satellite in the last assign().
  const std::vector<int>& begun() const { return begun_; }
  /// Places with a satellite, of whatever age.
  bool taken(int slot) const { return slots_[static_cast<std::size_t>(slot)].taken; }
  int count() const { return static_cast<int>(slots_.size()); }

 private:
  struct Slot {
    SatelliteId sv;
    GpsTime seen;
    bool taken = false;
  };
  std::vector<Slot> slots_;
  std::vector<int> begun_;
};

}  // namespace canyon::fusion
