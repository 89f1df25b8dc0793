// Places of a unit, an antenna and an axle on a body that turns, and lever arms that are estimated.
#include <cmath>
#include <optional>
#include <vector>

#include "canyon/core/earth/earth.h"
#include "canyon/core/earth/standard_atmosphere.h"
#include "canyon/core/stress/looks.h"
#include "canyon/fusion/stress/measurement_models/seen_state.h"
#include "canyon/fusion/stress/measurement_models/subjects.h"

namespace canyon::fusion {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using stress::Looks;

/// A place of the unit's own: points of a body that turns, from where it stands, and lever arms that are estimated.
StressFigure levers() {
  Looks looks;
  SeenState seen({"antenna_lever", "mounting", "hard_iron", "barometer_bias"});
  seen.lever_U = Vector3d(0.3, -0.2, 0.9), seen.lever_A = Vector3d(-1.0, 0.4, 1.6), seen.w = Vector3d(0.1, 0.3, -0.4);
  const Vector3d lever(0.05, -0.1, 0.2), mount(0.03, -0.02, 0.05);
  seen.set("antenna_lever", lever), seen.set("mounting", mount);
  seen.set("hard_iron", Vector3d(1.0, -2.0, 3.0)), seen.set("barometer_bias", Eigen::VectorXd::Constant(1, 12.0));
  const NavState& nav = seen.state.nav;
  const Vector3d arm = so3_exp(mount) * (seen.lever_A + lever - seen.lever_U);
  GnssFix fix = some_fix(seen);
  fix.v_A_E = Vector3d::Zero(), fix.velocity_covariance_E = Matrix3d::Identity();
  looks.near(
      (seen.model("position")->received(seen.view(), fix, 0)->residual - (fix.p_A_E - nav.p_EU_E - nav.R_EU * arm))
          .norm(),
      0.0, 1e-8);
  looks.near(
      (seen.model("velocity")->received(seen.view(), fix, 0)->residual + nav.v_EU_E + nav.R_EU * seen.w.cross(arm))
          .norm(),
      0.0, 1e-12);
  const auto compass =
      seen.model("magnetometer")->received(seen.view(), MagnetometerSample{kThen, Vector3d::Zero()}, 0);
  const Vector3d field_U = nav.R_EU.conjugate() * (kPlaceFrame.R_EW() * Vector3d(0.0, 25.0, -50.0 * std::sqrt(0.75)));
  looks.near((compass->residual + field_U + Vector3d(1.0, -2.0, 3.0)).norm(), 0.0, 1e-12);
  const auto air = seen.model("barometer")->received(seen.view(), BarometerSample{kThen, 90000.0}, 0);
  looks.near(air->residual[0], standard_height_m(90000.0) - geodetic_from_ecef(nav.p_EU_E).h_m - 12.0, 1e-8);
  // Heading is that of the body, not of the unit.
  const Matrix3d R_NB =
      kPlaceFrame.R_EW().transpose() * nav.R_EU.toRotationMatrix() * so3_exp(mount).toRotationMatrix();
  const auto heading = seen.model("heading")->received(seen.view(), HeadingSample{kThen, 0.0, 0.01}, 0);
  looks.near(std::remainder(heading->residual[0] + std::atan2(R_NB(0, 0), R_NB(1, 0)), 2.0 * kPi), 0.0, 1e-13);
  // And the axle's speed is along its axes.
  const auto axle_m = seen.model("non_holonomic");
  std::optional<Measurement> m;
  for (int k = 0; k < 20 && !m; ++k)
    m = axle_m->stepped(seen.view(), {.dt_s = 0.01, .dtheta_U = Vector3d::Zero(), .dv_U = Vector3d::Zero()});
  const Vector3d v_U = nav.R_EU.conjugate() * nav.v_EU_E + seen.w.cross(so3_exp(mount) * Vector3d(-seen.lever_U));
  looks.near((m->residual + (so3_exp(mount).conjugate() * v_U).tail<2>()).norm(), 0.0, 1e-13);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> lever_arm_cases() {
  StressRows rows = measured_rows();
  rows.add("measurement_models/levers", levers);
  return rows.take();
}

}  // namespace canyon::fusion
