// What an alignment with and without a prior comes to: where it settles, how sure it says it is, and its verdicts.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "canyon/core/math/chi_square.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/lidar/registration/engine/aligner.h"
#include "canyon/lidar/registration/engine/covariance_forms.h"
#include "canyon/lidar/registration/engine/match_form.h"
#include "canyon/lidar/registration/engine/match_sums.h"
#include "canyon/lidar/registration/engine/pose_search.h"
#include "canyon/lidar/registration/engine/robust_kernels.h"
#include "canyon/lidar/registration/engine/surface_cloud.h"
#include "canyon/lidar/registration/engine/surface_target.h"
#include "canyon/lidar/registration/registration_covariance.h"
#include "canyon/lidar/stress/engine_pieces.h"
#include "canyon/lidar/stress/made_clouds.h"
#include "canyon/lidar/stress/subjects.h"

namespace canyon::lidar {
namespace {

using Eigen::Vector3d;
using made::alike;
using stress::kInfinity;
using stress::Looks;

/// A room seen twice, with pillars that tell its corners apart if asked for; the second cloud is the target.
struct Scenery {
  std::shared_ptr<const PreparedCloud> source, target;
  std::unique_ptr<const SurfaceTarget> surfaces;
};
made::Cloud furnished(std::uint64_t number, bool pillars) {
  made::Cloud out = made::room(number);
  if (!pillars) return out;
  made::Cloud more = made::Surfaces(number + 100)
                         .plane({4, -6, -2}, {0, 3, 0}, {0, 0, 4}, 400)
                         .plane({-5, 2, -2}, {2, 0, 0}, {0, 0, 4}, 400)
                         .take();
  out.insert(out.end(), more.begin(), more.end());
  return out;
}
Scenery scenery(bool pillars, double leaf_m) {
  Scenery out{prepare_surfaces(furnished(1, pillars), leaf_m), prepare_surfaces(furnished(2, pillars), leaf_m), {}};
  out.surfaces = point_target(out.target);
  return out;
}

PosePrior prior_of(const Vector6d& off, double sigma_rad, double sigma_m, double yaw_rad = 0.0) {
  PosePrior out{Pose::exp(off), Matrix6d::Zero()};
  out.covariance.diagonal() << Vector3d::Constant(sigma_rad * sigma_rad), Vector3d::Constant(sigma_m * sigma_m);
  if (yaw_rad > 0.0) out.covariance(2, 2) = yaw_rad * yaw_rad;
  return out;
}
Vector6d drawn_off(std::uint64_t number, double rad, double m) {
  const RandomStream draws(number, "stress.aligners");
  Vector6d out;
  out << rad * draws.normal3(0), m * draws.normal3(1);
  return out;
}
double size_of(const Vector6d& xi) {
  return xi.tail<3>().norm() / 2e-4 + xi.head<3>().norm() / 2e-5;
}
/// Tilts of neighbours count twice; a block has sixteen leaves.
CovarianceSums sums_at(const PoseSearch& search, const Pose& X, double leaf_m, double reach_m) {
  std::vector<LastMatch> fresh;
  const Matching matching = search.matching_at(reach_m);
  normal_equations(matching, X, 1, fresh);
  CovarianceSums out = covariance_sums(matching, X, fresh, block_m(leaf_m), true);
  out.N *= 2.0;
  return out;
}

/// Where an alignment has settled no step is left: of the surfaces and the prior together, each piece of the cloud
/// counting once, by the formula of the most probable pose; what the surfaces alone would have is where their gradient
/// vanishes. What it says of its precision follows from the sums at that place by the form's own formula, with the
/// prior by the inverse of both precisions. Steps of the size at which it stops; matches that change to and fro move it
/// by three of them.
StressFigure settled(const std::string& form, double sigma_m, std::uint64_t number) {
  Looks looks;
  MatchingParameters matching;
  matching.max_iterations = 60;
  EngineParameters engine;
  engine.covariance = form;
  const Scenery s = scenery(true, matching.leaf_m);
  const bool with_prior = sigma_m > 0.0;
  PosePrior prior = prior_of(drawn_off(number, with_prior ? 0.06 * sigma_m : 0.003, with_prior ? 0.6 * sigma_m : 0.05),
                             with_prior ? 0.1 * sigma_m : 1.0, with_prior ? sigma_m : 1.0);
  if (!with_prior) prior.covariance.setConstant(kNaN);
  const RegistrationResult found = Aligner(*s.source, *s.surfaces, plane_to_plane, matching, engine, prior).align();
  PoseSearch search(*s.source, *s.surfaces, plane_to_plane, matching, engine, prior);
  looks.right(found.status == RegistrationStatus::kConverged && found.open.empty());
  const auto n = static_cast<double>(s.source->points.size());
  const double reach = matching.max_correspondence_m;
  looks.near(search.matching_at(reach).width_m, engine.kernel_width_m, 1e-15);
  looks.near(search.matching_at(3.0 * reach).width_m, 3.0 * engine.kernel_width_m, 1e-15);
  looks.near(search.matching_at(3.0 * reach).reach_m, 3.0 * reach, 1e-15);
  std::vector<LastMatch> fresh;
  const NormalEquations e = normal_equations(search.matching_at(reach), found.X_TS, 1, fresh);
  looks.near(found.overlap, static_cast<double>(e.matched) / n, 3.0 / n);
  double radius2 = 0.0;
  std::set<std::array<int, 3>> blocks;
  for (const Eigen::Vector3f& p : s.source->points) {
    radius2 += p.cast<double>().squaredNorm() / n;
    const Eigen::Vector3f b = p / 8.0f;
    blocks.insert({static_cast<int>(std::floor(b.x())), static_cast<int>(std::floor(b.y())),
                   static_cast<int>(std::floor(b.z()))});
  }
  looks.near(search.radius_m(), std::sqrt(radius2), 1e-9);
  const Vector6d alone = -e.A.ldlt().solve(e.g);
  if (with_prior) {
    const PriorLaw law = *PriorLaw::of(prior);
    const double s2 = worse(e.cost / e.weight, 1e-6 / 2e-3),
                 k = worse(1.0, s2 * static_cast<double>(e.matched) / static_cast<double>(blocks.size()));
    const Matrix6d precision = law.covariance_at(found.X_TS).inverse();
    const Vector6d step = -(e.A / k + precision).ldlt().solve(Vector6d(e.g / k + precision * law.off(found.X_TS)));
    looks.near(size_of(step), 0.0, 3.0);
    // The prior pulls: of the surfaces alone a step is left.
    looks.right(size_of(alone) > 3.0);
    std::vector<LastMatch> there;
    const NormalEquations by_surfaces = normal_equations(search.matching_at(reach), found.surfaces->X_TS, 1, there);
    looks.near(size_of(-by_surfaces.A.ldlt().solve(by_surfaces.g)), 0.0, 3.0 + 0.3 * size_of(alone));
  } else {
    looks.near(size_of(alone), 0.0, 3.0);
    looks.right(!found.surfaces.has_value());
  }
  const CovarianceSums sums = sums_at(search, found.X_TS, matching.leaf_m, reach);
  std::vector<Vector6d> guesses;
  const auto& row = model_row(covariance_forms(), form).make;
  if (row.restarts) {
    // Along each axis of the law of guesses, root six of its sigma to either side.
    Matrix6d law = Matrix6d::Zero();
    law.diagonal() << Vector3d::Constant(0.01 / radius2), Vector3d::Constant(0.01);
    if (with_prior) law = prior.covariance;
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(law);
    for (int k = 0; k < 6; ++k)
      for (const double side : {1.0, -1.0}) {
        FoundPose again;
        again.X = found.X_TS *
                  Pose::exp(side * std::sqrt(6.0 * eigen.eigenvalues()[k]) * Vector6d(eigen.eigenvectors().col(k)));
        search.anew(again, 20);
        guesses.push_back((found.X_TS.inverse() * again.X).log());
      }
  }
  const Matrix6d B = row.gradient({sums, engine.point_sigma_m, engine.range_bias_m, guesses});
  const RegistrationPrecision precision = registration_precision(sums, B);
  looks.near(found.rms_m / precision.rms_m, 1.0, 1e-3);
  // A match more or less is one of some thousand; where other guesses end is known to the steps at which they stop.
  const double share = row.restarts ? 0.02 : 2e-3;
  const Matrix6d by_surfaces = with_prior ? found.surfaces->covariance : found.covariance;
  alike(looks, by_surfaces, precision.covariance, share);
  if (with_prior) {
    const Matrix6d P = PriorLaw::of(prior)->covariance_at(found.X_TS);
    alike(looks, found.covariance, Matrix6d((P.inverse() + by_surfaces.inverse()).inverse()), 1e-8);
  }
  return looks.figure();
}

/// A prior that is sure of a place beside the true one: beyond its ellipsoid of 99.9 % together with what the surfaces
/// say, just where the square of what is between them says so; both are met, and nothing else: a round that raises what
/// is missed, however little that is, is damped, and the undamped step then says whether it has settled. A figure
/// counts.
StressFigure beyond_the_prior() {
  StressFigure out;
  const MatchingParameters matching;
  const EngineParameters engine;
  const Scenery s = scenery(true, matching.leaf_m);
  int believed = 0, beyond_it = 0;
  for (const double off_m : {0.02, 0.05, 0.07, 0.08, 0.09, 0.1, 0.11, 0.12, 0.14, 0.2}) {
    const PosePrior prior = prior_of((Vector6d() << 0.0, 0.0, 0.002, off_m, -0.3 * off_m, 0.0).finished(), 0.002, 0.02);
    const RegistrationResult found = Aligner(*s.source, *s.surfaces, plane_to_plane, matching, engine, prior).align();
    const PriorLaw law = *PriorLaw::of(prior);
    const Vector6d xi = law.off(found.surfaces->X_TS);
    const Matrix6d both = law.covariance_at(found.surfaces->X_TS) + found.surfaces->covariance;
    // chi^2 of six degrees of freedom exceeds 22.458 once in a thousand.
    const double square = xi.dot(both.inverse() * xi);
    if (std::abs(square / 22.4577 - 1.0) < 1e-3) continue;
    const bool is_beyond = square > 22.4577;
    out.figure += (found.status == RegistrationStatus::kBeyondPrior) == is_beyond ? 0.0 : 1.0;
    out.figure += !is_beyond && found.status != RegistrationStatus::kConverged ? 1.0 : 0.0;
    (is_beyond ? beyond_it : believed) += 1;
  }
  out.figure += believed > 1 && beyond_it > 1 ? 0.0 : 1.0;
  return out;
}

/// Sources of which a part meets nothing: overlap is the share that is matched, and too little just below the limit
/// that is set; of less than fifty points, of either cloud, there is no answer. A figure counts.
StressFigure too_little() {
  StressFigure out;
  const MatchingParameters matching;
  const Scenery s = scenery(true, matching.leaf_m);
  made::Cloud half = furnished(1, true);
  const std::size_t whole = half.size();
  for (std::size_t k = 0; k < whole; ++k) half.push_back(half[k] + Eigen::Vector3f(60.0f, 0.0f, 0.0f));
  const auto source = prepare_surfaces(half, matching.leaf_m);
  const PosePrior prior = prior_of(Vector6d::Zero(), 0.01, 0.05);
  const auto run = [&](const PreparedCloud& of, const SurfaceTarget& onto, double least) {
    EngineParameters engine;
    engine.least_overlap = least;
    return Aligner(of, onto, plane_to_plane, matching, engine, prior).align();
  };
  const double overlap = run(*source, *s.surfaces, 0.2).overlap;
  out.figure += std::abs(overlap - 0.5) < 0.02 ? 0.0 : 1.0;
  out.figure += run(*source, *s.surfaces, overlap - 1e-3).status == RegistrationStatus::kTooLittleOverlap ? 1.0 : 0.0;
  out.figure += run(*source, *s.surfaces, overlap + 1e-3).status == RegistrationStatus::kTooLittleOverlap ? 0.0 : 1.0;
  const auto part = [&](std::size_t n) {
    // One to a leaf, all over the room.
    made::Cloud points;
    for (std::size_t k = 0; points.size() < n; k += s.source->points.size() / 60) points.push_back(s.source->points[k]);
    return prepare_surfaces(points, matching.leaf_m);
  };
  const auto few = part(49), enough = part(50);
  out.figure += few->points.size() == 49 && enough->points.size() == 50 ? 0.0 : 1.0;
  const auto few_target = point_target(few), enough_target = point_target(enough);
  const auto is_few = [](const RegistrationResult& r) { return r.status == RegistrationStatus::kTooFewPoints; };
  out.figure += is_few(run(*few, *s.surfaces, 0.2)) && is_few(run(*s.source, *few_target, 0.2)) ? 0.0 : 1.0;
  out.figure += is_few(run(*enough, *s.surfaces, 0.2)) || is_few(run(*s.source, *enough_target, 0.2)) ? 1.0 : 0.0;
  return out;
}

/// A room that is the same turned half round: which way it stands only the prior can tell. Where that has the other way
/// at odds of less than a thousand to one the answer is ambiguous, else it is not; and where something in it tells them
/// apart it never is. A figure counts.
StressFigure half_turns(double yaw_sigma_rad, bool pillars) {
  StressFigure out;
  MatchingParameters matching;
  matching.leaf_m = 0.5;
  const EngineParameters engine;
  const Scenery s = scenery(pillars, matching.leaf_m);
  const PosePrior prior = prior_of(drawn_off(7, 0.01, 0.02), 0.01, 0.05, yaw_sigma_rad);
  const RegistrationResult found = Aligner(*s.source, *s.surfaces, plane_to_plane, matching, engine, prior).align();
  const bool open_to_both = !pillars && std::pow(kPi / yaw_sigma_rad, 2) < 2.0 * std::log(1000.0);
  out.figure += (found.status == RegistrationStatus::kAmbiguous) == open_to_both ? 0.0 : 1.0;
  out.figure += open_to_both || found.status == RegistrationStatus::kConverged ? 0.0 : 1.0;
  out.figure += open_to_both || found.X_TS.p.norm() < 0.1 ? 0.0 : 1.0;
  return out;
}

}  // namespace

std::vector<StressCase> aligner_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "where an alignment settles, and how sure it is there",
           "a prior that counts once a point in place of once a piece, sums of another place, guesses to one side",
           "no step of surfaces and prior together is left; each form by its formula: what settling leaves",
           "of the bound"});
  for (const auto& form : covariance_forms())
    rows.add(std::string("aligners/settled_with_a_prior_") + form.name,
             [name = std::string(form.name)] { return settled(name, 0.03, 1); });
  const char* const no_step = "once no match changes any more the last step was a Newton step, and none is left";
  rows.add("aligners/settled_with_a_weak_prior", [] { return settled("calibrated", 0.1, 2); })
      .add("aligners/settled_without_a_prior", [] { return settled("calibrated", 0.0, 3); })
      .loose(no_step)
      .add("aligners/settled_without_a_prior_from_other_guesses", [] { return settled("guess_and_bias", 0.0, 4); })
      .loose(no_step);
  rows.of({StressGroup::kData, "verdicts on an alignment", "a limit of the other side, or of another share",
           "each by its words, just so and just not so", "wrong"});
  rows.add("aligners/beyond_the_prior", beyond_the_prior).add("aligners/too_little", too_little);
  for (const double yaw : {0.3, 0.7, 1.6, 2.5})
    rows.add("aligners/half_turns_at_a_yaw_of_" + stress::text(yaw), [yaw] { return half_turns(yaw, false); });
  rows.add("aligners/half_turns_among_pillars", [] { return half_turns(1.0, true); });
  return rows.take();
}

}  // namespace canyon::lidar
