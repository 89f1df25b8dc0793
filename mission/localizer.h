#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <utility>

#include "canyon/fusion/error_state_filter.h"
#include "canyon/fusion/observers/predicted_motion.h"
#include "canyon/fusion/verdict/run_evidence.h"
#include "canyon/mission/boundaries.h"
#include "canyon/mission/part_clock.h"

namespace canyon::mission {

/// The localization filter of a run in its time: brings it from IMU sample to IMU sample, and in the middle of one to
/// where something waits for it.
class Localizer {
 public:
  Localizer(fusion::ErrorStateFilter filter, GpsTime start, const Boundaries& boundaries, PartClock& clock)
      : filter_(std::move(filter)), boundaries_(boundaries), clock_(clock), at_(start) {}

  void initialize(const Pose& X_WB, const Eigen::Vector3d& v_WB_W) {
    filter_.initialize(at_, X_WB, v_WB_W);
    X_WB_ = X_WB;
  }

  /// From now on the evidence gets all that the filter does; call after initialize(). It must outlive this.
  void gather(fusion::RunEvidence& evidence);
  /// The evidence gets what the filter says of its states.
  void look();

  /// Time of the last IMU sample, or of the part of one, that the filter has taken in.
  GpsTime at() const { return at_; }
  NavEstimate estimate() const { return filter_.estimate(); }
  Eigen::Matrix<double, 9, 9> body_covariance() const { return filter_.body_covariance(); }

  /// Takes in the sample that ends at t; what waits for a time within it is done there, in the order it came.
  Status take(ImuSample sample, GpsTime t);
  /// Does `work` once the filter has come to t: at once, or within the sample that covers t, which is then divided.
  Status once_at(GpsTime t, std::function<Status()> work);
  /// A message of a sensor beside IMU and receiver, as far as the filter takes such; at the time of at().
  Status aid(const fusion::AidingMessage& message);
  /// The ranges of an epoch, one by one; stamped as a fix is.
  Status update(const GnssEpoch& epoch);
  /// Where the vehicle was when take_clone() was last called, by registration; at the time of at().
  Status update(const RelativePose& since_clone);
  /// Where the vehicle is in a map that was there before; at the time of at().
  Status update(const PoseInMap& pose);
  /// From now on the filter's clone, if it carries one, holds the present pose.
  void take_clone();
  /// By what the estimate has been corrected since this was last asked, if it was: it is now this times what was
  /// predicted.
  std::optional<Pose> take_correction() { return std::exchange(correction_, std::nullopt); }
  /// How B (source) has moved since begin_motion() (target), by prediction alone: no correction is motion, though each
  /// makes what is predicted after it better. The covariance is that of a prediction without them. Times are those of
  /// at().
  RelativePose motion() const;
  void begin_motion();
  /// The fix is stamped in the time of at(); the unit's own clock may be any time off.
  Result<fusion::UpdateReport> update(const GnssFix& fix);

  std::int64_t predictions() const { return predictions_; }
  std::int64_t updates() const { return updates_; }

 private:
  Status predict(const ImuSample& sample, GpsTime t);
  void corrected();
  /// What the measurements from this report on have done, to the evidence.
  void tell(std::size_t from);

  fusion::ErrorStateFilter filter_;
  const Boundaries& boundaries_;
  PartClock& clock_;
  GpsTime at_;
  struct Waiting {
    GpsTime t;
    std::function<Status()> work;
  };
  std::deque<Waiting> waiting_;
  GpsTime clone_by_its_clock_;
  Pose X_WB_;    ///< as last estimated
  Pose motion_;  ///< since begin_motion()
  GpsTime motion_start_;
  std::optional<fusion::PredictedMotion> without_fixes_;  ///< since then
  std::optional<Pose> correction_;
  fusion::RunEvidence* evidence_ = nullptr;
  std::int64_t predictions_ = 0, updates_ = 0;
};

}  // namespace canyon::mission
