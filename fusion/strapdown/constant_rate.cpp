#include <cmath>

#include "canyon/core/motion/rotation.h"
#include "canyon/fusion/strapdown/models.h"

namespace canyon::fusion {
namespace {

/// Rate and force constant in U over the interval, which has a closed form for any angle a = |dtheta|, with n = dtheta
/// / a and T = skew(n) (Savage 1998, part 2, eqs. 20 and 38):
///   rotation     = dtheta
///   dv_start     = [I + (1 - cos a) / a T + (a - sin a) / a T^2] dv
///   displacement = [I / 2 + (a - sin a) / a^2 T + (a^2 / 2 - 1 + cos a) / a^2 T^2] dv dt
class ConstantRate final : public Copied<Strapdown, ConstantRate> {
 public:
  explicit ConstantRate(GravityFunction gravity) : gravity_(gravity) {}
  void reset() override {}
  InertialStep advance(NavState& state, const Increments& now) override {
    const Eigen::Vector3d turned = now.dtheta_U.cross(now.dv_U), twice = now.dtheta_U.cross(turned);
    const Factors k(now.dtheta_U.norm());
    const InertialStep step{.rotation_U = now.dtheta_U,
                            .dv_start_U = now.dv_U + k.velocity * turned + k.square * twice};
    const Eigen::Vector3d displacement = now.dt_s * (0.5 * now.dv_U + k.square * turned + k.fourth * twice);
    move(state, step, now.dt_s, gravity_, earth_turns_, displacement - 0.5 * now.dt_s * step.dv_start_U);
    return step;
  }
  void leave_out(const StrapdownOmissions& omissions) override {
    check_has_no_coning(omissions);
    earth_turns_ = !omissions.earth_rate;
  }

 private:
  /// (1 - cos a) / a^2, (a - sin a) / a^3, (a^2 / 2 - 1 + cos a) / a^4.
  struct Factors {
    double velocity, square, fourth;
    explicit Factors(double a) {
      const double a2 = a * a;
      const double half = a > 0.0 ? std::sin(0.5 * a) / (0.5 * a) : 1.0;
      velocity = 0.5 * half * half;  // without cancellation
      if (a < 0.1) {                 // series; the first terms left out are below 1e-15 of the sums
        square = (1.0 - a2 / 20.0 * (1.0 - a2 / 42.0 * (1.0 - a2 / 72.0 * (1.0 - a2 / 110.0)))) / 6.0;
        fourth = (1.0 - a2 / 30.0 * (1.0 - a2 / 56.0 * (1.0 - a2 / 90.0 * (1.0 - a2 / 132.0)))) / 24.0;
      } else {
        square = (a - std::sin(a)) / (a2 * a);
        fourth = (0.5 - velocity) / a2;
      }
    }
  };
  GravityFunction gravity_;
  bool earth_turns_ = true;
};

}  // namespace

std::unique_ptr<Strapdown> make_constant_rate(GravityFunction gravity) {
  return std::make_unique<ConstantRate>(gravity);
}

}  // namespace canyon::fusion
