#include "canyon/study/fuse/score.h"

#include <cmath>

#include "canyon/core/earth/earth.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/fusion/consistency.h"
#include "canyon/fusion/dead_reckoning.h"
#include "canyon/fusion/reference_track.h"

namespace canyon::study {
namespace {

using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix9d = Eigen::Matrix<double, 9, 9>;
constexpr int kTheta = fusion::ErrorIndex::kTheta, kPosition = fusion::ErrorIndex::kPosition,
              kVelocity = fusion::ErrorIndex::kVelocity;

const Eigen::Vector3d kUnknown = Eigen::Vector3d::Constant(kNaN);

Eigen::Vector3d sigmas(const Eigen::Matrix3d& covariance) {
  return covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
}

}  // namespace

Eigen::Vector3d truth_arm(const FuseTruth& truth, const Eigen::Vector3d& lever_U_B, const Eigen::Vector3d& lever_A_B) {
  switch (truth.of) {
    case TruthPoint::kImu:
      return Eigen::Vector3d::Zero();
    case TruthPoint::kAntenna:
      return lever_A_B - lever_U_B;
    case TruthPoint::kBody:
      return -lever_U_B;
  }
  return Eigen::Vector3d::Zero();
}

FuseError fuse_error(const FuseTruth& reference, const Eigen::Vector3d& arm_U, const EstimatedMotion& estimate,
                     const fusion::NavState& truth, fusion::NavigationError* detail) {
  const Eigen::Matrix3d R = estimate.nav.R_EU.toRotationMatrix();
  // Of the reference's point: it moves with the attitude's error, and with the turning of the body.
  const Eigen::Vector3d swing_U = estimate.rate_U.cross(arm_U);
  const Eigen::Vector3d p = estimate.nav.p_EU_E + R * arm_U, v = estimate.nav.v_EU_E + R * swing_U;
  Matrix9d J = Matrix9d::Identity();
  J.block<3, 3>(kPosition, kTheta) = -R * skew(arm_U);
  J.block<3, 3>(kVelocity, kTheta) = -R * skew(swing_U);
  const Matrix9d P = J * estimate.covariance * J.transpose();

  Vector9d error = Vector9d::Zero();
  error.segment<3>(kPosition) = truth.p_EU_E - p;
  if (reference.has_velocity) error.segment<3>(kVelocity) = truth.v_EU_E - v;
  if (reference.has_attitude) error.segment<3>(kTheta) = so3_log(estimate.nav.R_EU.conjugate() * truth.R_EU);

  const Eigen::Matrix3d R_EN = rotation_E_from_enu(geodetic_from_ecef(truth.p_EU_E));
  const auto in_enu = [&](int block) { return (R_EN.transpose() * P.block<3, 3>(block, block) * R_EN).eval(); };
  FuseError e{.t = truth.t,
              .attitude_rad = kUnknown,
              .attitude_sigma_rad = sigmas(P.block<3, 3>(kTheta, kTheta)),
              .position_enu_m = -(R_EN.transpose() * error.segment<3>(kPosition)),
              .position_sigma_m = sigmas(in_enu(kPosition)),
              .velocity_enu_m_s = kUnknown,
              .velocity_sigma_m_s = sigmas(in_enu(kVelocity))};
  if (reference.has_velocity) e.velocity_enu_m_s = -(R_EN.transpose() * error.segment<3>(kVelocity));
  if (reference.has_attitude) e.attitude_rad = -error.segment<3>(kTheta);
  if (reference.has_velocity && reference.has_attitude)
    e.nees = fusion::normalized_squared(error, P) / 9.0;
  else
    e.nees = fusion::normalized_squared(error.segment<3>(kPosition), P.block<3, 3>(kPosition, kPosition)) / 3.0;
  if (detail != nullptr)
    *detail = {.attitude_rad = e.attitude_rad,
               .attitude_covariance = P.block<3, 3>(kTheta, kTheta),
               .position_enu_m = e.position_enu_m,
               .position_covariance = in_enu(kPosition),
               .velocity_enu_m_s = e.velocity_enu_m_s,
               .velocity_covariance = in_enu(kVelocity)};
  return e;
}

Scorer::Scorer(const FuseTruth& truth, const Eigen::Vector3d& lever_U_B, const Eigen::Vector3d& lever_A_B,
               GpsTime count_from, fusion::RunEvidence& evidence)
    : truth_(truth), count_from_(count_from), evidence_(evidence) {
  arm_U_ = truth_arm(truth, lever_U_B, lever_A_B);
}

void Scorer::passed(const fusion::NavState& before, const fusion::NavState& after,
                    const fusion::ErrorStateFilter& filter, const Eigen::Vector3d& rate_U, Outages& outages) {
  for (; next_ < truth_.states.size(); ++next_) {
    const fusion::NavState& truth = truth_.states[next_];
    if (truth.t - after.t > -fusion::kSameInstant_s) return;
    if (truth.t - before.t < fusion::kSameInstant_s) continue;
    add(fusion::interpolate(before, after, truth.t), truth, filter, rate_U, outages);
  }
}

void Scorer::settled(const fusion::NavState& now, const fusion::ErrorStateFilter& filter, const Eigen::Vector3d& rate_U,
                     Outages& outages) {
  for (; next_ < truth_.states.size(); ++next_) {
    const fusion::NavState& truth = truth_.states[next_];
    if (truth.t - now.t > fusion::kSameInstant_s) return;
    if (now.t - truth.t > fusion::kSameInstant_s) continue;
    add(now, truth, filter, rate_U, outages);
  }
}

void Scorer::add(const fusion::NavState& estimate, const fusion::NavState& truth,
                 const fusion::ErrorStateFilter& filter, const Eigen::Vector3d& rate_U, Outages& outages) {
  fusion::NavigationError detail;
  FuseError e =
      fuse_error(truth_, arm_U_, {estimate, rate_U, filter.covariance().topLeftCorner<9, 9>()}, truth, &detail);
  e.counts = truth.t >= count_from_;
  if (e.counts) evidence_.error(truth.t, detail);
  outages.add(truth.t, e.position_enu_m.head<2>().norm(), std::abs(e.position_enu_m.z()));
  errors_.push_back(e);
}

FuseScore fuse_score(const std::vector<FuseError>& errors) {
  FuseScore s;
  const auto clear = [](auto&... vectors) { (vectors.setZero(), ...); };
  clear(s.position_rms_m, s.velocity_rms_m_s, s.attitude_rms_rad, s.position_ratio, s.velocity_ratio, s.attitude_ratio,
        s.position_sigma_m, s.velocity_sigma_m_s, s.attitude_sigma_rad);
  double nees = 0.0;
  for (const FuseError& e : errors) {
    if (!e.counts) continue;
    if (s.instants++ == 0) s.first = e.t;
    s.last = e.t;
    const auto add = [](const Eigen::Vector3d& error, const Eigen::Vector3d& sigma, Eigen::Vector3d& rms,
                        Eigen::Vector3d& ratio, Eigen::Vector3d& mean_sigma) {
      rms += error.cwiseAbs2();
      ratio += error.cwiseQuotient(sigma).cwiseAbs2();
      mean_sigma += sigma.cwiseAbs2();
    };
    add(e.position_enu_m, e.position_sigma_m, s.position_rms_m, s.position_ratio, s.position_sigma_m);
    add(e.velocity_enu_m_s, e.velocity_sigma_m_s, s.velocity_rms_m_s, s.velocity_ratio, s.velocity_sigma_m_s);
    add(e.attitude_rad, e.attitude_sigma_rad, s.attitude_rms_rad, s.attitude_ratio, s.attitude_sigma_rad);
    nees += e.nees;
    s.final_error_m = e.position_enu_m.norm();
    s.final_horizontal_m = e.position_enu_m.head<2>().norm();
  }
  const double n = s.instants > 0 ? static_cast<double>(s.instants) : kNaN;
  s.rms_3d_m = std::sqrt(s.position_rms_m.sum() / n);
  s.nees_mean = nees / n;
  for (Eigen::Vector3d* v : {&s.position_rms_m, &s.velocity_rms_m_s, &s.attitude_rms_rad, &s.position_sigma_m,
                             &s.velocity_sigma_m_s, &s.attitude_sigma_rad})
    *v = (*v / n).cwiseSqrt();
  for (Eigen::Vector3d* v : {&s.position_ratio, &s.velocity_ratio, &s.attitude_ratio}) *v /= n;
  return s;
}

}  // namespace canyon::study
