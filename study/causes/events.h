#pragma once

#include <limits>
#include <string>
#include <vector>

#include "canyon/core/model_table.h"
#include "canyon/mission/recorder/recorder.h"

namespace canyon::study {

/// What may lead to a failure, as seen on one run. A new one is one value here, one row of event_kinds(), and where
/// RunEvents sees it.
enum class EventKind { kDilutionJump, kHiddenSignals, kFixLost, kUnlikelyFix, kOverconfident, kStopped };
/// Name in results, and what it is.
ModelTable<EventKind> event_kinds();

/// Times are seconds after the start.
struct Event {
  EventKind kind = EventKind::kDilutionJump;
  double from_s = 0.0, to_s = 0.0;
  double size = 0.0;  ///< the largest of it: change of GDOP; hidden signals tracked; fixes lost; NIS over its 99.9 %
                      ///< bound; position error over its own 3 sigma; commands asking to stand, as a share: 1
};

/// Sees a run's events as it goes. Two of a kind that are less than kEventGap_s apart are one.
class RunEvents final : public mission::Recorder {
 public:
  Status gnss(const mission::GnssRow& row) override;
  Status epoch(const mission::NavRow& row) override;

  /// By time of their beginning.
  std::vector<Event> events() const;

 private:
  void see(EventKind kind, GpsTime t, double size);

  std::vector<Event> events_;
  bool started_ = false, had_fix_ = true;
  GpsTime start_;
  double last_gdop_ = std::numeric_limits<double>::quiet_NaN();
};

inline constexpr double kEventGap_s = 2.0;

/// The beginning of the last chain of events before a failure: from it backwards, as long as no gap of over 10 s parts
/// one from the next, and at most 60 s. Standing still is no part of it: it follows from others. `failed_s` without
/// any: 10 s before it.
double chain_start_s(const std::vector<Event>& events, double failed_s);

}  // namespace canyon::study
