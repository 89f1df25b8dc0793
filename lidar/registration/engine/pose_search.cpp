#include "canyon/lidar/registration/engine/pose_search.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "canyon/core/math/chi_square.h"
#include "canyon/core/units.h"
#include "canyon/lidar/voxels/voxel_index.h"

namespace canyon::lidar {
namespace {

constexpr double kSettled_m = 2e-4;
constexpr double kSettled_rad = 2e-5;
constexpr double kCoarse_m = 5e-3;
constexpr double kCoarse_rad = 5e-4;
// Matches that change to and fro keep a solution moving; the step that is left then counts as an error, up to half of
// what a closed direction may have, nearly.
constexpr double kNearly_m = 0.03;
constexpr double kNearly_rad = 1.5e-3;
constexpr double kUndamped = 1e-7;
constexpr std::size_t kCoarsePoints = 1000;  // of which the coarse rounds make do
constexpr double kShrinking = 0.6;           // of the reach, from round to round
constexpr double kWorse = 1.01;              // a round that raises the cost by more is taken back
constexpr double kFarthest_m = 1e8;          // farther than two clouds of 2^20 voxels can be apart
// A start finds the right place from about this far. ASSUMPTION, not measured.
constexpr double kBasin_m = 1.5;
constexpr double kBasin_rad = 8.0 * kDegree;
constexpr int kMostStarts = 1200;
constexpr std::size_t kRefined = 6;
constexpr double kCoarsePieces = 100.0;  // of the cloud, that speak for themselves, against the prior
constexpr double kScan_reaches = 0.5;    // a step of a scan: a place is then within a quarter of the reach of one
constexpr int kMostScanned = 500;        // either way
constexpr double kAlternative = 1e-3;    // a start that the prior has beyond its ellipsoid of so much is left out
// Another minimum counts as another place from here on.
constexpr double kApart_m = 0.3;
constexpr double kApart_rad = 1.5 * kDegree;

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

}  // namespace

bool are_apart(const Vector6d& xi) {
  return xi.tail<3>().norm() > kApart_m || xi.head<3>().norm() > kApart_rad;
}

PoseSearch::PoseSearch(const PreparedCloud& source, const SurfaceTarget& target, MatchForm* form,
                       const MatchingParameters& matching, const EngineParameters& engine, const PosePrior& prior)
    : source_(source),
      target_(target),
      form_(form),
      kernel_(model_row(robust_kernels(), engine.kernel).make),
      own_(matching),
      engine_(engine),
      guess_(prior.X_TS),
      prior_(PriorLaw::of(prior)),
      radius_m_(rms_radius(source)) {
  if (prior_) blocks_ = count_blocks(source, block_m(matching.leaf_m));
}

Matching PoseSearch::matching_at(double reach_m) const {
  const double width_m = engine_.kernel_width_m * reach_m / own_.max_correspondence_m;
  return {
      .source = &source_, .target = &target_, .form = form_, .kernel = kernel_, .reach_m = reach_m, .width_m = width_m};
}

/// The minimum of  xi^T A xi / 2 + g^T xi  plus the prior's part, in which a covariance without inverse is as good as
/// any:  (P A / k + 1) xi = -(P g / k + xi_0),  P carried to X, k = what one piece of independent knowledge weighs.
/// Open directions stay where they are.
Vector6d PoseSearch::step(const NormalEquations& e, const Pose& X, double damping, const Held& how) const {
  Matrix6d A = e.A;
  Vector6d scale;
  scale << Eigen::Vector3d::Constant(radius_m_ * radius_m_), Eigen::Vector3d::Ones();
  A.diagonal() += damping * (A.trace() / (scale.sum()) * scale);
  const auto n = static_cast<double>(e.matched);
  const double s2 = std::max(e.cost / std::max(e.weight, 1e-12), 1e-6 / kAcrossScale);
  const bool asks_prior = prior_ && !how.surfaces_alone;
  const double k = asks_prior ? std::max(1.0, s2 * n / static_cast<double>(blocks_)) : 1.0;
  const Vector6d xi_0 = asks_prior ? prior_->off(X) : Vector6d(Vector6d::Zero());
  const Matrix6d P_here = asks_prior ? prior_->covariance_at(X) : Matrix6d(Matrix6d::Zero());
  if (how.open == nullptr || how.open->empty()) {
    if (!asks_prior) return -A.ldlt().solve(e.g);
    const Matrix6d left = P_here * A / k + Matrix6d::Identity();
    return -left.partialPivLu().solve(P_here * e.g / k + xi_0);
  }
  // In coordinates of the directions at right angles to the open ones.
  const Eigen::MatrixXd C = how.open->closed_basis(), dual = how.open->closed_dual();
  if (C.cols() == 0) return Vector6d::Zero();
  const Eigen::MatrixXd closed = C.transpose() * A * C;
  if (!asks_prior) return -C * closed.ldlt().solve(C.transpose() * e.g);
  const Eigen::MatrixXd P = dual * P_here * dual.transpose();
  const Eigen::MatrixXd left = P * closed / k + Eigen::MatrixXd::Identity(C.cols(), C.cols());
  return -C * left.partialPivLu().solve(P * (C.transpose() * e.g) / k + dual * xi_0);
}

void PoseSearch::settle_nearly(const NormalEquations& equations, const Pose& X, FoundPose& at, const Held& how) const {
  const Vector6d left = step(equations, X, kUndamped, how);
  at.settled = left.tail<3>().norm() < kNearly_m && left.head<3>().norm() < kNearly_rad;
  if (at.settled) at.last_step = left;
}

void PoseSearch::descend(const Stage& stage, FoundPose& at, const Held& how) {
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
    const Vector6d xi = step(at.equations, at.X, damping, how);
    const Pose moved = at.X * Pose::exp(xi);
    if (!xi.allFinite() || !(moved.matrix().array().abs() < kFarthest_m).all()) return;
    before_X = at.X;
    before = at.equations;
    at.X = moved;
    // What the others do moves what the prior says of the open ones.
    if (how.open != nullptr) at.X = held(*how.open, at.X);
    const bool last_reach = reach_m <= own_.max_correspondence_m;
    compare = last_reach;
    if (last_reach && xi.tail<3>().norm() < stage.settled_m && xi.head<3>().norm() < stage.settled_rad) {
      // A step that damping alone makes small says nothing of how far it is.
      if (damping < 1e-2)
        at.settled = true;
      else
        settle_nearly(before, before_X, at, how);
      return;
    }
    if (round + 1 == stage.rounds && last_reach) settle_nearly(before, before_X, at, how);
    reach_m = std::max(own_.max_correspondence_m, kShrinking * reach_m);
  }
}

/// The prior's pose, and places around it in the plane and about the vertical, a basin apart, as far as 3 sigma.
std::vector<Pose> PoseSearch::starts() const {
  std::vector<Pose> out{guess_};
  if (!prior_) return out;
  const Matrix6d& P = prior_->covariance();
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
        out.push_back(guess_ * Pose{so3_exp(xi.head<3>()), xi.tail<3>()});
      }
    }
  }
  return out;
}

std::vector<FoundPose> PoseSearch::coarse() {
  const std::size_t stride = coarse_stride();
  const auto places = starts();
  several_ = places.size() > 1;
  const std::size_t first = places.size() > 8 ? 4 * stride : stride;
  const double reach_m = first_reach_m();
  std::vector<FoundPose> found;
  for (const Pose& X : places) {
    FoundPose at;
    at.X = X;
    descend({first, reach_m, first == stride ? 30 : 12, kCoarse_m, kCoarse_rad}, at, {});
    found.push_back(std::move(at));
  }
  if (found.size() == 1) return found;
  std::vector<std::size_t> order(found.size());
  const auto sort = [this, &order](const std::vector<FoundPose>& of) {
    std::vector<double> costs;
    for (const FoundPose& at : of) costs.push_back(kCoarsePieces * at.missed + improbable(at.X));
    order.resize(of.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return costs[a] < costs[b]; });
  };
  const auto known = [](const std::vector<FoundPose>& among, const Pose& X) {
    return std::any_of(among.begin(), among.end(),
                       [&](const FoundPose& k) { return !are_apart((k.X.inverse() * X).log()); });
  };
  const double farthest = chi_square_threshold(kAlternative, 6.0);
  sort(found);
  std::vector<FoundPose> kept;
  for (const std::size_t k : order) {
    if (kept.size() == 3 * kRefined) break;
    if (!kept.empty() && (improbable(found[k].X) > farthest || known(kept, found[k].X))) continue;
    kept.push_back(std::move(found[k]));
  }
  for (FoundPose& at : kept) {
    at.matches.clear();
    descend({stride, own_.max_correspondence_m, 15, kCoarse_m, kCoarse_rad}, at, {});
  }
  sort(kept);
  std::vector<FoundPose> best;
  for (const std::size_t k : order) {
    if (best.size() == kRefined) break;
    if (!known(best, kept[k].X)) best.push_back(std::move(kept[k]));
  }
  return best;
}

std::vector<FoundPose> PoseSearch::along(const Pose& X, const Vector6d& way) {
  struct Fit {
    int steps;
    double missed;
  };
  const double step_m = kScan_reaches * own_.max_correspondence_m, farthest = chi_square_threshold(kAlternative, 6.0);
  const auto moved = [&](int steps) {
    return X * Pose{Eigen::Quaterniond::Identity(), steps * step_m * way.tail<3>()};
  };
  const auto missed_at = [&](int steps) {
    std::vector<LastMatch> matches;
    const auto e = normal_equations(matching_at(own_.max_correspondence_m), moved(steps), coarse_stride(), matches);
    ++rounds_;
    matched_ += e.matched;
    return e.missed;
  };
  int from = 0, to = 0;
  while (-from < kMostScanned && !(improbable(moved(from - 1)) > farthest)) --from;
  while (to < kMostScanned && !(improbable(moved(to + 1)) > farthest)) ++to;
  // A step farther than the prior reaches, so that its last places have a neighbour on either side as well: a minimum
  // near one of them is within its ellipsoid, and may be a rival. A place beyond the last step that still is in the
  // ellipsoid, by up to a step, is passed over where the step outside of it fits better.
  std::vector<Fit> line, minima;
  for (int k = from - 1; k <= to + 1; ++k) line.push_back({k, missed_at(k)});
  for (std::size_t k = 1; k + 1 < line.size(); ++k) {
    if (line[k].missed < line[k - 1].missed && line[k].missed <= line[k + 1].missed && std::abs(line[k].steps) > 1)
      minima.push_back(line[k]);
  }
  std::stable_sort(minima.begin(), minima.end(), [](const Fit& a, const Fit& b) { return a.missed < b.missed; });
  minima.resize(std::min(minima.size(), kRefined));
  std::vector<FoundPose> out(minima.size());
  for (std::size_t k = 0; k < minima.size(); ++k) {
    out[k].X = moved(minima[k].steps);
    descend({coarse_stride(), own_.max_correspondence_m, 15, kCoarse_m, kCoarse_rad}, out[k], {});
  }
  return out;
}

void PoseSearch::refine(FoundPose& at, const Held& how) {
  descend({1, own_.max_correspondence_m, own_.max_iterations, kSettled_m, kSettled_rad}, at, how);
}

void PoseSearch::anew(FoundPose& at, int rounds, const Held& how) {
  at.matches.clear();
  descend({coarse_stride(), first_reach_m(), rounds, kCoarse_m, kCoarse_rad}, at, how);
  refine(at, how);
}

Pose PoseSearch::held(const OpenDirections& open, const Pose& X) const {
  return prior_ && !open.empty() ? open.held_at(*prior_, X) : X;
}

std::size_t PoseSearch::coarse_stride() const {
  return std::max<std::size_t>(1, source_.points.size() / kCoarsePoints);
}

double PoseSearch::first_reach_m() const {
  return std::max(engine_.start_correspondence_m, own_.max_correspondence_m);
}

}  // namespace canyon::lidar
