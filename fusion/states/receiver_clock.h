#pragma once

#include "canyon/core/messages.h"

namespace canyon::fusion {

/// The states of the block receiver_clock.
struct ClockIndex {
  static constexpr int kClock = 0, kRate = 1, kSystems = 2, kSize = 5;
  /// That of the time of a system against GPS; -1 for GPS, and what keeps its time.
  static constexpr int of(GnssSystem system) {
    switch (system) {
      case GnssSystem::kGlonass:
        return kSystems;
      case GnssSystem::kGalileo:
        return kSystems + 1;
      case GnssSystem::kBeidou:
        return kSystems + 2;
      default:
        return -1;
    }
  }
};

}  // namespace canyon::fusion
