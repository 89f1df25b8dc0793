#include <array>
#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/earth/earth.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/fusion/strapdown/models.h"

namespace canyon::fusion {
namespace {

using Eigen::Vector3d;

/// Integral of a rate over the present interval as a cubic of x = time / dt in [0, 1], through the sums of the present
/// and up to two earlier increments: S(x) = k1 x + k2 x^2 + k3 x^3.
struct Cubic {
  Vector3d k1, k2 = Vector3d::Zero(), k3 = Vector3d::Zero();

  Vector3d integral(double x) const { return x * (k1 + x * (k2 + x * k3)); }
  Vector3d rate(double x) const { return k1 + x * (2.0 * k2 + 3.0 * x * k3); }

  /// `before` the interval before, `earlier` the one before that, or null; lengths in units of the present interval.
  Cubic(const Vector3d& now, const Vector3d* before, double length, const Vector3d* earlier, double earlier_length)
      : k1(now) {
    if (before == nullptr) return;
    // Newton's form on the nodes 0, 1, -length, -reach: S = x (now + (x - 1) (b + (x + length) c)).
    const Vector3d b = (now - *before / length) / (1.0 + length);
    Vector3d c = Vector3d::Zero();
    if (earlier != nullptr) {
      const double reach = length + earlier_length;
      c = (b - (now - (*before + *earlier) / reach) / (1.0 + reach)) / earlier_length;
    }
    k1 = now - b - length * c;
    k2 = b + (length - 1.0) * c;
    k3 = c;
  }
};

/// Rotation vector of U from the interval's start to x: Magnus' series to second order, whose remainder is of fifth
/// order in the interval.
Vector3d rotation_to(const Cubic& turn, double x) {
  const double x3 = x * x * x;
  return turn.integral(x) +
         0.5 * x3 *
             (turn.k1.cross(turn.k2) / 3.0 + 0.5 * x * turn.k1.cross(turn.k3) + 0.2 * x * x * turn.k2.cross(turn.k3));
}

/// Rate and force quadratic in time over the last three intervals. Velocity and position then solve, in E,
///   v' = R_EU f + g(p) - 2 w_IE x v,   p' = v
/// by Gauss-Legendre collocation at three points (order 6; Hairer, Norsett & Wanner, Solving Ordinary Differential
/// Equations I, II.7), so that what is left is the error of the quadratics, of fourth order. After a reset the first
/// two intervals have fewer predecessors and lower order.
class ThreeSample final : public Copied<Strapdown, ThreeSample> {
 public:
  explicit ThreeSample(GravityFunction gravity) : gravity_(gravity) {}
  void reset() override { known_ = 0; }
  void leave_out(const StrapdownOmissions& omissions) override {
    CANYON_CHECK(!omissions.any(), "three_sample does not say what it can leave out");
  }

  InertialStep advance(NavState& state, const Increments& now) override {
    const double h = now.dt_s;
    const Increments* before = known_ > 0 ? &past_[0] : nullptr;
    const Increments* earlier = known_ > 1 ? &past_[1] : nullptr;
    const auto cubic = [&](Vector3d Increments::*field) {
      return Cubic(now.*field, before ? &(before->*field) : nullptr, before ? before->dt_s / h : 0.0,
                   earlier ? &(earlier->*field) : nullptr, earlier ? earlier->dt_s / h : 0.0);
    };
    const Cubic turn = cubic(&Increments::dtheta_U), force = cubic(&Increments::dv_U);

    InertialStep step;
    step.rotation_U = rotation_to(turn, 1.0);
    std::array<Vector3d, 3> force_E;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3d dv_start = so3_exp(rotation_to(turn, kNode[i])) * (force.rate(kNode[i]) / h);
      step.dv_start_U += kWeight[i] * h * dv_start;
      force_E[i] = so3_exp(-kNode[i] * h * earth_rate_E()) * (state.R_EU * dv_start);
    }
    collocate(state, force_E, h);
    state.R_EU = (so3_exp(-h * earth_rate_E()) * state.R_EU * so3_exp(step.rotation_U)).normalized();
    state.t = state.t + h;
    past_ = {now, past_[0]};
    known_ = known_ < 2 ? known_ + 1 : 2;
    return step;
  }

 private:
  /// Velocity and position over the interval, with the force in E at the nodes.
  void collocate(NavState& state, const std::array<Vector3d, 3>& force_E, double h) const {
    const Vector3d &v0 = state.v_EU_E, &p0 = state.p_EU_E;
    std::array<Vector3d, 3> a;
    a.fill(gravity_(p0) - 2.0 * earth_rate_E().cross(v0));
    for (std::size_t i = 0; i < 3; ++i) a[i] += force_E[i];
    // Each round gains a factor 2 w_IE h < 1e-5: after two of them the equations hold to rounding.
    for (int round = 0; round < 2; ++round) {
      std::array<Vector3d, 3> v, p;
      for (std::size_t i = 0; i < 3; ++i)
        v[i] = v0 + h * (kInner[i][0] * a[0] + kInner[i][1] * a[1] + kInner[i][2] * a[2]);
      for (std::size_t i = 0; i < 3; ++i)
        p[i] = p0 + h * (kInner[i][0] * v[0] + kInner[i][1] * v[1] + kInner[i][2] * v[2]);
      for (std::size_t i = 0; i < 3; ++i) a[i] = force_E[i] + gravity_(p[i]) - 2.0 * earth_rate_E().cross(v[i]);
    }
    Vector3d dv = Vector3d::Zero(), dp = h * v0;
    for (std::size_t i = 0; i < 3; ++i) {
      dv += kWeight[i] * h * a[i];
      dp += kWeight[i] * (1.0 - kNode[i]) * h * h * a[i];
    }
    state.p_EU_E += dp;
    state.v_EU_E += dv;
  }

  // Gauss-Legendre of three nodes on [0, 1] and its collocation matrix (sixth-order method of Kuntzmann & Butcher).
  static constexpr double kRoot15 = 3.872983346207417;
  static constexpr double kNode[3] = {0.5 - kRoot15 / 10.0, 0.5, 0.5 + kRoot15 / 10.0};
  static constexpr double kWeight[3] = {5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0};
  static constexpr double kInner[3][3] = {{5.0 / 36.0, 2.0 / 9.0 - kRoot15 / 15.0, 5.0 / 36.0 - kRoot15 / 30.0},
                                          {5.0 / 36.0 + kRoot15 / 24.0, 2.0 / 9.0, 5.0 / 36.0 - kRoot15 / 24.0},
                                          {5.0 / 36.0 + kRoot15 / 30.0, 2.0 / 9.0 + kRoot15 / 15.0, 5.0 / 36.0}};

  GravityFunction gravity_;
  std::array<Increments, 2> past_;  ///< the latest first
  int known_ = 0;
};

}  // namespace

std::unique_ptr<Strapdown> make_three_sample(GravityFunction gravity) {
  return std::make_unique<ThreeSample>(gravity);
}

}  // namespace canyon::fusion
