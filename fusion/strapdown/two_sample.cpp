#include "canyon/fusion/strapdown/models.h"

namespace canyon::fusion {
namespace {

Eigen::Vector3d coning(const Eigen::Vector3d& dtheta_before, const Eigen::Vector3d& dtheta) {
  return dtheta_before.cross(dtheta) / 12.0;
}
Eigen::Vector3d sculling(const Eigen::Vector3d& dtheta_before, const Eigen::Vector3d& dv_before,
                         const Eigen::Vector3d& dtheta, const Eigen::Vector3d& dv) {
  return (dtheta_before.cross(dv) + dv_before.cross(dtheta)) / 12.0;
}

/// Rate and force linear in time over the previous and the present interval (' = previous):
///   rotation = dtheta + (dtheta' x dtheta) / 12                             (Savage 1998, part 1, eq. 50)
///   dv_start = dv + (dtheta x dv) / 2 + dtheta x (dtheta x dv) / 6
///                 + (dtheta' x dv + dv' x dtheta) / 12                      (Savage 1998, part 2, eqs. 24, 59)
/// First interval after a reset: the previous increments are taken equal to the present ones, where the coning term
/// vanishes.
class TwoSample final : public Copied<Strapdown, TwoSample> {
 public:
  explicit TwoSample(GravityFunction gravity) : gravity_(gravity) {}
  void reset() override { have_previous_ = false; }
  InertialStep advance(NavState& state, const Increments& now) override {
    const Eigen::Vector3d& dtheta = now.dtheta_U;
    const Eigen::Vector3d& dv = now.dv_U;
    const Eigen::Vector3d turned = dtheta.cross(dv);
    InertialStep step{.rotation_U = dtheta, .dv_start_U = dv + 0.5 * turned + dtheta.cross(turned) / 6.0};
    if (have_previous_ && !leave_out_.coning) {
      // Scaled to the present interval, so that a jittering sample clock does not look like a change of rate.
      const double scale = now.dt_s / previous_.dt_s;
      const Eigen::Vector3d dtheta_before = scale * previous_.dtheta_U;
      const Eigen::Vector3d dv_before = scale * previous_.dv_U;
      step.rotation_U += coning(dtheta_before, dtheta);
      step.dv_start_U += sculling(dtheta_before, dv_before, dtheta, dv);
    }
    previous_ = now;
    have_previous_ = true;
    move(state, step, now.dt_s, gravity_, !leave_out_.earth_rate);
    return step;
  }
  void leave_out(const StrapdownOmissions& omissions) override { leave_out_ = omissions; }

 private:
  GravityFunction gravity_;
  StrapdownOmissions leave_out_;
  Increments previous_;
  bool have_previous_ = false;
};

/// What the two terms of the increments before do. Both vanish where rate and force stay as they are: what they do is
/// of the change from step to step, dtheta' x (dtheta - dtheta') / 12 and its like.
StepMove coning_of(const StrapdownStep& step) {
  StepMove move;
  if (step.dt_before_s <= 0.0) return move;
  const double scale = step.dt_s / step.dt_before_s;
  const Eigen::Vector3d dtheta_before = scale * step.dtheta_before_U, dv_before = scale * step.dv_before_U;
  move.theta_U = coning(dtheta_before, step.dtheta_U);
  move.v_E = step.R_EU * sculling(dtheta_before, dv_before, step.dtheta_U, step.dv_U);
  move.p_E = 0.5 * step.dt_s * move.v_E;
  return move;
}

}  // namespace

std::span<const StrapdownEffect> two_sample_effects() {
  static constexpr StrapdownEffect kEffects[] = {{kConing, coning_of}, {kEarthRate, earth_rate_of}};
  return kEffects;
}

std::unique_ptr<Strapdown> make_two_sample(GravityFunction gravity) {
  return std::make_unique<TwoSample>(gravity);
}

}  // namespace canyon::fusion
