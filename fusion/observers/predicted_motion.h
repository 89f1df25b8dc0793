#pragma once

#include "canyon/fusion/error_state_filter.h"

namespace canyon::fusion {

/// Whether a message tells of motion, not of a place: as wheels do; and not by the filter's clone, which is of a time
/// before a prediction began.
bool is_of_motion(const AidingMessage& message);

/// The motion that prediction alone gives from an instant on, with its covariance: a copy of a filter that goes on with
/// IMU, constraints and wheels, and gets no fix. What a fix would correct is not motion.
///
/// The covariance is that of the relative pose: errors of place and heading at the start go with both ends and drop
/// out; tilt, velocity and the IMU's errors at the start, and all noise since, do not.
class PredictedMotion {
 public:
  /// Begins at the filter's time.
  explicit PredictedMotion(const ErrorStateFilter& filter);
  PredictedMotion(const PredictedMotion&) = delete;
  PredictedMotion& operator=(const PredictedMotion&) = delete;

  void predict(const ImuSample& sample) { filter_.predict(sample); }
  /// Of wheels, and what else does not tell a place; of others (is_of_motion()) a ProgramError.
  void update(const AidingMessage& message);

  /// B now (source) in B at the start (target).
  RelativePose motion() const;

 private:
  /// The errors now as a function of those at the start: Phi times them, and noise of covariance Q.
  class Tracker final : public FilterObserver {
   public:
    void begin(const ErrorState& state) override;
    void predicted(ErrorPropagation& step) override;
    void corrected(const Correction& correction) override;
    void renewed(std::span<const Renewal> states) override;
    void restarted(const Measurement& fix) override;
    ErrorMatrix Phi, Q;
  };

  ErrorStateFilter filter_;
  Tracker tracker_;
  GpsTime start_;
  BodyPose start_pose_;
  Eigen::MatrixXd P_start_;
};

}  // namespace canyon::fusion
