// Who is registered against whom: pairs of clouds in large coordinates, and loops that are closed.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "canyon/core/files/pcd.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/lidar/loops/loop_closures.h"
#include "canyon/lidar/registration/cloud_pair.h"
#include "canyon/lidar/registration/prepared_cloud.h"
#include "canyon/lidar/registration/registration.h"
#include "canyon/lidar/stress/engine_pieces.h"
#include "canyon/lidar/stress/subjects.h"

namespace canyon::lidar {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using made::alike;
using made::drawn_positive;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Looks;

/// In the place of a method: it moves whatever it is asked of by one xi.
class Answers final : public Registration {
 public:
  std::shared_ptr<const PreparedCloud> prepare(std::span<const Vector3f> points) const override {
    auto cloud = std::make_shared<PreparedCloud>();
    cloud->points.assign(points.begin(), points.end());
    return cloud;
  }
  RegistrationResult align(const PreparedCloud&, std::span<const Placed> targets, const Pose& guess) const override {
    RegistrationResult r;
    r.status = RegistrationStatus::kConverged;
    r.X_TS = guess * Pose::exp((Vector6d() << 0.01, 0.0, 0.02, 0.1, -0.2, 0.3).finished());
    r.overlap = 0.4 + 0.1 * static_cast<double>(targets.size());
    return r;
  }
  RegistrationResult align_with_prior(const PreparedCloud& source, std::span<const Placed> targets,
                                      const PosePrior& prior) const override {
    RegistrationResult r = align(source, targets, prior.X_TS);
    r.covariance = 0.25 * prior.covariance;
    r.open.push_back(Vector6d::Unit(3));
    if (source.points.size() > 50) return r;
    r.covariance = prior.covariance;
    return r;
  }
};

/// A pair of clouds in large coordinates: the same as about their own middles, the prior's covariance said there, the
/// result's carried to where the source's own origin lies by the adjoint of the shift. Loops: who is held against whom,
/// with priors of both.
StressFigure pairs_and_loops() {
  Looks looks;
  const Answers method;
  CloudPlaces source, target;
  const Vector3d far(4e5, -3e5, 100.0);
  for (int k = 0; k < 101; ++k) {
    source.points.push_back(far + Vector3d(0.1 * k, std::sin(1.0 * k), 0.0));
    target.points.push_back(Vector3d(0.1 * k, std::cos(1.0 * k), 0.0));
  }
  PosePrior prior;
  prior.X_TS = Pose{rotation_from({.yaw_rad = 0.6, .pitch_rad = 0.02, .roll_rad = 0.01}), {10.0, 20.0, 3.0}};
  prior.covariance = drawn_positive(40);
  const CloudPair pair = register_pair(method, source, target, prior);
  // The stand-in moves by a fixed xi about the source's middle, the median in whole metres.
  const Pose middle{Eigen::Quaterniond::Identity(), {std::round(far.x() + 5.0), std::round(far.y()), 100.0}};
  const Pose expected =
      prior.X_TS * middle * Pose::exp((Vector6d() << 0.01, 0.0, 0.02, 0.1, -0.2, 0.3).finished()) * middle.inverse();
  looks.near((pair.result.X_TS.p - expected.p).norm(), 0.0, 64.0 * kEpsilon * 5e5);
  looks.near(pair.result.X_TS.R.angularDistance(expected.R), 0.0, 1e-7);
  // A quarter of the prior, seen from the source's origin: a turn there moves the middle, too.
  Matrix6d seen = Matrix6d::Identity();
  std::vector<double> across;
  for (const Vector3d& p : source.points) across.push_back(p.y());
  std::sort(across.begin(), across.end());
  seen.bottomLeftCorner<3, 3>() = skew({far.x() + 5.0, across[50], far.z()});
  alike(looks, pair.result.covariance, Matrix6d(0.25 * seen * prior.covariance * seen.transpose()), 64.0 * kEpsilon);
  looks.right(pair.source_points == 101 && pair.target_points == 101);

  std::vector<MappedCloud> frames;
  auto cloud = std::make_shared<PreparedCloud>();
  cloud->points.resize(3);
  for (int k = 0; k < 60; ++k) {
    // Two rounds of a circle of 20 m, 125.7 m each.
    const double a = 2.0 * kPi * k / 30.0;
    frames.push_back({cloud,
                      {rotation_from({.yaw_rad = a, .pitch_rad = 0.0, .roll_rad = 0.0}),
                       {20.0 * std::cos(a), 20.0 * std::sin(a), 0.01 * k}},
                      drawn_positive(50 + static_cast<std::uint64_t>(k))});
  }
  ClosureOptions options;
  options.within_m = 3.0;
  const auto trials = find_closures(method, frames, options);
  std::vector<double> way{0.0};
  for (std::size_t k = 1; k < 60; ++k) way.push_back(way.back() + (frames[k].X_WL.p - frames[k - 1].X_WL.p).norm());
  std::size_t i = 0;
  double last = -kInfinity;
  for (std::size_t k = 0; k < 60; ++k) {
    if (way[k] - last < options.apart_m) continue;
    double nearest = options.within_m;
    std::size_t at = 60;
    for (std::size_t j = 0; j < k; ++j) {
      const double apart = (frames[k].X_WL.p - frames[j].X_WL.p).norm();
      if (way[k] - way[j] >= options.least_way_m && apart <= nearest) nearest = apart, at = j;
    }
    if (at == 60) continue;
    last = way[k];
    if (i >= trials.size()) return {kInfinity, 1.0};
    const ClosureTrial& t = trials[i++];
    looks.right(t.source == k && t.target == at && t.status == RegistrationStatus::kConverged);
    const std::size_t targets = std::min(at + 4, k) - (at < 3 ? 0 : at - 3);
    looks.near(t.overlap, 0.4 + 0.1 * static_cast<double>(targets), 1e-12);
    looks.right(t.closes && t.open == 1);
    const Pose guess = frames[at].X_WL.inverse() * frames[k].X_WL;
    const Pose moved = guess * Pose::exp((Vector6d() << 0.01, 0.0, 0.02, 0.1, -0.2, 0.3).finished());
    looks.near((t.X_TS.p - moved.p).norm(), 0.0, 1e-12);
    // Both covariances in the source's frame: Ad of the way from target to source; and the floors.
    Matrix6d ad = Matrix6d::Zero();
    const Pose to = guess.inverse();
    ad.topLeftCorner<3, 3>() = ad.bottomRightCorner<3, 3>() = to.R.toRotationMatrix();
    ad.bottomLeftCorner<3, 3>() = skew(to.p) * to.R.toRotationMatrix();
    Matrix6d P = frames[k].covariance + ad * frames[at].covariance * ad.transpose();
    const double turn = 0.05 * kPi / 180.0;
    for (int d = 0; d < 3; ++d) P(d, d) += turn * turn, P(d + 3, d + 3) += 0.02 * 0.02;
    alike(looks, t.covariance, P, 1e-12);
  }
  looks.right(i == trials.size() && i > 5);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> closure_cases() {
  StressRows rows;
  rows.of(made::said_of_a_pose());
  rows.add("closures/pairs_and_loops", pairs_and_loops);
  return rows.take();
}

}  // namespace canyon::lidar
