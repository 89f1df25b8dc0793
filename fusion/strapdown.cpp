#include "fusion/strapdown.h"

#include "core/check.h"
#include "core/earth.h"
#include "core/rotation.h"

namespace canyon::fusion {
namespace {

/// The part that all integrators share.
void move(NavState& state, const InertialStep& step, double dt_s, GravityFunction gravity_at) {
  const Eigen::Vector3d earth_rate = earth_rate_E();
  // E itself turns under U: a vector fixed in inertial space turns by -w_IE dt in E, half of it on average.
  const Eigen::Quaterniond half_turn = so3_exp(-0.5 * dt_s * earth_rate);
  const Eigen::Vector3d dv_force = half_turn * (state.R_EU * step.dv_start_U);

  // Gravity and Coriolis at mid-interval; a first guess of the velocity there is enough, its error enters times w_IE
  // dt.
  const Eigen::Vector3d& v = state.v_EU_E;
  const Eigen::Vector3d p_mid = state.p_EU_E + 0.5 * dt_s * v;
  const Eigen::Vector3d gravity = gravity_at(p_mid);
  const Eigen::Vector3d v_mid = v + 0.5 * (dv_force + (gravity - 2.0 * earth_rate.cross(v)) * dt_s);
  const Eigen::Vector3d v_next = v + dv_force + (gravity - 2.0 * earth_rate.cross(v_mid)) * dt_s;

  state.p_EU_E += 0.5 * dt_s * (v + v_next);
  state.v_EU_E = v_next;
  state.R_EU = (half_turn * half_turn * state.R_EU * so3_exp(step.rotation_U)).normalized();
  state.t = state.t + dt_s;
}

/// Rotation and force taken as constant directions over the interval: no coning, no sculling, not even the rotation of
/// the force.
class Euler final : public Strapdown {
 public:
  explicit Euler(GravityFunction gravity) : gravity_(gravity) {}
  void reset() override {}
  InertialStep advance(NavState& state, const Increments& now) override {
    const InertialStep step{.rotation_U = now.dtheta_U, .dv_start_U = now.dv_U};
    move(state, step, now.dt_s, gravity_);
    return step;
  }

 private:
  GravityFunction gravity_;
};

/// Two-sample algorithm: rate and force linear in time over the previous and the present interval.
///   rotation = dtheta + (dtheta' x dtheta) / 12                               (Savage 1998, part 1, eq. 50; ' =
///   previous) dv_start = dv + (dtheta x dv) / 2 + dtheta x (dtheta x dv) / 6
///                 + (dtheta' x dv + dv' x dtheta) / 12                        (Savage 1998, part 2, eqs. 24, 59)
/// First interval after a reset: the previous increments are taken equal to the present ones, where the coning term
/// vanishes.
class TwoSample final : public Strapdown {
 public:
  explicit TwoSample(GravityFunction gravity) : gravity_(gravity) {}
  void reset() override { have_previous_ = false; }
  InertialStep advance(NavState& state, const Increments& now) override {
    const Eigen::Vector3d& dtheta = now.dtheta_U;
    const Eigen::Vector3d& dv = now.dv_U;
    const Eigen::Vector3d turned = dtheta.cross(dv);
    InertialStep step{.rotation_U = dtheta, .dv_start_U = dv + 0.5 * turned + dtheta.cross(turned) / 6.0};
    if (have_previous_) {
      // Scaled to the present interval, so that a jittering sample clock does not look like a change of rate.
      const double scale = now.dt_s / previous_.dt_s;
      const Eigen::Vector3d dtheta_before = scale * previous_.dtheta_U;
      const Eigen::Vector3d dv_before = scale * previous_.dv_U;
      step.rotation_U += dtheta_before.cross(dtheta) / 12.0;
      step.dv_start_U += (dtheta_before.cross(dv) + dv_before.cross(dtheta)) / 12.0;
    }
    previous_ = now;
    have_previous_ = true;
    move(state, step, now.dt_s, gravity_);
    return step;
  }

 private:
  GravityFunction gravity_;
  Increments previous_;
  bool have_previous_ = false;
};

std::unique_ptr<Strapdown> make_euler(GravityFunction gravity) {
  return std::make_unique<Euler>(gravity);
}
std::unique_ptr<Strapdown> make_two_sample(GravityFunction gravity) {
  return std::make_unique<TwoSample>(gravity);
}

constexpr StrapdownRow kRows[] = {
    {"euler", make_euler, 1,
     "increments as they are: no coning, no sculling, no rotation of the force within the interval"},
    {"two_sample", make_two_sample, 2, "coning and sculling from the previous and the present increments"},
};

}  // namespace

std::span<const StrapdownRow> strapdown_models() {
  return kRows;
}

std::vector<std::string> strapdown_names() {
  std::vector<std::string> names;
  for (const StrapdownRow& row : kRows) names.emplace_back(row.name);
  return names;
}

std::unique_ptr<Strapdown> make_strapdown(std::string_view name, GravityFunction gravity) {
  for (const StrapdownRow& row : kRows) {
    if (name == row.name) return row.make(gravity);
  }
  CANYON_CHECK(false, "no strapdown model \"", name, "\"");
  return nullptr;
}

}  // namespace canyon::fusion
