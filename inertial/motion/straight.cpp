#include <algorithm>

#include "canyon/inertial/motion/closed_form.h"

namespace canyon::inertial {
namespace {

/// Speed over time: between two points of the profile a step of fifth degree, so that acceleration and its derivative
/// are continuous; before the first and behind the last point constant. Distance is its integral in closed form.
class SpeedProfile {
 public:
  SpeedProfile(std::vector<double> t_s, std::vector<double> speed_m_s)
      : t_s_(std::move(t_s)), speed_m_s_(std::move(speed_m_s)), distance_m_(t_s_.size(), 0.0) {
    for (std::size_t i = 1; i < t_s_.size(); ++i)
      distance_m_[i] = distance_m_[i - 1] + 0.5 * (speed_m_s_[i - 1] + speed_m_s_[i]) * (t_s_[i] - t_s_[i - 1]);
  }

  Series distance(const Series& t) const {
    const auto next = std::upper_bound(t_s_.begin(), t_s_.end(), t.value());
    const auto i = static_cast<std::size_t>(next - t_s_.begin());
    if (i == 0) return Series(speed_m_s_.front()) * (t - t_s_.front());
    const Series since = t - t_s_[i - 1];
    const Series cruise = Series(distance_m_[i - 1]) + Series(speed_m_s_[i - 1]) * since;
    if (i == t_s_.size()) return cruise;
    // Integral of the step 10 u^3 - 15 u^4 + 6 u^5.
    const double length_s = t_s_[i] - t_s_[i - 1];
    const Series u = since / length_s, u2 = u * u;
    return cruise +
           Series((speed_m_s_[i] - speed_m_s_[i - 1]) * length_s) * (u2 * u2) * (Series(2.5) - Series(3.0) * u + u2);
  }

 private:
  std::vector<double> t_s_, speed_m_s_, distance_m_;
};

}  // namespace

Result<PlacedMotion> make_straight(const MotionConfig& config) {
  if (config.profile_s.size() != config.profile_m_s.size())
    return Error{.key = "profile_m_s",
                 .what = std::to_string(config.profile_m_s.size()) + " speeds at " +
                         std::to_string(config.profile_s.size()) + " times",
                 .expected = "as many of one as of the other"};
  if (!std::is_sorted(config.profile_s.begin(), config.profile_s.end(), std::less_equal<>()))
    return Error{.key = "profile_s", .what = "times do not increase", .expected = "ascending times"};
  const SpeedProfile profile = config.profile_s.empty() ? SpeedProfile({0.0}, {config.speed_m_s})
                                                        : SpeedProfile(config.profile_s, config.profile_m_s);
  const double yaw = start_yaw_rad(config), pitch = config.pitch_deg * kDegree, roll = config.roll_deg * kDegree;
  const Eigen::Vector3d ahead = rotation_from({yaw, pitch, 0.0}) * Eigen::Vector3d::UnitX();
  return closed_form(config, [=](const Series& t) {
    const Series s = profile.distance(t);
    return kinematics({s * ahead.x(), s * ahead.y(), s * ahead.z()}, quaternion_from(yaw, pitch, roll));
  });
}

}  // namespace canyon::inertial
