#include "canyon/fusion/smoothing/graph/imu_factor.h"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "canyon/core/check.h"
#include "canyon/core/earth/earth.h"
#include "canyon/core/motion/rotation.h"

namespace canyon::fusion {
namespace {

using Index = ErrorIndex;

/// 1-sigma of an IMU without noise over an interval, rad, m and m/s: beneath what double precision resolves of a
/// position on Earth.
constexpr double kNoNoise = 1e-10;

Eigen::Vector3d gravitation_E(const Eigen::Vector3d& p_E) {
  const Eigen::Vector3d w = earth_rate_E();
  return gravity_E(p_E) + w.cross(w.cross(p_E));
}

/// Exp(angle about z) - 1, without the cancellation of a small angle.
Eigen::Matrix3d turn_less_one(double angle_rad) {
  const double s = std::sin(angle_rad), half = std::sin(0.5 * angle_rad), c = -2.0 * half * half;
  Eigen::Matrix3d out = Eigen::Matrix3d::Zero();
  out.topLeftCorner<2, 2>() << c, -s, s, c;
  return out;
}

Eigen::Matrix3d inverse_right_jacobian(const Eigen::Vector3d& v) {
  return so3_right_jacobian(v).inverse();
}

}  // namespace

Eigen::MatrixXd whitening(const Eigen::MatrixXd& covariance, double floor) {
  const Eigen::Index n = covariance.rows();
  for (const double share : {0.0, 1e-12}) {
    Eigen::MatrixXd P = covariance;
    if (share > 0.0) P.diagonal() = ((1.0 + share) * P.diagonal().array() + floor * floor).matrix();
    const Eigen::VectorXd sigma = P.diagonal().cwiseSqrt();
    if (!(sigma.minCoeff() > 0.0)) continue;
    const Eigen::VectorXd scale = sigma.cwiseInverse();
    const Eigen::LLT<Eigen::MatrixXd> llt(scale.asDiagonal() * P * scale.asDiagonal());
    if (llt.info() != Eigen::Success) continue;
    Eigen::MatrixXd out = Eigen::MatrixXd::Identity(n, n);
    llt.matrixL().solveInPlace(out);
    return out * scale.asDiagonal();
  }
  CANYON_CHECK(false, "a covariance is not positive definite: diagonal ", covariance.diagonal().transpose());
  return {};
}

ImuFactor::ImuFactor(const GraphLayout& layout, const PreintegratedImu& imu, const Eigen::Vector3d& gradient_at_E)
    : imu_(imu) {
  const Eigen::MatrixXd half = layout.node_columns(imu.covariance);
  whiten_ = whitening(layout.node_columns(half.transpose()), kNoNoise);
  const Eigen::Matrix3d earth = skew(earth_rate_E());
  gravitation_gradient_ = gravity_gradient_E(gradient_at_E) + earth * earth;
  turn_less_one_ = turn_less_one(imu.dt_s * earth_rate_E().z());
}

GraphNode ImuFactor::predict(const GraphLayout& layout, const GraphNode& first,
                             const Eigen::VectorXd& constants) const {
  const Eigen::VectorXd values = layout.values(first.walking, constants);
  const PreintegratedImu in = imu_.moved_to(values);
  const double dt = imu_.dt_s;
  const Eigen::Vector3d w = earth_rate_E();
  const NavState& i = first.nav;
  const Eigen::Matrix3d back = so3_exp(-dt * w).toRotationMatrix(), R = i.R_EU.toRotationMatrix();
  const Eigen::Matrix3d forth = back.transpose();
  const Eigen::Vector3d u = i.v_EU_E + w.cross(i.p_EU_E), G = gravitation_E(i.p_EU_E);
  GraphNode out;
  out.nav.t = i.t + dt;
  out.nav.R_EU = (Eigen::Quaterniond(back) * i.R_EU * in.dR).normalized();
  // Gravitation at the end, which depends on the place there by 3e-6 dt^2 / 6: the second round is exact to rounding.
  Eigen::Vector3d G_end = G;
  for (int round = 0; round < 3; ++round) {
    out.nav.p_EU_E = back * (i.p_EU_E + dt * u + dt * dt * (G / 3.0 + G_end / 6.0) + R * in.dp);
    G_end = forth * gravitation_E(out.nav.p_EU_E);
  }
  out.nav.v_EU_E = back * (u + 0.5 * dt * (G + G_end) + R * in.dv) - w.cross(out.nav.p_EU_E);
  out.walking = layout.walking_of(imu_.kept).cwiseProduct(first.walking);
  return out;
}

FactorRows ImuFactor::rows(const GraphLayout& layout, const GraphNode& first, const GraphNode& second,
                           const Eigen::VectorXd& constants, bool derivatives) const {
  const double dt = imu_.dt_s;
  const Eigen::VectorXd values = layout.values(first.walking, constants);
  const PreintegratedImu in = imu_.moved_to(values);
  const NavState &i = first.nav, &j = second.nav;
  const Eigen::Vector3d w = earth_rate_E();
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity(), turn = one + turn_less_one_;
  const Eigen::Matrix3d R_t = i.R_EU.toRotationMatrix().transpose();
  const Eigen::Vector3d u = i.v_EU_E + w.cross(i.p_EU_E), G = gravitation_E(i.p_EU_E),
                        G_end = turn * gravitation_E(j.p_EU_E);
  // E+ p_j - p_i as a difference, and what E+ adds to it: 465 m in a second, where p is 6.4e6 m.
  const Eigen::Vector3d way = (j.p_EU_E - i.p_EU_E) + turn_less_one_ * j.p_EU_E;
  const Eigen::Vector3d pushed = R_t * (way - dt * u - dt * dt * (G / 3.0 + G_end / 6.0));
  const Eigen::Vector3d speeded = R_t * (turn * (j.v_EU_E + w.cross(j.p_EU_E)) - u - 0.5 * dt * (G + G_end));
  const Eigen::Quaterniond turned = in.dR.conjugate() * i.R_EU.conjugate() * Eigen::Quaterniond(turn) * j.R_EU;
  const Eigen::VectorXd kept = layout.walking_of(imu_.kept);
  const Eigen::Index n = layout.node_size(), others = n - Index::kMoving;

  FactorRows out;
  out.residual.resize(n);
  out.residual << so3_log(turned), pushed - in.dp, speeded - in.dv, second.walking - kept.cwiseProduct(first.walking);
  if (derivatives) {
    const Eigen::Vector3d r = out.residual.head<3>();
    const Eigen::Matrix3d Jr_inverse = inverse_right_jacobian(r), earth = skew(w), &gradient = gravitation_gradient_;
    Eigen::MatrixXd& by_i = out.by_first.setZero(n, n);
    by_i.block<3, 3>(0, 0) = -Jr_inverse * (in.dR * turned).toRotationMatrix().transpose();
    by_i.block<3, 3>(3, 0) = skew(pushed);
    by_i.block<3, 3>(3, 3) = R_t * (-one - dt * earth - dt * dt / 3.0 * gradient);
    by_i.block<3, 3>(3, 6) = -dt * R_t;
    by_i.block<3, 3>(6, 0) = skew(speeded);
    by_i.block<3, 3>(6, 3) = R_t * (-earth - 0.5 * dt * gradient);
    by_i.block<3, 3>(6, 6) = -R_t;
    by_i.diagonal().tail(others) = -kept;
    Eigen::MatrixXd& by_j = out.by_second.setZero(n, n);
    by_j.block<3, 3>(0, 0) = Jr_inverse;
    by_j.block<3, 3>(3, 3) = R_t * turn * (one - dt * dt / 6.0 * gradient);
    by_j.block<3, 3>(6, 3) = R_t * turn * (earth - 0.5 * dt * gradient);
    by_j.block<3, 3>(6, 6) = R_t * turn;
    by_j.diagonal().tail(others).setOnes();

    const Eigen::Vector3d a = imu_.by_values.topRows<3>() * (values - imu_.values);
    Eigen::MatrixXd by_values = Eigen::MatrixXd::Zero(Index::kMoving, layout.states());
    by_values.topRightCorner(3, layout.states() - Index::kMoving) =
        -Jr_inverse * turned.toRotationMatrix().transpose() * so3_right_jacobian(a) * imu_.by_values.topRows<3>();
    by_values.bottomRightCorner(6, layout.states() - Index::kMoving) = -imu_.by_values.bottomRows<6>();
    by_i.topRightCorner(Index::kMoving, others) = layout.node_columns(by_values).rightCols(others);
    out.by_constants.setZero(n, layout.constants());
    out.by_constants.topRows<Index::kMoving>() = layout.constant_columns(by_values);

    const auto L = whiten_.triangularView<Eigen::Lower>();
    out.by_first = L * out.by_first;
    out.by_second = L * out.by_second;
    out.by_constants = L * out.by_constants;
  }
  out.residual = whiten_.triangularView<Eigen::Lower>() * out.residual;
  return out;
}

}  // namespace canyon::fusion
