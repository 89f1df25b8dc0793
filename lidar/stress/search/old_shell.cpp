// What the generalized ICP on PCL says of its pose: the covariance by blocks of sixteen leaves of the matches at its
// end.
#include <cmath>
#include <memory>
#include <vector>

#include <Eigen/LU>

#include "canyon/core/model_choice.h"
#include "canyon/core/stress/looks.h"
#include "canyon/lidar/registration/prepared_cloud.h"
#include "canyon/lidar/registration/registration.h"
#include "canyon/lidar/registration/registration_covariance.h"
#include "canyon/lidar/stress/engine_pieces.h"
#include "canyon/lidar/stress/made_clouds.h"
#include "canyon/lidar/stress/search/subjects.h"

namespace canyon::lidar {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using stress::kInfinity;
using stress::Looks;

/// nullptr where Canyon was built without PCL.
std::unique_ptr<Registration> old_shell(double leaf_m) {
  RegistrationConfig config;
  config.method.name = "pcl_shell_gicp";
  config.method.own.get<MatchingParameters>().leaf_m = leaf_m;
  auto made = make_registration(config);
  return made.ok() ? *std::move(made) : nullptr;
}

/// The matches at the pose by trying all points of the target, each weighing by both planes, a thousand times thinner
/// than wide; from these the covariance that registration_precision() states. At its end the search stops at steps of
/// 2e-4 m, by which residuals of 1 cm are off by a fiftieth, and their squares by a twenty-fifth.
StressFigure covariance_by_blocks(double leaf_m) {
  const auto registration = old_shell(leaf_m);
  if (registration == nullptr) return {0.0, 1.0};
  Looks looks;
  const auto source = registration->prepare(made::room(1)), target = registration->prepare(made::room(2));
  const Pose X_TC = Pose::exp((Vector6d() << 0.1, 0.05, 1.2, 300.0, -200.0, 10.0).finished());
  const Pose off = Pose::exp((Vector6d() << 0.004, -0.003, 0.006, 0.05, -0.04, 0.03).finished());
  const std::vector<Registration::Placed> placed{{target, X_TC}};
  const RegistrationResult found = registration->align(*source, placed, X_TC * off);
  looks.right(found.status == RegistrationStatus::kConverged);
  looks.right(found.iterations > 1 && found.correspondences > 0 && found.pcl_objects == 6);
  const Pose X_CS = X_TC.inverse() * found.X_TS;
  // Two noises of 1 cm on some thousand points: no more than a few millimetres and some 1e-4 rad off.
  looks.near(X_CS.p.norm(), 0.0, 0.01);
  looks.near(so3_log(X_CS.R).norm(), 0.0, 2e-3);
  const Matrix3d R = X_CS.R.toRotationMatrix();
  const auto thin = [](const Eigen::Vector3f& n) {
    const Vector3d d = n.cast<double>();
    return Matrix3d(Matrix3d::Identity() - 0.999 * d * d.transpose());
  };
  std::vector<Correspondence> matches;
  for (std::size_t i = 0; i < source->points.size(); ++i) {
    const Vector3d p = source->points[i].cast<double>(), at = X_CS * p;
    double nearest = 1.0;  // within max_correspondence_m
    std::size_t of = target->points.size();
    for (std::size_t k = 0; k < target->points.size(); ++k) {
      const double square = (target->points[k].cast<double>() - at).squaredNorm();
      if (square < nearest) nearest = square, of = k;
    }
    if (of == target->points.size()) continue;
    matches.push_back({p, at - target->points[of].cast<double>(),
                       (R * thin(source->normals[i]) * R.transpose() + thin(target->normals[of])).inverse(),
                       0.25 * static_cast<double>(source->tilt_variance[i] + target->tilt_variance[of])});
  }
  const RegistrationPrecision expected = registration_precision(matches, R, 16.0 * leaf_m);
  looks.near(found.rms_m / expected.rms_m, 1.0, 0.02);
  made::alike(looks, found.covariance, expected.covariance, 0.04);
  // Blocks of another size say something else, by more than that.
  for (const double other : {8.0, 32.0, 1.0}) {
    const Matrix6d C = registration_precision(matches, R, other * leaf_m).covariance;
    looks.right((C - expected.covariance).norm() > 0.08 * expected.covariance.norm());
  }
  return looks.figure();
}

/// Statuses by their words: too few points of either cloud or matched, none that is determined, no finite guess. In
/// each of them the guess stands, and there is no covariance. A figure counts.
StressFigure refusals_of_the_old_shell() {
  const auto registration = old_shell(0.5);
  if (registration == nullptr) return {0.0, 0.0};
  int wrong = 0;
  const auto room = registration->prepare(made::room(1)), line = registration->prepare(made::line());
  made::Cloud few_points = made::room(1);
  few_points.resize(40);
  const auto few = registration->prepare(few_points);
  const Pose here, far = Pose{Eigen::Quaterniond::Identity(), Vector3d(500.0, 0.0, 0.0)};
  Pose none;
  none.p.y() = std::nan("");
  const struct {
    std::shared_ptr<const PreparedCloud> source, target;
    Pose guess;
    RegistrationStatus status;
  } asked[] = {{few, room, here, RegistrationStatus::kTooFewPoints},
               {room, few, here, RegistrationStatus::kTooFewPoints},
               {room, room, far, RegistrationStatus::kTooFewPoints},
               {line, line, here, RegistrationStatus::kDegenerate},
               {room, room, none, RegistrationStatus::kDiverged}};
  for (const auto& a : asked) {
    const std::vector<Registration::Placed> placed{{a.target, Pose()}};
    const RegistrationResult found = registration->align(*a.source, placed, a.guess);
    wrong += found.status == a.status ? 0 : 1;
    wrong += found.covariance.array().isNaN().all() ? 0 : 1;
    wrong += a.status == RegistrationStatus::kDiverged || (found.X_TS.p - a.guess.p).norm() == 0.0 ? 0 : 1;
  }
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> old_shell_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kData,
           .mechanism = "what the registration on PCL says of its pose",
           .why = "blocks of another size, planes as thick as wide, a residual in the guess's frame",
           .expected = "its matches by trying all, and the formula of blocks: steps of 2e-4 m against 1 cm",
           .unit = "of the bound"});
  for (const double leaf_m : {0.5, 0.4})
    rows.add("old_shell/covariance_with_leaves_of_" + stress::text(leaf_m) + "_m",
             [leaf_m] { return covariance_by_blocks(leaf_m); });
  rows.of({StressGroup::kData, "what the registration on PCL refuses",
           "a guess that is moved all the same, a covariance of nothing", "each by its status: exact", "wrong"});
  rows.add("old_shell/refusals", refusals_of_the_old_shell);
  return rows.take();
}

}  // namespace canyon::lidar
