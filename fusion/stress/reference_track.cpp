// A reference between its states, against polynomials.
#include <cmath>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/stress/looks.h"
#include "canyon/fusion/reference_track.h"
#include "canyon/fusion/strapdown.h"
#include "canyon/fusion/stress/subjects.h"

namespace canyon::fusion {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Looks;

/// A reference whose velocity and turn are of fifth degree between its states: met exactly, and a position of the third
/// with velocities, of the fifth without them; nothing in a gap, and where a log may begin.
StressFigure references() {
  Looks looks;
  const GpsTime start = GpsTime::from_week_sow(1590, 100.0);
  const Vector3d origin(4e6, 1e6, 4.8e6), axis(0.36, 0.48, 0.8);
  const auto fifth = [](double s) {
    return 0.1 * s - 0.02 * s * s + 0.004 * std::pow(s, 3) - 3e-4 * std::pow(s, 4) + 1e-5 * std::pow(s, 5);
  };
  for (const bool with_velocity : {true, false}) {
    const auto at = [&](double s) {
      NavState n;
      n.t = start + s;
      n.R_EU = so3_exp(fifth(s) * axis);
      const double x = with_velocity ? s - 0.2 * s * s + 0.03 * s * s * s : 10.0 * fifth(s);
      n.p_EU_E = origin + x * Vector3d(1.0, -2.0, 0.5);
      n.v_EU_E = with_velocity ? Vector3d((1.0 - 0.4 * s + 0.09 * s * s) * Vector3d(1.0, -2.0, 0.5))
                               : Vector3d(Vector3d::Constant(kNaN));
      return n;
    };
    std::vector<NavState> reference;
    for (int k = 0; k <= 10; ++k)
      if (k != 8) reference.push_back(at(k));
    for (double s = 0.1; s < 6.9; s += 0.37) {
      const auto found = reference_at(reference, start + s);
      if (!found) return {kInfinity, 1.0};
      const NavState truth = at(s);
      // Weights of six states at the end of their span are some 10; ulps of 6e6 m.
      const double fade = s < 2.0 || s > 5.0 ? 0.0 : 1.0;
      looks.near((found->p_EU_E - truth.p_EU_E).norm(), 0.0,
                 32.0 * kEpsilon * 6.4e6 + (with_velocity || fade > 0.0 ? 0.0 : 1e-2));
      if (fade > 0.0) {
        looks.near(so3_log(found->R_EU.conjugate() * truth.R_EU).norm(), 0.0, 1e-13);
        if (with_velocity) looks.near((found->v_EU_E - truth.v_EU_E).norm(), 0.0, 1e-12);
      }
    }
    looks.right(!reference_at(reference, start + 7.5) && !reference_at(reference, start + 8.5));
    looks.right(!reference_at(reference, start - 0.1) && !reference_at(reference, start + 10.1));
    looks.right(reference_at(reference, start + 4.0)->p_EU_E == at(4.0).p_EU_E);
    std::vector<ImuSample> log;
    for (int k = 0; k < 900; ++k) {
      ImuSample s;
      s.t = start + (2.505 + 0.01 * k), s.dt_s = 0.01;
      log.push_back(s);
    }
    const auto common = first_common_state(reference, log);
    looks.right(common.has_value());
    if (common) looks.near(common->t - start, 2.495, 1e-9);
    for (ImuSample& s : log) s.t = s.t - 5.0;
    const auto first = first_common_state(reference, log);
    looks.right(first && first->t == start);
    const auto rest = reference_from(*reference_at(reference, start + 2.5), reference);
    looks.right(rest.size() == 8 && rest[1].t == start + 3.0);
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> reference_track_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "a reference between its states",
           .why = "a weight of another state, a gap bridged, a start that the log does not have",
           .expected = "polynomials up to the degree that it has, where six states are near: roundings of places",
           .unit = "of the bound"});
  rows.add("reference_track/between_states", references);
  return rows.take();
}

}  // namespace canyon::fusion
