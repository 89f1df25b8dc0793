#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/model_table.h"
#include "canyon/mission/config/mission_config.h"
#include "canyon/mission/recorder/recorder.h"

namespace canyon::study {

/// What may lead to a failure, as seen on one run. A new one is one value here, one row of event_kinds(), and where
/// RunEvents sees it.
enum class EventKind {
  kDilutionJump,
  kHiddenSignals,
  kFixLost,
  kUnlikelyFix,
  kOverconfident,
  kMapDoubled,
  kPhantom,
  kStopped
};
/// Name in results, and what it is.
ModelTable<EventKind> event_kinds();

/// Times are seconds after the start.
struct Event {
  EventKind kind = EventKind::kDilutionJump;
  double from_s = 0.0, to_s = 0.0;
  double size = 0.0;  ///< the largest of it: change of GDOP; hidden signals tracked; fixes lost; NIS over its 99.9 %
                      ///< bound; position error over its own 3 sigma; m between the two copies; epochs: 1
};

/// By when the autonomy of a mission has seen something and planned, s after the start: a first scan must have begun
/// after the start, and there is one in every period; mission::Scorer::kFirstPlan_s more.
double first_plan_by_s(const mission::MissionConfig& config);

/// Sees a run's events as it goes. Two of a kind that are less than kEventGap_s apart are one.
class RunEvents final : public mission::Recorder {
 public:
  /// Who stands from the start on and no longer than until `first_plan_by_s` waits for its first scan, and has not
  /// stopped.
  explicit RunEvents(double first_plan_by_s = 0.0) : first_plan_by_s_(first_plan_by_s) {}

  Status gnss(const mission::GnssRow& row) override;
  Status epoch(const mission::NavRow& row) override;
  Status keyframe(const mission::KeyframeRow& row) override;

  /// By time of their beginning.
  std::vector<Event> events() const;

 private:
  void see(EventKind kind, GpsTime t, double size);
  void see_standing(bool stands, GpsTime t);

  /// Where keyframes truly were, and how far off they were placed.
  struct Placed {
    Eigen::Vector3d p_W, off_W;
  };

  double first_plan_by_s_;
  bool waits_ = true;              ///< it has stood since its first epoch, and may wait for its first scan
  std::optional<GpsTime> waited_;  ///< that epoch
  std::vector<Event> events_;
  std::map<std::pair<int, int>, std::vector<Placed>> placed_;  ///< by cells of kSameSurfaces_m
  bool started_ = false, had_fix_ = true;
  GpsTime start_;
  double last_gdop_ = std::numeric_limits<double>::quiet_NaN();
};

inline constexpr double kEventGap_s = 2.0;
/// Keyframes so near one another meet the same surfaces, which stand twice in a map that places them so differently.
inline constexpr double kSameSurfaces_m = 10.0, kDoubled_m = 0.5;

/// The beginning of the last chain of events before a failure: from it backwards, as long as no gap of over 10 s parts
/// one from the next, and at most 60 s. A map that is doubled and standing still, blocked or before a
/// phantom, are no part of it: they follow from others. `failed_s` without
/// any: 10 s before it.
double chain_start_s(const std::vector<Event>& events, double failed_s);

}  // namespace canyon::study
