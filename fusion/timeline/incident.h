#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "canyon/core/time.h"

namespace canyon::fusion {

/// What may be wrong with what reaches a filter. None of it ends a run.
enum class Trouble : std::uint8_t {
  kNone,
  kNotFinite,  ///< a value is NaN or infinite, or a covariance is none: left out
  kReversed,   ///< an IMU sample of a time that is over: left out
  kDuplicate,  ///< the same instant once more: left out
  kGap,        ///< IMU samples are missing before this one: bridged, and the filter less sure
  kLost,       ///< the sample repeats the last one, its own did not arrive: taken, and the filter less sure
  kTooLate,    ///< a message of a time further back than is kept: left out
  kFrozen,     ///< a fix that stands still to the bit while the vehicle moves: left out
  kAhead,      ///< a message of a time that the IMU has not reached: it waits
};
inline constexpr int kTroubles = 9;
/// "gap in the IMU's samples" and so on, for a table or a warning.
const char* trouble_text(Trouble trouble);
/// "gap" and so on, for a file.
const char* trouble_key(Trouble trouble);

/// How often each came.
class Incidents {
 public:
  void add(Trouble trouble, GpsTime t);
  void add(const Incidents& later);
  std::int64_t count(Trouble trouble) const { return counts_[static_cast<std::size_t>(trouble)]; }
  /// When it came first; undefined where count() is 0.
  GpsTime first(Trouble trouble) const { return first_[static_cast<std::size_t>(trouble)]; }
  /// "3 x gap in the IMU's samples (first at ...), 1 x ..."; empty where there was none.
  std::string text() const;

 private:
  std::array<std::int64_t, kTroubles> counts_{};
  std::array<GpsTime, kTroubles> first_{};
};

}  // namespace canyon::fusion
