// From where a registration begins to look: around the prior's pose, a basin apart, as far as the prior reaches.
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>

#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/lidar/registration/engine/match_form.h"
#include "canyon/lidar/registration/engine/pose_search.h"
#include "canyon/lidar/registration/engine/surface_target.h"
#include "canyon/lidar/stress/engine_pieces.h"
#include "canyon/lidar/stress/search/subjects.h"

namespace canyon::lidar {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using stress::Looks;

/// What a search says of its starts where nothing is within its reach: each of them ends after one round, where it was.
/// Those that are looked at once more, the 18 most probable, have a round more, and the best six are handed out.
struct Begun {
  int rounds = 0;
  std::vector<FoundPose> best;
};
Begun begun(const PosePrior& prior) {
  const auto source = made::drawn_cloud(3, 60, 5.0);
  auto far = std::make_shared<PreparedCloud>(*made::drawn_cloud(4, 60, 5.0));
  for (Eigen::Vector3f& p : far->points) p.x() += 50000.0f;
  far->tree = std::make_shared<LeafTree>(far->points);
  const auto target = point_target(far);
  const MatchingParameters matching;
  const EngineParameters engine;
  PoseSearch search(*source, *target, plane_to_plane, matching, engine, prior);
  Begun out;
  out.best = search.coarse();
  out.rounds = search.rounds();
  return out;
}

/// Steps to either side of the prior's pose. A basin reaches 1.5 m, or 8 degrees, and starts are a third more than
/// that apart; so s steps cover 3 sigma up to a quarter of a basin if 0.75 (3 sigma / basin - 0.75) is no more than s.
int steps_for(double sigma, double basin) {
  const double needed = 0.75 * (3.0 * sigma / basin - 0.75);
  int s = 0;
  while (s < needed && s < 1000) ++s;
  return s;
}

/// Starts by a prior with these sigmas, in the plane along its own axes: all of the lattice within the ellipsoid whose
/// square is 14, the lattice coarser by a fifth at a time until it has 1200 places. Counted, and the best six are the
/// most probable of them.
StressFigure starts_of(double sigma_a_m, double sigma_b_m, double yaw_rad, double axis_rad, int written_out) {
  Looks looks;
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(axis_rad).toRotationMatrix();
  PosePrior prior;
  prior.X_TS = Pose::exp((Vector6d() << 0.02, -0.01, 0.7, 30.0, -20.0, 1.0).finished());
  prior.covariance = Matrix6d::Zero();
  prior.covariance(0, 0) = prior.covariance(1, 1) = 1e-6, prior.covariance(5, 5) = 1e-4;
  prior.covariance(2, 2) = yaw_rad * yaw_rad;
  prior.covariance.block<2, 2>(3, 3) =
      R * Vector2d(sigma_a_m * sigma_a_m, sigma_b_m * sigma_b_m).asDiagonal() * R.transpose();
  const double basin_rad = 8.0 * kDegree;
  double coarser = 1.0;
  int a = 0, b = 0, c = 0;
  for (;; coarser *= 1.2) {
    a = steps_for(sigma_a_m / coarser, 1.5), b = steps_for(sigma_b_m / coarser, 1.5);
    c = steps_for(yaw_rad / coarser, basin_rad);
    if ((2.0 * a + 1.0) * (2.0 * b + 1.0) * (2.0 * c + 1.0) <= 1200.0) break;
  }
  const double step_m = 1.33 * 1.5 * coarser, step_rad = 1.33 * basin_rad * coarser;
  int count = 0;
  for (int i = -a; i <= a; ++i)
    for (int j = -b; j <= b; ++j)
      for (int k = -c; k <= c; ++k) {
        double square = 0.0;
        if (i != 0) square += std::pow(i * step_m / sigma_a_m, 2);
        if (j != 0) square += std::pow(j * step_m / sigma_b_m, 2);
        if (k != 0) square += std::pow(k * step_rad / yaw_rad, 2);
        count += square <= 14.0 ? 1 : 0;
      }
  looks.near(count, written_out, 0.5);
  const Begun found = begun(prior);
  const int again = count == 1 ? 0 : count < 18 ? count : 18;
  looks.near(found.rounds, count + again, 0.5);
  looks.right(found.best.size() == static_cast<std::size_t>(count < 6 ? count : 6));
  // Each is one of the lattice; the first is the prior's own, and none is less probable than one that follows.
  double before = 0.0;
  for (std::size_t n = 0; n < found.best.size(); ++n) {
    const Pose off = prior.X_TS.inverse() * found.best[n].X;
    const Vector3d turn = so3_log(off.R);
    const Vector2d along = R.transpose() * off.p.head<2>() / step_m;
    const double yaw = turn.z() / step_rad;
    for (const double x : {along.x(), along.y(), yaw}) looks.near(x - std::round(x), 0.0, 1e-9);
    looks.near(turn.head<2>().norm() + std::abs(off.p.z()), 0.0, 1e-12);
    if (n == 0) looks.near(off.p.norm() + turn.norm(), 0.0, 1e-12);
    const Vector6d xi = off.log();
    double square = 0.0;
    for (const auto& [x, sigma] : {std::pair(R.col(0).dot(xi.segment<2>(3)), sigma_a_m),
                                   std::pair(R.col(1).dot(xi.segment<2>(3)), sigma_b_m), std::pair(xi[2], yaw_rad)})
      if (std::abs(x) > 1e-9) square += x * x / (sigma * sigma);
    looks.right(square >= before - 1e-6);
    before = square;
    looks.right(n == 0 || (square > 0.0 && square < 22.5));
  }
  return looks.figure();
}

/// Without a covariance there is one start, the pose itself.
StressFigure start_without_prior() {
  PosePrior prior;
  prior.X_TS = Pose::exp((Vector6d() << 0.02, -0.01, 0.7, 30.0, -20.0, 1.0).finished());
  const Begun found = begun(prior);
  Looks looks;
  looks.right(found.rounds == 1 && found.best.size() == 1);
  if (!found.best.empty()) looks.near((prior.X_TS.inverse() * found.best[0].X).log().norm(), 0.0, 1e-12);
  // What counts as another place: 0.3 m or 1.5 degrees away.
  const auto apart = [](double rad, double m) {
    return are_apart((Vector6d() << 0.0, rad * 0.6, rad * 0.8, m * 0.8, 0.0, -m * 0.6).finished());
  };
  looks.right(apart(0.0, 0.301) && !apart(0.0, 0.299) && apart(1.51 * kDegree, 0.0) && !apart(1.49 * kDegree, 0.299));
  return looks.figure();
}

}  // namespace

std::vector<StressCase> search_start_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kData,
           .mechanism = "from where a registration begins to look",
           .why = "one axis of the prior for the other, a reach of one sigma, a lattice that is never coarser",
           .expected = "the lattice place by place, and how many there are, written out: exact",
           .unit = "of the bound",
           .loose = "counts are exact, and so are most places"});
  const struct {
    const char* name;
    double a_m, b_m, yaw_rad, axis_rad;
    int count;
  } priors[] = {{"tight", 0.2, 0.1, 0.02, 0.3, 1},     {"along_one_axis", 3.0, 0.3, 0.02, 0.3, 9},
                {"across_it", 0.3, 2.0, 0.02, 1.1, 7}, {"round", 1.2, 1.2, 0.02, 0.0, 21},
                {"turned", 0.2, 0.2, 0.4, 0.0, 13},    {"all_three", 1.5, 0.9, 0.15, 0.5, 67},
                {"wide", 20.0, 12.0, 1.0, 0.8, 485}};
  for (const auto& p : priors)
    rows.add(std::string("search_starts/") + p.name,
             [p] { return starts_of(p.a_m, p.b_m, p.yaw_rad, p.axis_rad, p.count); });
  rows.add("search_starts/without_a_prior", start_without_prior);
  return rows.take();
}

}  // namespace canyon::lidar
