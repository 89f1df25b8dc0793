#include "canyon/lidar/registration/engine/aligner.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "canyon/core/math/chi_square.h"
#include "canyon/core/units.h"
#include "canyon/lidar/registration/engine/witnesses.h"

namespace canyon::lidar {
namespace {

constexpr std::int64_t kFewestPoints = 50;  // in the source, the target, and matched
// Another place leaves the choice open if it explains the points nearly as well.
constexpr double kDecided = 13.8;  // odds of a thousand to one, as twice their logarithm
constexpr double kAsWellMatched = 0.8;
constexpr double kTelling_leaves = 0.4;
constexpr double kTellingBlock_leaves = 8.0;
// A pull of the prior below this leaves no doubt of what the surfaces alone would have.
constexpr double kNoPull_m = 0.03;
constexpr double kNoPull_rad = 3e-3;
// Where nothing is known of a guess and less than kFew of the points found a match: half turned, at most this share of
// what was missed is missed.
constexpr double kFew = 0.8;
constexpr double kFarBetter = 0.5;
constexpr double kWellMatched = 0.9;  // of the points; fewer may be out of reach because the prior holds them there
// Normals of neighbours err together (they share points), so that what they feign as curvature counts twice.
constexpr double kTiltsAlike = 2.0;
// A direction with more sigma is open: who says that it is closed says 0.2 m and 0.5 deg (3 sigma).
constexpr double kWidest_m = 0.2 / 3.0;
constexpr double kWidest_rad = 0.5 / 3.0 * kDegree;
constexpr double kProbability = 1e-3;
constexpr int kMostOpenings = 6;  // each opens a direction

}  // namespace

Aligner::Aligner(const PreparedCloud& source, const SurfaceTarget& target, MatchForm* form,
                 const MatchingParameters& matching, const EngineParameters& engine, const PosePrior& prior)
    : source_(source),
      target_(target),
      own_(matching),
      engine_(engine),
      search_(source, target, form, matching, engine, prior) {}

/// Of where `at` is; made once for each place.
const CovarianceSums& Aligner::sums_at(FoundPose& at) const {
  if (!at.sums) {
    at.sums = covariance_sums(search_.matching_at(own_.max_correspondence_m), at.X, at.matches, block_m(own_.leaf_m),
                              model_row(covariance_forms(), engine_.covariance).make.by_noise);
    at.sums->N *= kTiltsAlike;
  }
  return *at.sums;
}

/// By the surfaces and as `form` says; open directions have kUnconstrainedSigma_m, and the others what those lean by.
RegistrationPrecision Aligner::precision_at(FoundPose& at, const CovarianceForm& form, const OpenDirections& open) {
  const CovarianceSums& sums = sums_at(at);
  const auto guesses = form.restarts ? restarts(at) : std::vector<Vector6d>();
  RegistrationPrecision precision =
      registration_precision(sums, form.gradient({sums, engine_.point_sigma_m, engine_.range_bias_m, guesses}));
  if (!precision.covariance.allFinite()) return precision;
  if (form.by_witnesses) {
    OpenDirections all = open;
    for (const Vector6d& v : precision.open) all.add(v);
    precision.covariance = widened_by_witnesses(precision.covariance, sums, all);
  }
  precision.covariance += 4.0 * at.last_step * at.last_step.transpose();
  const auto& prior = search_.prior();
  if (open.empty() || !prior) return precision;
  const Leaning leaning = open.leaning(sums.block_surfaces, prior->covariance_at(at.X));
  const int closed = 6 - static_cast<int>(open.open().size());
  precision.covariance = open.with_open(precision.covariance, kUnconstrainedSigma_m) +
                         product_over_normal(leaning.directions, closed) * leaning.covariance;
  return precision;
}

/// Finds the open directions where `at` is, takes it to the prior along them, and goes on with the others; again, as
/// what is open shows the better the closer the surfaces are. Where that leads off the surfaces, they do not leave it
/// open: it stays where it was, unsettled. False: nothing is determined.
bool Aligner::keep_open_at_prior(Place& place) {
  FoundPose& at = place.found;
  OpenDirections& open = place.open;
  for (int pass = 0; pass < kMostOpenings; ++pass) {
    const CovarianceSums& sums = sums_at(at);
    if (sums.matched < kFewestPoints) return true;
    const RegistrationPrecision precision = precision_at(at, model_row(covariance_forms(), "calibrated").make, open);
    if (!precision.covariance.allFinite() || precision.open.size() >= 6) return false;
    const std::size_t before = open.open().size();
    for (const Vector6d& v : precision.open) open.add(v);
    open.open_wide(precision.covariance, kWidest_m, kWidest_rad);
    if (open.open().size() >= 6) return false;
    if (open.open().size() == before) return true;
    FoundPose stays = at;
    at.X = search_.held(open, at.X);
    search_.refine(at, {.open = &open});
    const Matching matching = search_.matching_at(own_.max_correspondence_m);
    if (share_still_on_surfaces(matching, at.X, at.matches, stays.matches) < kAsWellMatched) {
      at = std::move(stays);
      at.settled = false;
      return true;
    }
  }
  return true;
}

std::vector<Vector6d> Aligner::restarts(const FoundPose& at) {
  // The law of guesses: the prior's, else a tenth of the reach and as much at the cloud's radius.
  Matrix6d law = Matrix6d::Zero();
  const double sigma_m = 0.1 * own_.max_correspondence_m;
  law.diagonal() << Eigen::Vector3d::Constant(sigma_m * sigma_m / (search_.radius_m() * search_.radius_m())),
      Eigen::Vector3d::Constant(sigma_m * sigma_m);
  if (search_.prior()) law = search_.prior()->covariance();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(law);
  std::vector<Vector6d> out;
  for (int k = 0; k < 6; ++k) {
    for (const double side : {-1.0, 1.0}) {
      FoundPose again;
      again.X =
          at.X * Pose::exp(side * std::sqrt(6.0 * std::max(0.0, eigen.eigenvalues()[k])) * eigen.eigenvectors().col(k));
      search_.anew(again, 20);
      out.push_back((at.X.inverse() * again.X).log());
    }
  }
  return out;
}

/// Where the surfaces alone would have it: the solution lies between that and the prior. A prior that pulls is left out
/// and the search goes on without it.
Pose Aligner::by_surfaces(const FoundPose& at, const OpenDirections& open) {
  const Vector6d xi = open.closed_part(-at.equations.A.ldlt().solve(at.equations.g));
  const auto n = static_cast<double>(source_.points.size());
  if (static_cast<double>(at.equations.matched) > kWellMatched * n && xi.tail<3>().norm() < kNoPull_m &&
      xi.head<3>().norm() < kNoPull_rad)
    return at.X * Pose::exp(xi);
  FoundPose alone = at;
  search_.anew(alone, 30, {.open = &open, .surfaces_alone = true});
  return alone.X;
}

/// What a place leaves unexplained, at a scale at which relief of a facade tells.
std::vector<double> Aligner::unexplained(const FoundPose& at) const {
  Matching matching = search_.matching_at(own_.max_correspondence_m);
  matching.width_m = kTelling_leaves * own_.leaf_m;
  return missed_by_point(matching, at.X, at.matches);
}

/// Whether a leaves so many more points without a match than b that it is no rival: where a cloud shifted by the prior
/// leaves the target it loses some, but not a fifth.
bool Aligner::explains_less(const FoundPose& a, const FoundPose& b) {
  return static_cast<double>(a.equations.matched) < kAsWellMatched * static_cast<double>(b.equations.matched);
}

/// How much less probable b is than a, as twice the logarithm of the odds: by what they leave unexplained, of which the
/// sigma counts as one of a normal distribution, and by the prior.
double Aligner::odds(const Place& a, const Place& b) const {
  const double sigma = evidence_against(a.missed, b.missed, source_, kTellingBlock_leaves * own_.leaf_m);
  return sigma * std::abs(sigma) + search_.improbable(b.found.X) - search_.improbable(a.found.X);
}

/// Whether b is the better answer.
bool Aligner::loses_to(const Place& a, const Place& b) const {
  if (a.missed.empty() || explains_less(a.found, b.found)) return true;
  return !explains_less(b.found, a.found) && odds(a, b) < 0;
}

/// Whether b is another place, and explains what is seen nearly as well as a.
bool Aligner::rivals(const Place& a, const Place& b) const {
  if (a.missed.empty() || b.missed.empty() || explains_less(b.found, a.found)) return false;
  return are_apart(a.open.closed_part((a.found.X.inverse() * b.found.X).log())) && odds(a, b) < kDecided;
}

/// Places that may be it, each as far as it can be determined, and what it leaves unexplained if there are several.
std::vector<Aligner::Place> Aligner::places() {
  std::vector<Place> out;
  for (FoundPose& found : search_.coarse())
    out.push_back({.found = std::move(found), .open = OpenDirections(search_.radius_m()), .missed = {}});
  for (Place& place : out) {
    search_.refine(place.found);
    if (search_.prior()) place.determined = keep_open_at_prior(place);
    if (out.size() > 1 && place.determined && place.found.matches.size() == source_.points.size())
      place.missed = unexplained(place.found);
  }
  return out;
}

/// Whether nothing is known of the guess, many points have no match where it ended, and half turned about one of the
/// source's axes, begun where the guess stood, far more is explained: a guess that was half turned ends on level ground
/// or on one wall.
bool Aligner::turned_is_far_better(const FoundPose& at, double overlap) {
  if (search_.prior() || overlap > kFew) return false;
  for (const Eigen::Vector3d& axis :
       {Eigen::Vector3d(Eigen::Vector3d::UnitZ()), Eigen::Vector3d(Eigen::Vector3d::UnitX()),
        Eigen::Vector3d(Eigen::Vector3d::UnitY())}) {
    FoundPose turned;
    turned.X = Pose{at.X.R * so3_exp(kPi * axis), search_.guess().p};
    search_.anew(turned, 20);
    if (turned.equations.missed < kFarBetter * at.equations.missed) return true;
  }
  return false;
}

void Aligner::judge(const FoundPose& best, bool ambiguous, RegistrationResult& result) const {
  using Status = RegistrationStatus;
  result.status = Status::kConverged;
  if (result.overlap < engine_.least_overlap) {
    result.status = Status::kTooLittleOverlap;
  } else if (beyond_prior(result)) {
    result.status = Status::kBeyondPrior;
  } else if (!best.settled) {
    result.status = Status::kNotConverged;
  } else if (ambiguous) {
    result.status = Status::kAmbiguous;
  }
}

/// Whether what the surfaces alone have and the prior do not agree.
bool Aligner::beyond_prior(const RegistrationResult& result) const {
  const auto& prior = search_.prior();
  if (!prior) return false;
  const Vector6d xi = prior->off(result.surfaces->X_TS);
  const Matrix6d sum = prior->covariance_at(result.surfaces->X_TS) + result.surfaces->covariance;
  return !(xi.dot(sum.ldlt().solve(xi)) < chi_square_threshold(kProbability, 6.0));
}

RegistrationResult Aligner::align() {
  RegistrationResult result;
  result.X_TS = search_.guess();
  result.status = RegistrationStatus::kTooFewPoints;
  const auto n = static_cast<std::int64_t>(source_.points.size());
  if (n < kFewestPoints || static_cast<std::int64_t>(target_.size()) < kFewestPoints) return result;
  auto found = places();
  std::size_t first = 0;
  for (std::size_t k = 0; k < found.size(); ++k)
    if (!found[k].missed.empty() && loses_to(found[first], found[k])) first = k;
  Place& best = found[first];
  FoundPose& at = best.found;
  bool ambiguous = false;
  for (const Place& other : found) ambiguous |= &other != &best && rivals(best, other);
  result.iterations = search_.rounds();
  result.correspondences = search_.matched();
  result.overlap = static_cast<double>(at.equations.matched) / static_cast<double>(n);
  if (at.equations.matched < kFewestPoints) {
    result.status = RegistrationStatus::kTooLittleOverlap;
    return result;
  }
  const RegistrationPrecision precision =
      precision_at(at, model_row(covariance_forms(), engine_.covariance).make, best.open);
  result.status = RegistrationStatus::kDegenerate;
  if (!best.determined || !precision.covariance.allFinite() || precision.open.size() >= 6) return result;
  result.X_TS = at.X;
  const auto& prior = search_.prior();
  result.open = prior ? best.open.open() : precision.open;
  result.rms_m = precision.rms_m;
  result.covariance = precision.covariance;
  if (prior) result.surfaces = {.X_TS = by_surfaces(at, best.open), .covariance = precision.covariance};
  judge(at, ambiguous, result);
  if (result.status == RegistrationStatus::kConverged && turned_is_far_better(at, result.overlap))
    result.status = RegistrationStatus::kAmbiguous;
  // Together: along open directions the prior's, in the others what both know.
  if (prior) result.covariance = prior->with(at.X, precision.covariance);
  if (!result.covariance.allFinite()) {
    result.X_TS = search_.guess();
    result.covariance.setConstant(kNaN);
    result.surfaces.reset();
    result.status = RegistrationStatus::kDegenerate;
  }
  return result;
}

}  // namespace canyon::lidar
