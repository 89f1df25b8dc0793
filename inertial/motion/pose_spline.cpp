#include "inertial/motion/pose_spline.h"

#include <cmath>
#include <cstdio>

#include "core/units.h"
#include "inertial/motion/rigid_motion.h"

namespace canyon::inertial {
namespace {

/// Slower than this the direction of travel says nothing.
constexpr double kLeastSpeed_m_s = 0.01;

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

Status check_direction(const QuinticSpline& position, const std::vector<double>& t_s) {
  constexpr int kPerInterval = 8;
  Eigen::Vector2d before = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i + 1 < t_s.size(); ++i) {
    for (int k = 0; k <= kPerInterval; ++k) {
      const double t = t_s[i] + (t_s[i + 1] - t_s[i]) * k / kPerInterval;
      const Eigen::Vector2d v(position.at(t, 0).first(), position.at(t, 1).first());
      if (v.norm() < kLeastSpeed_m_s || v.dot(before) < 0.0)
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
  Eigen::MatrixXd positions(n, 3), attitudes(n, 4);
  for (Eigen::Index i = 0; i < n; ++i) positions.row(i) = knots.p_WB[static_cast<std::size_t>(i)];
  QuinticSpline position(knots.t_s, positions, smoothing_s);
  if (knots.R_WB.empty()) {
    CANYON_TRY_STATUS(check_direction(position, knots.t_s));
    return std::shared_ptr<const Motion>(std::make_shared<NoseAhead>(std::move(position)));
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
  return std::shared_ptr<const Motion>(
      std::make_shared<PoseSpline>(std::move(position), QuinticSpline(knots.t_s, attitudes, smoothing_s)));
}

}  // namespace canyon::inertial
