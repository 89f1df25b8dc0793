#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/config/config.h"
#include "canyon/core/messages.h"
#include "canyon/core/model_choice.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/result.h"

namespace canyon::lidar {

class Registration;

/// One way to register.
struct RegistrationMethod {
  std::unique_ptr<Registration> (*make)(const ModelParameters& own);  ///< nullptr: left out when Canyon was built
  const char* build_option;                                           ///< that puts it in
  const char* engine;     ///< whose it is, and what else its name has meant; for manifest.json
  bool registers = true;  ///< false: the prior pose stands
};
/// Every known method, whether it was compiled in or not.
ModelTable<RegistrationMethod> registration_methods();

/// Keys of the methods that match points.
struct MatchingParameters {
  double leaf_m = 0.5;  ///< voxel size of both clouds
  double max_correspondence_m = 1.0;
  std::int64_t max_iterations = 20;
};
void visit(FieldVisitor& f, MatchingParameters& c);

/// [registration] of a mission file.
struct RegistrationConfig {
  ModelChoice<registration_methods> method{"gicp"};
  std::int64_t submap_keyframes = 10;  ///< keyframes that form the target
  double keyframe_distance_m = 2.0;
  double keyframe_angle_deg = 10.0;
  // How the mapper weighs an alignment against the filter's pose; mission/mapping/mapper.h says where the figures come
  // from.
  double alignment_floor_m = 0.02;
  double alignment_floor_deg = 0.05;
  double motion_floor_m_s = 0.5;
  double motion_floor_deg_s = 0.1;
  double prior_correlation_s = 10.0;
  // A map that was there before: mission/mapping/mapper.h.
  std::string prior_map;  ///< file of points in W; "": none
  double prior_map_sigma_m = 0.05;
  double prior_map_sigma_deg = 0.05;
  double prior_map_correlation_m = 50.0;
};
void visit(FieldVisitor& f, RegistrationConfig& c);
/// False with a method that believes the prior pose: nothing is then known of registered keyframes and their map.
bool registers(const RegistrationConfig& config);

/// kDegenerate: what was matched does not determine a pose, as points on one line do not. kDiverged: the guess or the
/// solution is not finite. In either case, as with too few points, the guess stands and there is no covariance.
/// kAmbiguous: another pose within the prior fits about as well, or half turned far more is explained.
/// kTooLittleOverlap: most of the source has nothing to be matched to. kBeyondPrior: the prior and where the surfaces
/// have it by themselves contradict one another by more than 99.9 % of what their covariances together allow. The last
/// three are for the own methods to say.
enum class RegistrationStatus {
  kConverged,
  kNotConverged,
  kTooFewPoints,
  kDegenerate,
  kDiverged,
  kAmbiguous,
  kTooLittleOverlap,
  kBeyondPrior
};
/// With the word for files: "converged", "not_converged", ...
ModelTable<RegistrationStatus> registration_statuses();

struct RegistrationResult {
  RegistrationStatus status = RegistrationStatus::kNotConverged;
  Pose X_TS;  ///< a point of source in target's frame
  Matrix6d covariance =
      Matrix6d::Constant(kNaN);  ///< of xi, source frame; see registration_covariance.h. Finite, or NaN as a whole
  int iterations = 0;
  double rms_m = kNaN;               ///< of the matched points' distances along the surface normals
  std::int64_t correspondences = 0;  ///< work done: pairs matched, summed over the iterations
  /// Directions that the surfaces leave open, source frame, of length 1 and at right angles where a rotation counts by
  /// what it moves at the cloud's rms radius. Own methods only.
  std::vector<Vector6d> open;
  /// What the surfaces alone would have, where X_TS and covariance hold the prior's part too: for those who know the
  /// prior already and must not be told it again.
  struct Surfaces {
    Pose X_TS;
    Matrix6d covariance;
  };
  std::optional<Surfaces> surfaces;
  double overlap = kNaN;  ///< share of the source's points that are matched; own methods only
  int pcl_objects = 0;    ///< clouds, search trees and registrations of PCL that were made for it
};

/// What is known of a pose before it is registered: the pose, and the covariance of its xi (source frame). It may be
/// singular; NaN: nothing is known, the pose is where to start.
struct PosePrior {
  Pose X_TS;
  Matrix6d covariance = Matrix6d::Constant(kNaN);
};

/// A keyframe's cloud made ready for registration: thinned, with per-point covariances.
class PreparedCloud;

/// Registration of clouds. prepare() once per cloud, then align as often as wanted.
class Registration {
 public:
  virtual ~Registration() = default;
  /// `points` in the cloud's own frame, m.
  virtual std::shared_ptr<const PreparedCloud> prepare(std::span<const Eigen::Vector3f> points) const = 0;
  struct Placed {
    std::shared_ptr<const PreparedCloud> cloud;
    Pose X_TC;  ///< pose of the cloud in the target frame
  };
  /// Aligns `source` onto the union of `targets`, starting from `guess` = X_TS. Where targets overlap the last one
  /// counts. Whatever the clouds and the guess are, the answer is a status.
  virtual RegistrationResult align(const PreparedCloud& source, std::span<const Placed> targets,
                                   const Pose& guess) const = 0;
  /// The same with what is known before: the own methods search as far as the prior reaches, and their result is the
  /// most probable pose by prior and surfaces together; along open directions the prior alone has a say. The others
  /// start from its pose and make no use of its covariance.
  virtual RegistrationResult align_with_prior(const PreparedCloud& source, std::span<const Placed> targets,
                                              const PosePrior& prior) const {
    return align(source, targets, prior.X_TS);
  }
};

Result<std::unique_ptr<Registration>> make_registration(const RegistrationConfig& config);
/// The map that `config` names, in W; nullptr where it names none. Errors: as of read_map() (lidar/files/map_files.h).
Result<std::shared_ptr<const PreparedCloud>> make_prior_map(const RegistrationConfig& config,
                                                            const Registration& registration);

}  // namespace canyon::lidar
