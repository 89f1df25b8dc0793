#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/messages.h"
#include "lidar/registration.h"

namespace canyon::mission {

/// A keyframe of the map: its cloud and where it was placed.
struct Keyframe {
  GpsTime t;
  Pose X_WL_prior;                                  ///< from the filter alone
  Pose X_WL_registered;                             ///< prior and registration together
  std::optional<lidar::RegistrationStatus> status;  ///< none: not registered, as the first one and with method "none"
  int iterations = 0;
  double rms_m = kNaN;
  std::size_t points = 0;
};

/// Chooses keyframes, registers each onto the ones before it, and fuses the result with the filter's pose.
///
/// Registration alone would drift, the prior alone jumps with the fixes. Each keyframe's pose Z from registration has
/// the covariance of the keyframe before it, plus that of the alignment, plus a floor for the submap's own stiffness;
/// the prior Y has the filter's covariance, enlarged by (correlation time of the fixes' error) / (time since the last
/// keyframe), because that error hardly changes between keyframes and must not count as new knowledge each time. With
/// xi = log(Z^-1 Y) the fused pose is Z Exp(K xi), K = P_Z (P_Z + P_Y)^-1. Where registration does not converge the
/// prior stands.
class Mapper {
 public:
  Mapper(const lidar::RegistrationConfig& config, std::unique_ptr<lidar::Registration> registration, const Pose& X_BL);

  /// Offers a deskewed scan (in L at its stamp) with the filter's estimate at that time. Returns the new keyframe if it
  /// became one, else nullptr. The pointer is valid until the next call.
  const Keyframe* offer(const LidarScan& scan, const NavEstimate& estimate);

  /// Correction of the last keyframe: X_WB_registered = correction * X_WB_prior.
  const Pose& correction() const { return correction_; }

 private:
  struct Placed {
    std::shared_ptr<const lidar::PreparedCloud> cloud;
    Pose X_WL;
  };
  lidar::RegistrationConfig config_;
  std::unique_ptr<lidar::Registration> registration_;
  Pose X_BL_;
  std::deque<Placed> submap_;
  Keyframe last_;
  Matrix6d last_covariance_ = Matrix6d::Zero();
  bool has_last_ = false;
  Pose correction_;
};

}  // namespace canyon::mission
