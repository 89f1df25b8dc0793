#include "canyon/inertial/motion/rigid_motion.h"

namespace canyon::inertial {
namespace {

SeriesQuaternion product(const SeriesQuaternion& a, const SeriesQuaternion& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

SeriesQuaternion about(int axis, const Series& angle) {
  const SineCosine half = sine_cosine(Series(0.5) * angle);
  SeriesQuaternion q{half.cosine, 0.0, 0.0, 0.0};
  q[static_cast<std::size_t>(axis) + 1] = half.sine;
  return q;
}

}  // namespace

SeriesQuaternion quaternion_from(const Series& yaw, const Series& pitch, const Series& roll) {
  return product(product(about(2, yaw), about(1, pitch)), about(0, roll));
}

KinematicState kinematics(const SeriesVector& p_WB, const SeriesQuaternion& R_WB) {
  Series square;
  for (const Series& part : R_WB) square = square + part * part;
  const Series norm = sqrt(square);
  SeriesQuaternion q, conjugate, rate;
  for (std::size_t i = 0; i < 4; ++i) {
    q[i] = R_WB[i] / norm;
    conjugate[i] = i == 0 ? q[i] : -q[i];
    rate[i] = q[i].derivative();
  }
  const SeriesQuaternion half_w = product(conjugate, rate);

  KinematicState k;
  k.X_WB.R = Eigen::Quaterniond(q[0].value(), q[1].value(), q[2].value(), q[3].value());
  for (int i = 0; i < 3; ++i) {
    const auto u = static_cast<std::size_t>(i);
    k.X_WB.p[i] = p_WB[u].value();
    k.v_WB_W[i] = p_WB[u].first();
    k.a_WB_W[i] = p_WB[u].second();
    k.w_WB_B[i] = 2.0 * half_w[u + 1].value();
    k.alpha_WB_B[i] = 2.0 * half_w[u + 1].first();
  }
  return k;
}

KinematicState compose(const KinematicState& X_WB, const KinematicState& X_BC) {
  const Eigen::Matrix3d R_WB = X_WB.X_WB.R.toRotationMatrix(), R_CB = X_BC.X_WB.R.toRotationMatrix().transpose();
  const Eigen::Vector3d &w = X_WB.w_WB_B, &p = X_BC.X_WB.p, &v = X_BC.v_WB_W;
  const Eigen::Vector3d w_C = R_CB * w;  // of B, in C
  KinematicState k;
  k.t = X_WB.t;
  k.X_WB = X_WB.X_WB * X_BC.X_WB;
  k.v_WB_W = X_WB.v_WB_W + R_WB * (v + w.cross(p));
  k.a_WB_W = X_WB.a_WB_W + R_WB * (X_BC.a_WB_W + 2.0 * w.cross(v) + X_WB.alpha_WB_B.cross(p) + w.cross(w.cross(p)));
  k.w_WB_B = w_C + X_BC.w_WB_B;
  k.alpha_WB_B = R_CB * X_WB.alpha_WB_B + w_C.cross(X_BC.w_WB_B) + X_BC.alpha_WB_B;
  return k;
}

}  // namespace canyon::inertial
