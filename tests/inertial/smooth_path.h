#pragma once

#include <cmath>
#include <vector>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/time.h"
#include "canyon/core/truth.h"

namespace canyon::testing {

/// A drive in closed form with all its derivatives: at most 14.8 m/s and 24 deg/s, rolling, pitching and yawing at
/// once, smooth to every order. Yaw, pitch and roll are sines; so are the coordinates.
class SmoothPath {
 public:
  explicit SmoothPath(GpsTime start) : start_(start) {}

  GpsTime start() const { return start_; }

  KinematicState at(GpsTime t) const {
    KinematicState k = at(t - start_);
    k.t = t;
    return k;
  }
  KinematicState at(double s) const {
    const Sine x{100.0, 0.10, 0.0, s}, y{80.0, 0.13, 0.7, s}, z{3.0, 0.20, 0.2, s};
    const Sine yaw{1.3, 0.27, 0.3, s}, pitch{0.05, 1.1, 0.0, s}, roll{0.08, 0.9, 0.5, s};

    KinematicState k;
    k.X_WB.R = rotation_from({.yaw_rad = yaw.value(), .pitch_rad = pitch.value(), .roll_rad = roll.value()});
    k.X_WB.p = {x.value(), y.value(), z.value()};
    k.v_WB_W = {x.first(), y.first(), z.first()};
    k.a_WB_W = {x.second(), y.second(), z.second()};

    // Kinematic equation of R = Rz(yaw) Ry(pitch) Rx(roll), and its derivative.
    const double sp = std::sin(pitch.value()), cp = std::cos(pitch.value());
    const double sr = std::sin(roll.value()), cr = std::cos(roll.value());
    const double dy = yaw.first(), dp = pitch.first(), dr = roll.first();
    k.w_WB_B = {dr - dy * sp, dp * cr + dy * sr * cp, -dp * sr + dy * cr * cp};
    k.alpha_WB_B = {
        roll.second() - yaw.second() * sp - dy * dp * cp,
        pitch.second() * cr - dp * dr * sr + yaw.second() * sr * cp + dy * dr * cr * cp - dy * dp * sr * sp,
        -pitch.second() * sr - dp * dr * cr + yaw.second() * cr * cp - dy * dr * sr * cp - dy * dp * cr * sp};
    return k;
  }

  /// Nodes of sample k at that rate: `intervals` + 1 states over its interval.
  std::vector<KinematicState> nodes(std::int64_t k, double rate_hz, int intervals) const {
    std::vector<KinematicState> out;
    for (int i = 0; i <= intervals; ++i) {
      out.push_back(at(tick(start_, k * intervals + i, rate_hz * intervals)));
    }
    return out;
  }

 private:
  struct Sine {
    double amplitude, rate, phase, s;
    double value() const { return amplitude * std::sin(rate * s + phase); }
    double first() const { return amplitude * rate * std::cos(rate * s + phase); }
    double second() const { return -amplitude * rate * rate * std::sin(rate * s + phase); }
  };
  GpsTime start_;
};

}  // namespace canyon::testing
