#pragma once

namespace canyon::mission {

/// How a rear axle moves sideways under linear tyres. Its load share m feels the side force F, to the left,
///   m (v' + s w) = F = -m / k (v / s),
/// with v the sideways velocity (left positive), s the forward speed and w the yaw rate: v' + s w is the axle's lateral
/// acceleration, v / s its slip, and 1 / k = g times the tyre's cornering coefficient C / (m g). So the slip is -k
/// times the lateral acceleration, at every instant; on a steady circle v = -k s (s w), and what a change leaves fades
/// within k s seconds. Rajamani, Vehicle Dynamics and Control, 2nd ed. 2012, section 2.3; Gillespie, Fundamentals of
/// Vehicle Dynamics, 1992, chapter 6. That the rear axle moves as a mass of its own is exact for a yaw inertia of the
/// mass times the distances of both axles from its centre, as it nearly is for cars.
///
/// The yaw rate is given: front tyres that yield as much as the rear ones make a neutral vehicle, which turns as it is
/// steered. Valid for what a tyre can hold: s w counts as far as it makes a slip of kLargestSlip, and not beyond.
class SideSlip {
 public:
  static constexpr double kLargestSlip = 0.2;  ///< 11 degrees; a tyre's force stops growing before

  /// Over one step, tau from its beginning: the polynomial of third degree that meets velocity and acceleration of both
  /// ends, so that velocities are exact derivatives of places.
  struct Motion {
    double v_0 = 0.0, a_0 = 0.0, c_2 = 0.0, c_3 = 0.0;
    double velocity(double tau) const { return v_0 + (a_0 + (c_2 + c_3 * tau) * tau) * tau; }
    double acceleration(double tau) const { return a_0 + (2.0 * c_2 + 3.0 * c_3 * tau) * tau; }
  };
  /// What the vehicle does at an instant.
  struct Drive {
    double speed_m_s;     ///< s >= 0
    double turning_m_s2;  ///< s w
  };

  /// Slip per lateral acceleration, k, rad s^2/m (>= 0); 0: none. Without sideways motion.
  explicit SideSlip(double compliance_rad_s2_m);

  bool yields() const { return k_ > 0.0; }
  /// Goes on by dt_s > 0 and says how: Radau's method IIA of third order, damped at any speed however short k s is, and
  /// exact at the end in what the law says of v'.
  Motion advance(const Drive& at_third, const Drive& at_end, double dt_s);
  /// Where the last step has ended, to go on from.
  Motion now() const { return {.v_0 = v_, .a_0 = a_}; }
  /// Stands still.
  void stop() { v_ = a_ = 0.0; }

 private:
  double k_;
  double v_ = 0.0, a_ = 0.0;
};

}  // namespace canyon::mission
