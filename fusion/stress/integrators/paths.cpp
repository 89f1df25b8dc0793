// A path by each integrator, to the order that its table says.
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/earth/earth.h"
#include "canyon/core/earth/local_frame.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/fusion/dead_reckoning.h"
#include "canyon/fusion/strapdown.h"
#include "canyon/fusion/stress/integrators/subjects.h"

namespace canyon::fusion {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using stress::kInfinity;
using stress::Looks;

/// A body on a tight eight with waves of height, that turns about all of its axes on the way: nine seconds a round, in
/// closed form, on the turning Earth.
struct Eight {
  static constexpr double kRate = 2.0 * kPi / 9.0;
  LocalFrame frame{Geodetic{50.0 * kDegree, 7.0 * kDegree, 200.0}};
  Vector3d earth_W = frame.R_EW().transpose() * earth_rate_E();
  GpsTime start = GpsTime::from_week_sow(1590, 1000.0);

  static Vector3d way(double t, int derivative) {
    const double u = kRate * t, r = std::pow(kRate, derivative), r2 = std::pow(2.0 * kRate, derivative);
    const double turned = 0.5 * kPi * derivative;  // each derivative of a sine is a quarter further
    return {30.0 * r * std::sin(u + turned), 15.0 * r2 * std::sin(2.0 * u + turned),
            3.0 * r2 * std::sin(2.0 * u + 0.7 + turned)};
  }
  /// Yaw, pitch and roll, or their rates.
  static Vector3d angles(double t) {
    const double u = kRate * t;
    return {0.8 * u + 0.3 * std::sin(2.0 * u), 0.2 * std::sin(3.0 * u + 0.4), 0.6 * std::sin(2.0 * u)};
  }
  static Vector3d angle_rates(double t) {
    const double u = kRate * t;
    return kRate * Vector3d(0.8 + 0.6 * std::cos(2.0 * u), 0.6 * std::cos(3.0 * u + 0.4), 1.2 * std::cos(2.0 * u));
  }
  static Quaterniond attitude(double t) {
    const Vector3d a = angles(t);
    return rotation_from({.yaw_rad = a.x(), .pitch_rad = a.y(), .roll_rad = a.z()});
  }
  Vector3d rate_U(double t) const {
    const Vector3d a = angles(t), d = angle_rates(t);
    const double sp = std::sin(a.y()), cp = std::cos(a.y()), sr = std::sin(a.z()), cr = std::cos(a.z());
    return Vector3d(d.z() - d.x() * sp, d.y() * cr + d.x() * cp * sr, -d.y() * sr + d.x() * cp * cr) +
           attitude(t).conjugate() * earth_W;
  }
  Vector3d force_U(double t) const {
    const Vector3d gravity_W = frame.R_EW().transpose() * gravity_E(frame.to_E(way(t, 0)));
    return attitude(t).conjugate() * (way(t, 2) + 2.0 * earth_W.cross(way(t, 1)) - gravity_W);
  }
  NavState at(double t) const {
    NavState out;
    out.t = start + t;
    out.R_EU = (Quaterniond(frame.R_EW()) * attitude(t)).normalized();
    out.p_EU_E = frame.to_E(way(t, 0)), out.v_EU_E = frame.R_EW() * way(t, 1);
    return out;
  }
  /// Integrals by Simpson's rule over 64 parts of at most 0.1 s: (w h / 64)^4, 1e-13.
  ImuSample sample(double from, double to) const {
    ImuSample out;
    out.t = start + to, out.dt_s = to - from;
    constexpr int kParts = 64;
    for (int i = 0; i <= 2 * kParts; ++i) {
      const double t = from + (to - from) * i / (2.0 * kParts);
      const double weight = (i == 0 || i == 2 * kParts ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) * (to - from) / (6.0 * kParts);
      out.dtheta_U += weight * rate_U(t), out.dv_U += weight * force_U(t);
    }
    return out;
  }
};

/// An eight over ten seconds, exact increments, the integrator looking back beyond the start: errors of place, velocity
/// and attitude at its end fall with the interval to the power that the table says of them, but for 0.35 that the next
/// power still has.
StressFigure order_on_a_path(const StrapdownRow& row) {
  Looks looks;
  const Eight motion;
  struct Off {
    double place, speed, turn;
  };
  const auto off = [&](double dt_s) -> Off {
    std::vector<ImuSample> samples;
    const int before = 4, steps = static_cast<int>(std::lround(9.6 / dt_s));
    for (int k = 0; k < steps + before; ++k)
      samples.push_back(motion.sample(0.8 + (k - before) * dt_s, 0.8 + (k + 1 - before) * dt_s));
    const auto states = dead_reckon(samples, motion.at(0.8), *make_strapdown(row.name));
    const NavState end = motion.at(0.8 + 9.6), &found = states.back();
    looks.right(states.size() == static_cast<std::size_t>(steps) + 1);
    return {(found.p_EU_E - end.p_EU_E).norm(), (found.v_EU_E - end.v_EU_E).norm(),
            so3_log(end.R_EU.conjugate() * found.R_EU).norm()};
  };
  const Off whole = off(0.1), half = off(0.05);
  if (!row.order) return {kInfinity, 1.0};
  const auto fell = [](double a, double b) { return std::log2(a / b); };
  looks.near(beyond(*row.order, fell(whole.place, half.place)), 0.0, 0.35);
  looks.near(beyond(row.make.velocity_order, fell(whole.speed, half.speed)), 0.0, 0.35);
  looks.near(beyond(row.make.attitude_order, fell(whole.turn, half.turn)), 0.0, 0.35);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> integrator_path_cases() {
  StressRows rows;
  rows.of({StressGroup::kStiff, "a path by each integrator",
           "gravity, Coriolis or place to a lower order than the table says",
           "errors at the end of a tight eight fall by the table's orders, to 0.35", "of the bound"});
  for (const StrapdownRow& row : strapdown_models())
    rows.add(std::string("integrators/path_by_") + row.name, [&row] { return order_on_a_path(row); });
  return rows.take();
}

}  // namespace canyon::fusion
