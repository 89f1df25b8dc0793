#include "canyon/fusion/strapdown/models.h"

namespace canyon::fusion {
namespace {

/// Rotation and force taken as constant directions over the interval: no coning, no sculling, not even the rotation of
/// the force.
class Euler final : public Copied<Strapdown, Euler> {
 public:
  explicit Euler(GravityFunction gravity) : gravity_(gravity) {}
  void reset() override {}
  InertialStep advance(NavState& state, const Increments& now) override {
    const InertialStep step{.rotation_U = now.dtheta_U, .dv_start_U = now.dv_U};
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

std::unique_ptr<Strapdown> make_euler(GravityFunction gravity) {
  return std::make_unique<Euler>(gravity);
}

}  // namespace canyon::fusion
