#include "canyon/study/tradeoff/probes/smooth_motion.h"

#include <map>
#include <memory>
#include <mutex>

#include "canyon/inertial/motion/motion.h"
#include "canyon/study/tradeoff/probes/imu_samples.h"

namespace canyon::study {
namespace {

constexpr int kSeconds = 10, kLookBack = 2;
constexpr double kFrom_s = 1.0;  // of the motion, so that there is something to look back at

inertial::PlacedMotion eight(SmoothMotion kind) {
  inertial::MotionConfig config;
  config.path = "figure_eight";
  config.period_s = 30.0;
  config.climb_m = 2.0;
  config.sway_deg = 5.0;
  if (kind == SmoothMotion::kLively)
    config.vibration.sinusoid = {
        {.frequency_hz = 2.0, .acceleration_m_s2 = {20.0, 5.0, 0.0}, .angle_deg = {30.0, 0.0, 0.0}},
        {.frequency_hz = 1.7, .acceleration_m_s2 = {0.0, 20.0, 10.0}, .angle_deg = {0.0, 20.0, 30.0}}};
  return *inertial::make_motion(config, 1);
}

SmoothDrive make_drive(SmoothMotion kind, int rate_hz) {
  const inertial::PlacedMotion motion = eight(kind);
  SmoothDrive drive;
  drive.per_second = static_cast<std::size_t>(rate_hz);
  const auto state_at = [&](double t_s) {
    KinematicState truth = motion.imu_at(t_s);
    truth.t = motion.start + t_s;
    return imu_state(truth, motion.frame, Eigen::Vector3d::Zero(), std::nullopt);
  };
  const auto time_of = [&](int k) { return kFrom_s + static_cast<double>(k) / rate_hz; };
  drive.truth.push_back(state_at(kFrom_s));
  for (int k = -kLookBack; k < kSeconds * rate_hz; ++k) {
    const ImuSample s = inertial::motion_increments(motion, time_of(k), time_of(k + 1));
    drive.increments.push_back({.dt_s = s.dt_s, .dtheta_U = s.dtheta_U, .dv_U = s.dv_U});
    if (k >= 0 && (k + 1) % rate_hz == 0) drive.truth.push_back(state_at(time_of(k + 1)));
  }
  return drive;
}

}  // namespace

const SmoothDrive& smooth_drive(SmoothMotion motion, int rate_hz) {
  static std::mutex mutex;
  static std::map<std::pair<SmoothMotion, int>, std::unique_ptr<SmoothDrive>> made;
  const std::lock_guard lock(mutex);
  auto& drive = made[{motion, rate_hz}];
  if (!drive) drive = std::make_unique<SmoothDrive>(make_drive(motion, rate_hz));
  return *drive;
}

std::vector<fusion::NavState> integrate(const fusion::StrapdownRow& row, const SmoothDrive& drive) {
  const auto strapdown = row.make.make(gravity_E);
  std::vector<fusion::NavState> states;
  fusion::NavState state = drive.truth.front();
  for (std::size_t k = 0; k < drive.increments.size(); ++k) {
    if (k == kLookBack) state = drive.truth.front();
    strapdown->advance(state, drive.increments[k]);
    if (k >= kLookBack && (k - kLookBack + 1) % drive.per_second == 0) states.push_back(state);
  }
  return states;
}

}  // namespace canyon::study
