#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/messages.h"
#include "canyon/lidar/registration/registration.h"
#include "canyon/lidar/registration/submap.h"

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
  double overlap = kNaN;                      ///< as of lidar::RegistrationResult
  std::optional<std::vector<Vector6d>> open;  ///< as of lidar::RegistrationResult, of xi in L; none: it is not known
  std::optional<RelativePose> placed;         ///< L in L at the keyframe before, by alignment and predicted motion
  std::optional<RelativePose> alone;          ///< the same by the alignment alone, where it converged
  std::optional<RelativePose> aligned;        ///< that of B, for the filter
  Matrix6d prior_covariance = Matrix6d::Constant(kNaN);  ///< of X_WL_prior
  Matrix6d covariance = Matrix6d::Constant(kNaN);        ///< of X_WL_registered
  std::optional<lidar::RegistrationStatus> map_status;   ///< of the alignment onto the prior map; none: there is no map
  std::optional<PoseInMap> in_map;                       ///< B by that alignment alone, where it converged
};

/// Chooses keyframes, registers each onto the ones before it, and fuses the result with the filter's pose.
///
/// Registration alone would drift, the prior alone jumps with the fixes. An alignment begins from the motion since the
/// keyframe before as the filter has predicted it; methods that take a covariance (Registration::align_with_prior)
/// search as far as that reaches and say what the surfaces alone would have; this, with the floor of an alignment, is
/// weighed with that motion here, and contradicts it only beyond the 99.9 % bound of both together. Each keyframe's
/// pose Z from registration has the covariance of the keyframe before it, plus that of the alignment, plus a floor; the
/// prior Y has the filter's covariance, enlarged by prior_correlation_s / (time since the last keyframe), because the
/// filter's error hardly changes between keyframes and must not count as new knowledge each time. With xi = log(Z^-1 Y)
/// the fused pose is Z Exp(K xi), K = P_Z (P_Z + P_Y)^-1. Where registration does not converge, the predicted motion
/// carries on from the keyframe before, with its own covariance, and is weighed with the filter's pose likewise:
/// nothing jumps onto the prior.
///
/// The keyframes of the submap stand to one another as they were driven, not as they were placed in W: that the
/// filter's pose moves one by decimetres is no motion, and would bend the surfaces that the next is aligned to. A
/// keyframe that could not be aligned begins a new submap, for where it stands beside the surfaces before it is not
/// known. Both measured in `high`, docs/registration.md.
///
/// With a prior map (in W) each keyframe is then registered onto that as well, from where the above puts it, with the
/// covariance that this has; the pose that the map gives is weighed with it likewise, and the next keyframe carries on
/// from there. How far the map itself is off is as good as the same from one keyframe to the next: the covariance of
/// that is enlarged by prior_map_correlation_m / (way since the last keyframe). What the map says alone is in_map.
///
/// Where the three constants of [registration] come from. alignment_floor_m and _deg: the covariance of an alignment
/// knows its residuals, not what biases it (correspondences, the sensor: Brossard, Bonnabel and Barrau 2020, "A new
/// approach to 3D ICP covariance estimation"). 0.02 m is the range noise of the built-in LIDAR; 0.05 degrees are as
/// much at 23 m, the root mean square distance of the returns in the built-in streets (22 to 28 m). Measured, with the
/// true pose as guess and the prior left out (truth_as_pose = true, prior_correlation_s = 1e6, the first 430 m of the
/// built-in mission): 215 alignments tilt the map by 1.1 degrees, which is 0.08 degrees each if they are independent,
/// and its height jitters by 7 mm from one to the next. motion_floor_m_s and _deg_s: a filter's covariance knows its
/// noise, not what reflections make of the velocities that it has been given; those of signals that hidden satellites
/// send over a wall err by the vehicle's own speed and more, and a filter that averages some of them by a tenth of it.
/// prior_correlation_s: the error of the filter's position falls
/// to 1/e of its autocorrelation after 7, 8 and 11 s (east, north, up) in the built-in mission's high run, after 5, 7
/// and 11 s in its low one.
class Mapper {
 public:
  /// `prior_map` in W, made by that registration; nullptr: there is none.
  Mapper(const lidar::RegistrationConfig& config, std::unique_ptr<lidar::Registration> registration, const Pose& X_BL,
         std::shared_ptr<const lidar::PreparedCloud> prior_map = nullptr);

  /// Offers a deskewed scan (in L at its stamp) with the filter's estimate at that time, and the motion of B since the
  /// last keyframe by prediction alone, which the alignment begins from: what fixes have corrected since is not motion.
  /// Returns the new keyframe if it became one, else nullptr. The pointer is valid until the next call.
  const Keyframe* offer(const LidarScan& scan, const NavEstimate& estimate, const RelativePose& motion);

  // The two halves of an offer. One thread may choose while another places what was chosen before, in the same order.
  /// Whether a scan there would become a keyframe, if it has returns.
  bool wants(const NavEstimate& estimate) const;
  /// It becomes the next one.
  void choose(const NavEstimate& estimate) { chosen_ = estimate.X_WB * X_BL_; }
  const Keyframe& place(const LidarScan& scan, const NavEstimate& estimate, const RelativePose& motion);

  /// Work done.
  struct Counters {
    std::int64_t alignments = 0, found_in_map = 0, iterations = 0, correspondences = 0, pcl_objects = 0;
  };
  const Counters& counters() const { return counters_; }

  /// Correction of the last keyframe: X_WB_registered = correction * X_WB_prior.
  const Pose& correction() const { return correction_; }

 private:
  /// L since the keyframe before, by the surfaces where they tell, else as predicted.
  lidar::PosePrior align(const lidar::PreparedCloud& cloud, const lidar::PosePrior& predicted, Keyframe& keyframe);
  /// Fuses where that puts the keyframe with its prior.
  void fuse(const lidar::PosePrior& moved_by, Keyframe& keyframe) const;
  /// Fuses that with where the prior map puts it.
  void find_in_map(const lidar::PreparedCloud& cloud, Keyframe& keyframe);
  /// One alignment. What the surfaces say, with their floor, and the prior that was `given`; nothing unless converged.
  struct Alignment {
    lidar::RegistrationResult result;  ///< its status is that of both
    lidar::PosePrior alone;
  };
  Alignment aligned(const lidar::PreparedCloud& cloud, std::span<const lidar::Registration::Placed> targets,
                    const lidar::PosePrior& given, const Matrix6d& floor);

  lidar::RegistrationConfig config_;
  std::unique_ptr<lidar::Registration> registration_;
  Pose X_BL_;
  std::shared_ptr<const lidar::PreparedCloud> prior_map_;
  std::optional<Pose> chosen_;  ///< the last keyframe's prior
  lidar::Submap submap_;        // in a frame O of what was driven: L's poses as they followed from one another
  Keyframe last_;
  bool has_last_ = false;
  Pose correction_;
  Counters counters_;
};

}  // namespace canyon::mission
