// A mapper that is told what each alignment says: what it makes of it with the filter's pose, by the formulas that
// mapper.h states, written out.
#include "canyon/mission/mapping/mapper.h"

#include <cmath>
#include <string>
#include <vector>

#include <Eigen/LU>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/lidar/registration/prepared_cloud.h"
#include "canyon/mission/stress/subjects.h"

namespace canyon::mission {
namespace {

using Eigen::Vector3d;
using stress::kInfinity;
using stress::Looks;

/// Answers that the case has laid out, and what was asked.
struct Told {
  lidar::RegistrationResult answer;
  Pose off;  ///< the answer's pose is the guess times this
  lidar::PosePrior asked;
  std::vector<Pose> targets;
};

class ToldRegistration final : public lidar::Registration {
 public:
  explicit ToldRegistration(Told& told) : told_(told) {}
  std::shared_ptr<const lidar::PreparedCloud> prepare(std::span<const Eigen::Vector3f>) const override {
    return std::make_shared<lidar::PreparedCloud>();
  }
  lidar::RegistrationResult align(const lidar::PreparedCloud&, std::span<const Placed> targets,
                                  const Pose& guess) const override {
    told_.targets.clear();
    for (const Placed& t : targets) told_.targets.push_back(t.X_TC);
    lidar::RegistrationResult r = told_.answer;
    r.X_TS = guess * told_.off;
    if (r.surfaces) r.surfaces->X_TS = guess * told_.off * Pose::exp(Vector6d::Constant(2e-3));
    return r;
  }
  lidar::RegistrationResult align_with_prior(const lidar::PreparedCloud& source, std::span<const Placed> targets,
                                             const lidar::PosePrior& prior) const override {
    told_.asked = prior;
    return align(source, targets, prior.X_TS);
  }

 private:
  Told& told_;
};

Matrix6d spread_of(std::uint64_t number, double turn_rad, double move_m) {
  const RandomStream draws(number, "stress.mapping");
  Matrix6d A;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      A(i, j) =
          (i < 3 ? turn_rad : move_m) * draws.normal(static_cast<std::uint32_t>(i), static_cast<std::uint64_t>(j));
  return A * A.transpose() + 1e-8 * Matrix6d::Identity();
}

/// Ad of a pose, [rotation; translation].
Matrix6d carried_by(const Pose& X) {
  Matrix6d out = Matrix6d::Zero();
  const Eigen::Matrix3d R = X.R.toRotationMatrix();
  out.topLeftCorner<3, 3>() = out.bottomRightCorner<3, 3>() = R;
  out.bottomLeftCorner<3, 3>() = skew(X.p) * R;
  return out;
}
Matrix6d in_frame(const Matrix6d& P, const Pose& X) {
  return carried_by(X.inverse()) * P * carried_by(X.inverse()).transpose();
}
Matrix6d floors(double turn_deg, double move_m) {
  Matrix6d P = Matrix6d::Zero();
  const double turn = turn_deg * kPi / 180.0;
  for (int i = 0; i < 3; ++i) P(i, i) = turn * turn, P(i + 3, i + 3) = move_m * move_m;
  return P;
}
/// The information of both, at the weighted mean of their difference.
lidar::PosePrior both_of(const lidar::PosePrior& x, const lidar::PosePrior& y) {
  const Matrix6d K = x.covariance * (x.covariance + y.covariance).inverse();
  const Vector6d xi = (x.X_TS.inverse() * y.X_TS).log();
  return {x.X_TS * Pose::exp(K * xi), (x.covariance.inverse() + y.covariance.inverse()).inverse()};
}

/// Keyframes of a drive, each by its formula: predicted motion in L with its floor, an alignment with its own, weighed
/// where it converged, the filter's pose with a covariance enlarged for what lasts. Conditioning of 6 x 6 matrices:
/// 1e-8 of what they are.
StressFigure keyframes(const std::string& kind) {
  Looks looks;
  lidar::RegistrationConfig config;
  config.method.name = "gicp";
  config.submap_keyframes = 3;
  Told told;
  told.answer.status =
      kind == "failed" ? lidar::RegistrationStatus::kNotConverged : lidar::RegistrationStatus::kConverged;
  told.answer.covariance = spread_of(1, 1e-3, 0.01);
  told.answer.iterations = 7, told.answer.correspondences = 100, told.answer.rms_m = 0.03, told.answer.overlap = 0.8;
  if (kind == "surfaces") {
    told.answer.surfaces = lidar::RegistrationResult::Surfaces{{}, spread_of(2, 2e-3, 0.02)};
    told.answer.open.assign(2, Vector6d::Unit(0));
  }
  told.off = Pose::exp((Vector6d() << 1e-3, -2e-3, 3e-3, 0.02, -0.01, 0.03).finished());
  const Pose X_BL{rotation_from({.yaw_rad = 0.2, .pitch_rad = 0.1, .roll_rad = -0.05}), {0.4, -0.1, 1.7}};
  Mapper mapper(config, std::make_unique<ToldRegistration>(told), X_BL);
  const GpsTime start = GpsTime::from_week_sow(1600, 10.0);
  Pose before_prior, before_registered;
  Matrix6d before_P = Matrix6d::Zero();
  std::vector<Pose> kept;
  double t_before = 0.0;
  for (int k = 0; k < 8; ++k) {
    const double t_s = 0.7 * k + 0.1 * (k % 3);
    const Pose X_WB{rotation_from({.yaw_rad = 0.15 * k, .pitch_rad = 0.02, .roll_rad = 0.01}),
                    {2.4 * k, 0.3 * k, 0.05 * k}};
    NavEstimate estimate;
    estimate.t = start + t_s;
    estimate.X_WB = X_WB;
    estimate.pose_covariance = spread_of(10 + static_cast<std::uint64_t>(k), 5e-3, 0.2);
    LidarScan scan;
    scan.t = estimate.t;
    scan.points.resize(5);
    const Pose moved = before_prior.inverse() * (X_WB * X_BL) * Pose::exp(Vector6d::Constant(1e-3));
    const RelativePose motion{scan.t, scan.t, X_BL * moved * X_BL.inverse(), spread_of(30, 2e-3, 0.03)};
    const Keyframe* found = mapper.offer(scan, estimate, motion);
    if (found == nullptr) return {kInfinity, 1.0};
    const Pose prior = X_WB * X_BL;
    const Matrix6d P_prior = in_frame(estimate.pose_covariance, X_BL);
    const auto alike = [&](const Pose& a, const Pose& b, double bound) {
      looks.near((a.p - b.p).norm(), 0.0, bound);
      looks.near((a.R.toRotationMatrix() - b.R.toRotationMatrix()).norm(), 0.0, bound);
    };
    const auto same = [&](const Matrix6d& a, const Matrix6d& b) { looks.near((a - b).norm() / b.norm(), 0.0, 1e-9); };
    alike(found->X_WL_prior, prior, 1e-13);
    same(found->prior_covariance, P_prior);
    looks.right(found->points == 5 && found->t == scan.t);
    Pose registered = prior, driven;
    Matrix6d P = P_prior;
    if (k > 0) {
      const double elapsed = t_s - t_before;
      const lidar::PosePrior predicted{
          moved, in_frame(motion.covariance, X_BL) +
                     floors(config.motion_floor_deg_s * elapsed, config.motion_floor_m_s * elapsed)};
      alike(told.asked.X_TS, predicted.X_TS, 1e-12);
      same(told.asked.covariance, predicted.covariance);
      looks.right(told.targets.size() == std::min<std::size_t>(3, kept.size()));
      for (std::size_t i = 0; i < told.targets.size(); ++i)
        alike(told.targets[i], kept.back().inverse() * kept[kept.size() - told.targets.size() + i], 1e-9);
      lidar::PosePrior by = predicted;
      looks.right(found->aligned.has_value() == (kind != "failed") && found->iterations == 7 && found->overlap == 0.8);
      looks.right(found->alone.has_value() == (kind != "failed"));
      if (kind != "failed") {
        const Matrix6d floor = floors(config.alignment_floor_deg, config.alignment_floor_m);
        const lidar::PosePrior alone = kind == "surfaces"
                                           ? lidar::PosePrior{moved * told.off * Pose::exp(Vector6d::Constant(2e-3)),
                                                              told.answer.surfaces->covariance + floor}
                                           : lidar::PosePrior{moved * told.off, told.answer.covariance + floor};
        by = kind == "surfaces" ? both_of(predicted, alone) : alone;
        alike(found->aligned->X_TS, X_BL * alone.X_TS * X_BL.inverse(), 1e-12);
        same(found->aligned->covariance, in_frame(alone.covariance, X_BL.inverse()));
        alike(found->alone->X_TS, alone.X_TS, 1e-12);
        same(found->alone->covariance, alone.covariance);
        looks.right((kind == "surfaces") == found->open.has_value() &&
                    (!found->open || *found->open == told.answer.open));
      }
      alike(found->placed->X_TS, by.X_TS, 1e-9);
      same(found->placed->covariance, by.covariance);
      const lidar::PosePrior carried{before_registered * by.X_TS, in_frame(before_P, by.X_TS) + by.covariance};
      const double lasts = config.prior_correlation_s / elapsed;
      const lidar::PosePrior fused = both_of(carried, {prior, (lasts > 1.0 ? lasts : 1.0) * P_prior});
      registered = fused.X_TS, P = fused.covariance;
      driven = kept.back() * by.X_TS;  // the submap hangs together as it was driven, whatever moves it in W
      if (kind == "failed") kept.clear();
    }
    alike(found->X_WL_registered, registered, 1e-9);
    same(found->covariance, P);
    const Pose correction = mapper.correction();
    alike(correction * found->X_WL_prior, found->X_WL_registered, 1e-12);
    before_prior = found->X_WL_prior, before_registered = found->X_WL_registered, before_P = found->covariance;
    kept.push_back(driven);
    t_before = t_s;
    // Nearer than two metres and ten degrees it wants none.
    NavEstimate near = estimate;
    near.X_WB.p += Vector3d(1.3, -1.3, 0.5);
    looks.right(!mapper.wants(near));
    near.X_WB.p += Vector3d(0.2, -0.2, 0.0);
    looks.right(mapper.wants(near));
    for (const double turn_deg : {9.9, 10.1}) {
      NavEstimate turned = estimate;
      // About L itself, so that it does not move.
      const Eigen::Quaterniond turn(Eigen::AngleAxisd(turn_deg * kPi / 180.0, Vector3d::UnitZ()));
      const Pose X_WL = X_WB * X_BL * Pose{turn, Vector3d::Zero()};
      turned.X_WB = X_WL * X_BL.inverse();
      looks.right(mapper.wants(turned) == (turn_deg > 10.0));
    }
  }
  looks.right(mapper.counters().alignments == 7 && mapper.counters().iterations == 49 &&
              mapper.counters().correspondences == 700);
  return looks.figure();
}

/// Keyframes in a map that was there before: what it says, with its own error as alike as the way is short, weighed
/// with what was known, and alone for the filter. Conditioning as above.
StressFigure in_prior_map(bool surfaces) {
  Looks looks;
  lidar::RegistrationConfig config;
  config.method.name = "gicp";
  Told told;
  told.answer.status = lidar::RegistrationStatus::kConverged;
  told.answer.covariance = spread_of(3, 1e-3, 0.01);
  if (surfaces) told.answer.surfaces = lidar::RegistrationResult::Surfaces{{}, spread_of(4, 2e-3, 0.02)};
  told.off = Pose::exp((Vector6d() << -1e-3, 2e-3, 1e-3, -0.02, 0.03, 0.01).finished());
  const Pose X_BL{rotation_from({.yaw_rad = -0.3, .pitch_rad = 0.05, .roll_rad = 0.02}), {0.4, 0.2, 1.7}};
  Mapper mapper(config, std::make_unique<ToldRegistration>(told), X_BL, std::make_shared<lidar::PreparedCloud>());
  const GpsTime start = GpsTime::from_week_sow(1600, 10.0);
  Pose before;
  const auto alike = [&](const Pose& a, const Pose& b, double bound) {
    looks.near((a.p - b.p).norm(), 0.0, bound);
    looks.near((a.R.toRotationMatrix() - b.R.toRotationMatrix()).norm(), 0.0, bound);
  };
  const auto same = [&](const Matrix6d& a, const Matrix6d& b) { looks.near((a - b).norm() / b.norm(), 0.0, 1e-12); };
  for (int k = 0; k < 6; ++k) {
    NavEstimate estimate;
    estimate.t = start + 0.8 * k;
    // Once it turns where it stands, and once it goes farther than the map's error stays alike.
    estimate.X_WB = {rotation_from({.yaw_rad = 0.3 * k, .pitch_rad = 0.01, .roll_rad = 0.02}),
                     {k < 3    ? 3.0 * k
                      : k == 3 ? 6.0
                               : 70.0 + 3.0 * k,
                      0.2 * k, 0.0}};
    estimate.pose_covariance = spread_of(40 + static_cast<std::uint64_t>(k), 5e-3, 0.2);
    LidarScan scan;
    scan.t = estimate.t;
    scan.points.resize(5);
    const Keyframe* found = mapper.offer(scan, estimate, {scan.t, scan.t, Pose{}, spread_of(50, 2e-3, 0.03)});
    if (found == nullptr || !found->in_map || told.targets.size() != 1) return {kInfinity, 1.0};
    const Pose known = told.targets[0].inverse();
    alike(told.asked.X_TS, Pose{}, 1e-15);
    if (k == 0) {
      alike(known, estimate.X_WB * X_BL, 1e-12);
      same(told.asked.covariance, in_frame(estimate.pose_covariance, X_BL));
    }
    const double way_m = (known.p - before.p).norm();
    const double times = k == 0 || way_m > 50.0 ? 1.0 : 50.0 / (way_m > 0.1 ? way_m : 0.1);
    const Matrix6d floor = floors(config.alignment_floor_deg, config.alignment_floor_m) +
                           times * floors(config.prior_map_sigma_deg, config.prior_map_sigma_m);
    const lidar::PosePrior alone = surfaces ? lidar::PosePrior{told.off * Pose::exp(Vector6d::Constant(2e-3)),
                                                               told.answer.surfaces->covariance + floor}
                                            : lidar::PosePrior{told.off, told.answer.covariance + floor};
    const lidar::PosePrior fused = surfaces ? both_of({Pose{}, told.asked.covariance}, alone) : alone;
    alike(found->X_WL_registered, known * fused.X_TS, 1e-12);
    same(found->covariance, fused.covariance);
    alike(found->in_map->X_WB, known * alone.X_TS * X_BL.inverse(), 1e-12);
    same(found->in_map->covariance, in_frame(alone.covariance, X_BL.inverse()));
    looks.right(found->in_map->t == scan.t && found->map_status == lidar::RegistrationStatus::kConverged);
    before = found->X_WL_registered;
  }
  looks.right(mapper.counters().found_in_map == 6 && mapper.counters().alignments == 5);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> mapping_cases() {
  StressRows rows;
  rows.of(
      {.group = StressGroup::kData,
       .mechanism = "keyframes of a drive whose alignments are laid out",
       .why = "a covariance in the frame of the other end, a floor of sigma on variances, a gain for its complement",
       .expected = "each by the formulas that are stated: conditioning of 6 x 6 matrices",
       .unit = "of the bound"});
  for (const char* kind : {"converged", "surfaces", "failed"})
    rows.add(std::string("mapping/keyframes_") + kind, [name = std::string(kind)] { return keyframes(name); });
  rows.add("mapping/in_a_prior_map", [] { return in_prior_map(false); }).add("mapping/in_a_prior_map_by_surfaces", [] {
    return in_prior_map(true);
  });
  return rows.take();
}

}  // namespace canyon::mission
