#pragma once

#include <cstdint>

#include "canyon/core/model_table.h"

namespace canyon::mission {

/// How a mission ended, scored on the true vehicle. All but kSuccess are a Failure's kind. A new one is one value here
/// and one row of outcomes(); readers of results pass names through that they do not know.
enum class Outcome : std::uint8_t {
  kCollision,
  kLeftScene,
  kStuck,
  kAutonomyFault,
  kLost,
  kTimeout,
  kStopped,
  kMissedWaypoint,
  kNoLineOfSight,
  kSuccess,
};

/// Name in results, and when it is the outcome: the table of docs/results.md, row by row, in its order.
ModelTable<Outcome> outcomes();

inline const char* name(Outcome outcome) {
  return row_of(outcomes(), outcome).name;
}

}  // namespace canyon::mission
