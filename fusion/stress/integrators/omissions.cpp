// What each integrator may leave out, beside what its effects say of a step.
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/earth/earth.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/fusion/strapdown.h"
#include "canyon/fusion/stress/integrators/subjects.h"

namespace canyon::fusion {
namespace {

using stress::kEpsilon;
using stress::Looks;

/// What a row leaves out is what its effect says of the step, to second order of the turns, w_e dt beside |dtheta|; the
/// Earth's turn left out leaves a body in axes that stand still.
StressFigure left_out() {
  Looks looks;
  const RandomStream draws(8, "stress.integrators");
  int told = 0;
  for (const StrapdownRow& row : strapdown_models()) {
    if (row.make.effects == nullptr) {
      looks.right(stress::not_refused([&] { make_strapdown(row.name)->leave_out({.earth_rate = true}); }) == 0);
      continue;
    }
    for (const StrapdownEffect& effect : row.make.effects()) {
      ++told;
      const bool coning = std::string(effect.name) == kConing;
      for (std::uint64_t k = 0; k < 20; ++k) {
        const double dt = draws.uniform(0.004, 0.02, 0, k), dt_before = draws.uniform(0.004, 0.02, 1, k);
        NavState start;
        start.R_EU = so3_exp(draws.normal3(k, 2)), start.v_EU_E = 20.0 * draws.normal3(k, 3);
        start.p_EU_E = ecef_from_geodetic({0.7, 0.2, 100.0});
        const Increments before{
            .dt_s = dt_before, .dtheta_U = 0.01 * draws.normal3(k, 4), .dv_U = 0.1 * draws.normal3(k, 5)},
            in{.dt_s = dt, .dtheta_U = 0.01 * draws.normal3(k, 6), .dv_U = 0.1 * draws.normal3(k, 7)};
        const auto with = make_strapdown(row.name), without = make_strapdown(row.name);
        without->leave_out({.coning = coning, .earth_rate = !coning});
        NavState scratch = start, a = start, b = start;
        with->advance(scratch, before), without->advance(scratch = start, before);
        with->advance(a, in), without->advance(b, in);
        const StepMove move = effect.of_step({.dt_s = dt,
                                              .dt_before_s = dt_before,
                                              .dtheta_U = in.dtheta_U,
                                              .dv_U = in.dv_U,
                                              .dtheta_before_U = before.dtheta_U,
                                              .dv_before_U = before.dv_U,
                                              .R_EU = start.R_EU.toRotationMatrix(),
                                              .v_EU_E = start.v_EU_E});
        // Second order: the effect times the turn of the step, and an epsilon of attitude and of the Earth's radius.
        const double second = in.dtheta_U.norm() + before.dtheta_U.norm();
        looks.near((so3_log(b.R_EU.conjugate() * a.R_EU) - move.theta_U).norm(), 0.0,
                   2.0 * move.theta_U.norm() * second + 4.0 * kEpsilon);
        looks.near((a.v_EU_E - b.v_EU_E - move.v_E).norm(), 0.0,
                   2.0 * move.v_E.norm() * second + 64.0 * kEpsilon * 50.0);
        looks.near((a.p_EU_E - b.p_EU_E - move.p_E).norm(), 0.0, move.p_E.norm() * second + 2.0 * kEpsilon * 6.4e6);
        looks.right(a.t == b.t);
        if (coning)
          looks.near(effect.of_step({.dt_s = dt, .dtheta_U = in.dtheta_U, .dv_U = in.dv_U}).theta_U.norm(), 0.0,
                     1e-300);
      }
      const ImuNoise noise{.gyro = {.white_per_sqrt_hz = 3e-5}, .accel = {}};
      const Need need = strapdown_need(effect, 0.02, 500.0, noise);
      looks.near(need.bound / ((0.02 + 1e-9) / 500.0 * 3600.0 * 180.0 / kPi), 1.0, 1e-12);
      looks.right(need.effect == effect.name && need.verdict == Verdict::kNotNeeded && need.bound_unit == "deg/h");
      char noise_text[40];
      std::snprintf(noise_text, sizeof noise_text, "noise by %.2g", 3e-5 / std::sqrt(500.0) * 3600.0 * 180.0 / kPi);
      looks.right(need.reason.find(noise_text) != std::string::npos);
      const StrapdownOmissions out = strapdown_omissions_of({need});
      looks.right(out.coning == coning && out.earth_rate == !coning && out.any());
      Need needed = need;
      needed.verdict = Verdict::kNeeded;
      looks.right(!strapdown_omissions_of({needed}).any());
    }
    if (std::string(row.name) != "two_sample")
      looks.right(stress::not_refused([&] { make_strapdown(row.name)->leave_out({.coning = true}); }) == 0);
  }
  looks.right(told == 5);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> omission_cases() {
  StressRows rows;
  rows.of({StressGroup::kStiff, "what an integrator leaves out", "an effect of the other sign, or of half the step",
           "what the effect says of the step, to second order", "of the bound"});
  rows.add("integrators/left_out", left_out);
  return rows.take();
}

}  // namespace canyon::fusion
