#include "canyon/study/registration_error/response/estimate_errors.h"

#include <algorithm>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"

namespace canyon::study {
namespace {

Pose shifted(const ErrorLaid& on, double by_m) {
  return {on.X_WB_true.R, on.X_WB_true.p + by_m * on.direction_W};
}

Pose biased(const ErrorLaid& on) {
  return shifted(on, on.size);
}

Pose jumped(const ErrorLaid& on) {
  return shifted(on, on.since_s >= 0.0 ? on.size : 0.0);
}

Pose ramped(const ErrorLaid& on) {
  return shifted(on, on.size * std::max(0.0, on.since_s));
}

Pose noisy(const ErrorLaid& on) {
  if (on.since_s < 0.0) return on.X_WB_true;
  const RandomStream stream(on.seed, "study.estimate_errors");
  return shifted(on, on.size * stream.normal(static_cast<std::uint32_t>(on.axis), on.keyframe));
}

Pose late(const ErrorLaid& on) {
  return on.true_pose(on.t - on.size);
}

Pose turned(const ErrorLaid& on) {
  if (on.since_s < 0.0) return on.X_WB_true;
  const Eigen::Vector3d axis_B = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(on.axis));
  return {(on.X_WB_true.R * so3_exp(on.size * kDegree * axis_B)).normalized(), on.X_WB_true.p};
}

std::vector<double> metres() {
  return {0.3, 1.0, 3.0, 10.0};
}
std::vector<double> metres_per_second() {
  return {0.03, 0.1, 0.3, 1.0};
}
std::vector<double> delays() {
  return {0.02, 0.05, 0.1, 0.3};
}
std::vector<double> angles() {
  return {0.3, 1.0, 3.0, 10.0};
}

}  // namespace

ModelTable<EstimateErrorKind> estimate_errors() {
  static constexpr ModelRow<EstimateErrorKind> kRows[] = {
      {"bias_m", {biased, false, true, metres}, "off by this from before the place on: the map begins with it"},
      {"jump_m",
       {jumped, false, true, metres},
       "corrected by this at the place's beginning, and off by it from then on"},
      {"ramp_m_s", {ramped, true, true, metres_per_second}, "drifts off at this speed from the place's beginning on"},
      {"noise_m", {noisy, false, true, metres}, "corrected anew at each keyframe, by white noise of this 1-sigma"},
      {"latency_s", {late, true, false, delays}, "is where the vehicle was so long ago"},
      {"attitude_deg",
       {turned, true, true, angles},
       "turned by this about the vehicle's axis from the place's beginning on"},
  };
  return kRows;
}

const char* axis_name(std::size_t axis) {
  constexpr const char* kNames[] = {"forward", "left", "up"};
  return kNames[axis];
}

}  // namespace canyon::study
