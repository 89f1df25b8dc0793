#include <vector>

#include "canyon/core/earth/earth.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/inertial/motion/motion.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Worst;

struct Reached {
  ImuSample sample;
  IncrementAccuracy within;
};
Reached increments(const PlacedMotion& motion, double from_s, double to_s) {
  Reached out;
  out.sample = motion_increments(motion, from_s, to_s, &out.within);
  return out;
}

/// A circle of 1 mm at 100 m/s: 16 000 turns a second, a million g. Over a sample of 10 ms the turn about the vertical
/// is (v / r + the Earth's part) dt and the force to the centre v^2 / r + 2 w v, which do not change on the way; the
/// integrals are good to what the quadrature itself says, and that is near what rounding leaves of such terms (50
/// epsilons of them, and what an epsilon of the time turns in 1e5 rad/s).
StressFigure small_circle(double speed_m_s) {
  MotionConfig config;
  config.path = "circle";
  config.height_m = 0.0;  // where gravity is along the ellipsoid's normal
  config.radius_m = 0.001;
  config.speed_m_s = speed_m_s;
  const PlacedMotion motion = *make_motion(config, 1);
  const double dt_s = 0.01, rate = speed_m_s / config.radius_m, force = rate * speed_m_s;
  const double up = Wgs84::rate_rad_s * std::sin(config.lat_deg * kDegree);
  const auto [sample, within] = increments(motion, 0.0, dt_s);
  Worst worst;
  worst.look(sample.dtheta_U.z() - (rate + up) * dt_s, within.dtheta_rad + 2.0 * kEpsilon * rate * dt_s);
  // Gravity's own horizontal part, 2e-3 m from the origin of W at most, is g / r of that: below 4e-9 m/s^2.
  worst.look(sample.dv_U.y() - (force + 2.0 * up * speed_m_s) * dt_s,
             within.dv_m_s + 2.0 * kEpsilon * force * dt_s + 4e-9 * dt_s);
  worst.look(within.dtheta_rad, std::max(1e-12, 200.0 * kEpsilon * rate * dt_s));
  worst.look(within.dv_m_s, std::max(1e-12, (200.0 + 20.0 * rate * dt_s) * kEpsilon * force * dt_s));
  return worst.figure();
}

/// A cone of half angle a, one whole turn of it in two samples: about the body's own axis -(1 - cos a) of a turn, and
/// the Earth's rate that is along it on average, cos a of its vertical part. To the quadrature's word, which itself may
/// be no more than its tolerance, or 200 epsilons of the two turns that such a rate, 4 pi f at most, makes.
StressFigure coning(double cone_deg, double cone_hz) {
  MotionConfig config;
  config.path = "coning";
  config.cone_deg = cone_deg;
  config.cone_hz = cone_hz;
  const PlacedMotion motion = *make_motion(config, 1);
  const double period_s = 1.0 / cone_hz, c = std::cos(cone_deg * kDegree);
  const auto first = increments(motion, 0.0, 0.5 * period_s), second = increments(motion, 0.5 * period_s, period_s);
  const double up = Wgs84::rate_rad_s * std::sin(config.lat_deg * kDegree);
  const double exact = -(1.0 - c) * 2.0 * kPi + c * up * period_s;
  Worst worst;
  worst.look(first.sample.dtheta_U.z() + second.sample.dtheta_U.z() - exact,
             first.within.dtheta_rad + second.within.dtheta_rad + 8.0 * kEpsilon * 2.0 * kPi);
  for (const Reached& half : {first, second})
    worst.look(half.within.dtheta_rad, std::max(1e-12, 200.0 * kEpsilon * 2.0 * kPi));
  return worst.figure();
}

/// A shaker at 100 kHz and 10 000 g in samples of 5 ms, 500.5 periods each: A / w (cos(w t0) - cos(w t1)) along east,
/// and nothing of gravity or Coriolis that its 0.25 um could make.
StressFigure shaker() {
  MotionConfig config;
  config.heading_deg = 90.0;
  Sinusoid wave;
  wave.frequency_hz = 1e5;
  wave.acceleration_m_s2 = {1e5, 0.0, 0.0};
  wave.phase_deg = 0.0;
  config.vibration.sinusoid = {wave};
  const PlacedMotion motion = *make_motion(config, 1);
  const double w = 2.0 * kPi * wave.frequency_hz, from_s = 0.0, to_s = 0.005005;
  const auto [sample, within] = increments(motion, from_s, to_s);
  const double exact = 1e5 / w * (std::cos(w * from_s) - std::cos(w * to_s));
  // A panel of two turns is integrated to 1e-11 of its amplitude (motion/increments.cpp). Beside that 2 w_e x
  // displacement, 1.5e-4 rad/s times 5e-7 m, and of the phase of 3145 rad an epsilon of itself.
  const double rule = 1e-11 * 1e5 * to_s;
  return {std::abs(sample.dv_U.x() - exact), within.dv_m_s > 0.0 ? rule + 1e-10 + 4.0 * kEpsilon * to_s * 1e5 : 0.0};
}

/// At rest: as much rate as the Earth has, as much force as gravity has there, at the angle between them. To the
/// quadrature's word, which is its tolerance at most where nothing changes, and to ten roundings of the place for the
/// direction.
StressFigure rest(double lat_deg, double lon_deg, double height_m, double pitch_deg, double roll_deg) {
  MotionConfig config;
  config.lat_deg = lat_deg;
  config.lon_deg = lon_deg;
  config.height_m = height_m;
  config.heading_deg = 123.0;
  config.pitch_deg = pitch_deg;
  config.roll_deg = roll_deg;
  const PlacedMotion motion = *make_motion(config, 1);
  const double dt_s = 0.01;
  const auto [sample, within] = increments(motion, 5.0, 5.0 + dt_s);
  const double length_s = sample.dt_s;
  const Vector3d g_E = gravity_E(ecef_from_geodetic({lat_deg * kDegree, lon_deg * kDegree, height_m}));
  const double round = 10.0 * kEpsilon;
  Worst worst;
  worst.look(sample.dtheta_U.norm() - Wgs84::rate_rad_s * length_s, within.dtheta_rad + round * 1e-6);
  worst.look(sample.dv_U.norm() - g_E.norm() * length_s, within.dv_m_s + round * 0.1);
  const double along = -earth_rate_E().dot(g_E) * length_s * length_s;
  worst.look(sample.dtheta_U.dot(sample.dv_U) - along,
             within.dtheta_rad * 0.1 + within.dv_m_s * 1e-6 + 2.0 * round * 1e-7);
  worst.look(within.dtheta_rad, 1e-12);
  worst.look(within.dv_m_s, 1e-12);
  return worst.figure();
}

/// A whole number of rounds later the same increments come out: to both quadratures' word, in which an epsilon of the
/// time counts as it turns and accelerates the body; with less than 1 rad/s and 12 m/s^2, and eight such epsilons, the
/// word itself has its limit.
StressFigure rounds_later(double later_s) {
  MotionConfig config;
  config.path = "figure_eight";
  config.period_s = 64.0;
  config.climb_m = 3.0;
  config.sway_deg = 5.0;
  const PlacedMotion motion = *make_motion(config, 1);
  Worst worst;
  for (const double t_s : {0.5, 7.25, 16.0, 40.125}) {
    const auto early = increments(motion, t_s, t_s + 0.0078125);
    const auto late = increments(motion, t_s + later_s, t_s + later_s + 0.0078125);
    const double moment_s = 8.0 * kEpsilon * (t_s + later_s);
    for (const Reached& one : {early, late}) {
      worst.look(one.within.dtheta_rad, 1e-12 + moment_s * 1.0);
      worst.look(one.within.dv_m_s, 1e-12 + moment_s * 12.0);
    }
    worst.look((late.sample.dtheta_U - early.sample.dtheta_U).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(),
               early.within.dtheta_rad + late.within.dtheta_rad);
    worst.look((late.sample.dv_U - early.sample.dv_U).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(),
               early.within.dv_m_s + late.within.dv_m_s);
  }
  return worst.figure();
}

}  // namespace

std::vector<StressCase> increment_cases() {
  const StressMechanism fast{StressGroup::kStiff, "a tolerance below rounding",
                             "an absolute tolerance of 1e-12 is below an epsilon of 1e5 m/s: every interval is halved "
                             "without end (2026-11-22: "
                             "it did not end, nor heed Ctrl-C)",
                             "the closed form, to what the quadrature says that it has reached", "of the bound"};
  const StressMechanism cone{
      StressGroup::kStiff, "coning of a whole turn within two samples",
      "sums of rotation vectors instead of rates lose the cone's own turn, or find it twice",
      "-(1 - cos a) of a turn about the body's axis and the Earth's part, to the quadrature's word", "of the bound"};
  StressMechanism shake{StressGroup::kStiff, "500 periods of a vibration within a sample",
                        "too few points see another, slow vibration",
                        "A / w times the difference of cosines, to 1e-11 of the amplitude over the sample", "m/s"};
  shake.loose = "the bound adds the magnitudes of 256 panels' errors, which alternate and cancel";
  const StressMechanism place{StressGroup::kGeometry, "an attitude or place where angles are undefined",
                              "heading at a pole, yaw and roll at a pitch of 90 degrees, a height below the ellipsoid",
                              "the Earth's rate, gravity and the angle between them, to the quadrature's word",
                              "of the bound"};
  const StressMechanism late{
      StressGroup::kLong, "the time since the start in a phase", "a phase of 1e6 rad has lost ten digits",
      "the increments of a round that is the same, to the quadrature's word for each", "of the bound"};
  StressRows rows;
  for (const double speed_m_s : {0.1, 10.0, 100.0})
    rows.of(fast).add("increments/circle_of_1_mm_at_" + stress::text(speed_m_s) + "_m_s",
                      [=] { return small_circle(speed_m_s); });
  rows.of(cone).add("increments/coning_90_deg_50_hz", [] { return coning(90.0, 50.0); });
  rows.of(cone).add("increments/coning_179_deg_1000_hz", [] { return coning(179.0, 1000.0); });
  rows.of(shake).add("increments/shaker_100_khz_10000_g", shaker);
  rows.of(place).add("increments/rest_at_the_north_pole", [] { return rest(90, 0, 0, 0, 0); });
  rows.of(place).add("increments/rest_at_the_south_pole_400_m_below", [] { return rest(-90, 180, -400, 0, 0); });
  rows.of(place).add("increments/rest_at_the_antimeridian_20_km_up", [] { return rest(-17, -180, 20000, 0, 180); });
  rows.of(place).add("increments/rest_nose_down", [] { return rest(45, 10, 100, 90, 30); });
  rows.of(place).add("increments/rest_nose_up", [] { return rest(45, 10, 100, -90, -150); });
  for (const double rounds : {1000.0, 100000.0})
    rows.of(late).add("increments/" + stress::text(rounds * 64.0) + "_s_after_the_start",
                      [=] { return rounds_later(rounds * 64.0); });
  return rows.take();
}

}  // namespace canyon::inertial
