#include "canyon/study/registration_error/events/event_kinds.h"

namespace canyon::study {

ModelTable<MapEventKind> map_event_kinds() {
  static constexpr ModelRow<MapEventKind> kRows[] = {
      {"dop_jump", MapEventKind::kDilutionJump, "GDOP changes by more than 2 from fix to fix; size: by how much"},
      {"fix_lost", MapEventKind::kFixLost,
       "the first epoch without a fix; size: seconds until the next one, or the end"},
      {"fix_back", MapEventKind::kFixBack, "the first fix after some without; size: seconds that there was none"},
      {"nlos_begin", MapEventKind::kNlosBegin,
       "signals of hidden satellites come into the fix; size: the most of them at once"},
      {"estimate_jump", MapEventKind::kEstimateJump,
       "between two keyframes the estimate is corrected by more than 3 sigma of what was predicted, or by more than 1 "
       "m; size: by how much"},
  };
  return kRows;
}

std::vector<MapEvent> fix_events(const std::vector<Event>& seen, double first_s, double last_s, double period_s) {
  std::vector<MapEvent> out;
  for (const Event& event : seen) {
    const double from_s = first_s + event.from_s, to_s = first_s + event.to_s, back_s = to_s + period_s;
    switch (event.kind) {
      case EventKind::kDilutionJump:
        out.push_back({MapEventKind::kDilutionJump, from_s, from_s, to_s, event.size});
        break;
      case EventKind::kHiddenSignals:
        out.push_back({MapEventKind::kNlosBegin, from_s, from_s, to_s, event.size});
        break;
      case EventKind::kFixLost:
        out.push_back({MapEventKind::kFixLost, from_s, from_s, to_s, back_s - from_s});
        if (to_s < last_s - 0.5 * period_s)
          out.push_back({MapEventKind::kFixBack, back_s, from_s, back_s, back_s - from_s});
        break;
      default:  // what a mission fails of, not what moves a map
        break;
    }
  }
  return out;
}

}  // namespace canyon::study
