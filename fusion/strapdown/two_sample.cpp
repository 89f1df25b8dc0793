#include "canyon/fusion/strapdown/models.h"

namespace canyon::fusion {
namespace {

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

}  // namespace

std::unique_ptr<Strapdown> make_two_sample(GravityFunction gravity) {
  return std::make_unique<TwoSample>(gravity);
}

}  // namespace canyon::fusion
