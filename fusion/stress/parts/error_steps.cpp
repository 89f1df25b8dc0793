// The step of errors beside differences of the step itself.
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/earth/earth.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/stress/looks.h"
#include "canyon/fusion/propagation/step_jacobian.h"
#include "canyon/fusion/strapdown.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/stress/drawn_numbers.h"
#include "canyon/fusion/stress/parts/subjects.h"

namespace canyon::fusion {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Looks;

/// One step of errors against differences of the step itself, state by state and for each error of the unit: at rest
/// over `dt_s`, where only the Earth turns, to what the differences round and the cube of its turn, and gravity's
/// gradient to a part in 1e4; and in a bend, to the square of the turn within the step.
StressFigure linearized(double dt_s, double turn_rad) {
  Looks looks;
  DrawnNumbers draw(9);
  NavState before = resting_at(48.0, 11.0, 300.0);
  before.v_EU_E = turn_rad > 0.0 ? Vector3d(30.0, -20.0, 10.0) : Vector3d(0.0, 0.0, 0.0);
  Calibration imu;
  imu.gyro_bias = 1e-3 * draw.three(), imu.accel_bias = 1e-2 * draw.three();
  imu.set_gains(0.02 * draw.any(3, 3), 0.02 * draw.any(3, 3));
  Increments in = rest_increments(before, dt_s);
  in.dtheta_U += turn_rad * Vector3d(0.6, -0.48, 0.64);
  if (turn_rad > 0.0) in.dv_U += dt_s * Vector3d(3.0, -4.0, 1.0);
  const Vector3d raw_turn = in.dtheta_U + imu.gyro_gain * in.dtheta_U + dt_s * imu.gyro_bias,
                 raw_push = in.dv_U + imu.accel_gain * in.dv_U + dt_s * imu.accel_bias;
  using Vector9 = Eigen::Matrix<double, 9, 1>;
  const auto after = [&](const Vector9& off, const Vector3d& gyro, const Vector3d& accel) {
    NavState s = before;
    s.R_EU = s.R_EU * so3_exp(off.head<3>());
    s.p_EU_E += off.segment<3>(3), s.v_EU_E += off.tail<3>();
    Calibration with = imu;
    with.gyro_bias += gyro, with.accel_bias += accel;
    make_strapdown("two_sample")->advance(s, with.apply(dt_s, raw_turn, raw_push));
    return s;
  };
  const auto slope = [&](const Vector9& off, const Vector3d& gyro, const Vector3d& accel, double by) -> Vector9 {
    const NavState up = after(off, gyro, accel), down = after(-off, -gyro, -accel);
    Vector9 out;
    out << so3_log(down.R_EU.conjugate() * up.R_EU), up.p_EU_E - down.p_EU_E, up.v_EU_E - down.v_EU_E;
    return out / (2.0 * by);
  };
  const StepJacobian J(before, in, imu, gravity_gradient_E(before.p_EU_E));
  looks.right(J.dt_s == dt_s);
  const double earth = 7.3e-5 * dt_s;
  // What is left out of theta is nothing; of v and p the square of the turn in the step, and the Earth's cube and its
  // product with the turn; differences leave the square of their angle, and of a place what gravity's gradient, itself
  // a difference, is good to. Places round by an epsilon of the Earth's radius, attitudes and speeds by theirs.
  const auto look = [&](const Vector9& found, const Vector9& expected, double by, double differences, double beside) {
    for (int block = 0; block < 3; ++block) {
      const double size = expected.segment<3>(3 * block).norm();
      const double order = block == 0 ? 0.0 : turn_rad * turn_rad + earth * turn_rad + earth * earth * earth;
      const double rounded = (block == 1 ? 4.0 * 6.4e6 : block == 2 ? 200.0 : 8.0) * kEpsilon / by;
      looks.near((found.segment<3>(3 * block) - expected.segment<3>(3 * block)).norm(), 0.0,
                 size * (order + differences) + rounded + (block == 0 ? 0.0 : beside));
    }
  };
  const double h = dt_s;
  for (int j = 0; j < 9; ++j) {
    const Vector9 unit = Vector9::Unit(j);
    const double by = j < 3 ? 1e-4 : 100.0;
    Vector9 expected;
    expected.head<3>() = J.theta_theta * unit.head<3>();
    expected.tail<3>() = J.v_theta * unit.head<3>() + J.v_p * unit.segment<3>(3) + J.v_v * unit.tail<3>();
    expected.segment<3>(3) = unit.segment<3>(3) + 0.5 * h * (unit.tail<3>() + expected.tail<3>());
    look(slope(by * unit, Vector3d::Zero(), Vector3d::Zero(), by), expected, by,
         j < 3   ? 2e-8
         : j < 6 ? 1e-4
                 : 3e-10,
         0.0);
  }
  for (int j = 0; j < 6; ++j) {
    const Vector3d gyro = j < 3 ? Vector3d(Vector3d::Unit(j)) : Vector3d(Vector3d::Zero()),
                   accel = j < 3 ? Vector3d(Vector3d::Zero()) : Vector3d(Vector3d::Unit(j - 3));
    const double by = j < 3 ? 1e-4 / h : 0.1;
    // Constant over the step: integrals e h, e h^2 / 2, e h^3 / 6.
    Vector9 expected;
    expected.head<3>() = J.theta_gyro * gyro * h;
    expected.tail<3>() = J.v_accel * accel * h + J.v_gyro * gyro * (0.5 * h * h);
    // The step's own place is the trapezoid of speeds.
    expected.segment<3>(3) = 0.5 * h * expected.tail<3>();
    // A turn within the step turns the force by its own square too: of half the force the first order has two thirds of
    // the turn, whatever part of it lies across the axis.
    const double squared = j < 3 ? 2.0 / 3.0 * (turn_rad + earth) * 0.55 * h * in.dv_U.norm() : 0.0;
    look(slope(Vector9::Zero(), by * gyro, by * accel, by), expected, by, j < 3 ? 2e-8 : 2e-9, squared);
  }
  // In axes that stand still.
  const StepJacobian still(before.R_EU, in, imu);
  looks.right(still.v_v == StepJacobian::Matrix::Identity() && still.v_p == StepJacobian::Matrix::Zero() &&
              still.dt_s == dt_s);
  looks.near((still.theta_theta - J.theta_theta).norm() + (still.theta_gyro - J.theta_gyro).norm(), 0.0, 1e-300);
  const double scale = still.v_theta.norm() + still.v_accel.norm() + still.v_gyro.norm();
  looks.near((still.v_theta - J.v_theta).norm() + (still.v_accel - J.v_accel).norm() + (still.v_gyro - J.v_gyro).norm(),
             0.0, 2.0 * earth * scale);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> error_step_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "the step of errors", "a term of the Earth's turn, of a gain or of half a step",
           "differences of the step itself: its square, and roundings", "of the bound"});
  rows.add("states/step_at_rest", [] { return linearized(1.0, 0.0); }).add("states/step_in_a_bend", [] {
    return linearized(0.02, 0.004);
  });
  return rows.take();
}

}  // namespace canyon::fusion
