#include "canyon/mission/motion/side_slip.h"

#include <algorithm>

#include "canyon/core/check.h"

namespace canyon::mission {

SideSlip::SideSlip(double compliance_rad_s2_m) : k_(compliance_rad_s2_m) {
  CANYON_CHECK(k_ >= 0.0, "compliance = ", k_);
}

SideSlip::Motion SideSlip::advance(const Drive& at_third, const Drive& at_end, double dt_s) {
  CANYON_CHECK(dt_s > 0.0 && at_third.speed_m_s >= 0.0 && at_end.speed_m_s >= 0.0, "dt_s = ", dt_s,
               ", speeds = ", at_third.speed_m_s, ", ", at_end.speed_m_s);
  // T v' = -(v + T u) with T = k s, at a third of the step and at its end, where v = v_0 + h A (v'_1, v'_2): two linear
  // equations, which are regular at rest too.
  constexpr double kA[2][2] = {{5.0 / 12.0, -1.0 / 12.0}, {3.0 / 4.0, 1.0 / 4.0}};
  const double T[2] = {k_ * at_third.speed_m_s, k_ * at_end.speed_m_s};
  const double most = kLargestSlip / k_;
  const double right[2] = {-(v_ + T[0] * std::clamp(at_third.turning_m_s2, -most, most)),
                           -(v_ + T[1] * std::clamp(at_end.turning_m_s2, -most, most))};
  const double m00 = T[0] + dt_s * kA[0][0], m01 = dt_s * kA[0][1], m10 = dt_s * kA[1][0], m11 = T[1] + dt_s * kA[1][1];
  const double determinant = m00 * m11 - m01 * m10;  // above h^2 / 6
  const double slope[2] = {(m11 * right[0] - m01 * right[1]) / determinant,
                           (m00 * right[1] - m10 * right[0]) / determinant};
  Motion step{.v_0 = v_, .a_0 = a_};
  v_ += dt_s * (kA[1][0] * slope[0] + kA[1][1] * slope[1]);
  a_ = slope[1];
  const double mean = (v_ - step.v_0) / dt_s;
  step.c_2 = (3.0 * mean - 2.0 * step.a_0 - a_) / dt_s;
  step.c_3 = (step.a_0 + a_ - 2.0 * mean) / (dt_s * dt_s);
  return step;
}

}  // namespace canyon::mission
