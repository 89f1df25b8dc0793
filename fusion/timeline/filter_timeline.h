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
  double same_instant_s = 1e-6;   ///< not a key: instants this close are the same, by the rounding of stamps

  /// Takes samples and messages as a run took them whose own clock stamped them: nothing is mended.
  static TimelineConfig as_recorded();
};
void visit(FieldVisitor& f, TimelineConfig& c);

/// A filter on what really arrives: IMU samples and messages in any order, late, twice, not at all, or wrong. What
/// comes late is taken in its place: the filter goes back to a copy of itself from before, and runs what has come since
/// once more. What comes ahead of the IMU waits. A message between two samples divides the one that covers it, rate and
/// force being constant in it.
///
/// Fixes are due at their stamp plus what the block time_offset says of stamps.
///
/// Times are by the clock of the messages. A unit whose samples are stamped by another one, that nobody sets, says with
/// each sample when it ended by that of the messages.
class FilterTimeline {
 public:
  /// The filter must have been initialized; its first sample begins there.
  FilterTimeline(ErrorStateFilter filter, const TimelineConfig& config)
      : FilterTimeline(std::move(filter), config, std::nullopt) {}
  /// `at`: where that is by the clock of the messages; none: that is the filter's.
  FilterTimeline(ErrorStateFilter filter, const TimelineConfig& config, std::optional<GpsTime> at);

  /// Takes it in, and says what was wrong with it. The time of the filter is that of the last sample.
  Trouble add(const ImuSample& sample) { return add(sample, sample.t); }
  Trouble add(const ImuSample& sample, GpsTime at);
  Trouble add(const AidingMessage& message) { return add(message, due(message)); }
  /// One that is due at another time than its stamp says, which is by the clock of its receiver.
  Trouble add(const AidingMessage& message, GpsTime due);
  /// Calls on_look once all before t, and what came of t, has been taken in: a sample that holds t is divided there.
  void look(GpsTime t);
  /// Goes on to t without an IMU: nothing turns and nothing pushes, as unsure as the IMU's noise that the filter was
  /// told of. For a receiver by itself.
  void coast(GpsTime to);

  /// From now on tells this of what the filter does for the first time; null: nobody. It must outlive this. begin() is
  /// called again after each return to a late message.
  void watch(FilterObserver* observer);

  /// As it stands with all that has come.
  const ErrorStateFilter& filter() const { return filter_; }
  /// Where the filter is, by the clock of the messages.
  GpsTime at() const { return at_; }
  /// How long the samples were missing that were bridged, s in all.
  double bridged_s() const { return bridged_s_; }
  /// Messages that wait for the IMU.
  std::size_t waiting() const;
  const Incidents& incidents() const { return incidents_; }
  /// How often it went back, for late messages.
  std::int64_t replays() const { return replays_; }

  /// Called after each measurement that is taken in for the first time, and where a filter that was lost has taken its
  /// place from a fix (dimension 0).
  std::function<void(const UpdateReport&, const ErrorStateFilter&)> on_update;
  /// Called before and after each step that is taken for the first time; before it all of its instant has been taken
  /// in.
  std::function<void(const ErrorStateFilter&)> on_leave;
  std::function<void(const ImuSample&, const NavState& before, const ErrorStateFilter&)> on_step;
  std::function<void(const ErrorStateFilter&)> on_look;
  /// Called where a gap has made the filter less sure of its motion (1-sigma, rad, m, m/s), for the first time.
  std::function<void(double theta_rad, double p_m, double v_m_s)> on_loosened;

 private:
  /// A part of a gap in which nothing is known of the motion.
  struct Coast {
    double dt_s;
  };
  struct Look {};
  struct Event {
    GpsTime t;    ///< end of a sample or coast; when a message is due
    GpsTime own;  ///< of a sample or coast: the same by the unit's own clock
    std::variant<ImuSample, Coast, AidingMessage, Look> what;
    double gap_s = 0.0;  ///< a gap of this length ends with it
    bool done = false;   ///< taken in before, if it is run once more
    bool moves() const { return std::holds_alternative<ImuSample>(what) || std::holds_alternative<Coast>(what); }
  };
  struct Checkpoint {
    ErrorStateFilter filter;
    GpsTime at;
    std::int64_t next;  ///< event, counted from the first of all
  };

  Trouble judge(const AidingMessage& message);
  GpsTime due(const AidingMessage& message) const;
  void bridge(GpsTime to, double dt_s, std::int64_t own_ns, bool loosens);
  /// Before all of its time that has waited for it.
  void insert_motion(Event event);
  void run();
  void move(Event& event);
  bool reach(const Event& event);
  void take(const AidingMessage& message, bool done);
  void predict(const ImuSample& sample, GpsTime to, bool done);
  ImuSample motion_of(const Event& event) const;
  void go_back(std::int64_t to);
  void forget();
  Event& event(std::int64_t i) { return events_[static_cast<std::size_t>(i - first_)]; }
  std::int64_t end() const { return first_ + static_cast<std::int64_t>(events_.size()); }

  ErrorStateFilter filter_;
  FilterObserver* observer_ = nullptr;
  TimelineConfig config_;
  Incidents incidents_;
  std::deque<Event> events_;  ///< in the order of their time
  std::int64_t first_ = 0;    ///< number of the first that is kept
  std::int64_t next_ = 0;     ///< number of the first that is not in filter_
  std::deque<Checkpoint> checkpoints_;
  std::optional<ImuSample> rest_;  ///< of the sample that is being divided
  std::optional<ImuSample> last_imu_;
  std::optional<GnssFix> last_fix_;
  GpsTime at_;       ///< of filter_
  GpsTime reached_;  ///< end of the last sample that has come
  double bridged_s_ = 0.0;
  std::int64_t replays_ = 0;
};

}  // namespace canyon::fusion
