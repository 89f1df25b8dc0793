#pragma once

#include <vector>

#include "canyon/core/model_table.h"
#include "canyon/study/causes/events.h"

namespace canyon::study {

/// What may move a map, as seen on one run. A new one is a value here, a row of map_event_kinds(), and where it is
/// seen.
enum class MapEventKind { kDilutionJump, kFixLost, kFixBack, kNlosBegin, kEstimateJump };
/// Name in results, and what it is.
ModelTable<MapEventKind> map_event_kinds();

/// Times are seconds after the start, on the tape.
struct MapEvent {
  MapEventKind kind = MapEventKind::kDilutionJump;
  double t_s = 0.0;                 ///< when it happens
  double from_s = 0.0, to_s = 0.0;  ///< while what it belongs to lasts: a place is without it only outside of this
  double size = 0.0;  ///< change of GDOP; seconds without fix; most hidden signals; metres of the correction
};

/// Those of the fixes, out of what RunEvents saw. `first_s` and `last_s`: when its first and its last row came, after
/// the start; fixes come every `period_s`. A loss that lasts to the end is one without a return.
std::vector<MapEvent> fix_events(const std::vector<Event>& seen, double first_s, double last_s, double period_s);

}  // namespace canyon::study
