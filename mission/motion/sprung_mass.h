#pragma once

namespace canyon::mission {

/// One sprung degree of freedom over a moving ground u(t), damped relative to the ground as a shock absorber is:
///   x'' = w^2 (u - x) + 2 zeta w (u' - x').
/// A ramp is followed without error, so x - u obeys the free equation between two nodes of u; its solution carries the
/// state over a step of any length exactly, whatever stiffness and damping (under, at or over the critical one). Where
/// the ground jumps, the damper's blow changes the velocity by 2 zeta w times the jump and leaves x.
class SprungMass {
 public:
  struct State {
    double x = 0.0, v = 0.0, a = 0.0;  ///< position, velocity, acceleration at the end of the last step
  };

  /// Undamped angular frequency, rad/s (> 0), and damping ratio (>= 0); at rest on the ground `u`.
  SprungMass(double w_rad_s, double damping, double u);

  /// Over dt_s > 0 the ground goes evenly from `u_begin` to `u_end`; a difference from the last step's u_end is a jump.
  const State& advance(double u_begin, double u_end, double dt_s);
  const State& advance(double u_end, double dt_s) { return advance(u_, u_end, dt_s); }
  const State& state() const { return state_; }

 private:
  double w_rad_s_, damping_, u_;
  State state_;
};

}  // namespace canyon::mission
