#include "canyon/core/motion/true_motion.h"

#include <array>
#include <vector>

#include "canyon/core/stress/subjects.h"
#include "canyon/core/stress_rows.h"

namespace canyon {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Worst;

/// Value and two derivatives of 0.5 s - 0.3 s^2 + 0.2 s^3 - 0.4 s^4 + 0.1 s^5.
std::array<double, 3> curve(double s) {
  return {s * (0.5 + s * (-0.3 + s * (0.2 + s * (-0.4 + s * 0.1)))),
          0.5 + s * (-0.6 + s * (0.6 + s * (-1.6 + s * 0.5))), -0.6 + s * (1.2 + s * (-4.8 + s * 2.0))};
}

/// 100 km from the origin and on by up to 100 km, while it turns about a fixed axis: both of fifth degree in time,
/// which the motion between two nodes is too.
struct QuinticCourse {
  double h, way_m;
  Vector3d from_W{-1e5, 7e4, 300.0}, along_W{0.6, -0.64, 0.48}, axis_B{0.36, 0.48, 0.8};

  explicit QuinticCourse(double duration_s) : h(duration_s), way_m(std::min(1e5, 30.0 * duration_s)) {}
  KinematicState at(GpsTime t, double s) const {
    const auto [value, first, second] = curve(s);
    KinematicState k;
    k.t = t;
    k.X_WB = {so3_exp(value * axis_B), from_W + way_m * value * along_W};
    k.v_WB_W = way_m * first / h * along_W;
    k.a_WB_W = way_m * second / (h * h) * along_W;
    k.w_WB_B = first / h * axis_B;
    k.alpha_WB_B = second / (h * h) * axis_B;
    return k;
  }
};

/// The differences that the coefficients are made of cancel to some four roundings e of the largest term, here the
/// distance from the origin and one radian. Coefficients 3 to 5 are 10, 15 and 6 of them at most, so that value, first
/// and second derivative with respect to s are wrong by up to 31, 120 and 360 e; h and h^2 make velocity and
/// acceleration of it. No other formula knows more: the nodes themselves are rounded so.
StressFigure over_one_step(std::int64_t step_ns) {
  const double h = 1e-9 * static_cast<double>(step_ns);
  const QuinticCourse course(h);
  const GpsTime start = GpsTime::from_week_sow(2160, 0.0), end{start.ns + step_ns};
  TrueMotion motion;
  motion.append(course.at(start, 0.0));
  motion.append(course.at(end, 1.0));
  Worst worst;
  motion.for_each_piece(start, end, [&](const TrueMotion::Piece& piece) {
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const KinematicState truth = course.at(start, 0.25 * static_cast<double>(i)), &found = piece[i];
      const double e_m = 4.0 * kEpsilon * 1.3e5, e_rad = 4.0 * kEpsilon;
      worst.look((found.X_WB.p - truth.X_WB.p).norm(), 31.0 * e_m);
      worst.look((found.v_WB_W - truth.v_WB_W).norm(), 120.0 * e_m / h);
      worst.look((found.a_WB_W - truth.a_WB_W).norm(), 360.0 * e_m / (h * h));
      worst.look(so3_log(found.X_WB.R.conjugate() * truth.X_WB.R).norm(), 31.0 * e_rad);
      worst.look((found.w_WB_B - truth.w_WB_B).norm(), 120.0 * e_rad / h);
      worst.look((found.alpha_WB_B - truth.alpha_WB_B).norm(), 360.0 * e_rad / (h * h));
    }
  });
  return worst.figure();
}

/// Asked for at a node it is the node to the bit, at any instant; and what is beside the known is refused.
StressFigure borders() {
  int wrong = 0;
  const QuinticCourse course(0.01);
  for (const std::int64_t base_ns : {std::int64_t{0}, (std::int64_t{1} << 31) * kNsPerSecond, std::int64_t{1} << 62}) {
    const GpsTime start{base_ns}, end{base_ns + 10'000'000};
    TrueMotion motion;
    wrong += stress::not_refused([&] { return motion.at(start); });
    motion.append(course.at(start, 0.0));
    wrong += stress::not_refused([&] { motion.append(course.at(start, 1.0)); });
    wrong += stress::not_refused([&] { motion.append(course.at({start.ns - 1}, 1.0)); });
    motion.append(course.at(end, 1.0));
    wrong += motion.at(start).X_WB.p == course.at(start, 0.0).X_WB.p ? 0 : 1;
    wrong += motion.at(end).v_WB_W == course.at(end, 1.0).v_WB_W ? 0 : 1;
    wrong += stress::not_refused([&] { return motion.at({start.ns - 1}); });
    wrong += stress::not_refused([&] { return motion.at({end.ns + 1}); });
    wrong += stress::not_refused([&] { motion.for_each_piece(start, start, [](const TrueMotion::Piece&) {}); });
  }
  return {1.0 * wrong, 0.0};
}

/// A turn of 1 rad and more between two nodes has more than one short way.
StressFigure fast_turns() {
  int wrong = 0;
  for (const double angle : {1.0001, 2.0, 3.14, 3.15, 6.0 - 3.0}) {
    KinematicState a, b;
    b.t.ns = 10'000'000;
    b.X_WB.R = so3_exp({0.0, 0.0, angle});
    TrueMotion motion;
    motion.append(a);
    wrong += stress::not_refused([&] { motion.append(b); });
  }
  return {1.0 * wrong, 0.0};
}

/// 2000 deg/s for one revolution in steps of 10 ms, then braked: rate and attitude are what they are between the nodes
/// too. The rate is constant, so phi is linear: 31 and 120 times four roundings of the angle.
StressFigure spin() {
  constexpr double kRate = 2000.0 * 0.017453292519943295;
  TrueMotion motion;
  for (int k = 0; k <= 18; ++k) {
    KinematicState s;
    s.t.ns = k * 10'000'000;
    s.X_WB.R = so3_exp({0.0, kRate * 0.01 * k, 0.0});
    s.w_WB_B = {0.0, kRate, 0.0};
    motion.append(s);
  }
  Worst worst;
  for (std::int64_t ns = 0; ns <= 180'000'000; ns += 777'777) {
    const KinematicState s = motion.at({ns});
    const Eigen::Quaterniond truth = so3_exp({0.0, kRate * 1e-9 * static_cast<double>(ns), 0.0});
    // Whole angles of up to a turn are in the nodes.
    const double e_rad = 4.0 * kEpsilon * 6.3;
    worst.look(so3_log(s.X_WB.R.conjugate() * truth).norm(), 31.0 * e_rad);
    worst.look((s.w_WB_B - Vector3d(0.0, kRate, 0.0)).norm(), 120.0 * e_rad / 0.01);
  }
  return worst.figure();
}

}  // namespace

std::vector<StressCase> true_motion_cases() {
  const StressMechanism tiny{
      StressGroup::kStiff, "difference quotients over tiny and long steps",
      "positions 100 km off are subtracted and divided by h^2: a term too many of them, or a step in the wrong unit",
      "a motion of fifth degree is met at five instants of the step to 31, 120 / h and 360 / h^2 times four roundings",
      "of the bound"};
  const StressMechanism border{
      StressGroup::kGeometry, "instants at and beside what is known",
      "equal times divide by zero, an instant beside the end is extrapolated by the fifth power",
      "a node is itself to the bit, beside the known is refused", "answers"};
  const StressMechanism turn{
      StressGroup::kGeometry, "a turn per step near its limit", "beyond half a turn the short way is the other one",
      "1 rad and more is refused; 2000 deg/s is followed within a step of 0.35 rad", "of the bound"};
  StressRows rows;
  for (const std::int64_t step_ns :
       {std::int64_t{1}, std::int64_t{1000}, std::int64_t{1'000'000}, std::int64_t{10'000'000}, kNsPerSecond,
        1000 * kNsPerSecond, 100'000 * kNsPerSecond})
    rows.of(tiny).add("true_motion/step_of_" + stress::text(1e-9 * static_cast<double>(step_ns)) + "_s",
                      [step_ns] { return over_one_step(step_ns); });
  rows.of(border).add("true_motion/instants_at_its_borders", borders);
  rows.of(turn).add("true_motion/turns_of_1_rad_are_refused", fast_turns);
  rows.of(turn).add("true_motion/2000_deg_s_at_100_hz", spin);
  return rows.take();
}

}  // namespace canyon
