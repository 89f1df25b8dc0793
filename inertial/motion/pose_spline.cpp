#include "canyon/inertial/motion/pose_spline.h"

#include <cmath>
#include <cstdio>

#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/inertial/motion/rigid_motion.h"

namespace canyon::inertial {
namespace {

/// Slower than this the direction of travel says nothing.
constexpr double kLeastSpeed_m_s = 0.01;
constexpr std::size_t kPointsPerLook = 4096;  // at whether the user wants to stop

SeriesVector position_at(const QuinticSpline& spline, double t_s) {
  return {spline.at(t_s, 0), spline.at(t_s, 1), spline.at(t_s, 2)};
}

class PoseSpline final : public Motion {
 public:
  PoseSpline(QuinticSpline position, QuinticSpline attitude)
      : position_(std::move(position)), attitude_(std::move(attitude)) {}
  double duration_s() const override { return position_.last_s(); }
  KinematicState at(double t_s) const override {
    return kinematics(position_at(position_, t_s),
                      {attitude_.at(t_s, 0), attitude_.at(t_s, 1), attitude_.at(t_s, 2), attitude_.at(t_s, 3)});
  }

 private:
  QuinticSpline position_, attitude_;
};

class NoseAhead final : public Motion {
 public:
  explicit NoseAhead(QuinticSpline position) : position_(std::move(position)) {}
  double duration_s() const override { return position_.last_s(); }
  KinematicState at(double t_s) const override {
    const SeriesVector p = position_at(position_, t_s);
    const Series vx = p[0].derivative(), vy = p[1].derivative(), vz = p[2].derivative();
    return kinematics(p, quaternion_from(atan2(vy, vx), -atan2(vz, sqrt(vx * vx + vy * vy)), 0.0));
  }

 private:
  QuinticSpline position_;
};

Error cannot_join(double t_s, const char* what, std::string expected) {
  char text[120];
  std::snprintf(text, sizeof text, "at %.3f s %s", t_s, what);
  return Error{.what = text, .expected = std::move(expected)};
}

/// Points a nanosecond apart make derivatives that no number holds.
Status check_finite(const Motion& motion, const std::vector<double>& t_s) {
  for (std::size_t i = 0; i + 1 < t_s.size(); ++i) {
    if (i % kPointsPerLook == 0) throw_if_cancelled();
    for (const double share : {0.0, 0.5, 1.0}) {
      const KinematicState k = motion.at(t_s[i] + share * (t_s[i + 1] - t_s[i]));
      if (k.X_WB.p.allFinite() && k.v_WB_W.allFinite() && std::isfinite(k.a_WB_W.squaredNorm()) &&
          std::isfinite(k.w_WB_B.squaredNorm()) && k.alpha_WB_B.allFinite())
        continue;
      return cannot_join(t_s[i], "speed or acceleration grow beyond all numbers",
                         "points farther apart in time, or nearer in space");
    }
  }
  return Ok{};
}

Status check_direction(const QuinticSpline& position, const std::vector<double>& t_s) {
  constexpr int kPerInterval = 8;
  Eigen::Vector2d before = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i + 1 < t_s.size(); ++i) {
    for (int k = 0; k <= kPerInterval; ++k) {
      const double t = t_s[i] + (t_s[i + 1] - t_s[i]) * k / kPerInterval;
      const Eigen::Vector2d v(position.at(t, 0).first(), position.at(t, 1).first());
      if (!(v.norm() >= kLeastSpeed_m_s) || v.dot(before) < 0.0)
        return cannot_join(t, "there is no direction of travel", "attitudes where the body halts or turns back");
      before = v;
    }
  }
  return Ok{};
}

}  // namespace

Result<std::shared_ptr<const Motion>> make_pose_spline(const PoseKnots& knots, double smoothing_s) {
  const auto n = static_cast<Eigen::Index>(knots.t_s.size());
  if (n < 3) return Error{.what = std::to_string(n) + " points", .expected = "three or more"};
  for (std::size_t i = 0; i + 1 < knots.t_s.size(); ++i)
    if (!(knots.t_s[i] < knots.t_s[i + 1]))
      return cannot_join(knots.t_s[i], "two points are nearer in time than a double can tell", "points farther apart");
  Eigen::MatrixXd positions(n, 3), attitudes(n, 4);
  for (Eigen::Index i = 0; i < n; ++i) positions.row(i) = knots.p_WB[static_cast<std::size_t>(i)];
  QuinticSpline position(knots.t_s, positions, smoothing_s);
  if (knots.R_WB.empty()) {
    CANYON_TRY_STATUS(check_direction(position, knots.t_s));
    const auto motion = std::make_shared<NoseAhead>(std::move(position));
    CANYON_TRY_STATUS(check_finite(*motion, knots.t_s));
    return std::shared_ptr<const Motion>(motion);
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Quaterniond& q = knots.R_WB[static_cast<std::size_t>(i)];
    attitudes.row(i) << q.w(), q.x(), q.y(), q.z();
    if (i == 0) continue;
    const double cos_half = attitudes.row(i).dot(attitudes.row(i - 1));
    if (cos_half < 0.0) attitudes.row(i) *= -1.0;
    if (std::abs(cos_half) < std::cos(60.0 * kDegree))
      return cannot_join(knots.t_s[static_cast<std::size_t>(i)], "the attitude has turned by more than 120 degrees",
                         "points closer in time");
  }
  const auto motion =
      std::make_shared<PoseSpline>(std::move(position), QuinticSpline(knots.t_s, attitudes, smoothing_s));
  CANYON_TRY_STATUS(check_finite(*motion, knots.t_s));
  return std::shared_ptr<const Motion>(motion);
}

}  // namespace canyon::inertial
