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
// Where less than kFew of the points found a match: half turned, at most this share of what was missed is missed.
constexpr double kFew = 0.8;
constexpr double kFarBetter = 0.5;
constexpr double kWellMatched = 0.9;  // of the points; fewer may be out of reach because the prior holds them there
// Normals of neighbours err together (they share points), so that what they feign as curvature counts twice.
constexpr double kTiltsAlike = 2.0;
// A direction with more sigma is open: who says that it is closed says 0.2 m and 0.5 deg (3 sigma).
constexpr double kWidest_m = 0.2 / 3.0;
constexpr double kWidest_rad = 0.5 / 3.0 * kDegree;
constexpr double kProbability = 1e-3;
constexpr int kMostOpenings = 6;      // each opens a direction
constexpr double kClosedShare = 0.5;  // of a way; what has less is open

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
/// open: it stays where it was, unsettled. False: nothing is determined. Where nothing had been open but by its width,
/// and the others, which lean by as much as the prior is wide, all followed, it stays where it was then too.
bool Aligner::keep_open_at_prior(Place& place) {
  FoundPose& at = place.found;
  OpenDirections& open = place.open;
  std::optional<FoundPose> closed;  // where the surfaces left nothing open but by its width
  const auto undetermined = [&] {
    if (!closed) return false;
    at = *std::move(closed);
    at.settled = false;
    open = OpenDirections(search_.radius_m());
    place.kept = true;
    return false;
  };
  for (int pass = 0; pass < kMostOpenings; ++pass) {
    const CovarianceSums& sums = sums_at(at);
    if (sums.matched < kFewestPoints) return true;
    const RegistrationPrecision precision = precision_at(at, model_row(covariance_forms(), "calibrated").make, open);
    if (!precision.covariance.allFinite() || precision.open.size() >= 6) return undetermined();
    const std::size_t before = open.open().size();
    for (const Vector6d& v : precision.open) open.add(v);
    const std::size_t without_scale = open.open().size();
    open.open_wide(precision.covariance, kWidest_m, kWidest_rad);
    place.opened_wide |= open.open().size() > without_scale;
    if (open.open().size() >= 6) return undetermined();
    if (open.open().size() == before) return true;
    FoundPose stays = at;
    if (pass == 0 && precision.open.empty()) closed = at;
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
bool Aligner::explains_less(const Fit& a, const Fit& b) {
  return static_cast<double>(a.matched) < kAsWellMatched * static_cast<double>(b.matched);
}

/// How much less probable b is than a, as twice the logarithm of the odds: by what they leave unexplained, of which the
/// sigma counts as one of a normal distribution, and by the prior.
double Aligner::odds(const Place& a, const Place& b) const {
  const double sigma = evidence_against(a.fit.by_point, b.fit.by_point, source_, kTellingBlock_leaves * own_.leaf_m);
  return sigma * std::abs(sigma) + search_.improbable(b.fit.X) - search_.improbable(a.fit.X);
}

/// Whether b is the better answer: one that is none loses to any.
bool Aligner::loses_to(const Place& a, const Place& b) const {
  if (a.determined != b.determined) return b.determined;
  if (a.fit.by_point.empty() || explains_less(a.fit, b.fit)) return !b.fit.by_point.empty();
  return !b.fit.by_point.empty() && !explains_less(b.fit, a.fit) && odds(a, b) < 0;
}

/// Whether b is another place, and explains what is seen nearly as well as a, or better. Whether it could be the answer
/// is not asked: that a true place leaves too much open to be told makes a false one no truer.
bool Aligner::rivals(const Place& a, const Place& b) const {
  if (a.fit.by_point.empty() || b.fit.by_point.empty() || explains_less(b.fit, a.fit)) return false;
  if (!are_apart(a.open.closed_part((a.fit.X.inverse() * b.fit.X).log()))) return false;
  // One that fits better though it has not settled yet is not known at the scale that tells.
  return (!b.fit.settled && b.fit.missed < a.fit.missed) || odds(a, b) < kDecided;
}

/// As far as it can be determined, and how it fits if there may be several; what led to the same place once more, and
/// fits no better, is left out.
void Aligner::take_in(FoundPose found, std::vector<Place>& places) {
  search_.refine(found);
  Fit fit{.X = found.X, .matched = found.equations.matched, .missed = found.equations.missed, .settled = found.settled};
  if (search_.several() && found.matches.size() == source_.points.size()) fit.by_point = unexplained(found);
  for (const Place& known : places)
    if (!are_apart((known.fit.X.inverse() * fit.X).log()) && known.fit.missed <= fit.missed) return;
  Place place{.found = std::move(found), .fit = std::move(fit), .open = OpenDirections(search_.radius_m())};
  if (search_.prior()) place.determined = keep_open_at_prior(place);
  places.push_back(std::move(place));
}

std::size_t Aligner::likeliest(const std::vector<Place>& places) const {
  std::size_t first = 0;
  for (std::size_t k = 1; k < places.size(); ++k)
    if (loses_to(places[first], places[k])) first = k;
  return first;
}

/// The way in the source's x-y plane (level as the sensor is) along which the surfaces hold a place the least, of
/// length 1; nothing where it is open there.
std::optional<Vector6d> Aligner::weakest_way(Place& place) const {
  const CovarianceSums& sums = sums_at(place.found);
  const Matrix6d spread = sums.A.ldlt().solve(Matrix6d::Identity());
  if (!spread.allFinite()) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> plane(spread.block<2, 2>(3, 3));
  Vector6d way = Vector6d::Zero();
  way.segment<2>(3) = plane.eigenvectors().col(1);
  if (!way.allFinite() || !(plane.eigenvalues()[0] > 0.0) ||
      place.open.closed_part(way).tail<3>().norm() < kClosedShare)
    return std::nullopt;
  return way;
}

/// Places that may be it. Where things repeat, a start ends at what is nearest to it, and with few beams at where their
/// rings on the ground fit one another, off any of the repeats: so along the way that the likeliest place leaves the
/// weakest others are looked for, with all else as it is there.
std::vector<Aligner::Place> Aligner::places() {
  std::vector<Place> out;
  for (FoundPose& found : search_.coarse()) take_in(std::move(found), out);
  if (!search_.several()) return out;
  std::vector<FoundPose> others;
  if (Place& first = out[likeliest(out)]; first.determined) {
    if (const auto way = weakest_way(first)) others = search_.along(first.fit.X, *way);
  }
  for (FoundPose& found : others) take_in(std::move(found), out);
  return out;
}

/// Whether many points have no match where it ended, and half turned about one of the source's axes, begun where the
/// guess stood, far more is explained: a guess that was half turned ends on level ground or on one wall, and a prior
/// has its way in all that these leave open. What is held at a prior is compared by where the surfaces alone lead from
/// there.
bool Aligner::turned_is_far_better(const FoundPose& at, double overlap) {
  if (overlap > kFew) return false;
  const auto missed_from = [this](const Pose& X) {
    FoundPose alone;
    alone.X = X;
    search_.anew(alone, 20, {.surfaces_alone = true});
    return alone.equations.missed;
  };
  const double missed = search_.prior() ? std::min(at.equations.missed, missed_from(at.X)) : at.equations.missed;
  for (const Eigen::Vector3d& axis :
       {Eigen::Vector3d(Eigen::Vector3d::UnitZ()), Eigen::Vector3d(Eigen::Vector3d::UnitX()),
        Eigen::Vector3d(Eigen::Vector3d::UnitY())}) {
    if (missed_from(Pose{at.X.R * so3_exp(kPi * axis), search_.guess().p}) < kFarBetter * missed) return true;
  }
  return false;
}

void Aligner::judge(const Place& best, bool ambiguous, RegistrationResult& result) const {
  using Status = RegistrationStatus;
  result.status = Status::kConverged;
  if (result.overlap < engine_.least_overlap) {
    result.status = Status::kTooLittleOverlap;
  } else if (best.kept) {
    result.status = Status::kNotConverged;
  } else if (result.surfaces && beyond_prior(result.surfaces->X_TS, result.surfaces->covariance)) {
    result.status = Status::kBeyondPrior;
  } else if (!best.found.settled) {
    result.status = Status::kNotConverged;
  } else if (ambiguous) {
    result.status = Status::kAmbiguous;
  }
}

/// Whether what the surfaces alone have, with so much covariance, and the prior do not agree.
bool Aligner::beyond_prior(const Pose& X, const Matrix6d& by_surfaces) const {
  const Vector6d xi = search_.prior()->off(X);
  const Matrix6d sum = search_.prior()->covariance_at(X) + by_surfaces;
  return !(xi.dot(sum.ldlt().solve(xi)) < chi_square_threshold(kProbability, 6.0));
}

/// From where the place was before anything was held at the prior.
Aligner::Alone Aligner::by_themselves(const Place& best) {
  Alone alone{.at = best.found, .open = OpenDirections(search_.radius_m()), .precision = {}};
  alone.at.X = best.fit.X;
  for (int pass = 0; pass < kMostOpenings; ++pass) {
    search_.anew(alone.at, 30, {.open = &alone.open, .surfaces_alone = true});
    alone.precision = precision_at(alone.at, model_row(covariance_forms(), engine_.covariance).make, alone.open);
    const std::size_t before = alone.open.open().size();
    for (const Vector6d& v : alone.precision.open) alone.open.add(v);
    if (alone.open.open().size() == before || alone.open.open().size() >= 6) break;
    alone.at.X = search_.held(alone.open, alone.at.X);
  }
  return alone;
}

/// Held by a prior that is wrong and sure of it, all points are off their surfaces: by such residuals every direction
/// is wide, what is wide is open and the prior's, and nothing is left that contradicts it. So the two are compared
/// where the surfaces have it by themselves, and with what they are sure of there.
void Aligner::doubt_prior(const Place& best, RegistrationResult& result) {
  using Status = RegistrationStatus;
  if (result.status == Status::kTooLittleOverlap || result.status == Status::kAmbiguous) return;
  // However sure surfaces are, they contradict nothing within the prior's own ellipsoid.
  constexpr double kSurest = 1e-12;
  if (!best.opened_wide &&
      (result.status == Status::kBeyondPrior || !beyond_prior(result.surfaces->X_TS, kSurest * Matrix6d::Identity())))
    return;
  const Alone alone = by_themselves(best);
  if (!alone.precision.covariance.allFinite() || alone.open.open().size() >= 6) return;
  if (!beyond_prior(alone.at.X, alone.precision.covariance)) return;
  if (!alone.at.settled) {  // where they have it is not known, nor that it is where the prior has it
    if (result.status == Status::kConverged) result.status = Status::kNotConverged;
    return;
  }
  result.status = Status::kBeyondPrior;
  result.open = alone.open.open();
  result.surfaces = {.X_TS = alone.at.X, .covariance = alone.precision.covariance};
}

RegistrationResult Aligner::align() {
  RegistrationResult result;
  result.X_TS = search_.guess();
  result.status = RegistrationStatus::kTooFewPoints;
  const auto n = static_cast<std::int64_t>(source_.points.size());
  if (n < kFewestPoints || static_cast<std::int64_t>(target_.size()) < kFewestPoints) return result;
  auto found = places();
  Place& best = found[likeliest(found)];
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
  const auto& prior = search_.prior();
  if (!(best.determined || best.kept) || !precision.covariance.allFinite() || precision.open.size() >= 6) {
    // That is where the prior holds it; by themselves the surfaces may be sure of another place.
    if (best.opened_wide) doubt_prior(best, result);
    if (result.status != RegistrationStatus::kBeyondPrior) return result;
    result.X_TS = best.fit.X;
    result.covariance = prior->with(best.fit.X, result.surfaces->covariance);
    return finite_or_degenerate(std::move(result));
  }
  result.X_TS = at.X;
  result.open = prior ? best.open.open() : precision.open;
  result.rms_m = precision.rms_m;
  result.covariance = precision.covariance;
  if (prior) result.surfaces = {.X_TS = by_surfaces(at, best.open), .covariance = precision.covariance};
  judge(best, ambiguous, result);
  if (prior) doubt_prior(best, result);
  if (result.status == RegistrationStatus::kConverged && turned_is_far_better(at, result.overlap))
    result.status = RegistrationStatus::kAmbiguous;
  // Together: along open directions the prior's, in the others what both know.
  if (prior) result.covariance = prior->with(at.X, precision.covariance);
  return finite_or_degenerate(std::move(result));
}

/// A covariance is finite, or there is none and the guess stands.
RegistrationResult Aligner::finite_or_degenerate(RegistrationResult result) const {
  if (result.covariance.allFinite()) return result;
  result.X_TS = search_.guess();
  result.covariance.setConstant(kNaN);
  result.surfaces.reset();
  result.status = RegistrationStatus::kDegenerate;
  return result;
}

}  // namespace canyon::lidar
