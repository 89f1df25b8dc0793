#include "canyon/study/dead_reckoning/dead_reckoning.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "canyon/core/earth/gravity.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"

namespace canyon::study {

DeadReckoning dead_reckon(ImuRecording recording, const Reference& reference, const std::string& integrator,
                          const std::string& gravity) {
  DeadReckoning out;
  out.recording = std::move(recording);
  out.integrator = integrator;
  out.gravity = gravity;
  const auto strapdown = fusion::make_strapdown(integrator, gravity_by_name(gravity));
  out.states = fusion::dead_reckon(out.recording.samples, reference.initial, *strapdown);
  out.errors = fusion::navigation_errors(out.states, reference.truth);
  out.held = fusion::held_errors(out.states, out.errors);
  out.statistics = fusion::navigation_error_statistics(out.errors);
  out.held_ones = fusion::navigation_error_statistics(out.held_errors());
  return out;
}

Unscored unscored(const DeadReckoning& o) {
  const ImuSample& first = o.recording.samples.front();
  return {std::max(0.0, o.errors.front().t - (first.t - first.dt_s)),
          std::max(0.0, o.recording.samples.back().t - o.errors.back().t)};
}

std::string rounding_reason(const DeadReckoning& o) {
  std::string text =
      "free inertial height is unstable, and what arithmetic rounds grows as e^(t / 570 s): from then on it may be "
      "larger than the error that is asked for";
  if (!std::isfinite(o.held.rounding_m)) return text;
  char at_the_end[40];
  std::snprintf(at_the_end, sizeof at_the_end, ", at the end %.2g m", o.held.rounding_m);
  return text + at_the_end;
}

PlainIntegrals::PlainIntegrals(const DeadReckoning& o) {
  constexpr std::size_t kSamplesPerLook = 4096;  // at whether the user wants to stop
  Eigen::Vector3d angle = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < o.recording.samples.size(); ++k) {
    if (k % kSamplesPerLook == 0) throw_if_cancelled();
    const ImuSample& s = o.recording.samples[k];
    if (s.t <= o.states.front().t) continue;
    t_s.push_back(s.t - o.states.front().t);
    angle += s.dtheta_U / kDegree;
    for (int i = 0; i < 3; ++i) {
      rate_deg_s[i].push_back(s.dtheta_U[i] / s.dt_s / kDegree);
      angle_deg[i].push_back(angle[i]);
    }
  }
}

}  // namespace canyon::study
