#include "canyon/core/motion/true_motion.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/check.h"

namespace canyon {
namespace {

using Coefficients = Eigen::Matrix<double, 3, 6>;

/// Of s in [0, 1]: value, first and second derivative at both ends, derivatives with respect to s.
Coefficients quintic(const Eigen::Vector3d& x0, const Eigen::Vector3d& v0, const Eigen::Vector3d& a0,
                     const Eigen::Vector3d& x1, const Eigen::Vector3d& v1, const Eigen::Vector3d& a1) {
  const Eigen::Vector3d dx = x1 - x0 - v0 - 0.5 * a0, dv = v1 - v0 - a0, da = a1 - a0;
  Coefficients c;
  c.col(0) = x0;
  c.col(1) = v0;
  c.col(2) = 0.5 * a0;
  c.col(3) = 10.0 * dx - 4.0 * dv + 0.5 * da;
  c.col(4) = -15.0 * dx + 7.0 * dv - da;
  c.col(5) = 6.0 * dx - 3.0 * dv + 0.5 * da;
  return c;
}

struct Derivatives {
  Eigen::Vector3d value, first, second;
};

Derivatives evaluate_quintic(const Coefficients& c, double s) {
  Derivatives d{c.col(5), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  for (int power = 4; power >= 0; --power) {  // Horner, with its own derivatives
    d.second = d.second * s + d.first;
    d.first = d.first * s + d.value;
    d.value = d.value * s + c.col(power);
  }
  d.second *= 2.0;
  return d;
}

/// A = (1 - cos a) / a^2 and B = (a - sin a) / a^3 of the right Jacobian Jr = I - A [phi] + B [phi]^2, as series in
/// q = a^2, with their derivatives with respect to q. For a < 1 the first term left out is below 1e-17 of the sum.
struct JacobianFactors {
  double A = 0, B = 0, dA = 0, dB = 0;
  explicit JacobianFactors(double q) {
    double a = 0.5, b = 1.0 / 6.0;  // coefficients 1 / (2 n + 2)! and 1 / (2 n + 3)! with alternating signs
    double power = 1.0, power_before = 0.0;
    for (int n = 0; n < 9; ++n) {
      A += a * power;
      B += b * power;
      dA += n * a * power_before;
      dB += n * b * power_before;
      power_before = power;
      power *= q;
      a /= -(2.0 * n + 3.0) * (2.0 * n + 4.0);
      b /= -(2.0 * n + 4.0) * (2.0 * n + 5.0);
    }
  }
};

struct RightJacobian {
  Eigen::Matrix3d J, rate;  ///< Jr(phi), and its derivative as phi changes
  RightJacobian(const Eigen::Vector3d& phi, const Eigen::Vector3d& phi_rate) {
    const double q = phi.squaredNorm(), q_rate = 2.0 * phi.dot(phi_rate);
    const JacobianFactors f(q);
    const Eigen::Matrix3d V = skew(phi), dV = skew(phi_rate);
    J = Eigen::Matrix3d::Identity() - f.A * V + f.B * V * V;
    rate = -f.dA * q_rate * V - f.A * dV + f.dB * q_rate * V * V + f.B * (dV * V + V * dV);
  }
};

}  // namespace

TrueMotion::Segment TrueMotion::segment(const KinematicState& a, const KinematicState& b) {
  const double h = b.t - a.t;
  const Eigen::Vector3d phi = so3_log(a.X_WB.R.conjugate() * b.X_WB.R);
  CANYON_CHECK(phi.norm() < 1.0, "true motion turns by ", phi.norm(), " rad from ", a.t.iso(6), " to ", b.t.iso(6));
  const Eigen::Matrix3d J_inverse = RightJacobian(phi, Eigen::Vector3d::Zero()).J.inverse();
  const Eigen::Vector3d phi_rate = J_inverse * b.w_WB_B;
  const Eigen::Vector3d phi_acceleration = J_inverse * (b.alpha_WB_B - RightJacobian(phi, phi_rate).rate * phi_rate);
  const double h2 = h * h;
  return {h, quintic(a.X_WB.p, h * a.v_WB_W, h2 * a.a_WB_W, b.X_WB.p, h * b.v_WB_W, h2 * b.a_WB_W),
          quintic(Eigen::Vector3d::Zero(), h * a.w_WB_B, h2 * a.alpha_WB_B, phi, h * phi_rate, h2 * phi_acceleration)};
}

KinematicState TrueMotion::evaluate(const KinematicState& a, const Segment& segment, GpsTime t, double s) {
  const double h = segment.duration_s;
  const Derivatives p = evaluate_quintic(segment.position, s), phi = evaluate_quintic(segment.rotation, s);
  const Eigen::Vector3d phi_rate = phi.first / h, phi_acceleration = phi.second / (h * h);
  const RightJacobian jacobian(phi.value, phi_rate);
  KinematicState state;
  state.t = t;
  state.X_WB = {(a.X_WB.R * so3_exp(phi.value)).normalized(), p.value};
  state.v_WB_W = p.first / h;
  state.a_WB_W = p.second / (h * h);
  state.w_WB_B = jacobian.J * phi_rate;
  state.alpha_WB_B = jacobian.J * phi_acceleration + jacobian.rate * phi_rate;
  return state;
}

void TrueMotion::append(const KinematicState& node) {
  if (!nodes_.empty()) {
    CANYON_CHECK(last() < node.t, node.t.ns, " ns after ", last().ns, " ns");
    segments_.push_back(segment(nodes_.back(), node));
  }
  nodes_.push_back(node);
}

void TrueMotion::forget_before(GpsTime t) {
  while (segments_.size() > 1 && nodes_[1].t <= t) {
    nodes_.pop_front();
    segments_.pop_front();
  }
}

/// The segment that t lies in, the earlier one at a node.
std::size_t TrueMotion::segment_before(GpsTime t) const {
  const auto next = std::lower_bound(nodes_.begin() + 1, nodes_.end(), t,
                                     [](const KinematicState& node, GpsTime value) { return node.t < value; });
  return static_cast<std::size_t>(next - nodes_.begin()) - 1;
}

KinematicState TrueMotion::at(GpsTime t) const {
  CANYON_CHECK(!empty() && first() <= t && t <= last(), "true motion at ", t.iso(6), " is not known");
  if (t == last()) return nodes_.back();
  const std::size_t i = segment_before(t);
  for (const KinematicState* node : {&nodes_[i], &nodes_[i + 1]})
    if (t == node->t) return *node;
  return evaluate(nodes_[i], segments_[i], t, (t - nodes_[i].t) / segments_[i].duration_s);
}

void TrueMotion::for_each_piece(GpsTime from, GpsTime to, const std::function<void(const Piece&)>& body) const {
  CANYON_CHECK(!segments_.empty() && first() <= from && from < to && to <= last(), "true motion from ", from.iso(6),
               " to ", to.iso(6), " is not known");
  std::size_t i = segment_before(from);
  if (nodes_[i + 1].t == from) ++i;
  for (GpsTime begin = from; begin < to; ++i) {
    const KinematicState& node = nodes_[i];
    const GpsTime end = std::min(to, nodes_[i + 1].t);
    const double h = segments_[i].duration_s, s0 = (begin - node.t) / h, s1 = (end - node.t) / h;
    Piece piece;
    for (int k = 0; k < kPoints; ++k) {
      const double share = static_cast<double>(k) / (kPoints - 1);
      piece[static_cast<std::size_t>(k)] =
          evaluate(node, segments_[i], begin + share * (end - begin), s0 + share * (s1 - s0));
    }
    piece.back().t = end;
    body(piece);
    begin = end;
  }
}

}  // namespace canyon
