#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <variant>

#include "canyon/fusion/error_state_filter.h"
#include "canyon/fusion/timeline/incident.h"

namespace canyon::fusion {

struct TimelineConfig {
  double wait_s = 1.0;            ///< so far back messages are taken in their place
  double held_s = 0.1;            ///< in a gap the last rates hold so long; then nothing turns or pushes
  double gap_rate_deg_s = 20.0;   ///< 1-sigma of the rate of turn that is not known in a gap
  double gap_force_m_s2 = 2.0;    ///< of the force
  double frozen_speed_m_s = 0.5;  ///< estimated speed from which a fix that stands still is none
};
void visit(FieldVisitor& f, TimelineConfig& c);

/// A filter on what really arrives: IMU samples and messages in any order, late, twice, not at all, or wrong. What
/// comes late is taken in its place: the filter goes back to a copy of itself from before, and runs what has come since
/// once more. What comes ahead of the IMU waits. A message between two samples divides the one that covers it, rate and
/// force being constant in it.
///
/// Fixes are due at their stamp plus what the block time_offset says of stamps.
class FilterTimeline {
 public:
  /// The filter must have been initialized; its first sample begins there.
  FilterTimeline(ErrorStateFilter filter, const TimelineConfig& config);

  /// Takes it in, and says what was wrong with it. The time of the filter is that of the last sample.
  Trouble add(const ImuSample& sample);
  Trouble add(const AidingMessage& message);
  /// Goes on to t without an IMU: nothing turns and nothing pushes, as unsure as the IMU's noise that the filter was
  /// told of. For a receiver by itself.
  void coast(GpsTime to);

  /// As it stands with all that has come.
  const ErrorStateFilter& filter() const { return filter_; }
  const Incidents& incidents() const { return incidents_; }
  /// How often it went back, for late messages.
  std::int64_t replays() const { return replays_; }

  /// Called after each measurement that is taken in for the first time.
  std::function<void(const UpdateReport&, const ErrorStateFilter&)> on_update;

 private:
  /// A part of a gap in which nothing is known of the motion.
  struct Coast {
    double dt_s;
  };
  struct Event {
    GpsTime t;  ///< end of a sample or coast; when a message is due
    std::variant<ImuSample, Coast, AidingMessage> what;
    double gap_s = 0.0;  ///< a gap of this length ends with it
    bool done = false;   ///< taken in before, if it is run once more
    bool moves() const { return !std::holds_alternative<AidingMessage>(what); }
  };
  struct Checkpoint {
    ErrorStateFilter filter;
    std::int64_t next;  ///< event, counted from the first of all
  };

  Trouble judge(const AidingMessage& message);
  GpsTime due(const AidingMessage& message) const;
  void bridge(GpsTime to, double dt_s, bool loosens);
  void run();
  void move(Event& event);
  bool correct(Event& event);
  void predict(const ImuSample& sample, bool done);
  ImuSample motion_of(const Event& event) const;
  void go_back(std::int64_t to);
  void forget();
  Event& event(std::int64_t i) { return events_[static_cast<std::size_t>(i - first_)]; }
  std::int64_t end() const { return first_ + static_cast<std::int64_t>(events_.size()); }

  ErrorStateFilter filter_;
  TimelineConfig config_;
  Incidents incidents_;
  std::deque<Event> events_;  ///< in the order of their time
  std::int64_t first_ = 0;    ///< number of the first that is kept
  std::int64_t next_ = 0;     ///< number of the first that is not in filter_
  std::deque<Checkpoint> checkpoints_;
  std::optional<ImuSample> rest_;  ///< of the sample that is being divided
  std::optional<ImuSample> last_imu_;
  std::optional<GnssFix> last_fix_;
  GpsTime reached_;  ///< end of the last sample that has come
  std::int64_t replays_ = 0;
};

}  // namespace canyon::fusion
