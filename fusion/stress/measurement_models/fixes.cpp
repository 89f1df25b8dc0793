// What fixes and their velocities count for, and what lasts of their errors.
#include <cmath>
#include <vector>

#include "canyon/core/earth/earth.h"
#include "canyon/core/stress/looks.h"
#include "canyon/fusion/states/fix_error.h"
#include "canyon/fusion/states/velocity_error.h"
#include "canyon/fusion/stress/measurement_models/seen_state.h"
#include "canyon/fusion/stress/measurement_models/subjects.h"

namespace canyon::fusion {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using stress::kInfinity;
using stress::Looks;

/// What a fix counts for by each rule, its floor, its age and its own velocity; and what a way leaves of errors that
/// last.
StressFigure fixes() {
  Looks looks;
  const struct {
    const char* keys;
    int kind;  // of what is below
  } rules[] = {{"", 0},
               {"fix_covariance = \"inflated\"", 1},
               {"fix_covariance = \"inflated\"\nfix_sigma_scale = 3", 2},
               {"fix_covariance = \"constant\"", 3},
               {"fix_covariance = \"constant\"\nfix_sigma_m = 0.7", 4},
               {"fix_covariance = \"from_dop\"", 5},
               {"fix_sigma_floor_m = 2", 6}};
  for (const auto& rule : rules) {
    SeenState seen({}, rule.keys);
    GnssFix fix = some_fix(seen);
    fix.dop.hdop = 1.4, fix.dop.vdop = 2.5;
    const Matrix3d stated = 0.5 * (fix.covariance_E + fix.covariance_E.transpose()),
                   R_EN = rotation_E_from_enu(geodetic_from_ecef(fix.p_A_E));
    Matrix3d expected = stated;
    if (rule.kind == 1) expected = 4.0 * stated;
    if (rule.kind == 2) expected = 9.0 * stated;
    if (rule.kind == 3) expected = 9.0 * Matrix3d::Identity();
    if (rule.kind == 4) expected = 0.49 * Matrix3d::Identity();
    if (rule.kind == 5) expected = 9.0 * R_EN * Vector3d(0.98, 0.98, 6.25).asDiagonal() * R_EN.transpose();
    if (rule.kind == 6)
      for (int i = 0; i < 3; ++i) expected(i, i) = stated(i, i) > 4.0 ? stated(i, i) : 4.0;
    const auto m = seen.model("position")->received(seen.view(), fix, 0);
    looks.near((m->R - expected).norm() / expected.norm(), 0.0, 1e-13);
    if (rule.kind == 5) {
      fix.dop.vdop = kNaN;
      looks.near((seen.model("position")->received(seen.view(), fix, 0)->R - stated).norm() / stated.norm(), 0.0,
                 1e-13);
    }
  }
  SeenState seen({"fix_error", "velocity_error", "time_offset"},
                 "fix_error_way_m = 40\nfix_velocity_scale = 2\nfix_velocity_floor_m_s = 0.3");
  seen.set("time_offset", Eigen::VectorXd::Constant(1, 0.02));
  seen.set("fix_error", Vector3d(0.3, -0.2, 0.1)), seen.set("velocity_error", Vector3d(0.5, 0.1, -0.4));
  GnssFix fix = some_fix(seen);
  fix.t = kThen + 0.05;
  fix.v_A_E = seen.state.nav.v_EU_E + Vector3d(0.1, 0.2, -0.3);
  DrawnNumbers draw(8);
  fix.velocity_covariance_E = 0.02 * draw.positive(3, 0.1);
  const auto position = seen.model("position"), velocity = seen.model("velocity");
  const auto p = position->received(seen.view(), fix, 0), v = velocity->received(seen.view(), fix, 0);
  if (!p || !v) return {kInfinity, 1.0};
  const FixErrorParameters lasting{.fix_error_sigma_m = 0.3, .fix_error_scale = 1.5};
  const double age = 0.07;
  const Matrix3d share = lasting.share(fix.covariance_E);
  looks.near((p->residual - (Vector3d(1.0, -2.0, 0.5) - age * seen.state.nav.v_EU_E - share * Vector3d(0.3, -0.2, 0.1)))
                 .norm(),
             0.0, 1e-8);
  looks.near((p->H.middleCols<3>(seen.state.offset("fix_error")) - share).norm(), 0.0, 1e-13);
  looks.near((p->H.col(seen.state.offset("time_offset")) - seen.state.nav.v_EU_E).norm(), 0.0, 1e-13);
  looks.right(p->motion.has_value() && p->motion->measured);
  looks.near(p->motion->speed_m_s, 8.0, 1e-12),
      looks.near((p->motion->residual_m_s - Vector3d(0.1, 0.2, -0.3)).norm(), 0.0, 1e-13);
  const Vector3d a = seen.state.nav.R_EU * seen.f + gravity_E(seen.state.nav.p_EU_E) -
                     2.0 * earth_rate_E().cross(seen.state.nav.v_EU_E);
  const Matrix3d root = VelocityErrorParameters{}.share(fix.velocity_covariance_E,
                                                        rotation_E_from_enu(geodetic_from_ecef(fix.p_A_E)).col(2));
  looks.near((v->residual - (Vector3d(0.1, 0.2, -0.3) - age * a - root * Vector3d(0.5, 0.1, -0.4))).norm(), 0.0, 1e-11);
  Matrix3d noise = 4.0 * 0.5 * (fix.velocity_covariance_E + fix.velocity_covariance_E.transpose());
  for (int i = 0; i < 3; ++i) noise(i, i) = noise(i, i) > 0.09 ? noise(i, i) : 0.09;
  looks.near((v->R - noise).norm(), 0.0, 1e-14);
  // Without a velocity there is none, and of unknown quality neither.
  GnssFix silent = fix;
  silent.velocity_covariance_E(1, 1) = kNaN;
  looks.right(!velocity->received(seen.view(), silent, 0) &&
              !position->received(seen.view(), silent, 0)->motion->measured);
  silent.v_A_E.setConstant(kNaN);
  looks.right(!velocity->received(seen.view(), silent, 0) &&
              position->received(seen.view(), silent, 0)->motion->residual_m_s.isZero(0.0));
  silent.status = FixStatus::kNone;
  looks.right(!position->received(seen.view(), silent, 0));
  SeenState plain({});
  GnssFix usual = fix;
  usual.velocity_covariance_E = 1e-6 * Matrix3d::Identity();
  looks.near((plain.model("velocity")->received(plain.view(), usual, 0)->R - 0.0025 * Matrix3d::Identity()).norm(), 0.0,
             1e-16);
  // The antenna's way between two fixes: first none, then e^(-way / 40 m); a rest changes nothing.
  looks.right(position->parts(seen.view(), fix) == 1 && position->renewed().empty());
  fix.t = fix.t + 2.5;
  position->parts(seen.view(), fix);
  looks.right(position->renewed().size() == 3);
  for (std::size_t i = 0; i < position->renewed().size(); ++i) {
    looks.right(position->renewed()[i].state == seen.state.offset("fix_error") + static_cast<int>(i));
    looks.near(position->renewed()[i].kept, std::exp(-2.5 * 8.0 / 40.0), 1e-12);
  }
  seen.state.nav.v_EU_E *= 1e-9;
  fix.t = fix.t + 2.5;
  position->parts(seen.view(), fix);
  looks.right(position->renewed().empty());
  position->parts(seen.view(), OdometerSample{});
  looks.right(position->renewed().empty());
  position->start();
  seen.state.nav.v_EU_E *= 1e9;
  fix.t = fix.t + 2.5;
  position->parts(seen.view(), fix);
  looks.right(position->renewed().empty());
  return looks.figure();
}

}  // namespace

std::vector<StressCase> measured_fix_cases() {
  StressRows rows = measured_rows();
  rows.add("measurement_models/fixes", fixes);
  return rows.take();
}

}  // namespace canyon::fusion
