#include "canyon/lidar/registration/engine/aligner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "canyon/core/math/chi_square.h"
#include "canyon/core/units.h"
#include "canyon/lidar/registration/engine/covariance_forms.h"
#include "canyon/lidar/voxels/voxel_index.h"

namespace canyon::lidar {
namespace {

constexpr std::int64_t kFewestPoints = 50;  // in the source, the target, and matched
constexpr double kSettled_m = 2e-4;
constexpr double kSettled_rad = 2e-5;
// Matches that change to and fro keep a solution moving; the step that is left then counts as an error, up to half of
// what a closed direction may have.
constexpr double kNearly_m = 0.03;
constexpr double kNearly_rad = 1.5e-3;
constexpr double kUndamped = 1e-7;
constexpr double kBlock_leaves = 16.0;       // normals correlate over about as much
constexpr std::size_t kCoarsePoints = 1000;  // of which the coarse rounds make do
constexpr double kShrinking = 0.6;           // of the reach, from round to round
constexpr double kWorse = 1.01;              // a round that raises the cost by more is taken back
constexpr double kFarthest_m = 1e8;          // farther than two clouds of 2^20 voxels can be apart
// A start finds the right place from about this far (docs/registration.md).
constexpr double kBasin_m = 1.5;
constexpr double kBasin_rad = 8.0 * kDegree;
constexpr int kMostStarts = 1200;
constexpr std::size_t kRefined = 6;
constexpr double kCoarsePieces = 100.0;  // of the cloud, that speak for themselves, against the prior
// Another minimum counts as another place from here on ...
constexpr double kApart_m = 0.3;
constexpr double kApart_rad = 1.5 * kDegree;
// ... and leaves the choice open if it explains the points nearly as well.
constexpr double kDecided = 13.8;          // odds of a thousand to one, as twice their logarithm
constexpr double kCertainSquared = 1e-12;  // variance of what the prior knows to be so
constexpr double kAsWellMatched = 0.8;
constexpr double kTelling_leaves = 0.4;
constexpr double kTellingBlock_leaves = 8.0;
// A pull of the prior below this leaves no doubt of what the surfaces alone would have.
constexpr double kNoPull_m = 0.03;
constexpr double kNoPull_rad = 3e-3;
constexpr double kWellMatched = 0.9;  // of the points; fewer may be out of reach because the prior holds them there
// Normals of neighbours err together (they share points), so that what they feign as curvature counts twice.
constexpr double kTiltsAlike = 2.0;
// A direction with more sigma is open: who says that it is closed says 0.2 m and 0.5 deg (3 sigma).
constexpr double kWidest_m = 0.2 / 3.0;
constexpr double kWidest_rad = 0.5 / 3.0 * kDegree;
constexpr double kProbability = 1e-3;
constexpr int kMostOpenings = 6;  // each opens a direction

double rms_radius(const PreparedCloud& cloud) {
  double sum = 0;
  for (const Eigen::Vector3f& p : cloud.points) sum += p.cast<double>().squaredNorm();
  return cloud.points.empty() ? 1.0 : std::max(1e-3, std::sqrt(sum / static_cast<double>(cloud.points.size())));
}

std::size_t count_blocks(const PreparedCloud& cloud, double block_m) {
  VoxelIndex blocks(block_m);
  for (const Eigen::Vector3f& p : cloud.points) {
    if (const auto place = blocks.coordinates(p)) blocks.insert(*place);
  }
  return std::max<std::size_t>(blocks.size(), 1);
}

/// A prior of endless sigma leaves roundings below nothing.
Matrix6d without_negative(const Matrix6d& covariance) {
  const Matrix6d even = 0.5 * (covariance + covariance.transpose());
  if (!even.allFinite()) return even;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(even);
  const Vector6d& values = eigen.eigenvalues();
  if (!(values[0] < 0)) return even;
  return eigen.eigenvectors() * values.cwiseMax(0.0).asDiagonal() * eigen.eigenvectors().transpose();
}

bool apart(const Vector6d& xi) {
  return xi.tail<3>().norm() > kApart_m || xi.head<3>().norm() > kApart_rad;
}

bool apart(const Pose& a, const Pose& b) {
  return apart(Vector6d((a.inverse() * b).log()));
}

}  // namespace

Aligner::Aligner(const PreparedCloud& source, const SurfaceTarget& target, MatchForm* form,
                 const MatchingParameters& matching, const EngineParameters& engine, const PosePrior& prior)
    : source_(source),
      target_(target),
      form_(form),
      kernel_(model_row(robust_kernels(), engine.kernel).make),
      own_(matching),
      engine_(engine),
      X_prior_(prior.X_TS),
      radius_m_(rms_radius(source)),
      open_(radius_m_) {
  if (!prior.covariance.allFinite()) return;
  // As large as the grids are, so that sums of it stay finite.
  const Matrix6d P = 0.5 * (prior.covariance + prior.covariance.transpose());
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(P);
  if (eigen.info() != Eigen::Success) return;
  const Vector6d values = eigen.eigenvalues().cwiseMax(0.0).cwiseMin(1e12);
  P_prior_ = eigen.eigenvectors() * values.asDiagonal() * eigen.eigenvectors().transpose();
  held_law_ = P_prior_;
  blocks_ = count_blocks(source, kBlock_leaves * matching.leaf_m);
}

Matching Aligner::matching_at(double reach_m) const {
  const double width_m = engine_.kernel_width_m * reach_m / own_.max_correspondence_m;
  return {
      .source = &source_, .target = &target_, .form = form_, .kernel = kernel_, .reach_m = reach_m, .width_m = width_m};
}

/// The minimum of  xi^T A xi / 2 + g^T xi  plus the prior's part, in which a covariance without inverse is as good as
/// any:  (P A / k + 1) xi = -(P g / k + xi_0),  P carried to X, k = what one piece of independent knowledge weighs.
/// Open directions stay where they are.
Vector6d Aligner::step(const NormalEquations& e, const Pose& X, double damping) const {
  Matrix6d A = e.A;
  Vector6d scale;
  scale << Eigen::Vector3d::Constant(radius_m_ * radius_m_), Eigen::Vector3d::Ones();
  A.diagonal() += damping * (A.trace() / (scale.sum()) * scale);
  const auto n = static_cast<double>(e.matched);
  const double s2 = std::max(e.cost / std::max(e.weight, 1e-12), 1e-6 / kAcrossScale);
  const double k = P_prior_ ? std::max(1.0, s2 * n / static_cast<double>(blocks_)) : 1.0;
  const Vector6d xi_0 = P_prior_ ? Vector6d((X_prior_.inverse() * X).log()) : Vector6d(Vector6d::Zero());
  const Matrix6d P_here = P_prior_ ? carried(*P_prior_, X_prior_, X) : Matrix6d(Matrix6d::Zero());
  if (open_.empty()) {
    if (!P_prior_) return -A.ldlt().solve(e.g);
    const Matrix6d left = P_here * A / k + Matrix6d::Identity();
    return -left.partialPivLu().solve(P_here * e.g / k + xi_0);
  }
  // In coordinates of the directions at right angles to the open ones.
  const Eigen::MatrixXd C = open_.closed_basis(), dual = open_.closed_dual();
  if (C.cols() == 0) return Vector6d::Zero();
  const Eigen::MatrixXd closed = C.transpose() * A * C;
  if (!P_prior_) return -C * closed.ldlt().solve(C.transpose() * e.g);
  const Eigen::MatrixXd P = dual * P_here * dual.transpose();
  const Eigen::MatrixXd left = P * closed / k + Eigen::MatrixXd::Identity(C.cols(), C.cols());
  return -C * left.partialPivLu().solve(P * (C.transpose() * e.g) / k + dual * xi_0);
}

void Aligner::descend(const Stage& stage, Candidate& at) {
  double damping = kUndamped, reach_m = stage.reach_m;
  bool compare = false;
  Pose before_X = at.X;
  NormalEquations before;
  at.settled = false;
  at.last_step.setZero();
  for (std::int64_t round = 0; round < stage.rounds; ++round) {
    at.sums.reset();
    at.equations = normal_equations(matching_at(reach_m), at.X, stage.stride, at.matches);
    ++rounds_;
    matched_ += at.equations.matched;
    if (compare && at.equations.missed > kWorse * before.missed) {
      at.X = before_X;
      at.equations = before;
      damping = std::max(10.0 * damping, 1e-3);
      if (damping > 1e3) return;
    } else {
      damping = std::max(0.1 * damping, kUndamped);
    }
    at.missed = at.equations.missed;
    if (at.equations.matched < 6) return;
    const Vector6d xi = step(at.equations, at.X, damping);
    const Pose moved = at.X * Pose::exp(xi);
    if (!xi.allFinite() || !(moved.matrix().array().abs() < kFarthest_m).all()) return;
    before_X = at.X;
    before = at.equations;
    at.X = moved;
    // What the others do moves what the prior says of the open ones.
    at.X = held(open_, at.X);
    const bool last_reach = reach_m <= own_.max_correspondence_m;
    compare = last_reach;
    if (last_reach && xi.tail<3>().norm() < stage.settled_m && xi.head<3>().norm() < stage.settled_rad) {
      at.settled = damping < 1e-2;
      return;
    }
    if (round + 1 == stage.rounds && last_reach) {
      at.last_step = step(before, before_X, kUndamped);
      at.settled = at.last_step.tail<3>().norm() < kNearly_m && at.last_step.head<3>().norm() < kNearly_rad;
      if (!at.settled) at.last_step.setZero();
    }
    reach_m = std::max(own_.max_correspondence_m, kShrinking * reach_m);
  }
}

/// The prior's pose, and places around it in the plane and about the vertical, a basin apart, as far as 3 sigma.
std::vector<Pose> Aligner::starts() const {
  std::vector<Pose> out{X_prior_};
  if (!P_prior_) return out;
  const Matrix6d& P = *P_prior_;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> plane(P.block<2, 2>(3, 3));
  const Eigen::Vector2d sigma = plane.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  const double yaw_sigma = std::sqrt(std::max(0.0, P(2, 2)));
  double spacing = 1.0;
  const auto reach = [&](double s, double basin) {
    return static_cast<int>(std::min(1000.0, std::ceil(std::max(0.0, 3.0 * s / (basin * spacing) - 0.75) * 0.75)));
  };
  while (static_cast<double>(2 * reach(sigma[0], kBasin_m) + 1) * (2 * reach(sigma[1], kBasin_m) + 1) *
             (2 * reach(yaw_sigma, kBasin_rad) + 1) >
         kMostStarts)
    spacing *= 1.2;
  const int a_max = reach(sigma[0], kBasin_m), b_max = reach(sigma[1], kBasin_m), c_max = reach(yaw_sigma, kBasin_rad);
  for (int c = -c_max; c <= c_max; ++c) {
    for (int a = -a_max; a <= a_max; ++a) {
      for (int b = -b_max; b <= b_max; ++b) {
        if (a == 0 && b == 0 && c == 0) continue;
        const Eigen::Vector2d shift =
            spacing * 1.33 * kBasin_m * (a * plane.eigenvectors().col(0) + b * plane.eigenvectors().col(1));
        const double yaw_rad = spacing * 1.33 * kBasin_rad * c;
        const auto part = [](double x, double s) { return s > 0 ? x * x / (s * s) : 0.0; };
        const Eigen::Vector2d along = plane.eigenvectors().transpose() * shift;
        if (part(along[0], sigma[0]) + part(along[1], sigma[1]) + part(yaw_rad, yaw_sigma) > 14.0) continue;
        Vector6d xi = Vector6d::Zero();
        xi[2] = yaw_rad;
        xi.segment<2>(3) = shift;
        out.push_back(X_prior_ * Pose{so3_exp(xi.head<3>()), xi.tail<3>()});
      }
    }
  }
  return out;
}

std::vector<Aligner::Candidate> Aligner::coarse() {
  const std::size_t stride = std::max<std::size_t>(1, source_.points.size() / kCoarsePoints);
  const auto places = starts();
  const std::size_t first = places.size() > 8 ? 4 * stride : stride;
  const double reach_m = std::max(engine_.start_correspondence_m, own_.max_correspondence_m);
  std::vector<Candidate> found;
  for (const Pose& X : places) {
    Candidate at;
    at.X = X;
    descend({first, reach_m, first == stride ? 30 : 12, 5e-3, 5e-4}, at);
    found.push_back(std::move(at));
  }
  if (found.size() == 1) return found;
  std::vector<std::size_t> order(found.size());
  const auto sort = [this, &order](const std::vector<Candidate>& of) {
    std::vector<double> improbable;
    for (const Candidate& at : of) improbable.push_back(kCoarsePieces * at.missed + from_prior(at.X));
    order.resize(of.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return improbable[a] < improbable[b]; });
  };
  const auto known = [](const std::vector<Candidate>& among, const Pose& X) {
    return std::any_of(among.begin(), among.end(), [&](const Candidate& k) { return !apart(k.X, X); });
  };
  const double farthest = chi_square_threshold(kProbability, 6.0);
  sort(found);
  std::vector<Candidate> kept;
  for (const std::size_t k : order) {
    if (kept.size() == 3 * kRefined) break;
    if (!kept.empty() && (from_prior(found[k].X) > farthest || known(kept, found[k].X))) continue;
    kept.push_back(std::move(found[k]));
  }
  for (Candidate& at : kept) {
    at.matches.clear();
    descend({stride, own_.max_correspondence_m, 15, 5e-3, 5e-4}, at);
  }
  sort(kept);
  std::vector<Candidate> best;
  for (const std::size_t k : order) {
    if (best.size() == kRefined) break;
    if (!known(best, kept[k].X)) best.push_back(std::move(kept[k]));
  }
  return best;
}

void Aligner::refine(Candidate& at) {
  descend({1, own_.max_correspondence_m, own_.max_iterations, kSettled_m, kSettled_rad}, at);
}

/// Of where `at` is; made once for each place.
const CovarianceSums& Aligner::sums_at(Candidate& at) const {
  if (!at.sums) {
    at.sums = covariance_sums(matching_at(own_.max_correspondence_m), at.X, at.matches, kBlock_leaves * own_.leaf_m);
    at.sums->N *= kTiltsAlike;
  }
  return *at.sums;
}

/// Without a prior there is nothing to go by; its search runs from where it began.
Pose Aligner::held(const OpenDirections& open, const Pose& X) const {
  return held_law_ && !open.empty() ? open.held_at(X_prior_, *held_law_, X) : X;
}

/// By the surfaces and with `B`; open directions have kUnconstrainedSigma_m, and the others what those lean by.
RegistrationPrecision Aligner::precision_at(Candidate& at, const Matrix6d& B, const OpenDirections& open) const {
  const CovarianceSums& sums = sums_at(at);
  RegistrationPrecision precision = registration_precision(sums, B);
  if (!precision.covariance.allFinite()) return precision;
  precision.covariance += 4.0 * at.last_step * at.last_step.transpose();
  if (open.empty() || !P_prior_) return precision;
  precision.covariance = open.with_open(precision.covariance, kUnconstrainedSigma_m) +
                         kInflation * open.leaning(sums.block_surfaces, carried(*P_prior_, X_prior_, at.X));
  return precision;
}

/// Finds the open directions where `at` is, takes it to the prior along them, and goes on with the others; again, as
/// what is open shows the better the closer the surfaces are. Where fewer points then find a match, the surfaces do not
/// leave it open: it stays where it was, unsettled. False: nothing is determined.
bool Aligner::keep_open_at_prior(Candidate& at, OpenDirections& open) {
  for (int pass = 0; pass < kMostOpenings; ++pass) {
    const CovarianceSums& sums = sums_at(at);
    if (sums.matched < kFewestPoints) return true;
    const RegistrationPrecision precision = precision_at(at, kInflation * gradient_scatter(sums), open);
    if (!precision.covariance.allFinite() || precision.open.size() >= 6) return false;
    const std::size_t before = open.open().size();
    for (const Vector6d& v : precision.open) open.add(v);
    open.open_wide(precision.covariance, kWidest_m, kWidest_rad);
    if (open.open().size() >= 6) return false;
    if (open.open().size() == before) return true;
    Candidate stays = at;
    open_ = open;
    at.X = held(open, at.X);
    refine(at);
    open_ = OpenDirections(radius_m_);
    if (explains_less(at, stays)) {
      at = std::move(stays);
      at.settled = false;
      return true;
    }
  }
  return true;
}

std::vector<Vector6d> Aligner::restarts(const Candidate& at) {
  // The law of guesses: the prior's, else a tenth of the reach and as much at the cloud's radius.
  Matrix6d law = Matrix6d::Zero();
  const double sigma_m = 0.1 * own_.max_correspondence_m;
  law.diagonal() << Eigen::Vector3d::Constant(sigma_m * sigma_m / (radius_m_ * radius_m_)),
      Eigen::Vector3d::Constant(sigma_m * sigma_m);
  if (P_prior_) law = *P_prior_;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(law);
  std::vector<Vector6d> out;
  for (int k = 0; k < 6; ++k) {
    for (const double side : {-1.0, 1.0}) {
      Candidate again;
      again.X =
          at.X * Pose::exp(side * std::sqrt(6.0 * std::max(0.0, eigen.eigenvalues()[k])) * eigen.eigenvectors().col(k));
      descend({std::max<std::size_t>(1, source_.points.size() / kCoarsePoints),
               std::max(engine_.start_correspondence_m, own_.max_correspondence_m), 20, 5e-3, 5e-4},
              again);
      refine(again);
      out.push_back((at.X.inverse() * again.X).log());
    }
  }
  return out;
}

/// Where the surfaces alone would have it: the solution lies between that and the prior. A prior that pulls is left out
/// and the search goes on without it.
Pose Aligner::by_surfaces(const Candidate& at, const OpenDirections& open) {
  const Vector6d xi = open.closed_part(-at.equations.A.ldlt().solve(at.equations.g));
  const auto n = static_cast<double>(source_.points.size());
  if (static_cast<double>(at.equations.matched) > kWellMatched * n && xi.tail<3>().norm() < kNoPull_m &&
      xi.head<3>().norm() < kNoPull_rad)
    return at.X * Pose::exp(xi);
  const auto prior = std::exchange(P_prior_, std::nullopt);
  open_ = open;
  Candidate alone = at;
  alone.matches.clear();
  const std::size_t stride = std::max<std::size_t>(1, source_.points.size() / kCoarsePoints);
  descend({stride, std::max(engine_.start_correspondence_m, own_.max_correspondence_m), 30, 5e-3, 5e-4}, alone);
  refine(alone);
  P_prior_ = prior;
  open_ = OpenDirections(radius_m_);
  return alone.X;
}

/// What a place leaves unexplained, at a scale at which relief of a facade tells.
std::vector<double> Aligner::unexplained(const Candidate& at) const {
  Matching matching = matching_at(own_.max_correspondence_m);
  matching.width_m = kTelling_leaves * own_.leaf_m;
  return missed_by_point(matching, at.X, at.matches);
}

/// Squared distance from the prior's pose, in its sigma.
double Aligner::from_prior(const Pose& X) const {
  if (!P_prior_) return 0.0;
  const Vector6d xi = (X_prior_.inverse() * X).log();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(*P_prior_);
  double sum = 0;
  for (int k = 0; k < 6; ++k) {
    const double along = eigen.eigenvectors().col(k).dot(xi), variance = eigen.eigenvalues()[k];
    if (variance > kCertainSquared) sum += along * along / variance;
  }
  return sum;
}

/// Whether a leaves so many more points without a match than b that it is no rival: where a cloud shifted by the prior
/// leaves the target it loses some, but not a fifth.
bool Aligner::explains_less(const Candidate& a, const Candidate& b) {
  return static_cast<double>(a.equations.matched) < kAsWellMatched * static_cast<double>(b.equations.matched);
}

/// How much less probable b is than a, as twice the logarithm of the odds: by what they leave unexplained, of which the
/// sigma counts as one of a normal distribution, and by the prior.
double Aligner::odds(const Candidate& a, std::span<const double> missed_a, const Candidate& b,
                     std::span<const double> missed_b) const {
  const double sigma = evidence_against(missed_a, missed_b, source_, kTellingBlock_leaves * own_.leaf_m);
  return sigma * std::abs(sigma) + from_prior(b.X) - from_prior(a.X);
}

void Aligner::judge(const Candidate& best, const RegistrationPrecision& precision, bool ambiguous,
                    RegistrationResult& result) {
  using Status = RegistrationStatus;
  result.status = Status::kConverged;
  if (result.overlap < engine_.least_overlap) {
    result.status = Status::kTooLittleOverlap;
  } else if (beyond_prior(precision, result)) {
    result.status = Status::kBeyondPrior;
  } else if (!best.settled) {
    result.status = Status::kNotConverged;
  } else if (ambiguous) {
    result.status = Status::kAmbiguous;
  }
}

bool Aligner::beyond_prior(const RegistrationPrecision& precision, const RegistrationResult& result) const {
  if (!P_prior_) return false;
  const Vector6d xi = (X_prior_.inverse() * result.surfaces->X_TS).log();
  const Matrix6d sum = carried(*P_prior_, X_prior_, result.surfaces->X_TS) + precision.covariance;
  return !(xi.dot(sum.ldlt().solve(xi)) < chi_square_threshold(kProbability, 6.0));
}

RegistrationResult Aligner::align() {
  RegistrationResult result;
  result.X_TS = X_prior_;
  result.status = RegistrationStatus::kTooFewPoints;
  const auto n = static_cast<std::int64_t>(source_.points.size());
  if (n < kFewestPoints || static_cast<std::int64_t>(target_.size()) < kFewestPoints) return result;
  auto candidates = coarse();
  std::vector<OpenDirections> open(candidates.size(), OpenDirections(radius_m_));
  std::vector<bool> determined(candidates.size(), true);
  std::vector<std::vector<double>> missed(candidates.size());
  std::size_t best = 0;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    refine(candidates[k]);
    if (P_prior_) determined[k] = keep_open_at_prior(candidates[k], open[k]);
    if (candidates.size() == 1 || !determined[k] || candidates[k].matches.size() != static_cast<std::size_t>(n))
      continue;
    missed[k] = unexplained(candidates[k]);
    if (missed[best].empty() || explains_less(candidates[best], candidates[k]) ||
        (!explains_less(candidates[k], candidates[best]) &&
         odds(candidates[best], missed[best], candidates[k], missed[k]) < 0))
      best = k;
  }
  Candidate& at = candidates[best];
  bool ambiguous = false;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const Candidate& other = candidates[k];
    if (k == best || missed[k].empty() || missed[best].empty() || explains_less(other, at)) continue;
    if (!apart(open[best].closed_part((at.X.inverse() * other.X).log()))) continue;
    ambiguous |= odds(at, missed[best], other, missed[k]) < kDecided;
  }
  result.iterations = rounds_;
  result.correspondences = matched_;
  result.overlap = static_cast<double>(at.equations.matched) / static_cast<double>(n);
  if (at.equations.matched < kFewestPoints) {
    result.status = RegistrationStatus::kTooLittleOverlap;
    return result;
  }
  const CovarianceSums& sums = sums_at(at);
  const auto& form = model_row(covariance_forms(), engine_.covariance).make;
  const auto guesses = form.restarts ? restarts(at) : std::vector<Vector6d>();
  const RegistrationPrecision precision =
      precision_at(at, form.gradient({sums, engine_.point_sigma_m, engine_.range_bias_m, guesses}), open[best]);
  result.status = RegistrationStatus::kDegenerate;
  if (!determined[best] || !precision.covariance.allFinite() || precision.open.size() >= 6) return result;
  result.X_TS = at.X;
  result.open = P_prior_ ? open[best].open() : precision.open;
  result.rms_m = precision.rms_m;
  result.covariance = precision.covariance;
  if (P_prior_) result.surfaces = {.X_TS = by_surfaces(at, open[best]), .covariance = precision.covariance};
  judge(at, precision, ambiguous, result);
  if (P_prior_) {
    // Together: along open directions the prior's, in the others what both know.
    const Matrix6d P = carried(*P_prior_, X_prior_, at.X);
    const Matrix6d K =
        (P + precision.covariance).transpose().partialPivLu().solve(precision.covariance.transpose()).transpose();
    const Matrix6d left = Matrix6d::Identity() - K;
    const Matrix6d both = left * precision.covariance * left.transpose() + K * P * K.transpose();
    result.covariance = without_negative(both);
  }
  if (!result.covariance.allFinite()) {
    result.X_TS = X_prior_;
    result.covariance.setConstant(kNaN);
    result.surfaces.reset();
    result.status = RegistrationStatus::kDegenerate;
  }
  return result;
}

}  // namespace canyon::lidar
