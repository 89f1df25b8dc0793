#include "canyon/core/motion/rotation.h"
#include "canyon/fusion/strapdown/models.h"

namespace canyon::fusion {
namespace {

/// The force is turned with the attitudes at both ends of the interval, half of it with each:
///   dv_start = (dv + Exp(dtheta) dv) / 2.
class Trapezoid final : public Copied<Strapdown, Trapezoid> {
 public:
  explicit Trapezoid(GravityFunction gravity) : gravity_(gravity) {}
  void reset() override {}
  InertialStep advance(NavState& state, const Increments& now) override {
    const InertialStep step{.rotation_U = now.dtheta_U,
                            .dv_start_U = 0.5 * (now.dv_U + so3_exp(now.dtheta_U) * now.dv_U)};
    move(state, step, now.dt_s, gravity_, earth_turns_);
    return step;
  }
  void leave_out(const StrapdownOmissions& omissions) override {
    check_has_no_coning(omissions);
    earth_turns_ = !omissions.earth_rate;
  }

 private:
  GravityFunction gravity_;
  bool earth_turns_ = true;
};

}  // namespace

std::unique_ptr<Strapdown> make_trapezoid(GravityFunction gravity) {
  return std::make_unique<Trapezoid>(gravity);
}

}  // namespace canyon::fusion
