// How an autonomy checks its estimate: walls matched from scan to scan, and an account of its own of the way.
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/LU>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/stress/looks.h"
#include "canyon/mission/autonomy/self_check/planar_match.h"
#include "canyon/mission/autonomy/self_check/self_check.h"
#include "canyon/mission/stress/autonomy_parts.h"
#include "canyon/mission/stress/subjects.h"

namespace canyon::mission {
namespace {

using Eigen::Vector2d;
using stress::Looks;

/// A room whose walls do not meet: from where one has truly come to, nothing moves it, and it is as sure as its returns
/// say, each over a hundred times (3 cm)^2; from beside, what was known pulls by its share.
StressFigure matched_walls(double yaw_rad) {
  Looks looks;
  const Vector2d moved(0.21, -0.12);
  PlanarPoints before, now;
  std::vector<Vector2d> normals;
  const auto wall = [&](const Vector2d& p, const Vector2d& normal) {
    before.push_back(p);
    const Vector2d seen = seen_from(p, moved, yaw_rad);
    now.push_back(seen);
    normals.push_back(normal);
  };
  for (double v = -5.9; v < 6.0; v += 0.2) {
    wall({10.5, v}, {1.0, 0.0}), wall({-9.5, v}, {1.0, 0.0});
    wall({v, 8.5}, {0.0, 1.0}), wall({v, -7.5}, {0.0, 1.0});
  }
  const WallPieces pieces(before);
  looks.right(pieces.count() == 48);
  PlanarMotion known;
  known.pose = {moved, yaw_rad};
  known.covariance = Eigen::Vector3d(0.04, 0.09, 1e-4).asDiagonal();
  Eigen::Matrix3d H = known.covariance.inverse();
  for (std::size_t i = 0; i < now.size(); ++i) {
    const Vector2d arm = before[i] - moved;
    const Eigen::Vector3d slope(normals[i].x(), normals[i].y(), normals[i].dot(Vector2d(-arm.y(), arm.x())));
    H += slope * slope.transpose() / (9e-4 * 100.0);
  }
  const Eigen::Matrix3d P = H.inverse();
  const PlanarMotion still = pieces.match(now, known);
  looks.near((still.pose.p_m - moved).norm(), 0.0, 1e-12);
  looks.near(still.pose.yaw_rad, yaw_rad, 1e-13);
  looks.near((still.covariance - P).norm() / P.norm(), 0.0, 1e-10);
  PlanarMotion off = known;
  const Eigen::Vector3d by(0.05, -0.04, 0.004);
  off.pose = {moved + by.head<2>(), yaw_rad + by.z()};
  const PlanarMotion back = pieces.match(now, off);
  const Eigen::Vector3d left = P * known.covariance.inverse() * by;
  // Cauchy's weights and the turn's curvature are of second order: what is left squared over 3 cm, and 4e-3 squared of
  // 12 m; and it ends with steps of 1e-4 m.
  const double second = left.norm() * (left.norm() / 0.03 + 0.1) + 1e-4;
  looks.near((back.pose.p_m - moved - left.head<2>()).norm(), 0.0, second);
  looks.near(back.pose.yaw_rad - yaw_rad, left.z(), second / 8.0);
  // Seen by a scan, turned and lifted: the same points, once for every 0.2 m, within heights and reach.
  LidarScan scan;
  const Pose X_WB{rotation_from({.yaw_rad = 0.9, .pitch_rad = 0.0, .roll_rad = 0.0}), {5.0, -3.0, 2.0}};
  const Pose X_WL{rotation_from({.yaw_rad = 2.0, .pitch_rad = 0.0, .roll_rad = 0.0}), {5.4, -2.7, 3.5}};
  int expected = 0;
  for (int i = 0; i < 40; ++i)
    for (int repeat = 0; repeat < 3; ++repeat) {
      const double height = std::array{0.5, 1.5, 3.2}[static_cast<std::size_t>(repeat)];
      const Eigen::Vector3d p_B(-31.0 + 1.5 * i + 0.07, 4.07, height);
      const Eigen::Vector3d p_L = X_WL.R.conjugate() * (X_WB.R * p_B + X_WB.p - X_WL.p);
      scan.points.push_back(
          {.x = static_cast<float>(p_L.x()), .y = static_cast<float>(p_L.y()), .z = static_cast<float>(p_L.z())});
      if (repeat != 1) continue;
      scan.points.push_back(scan.points.back());
      expected += p_B.head<2>().norm() < 28.0 ? 1 : 0;
    }
  const PlanarPoints stand = standing_points(scan, X_WL, X_WB, {});
  looks.right(static_cast<int>(stand.size()) == expected);
  for (const Vector2d& p : stand) {
    looks.near(p.y(), 4.07, 1e-5);
    looks.near(std::remainder(p.x() + 31.0 - 0.07, 1.5), 0.0, 1e-5);
  }
  return looks.figure();
}

/// An account of the way by wheel and heading alone, each look 2 cm unsure: an estimate that jumps aside is doubted
/// just where its square exceeds -2 ln(1e-4) times what estimates, way and course may err against more than half of the
/// looks before; doubt for 12 s is being lost, and one that comes back is believed. An estimate that says more than 5 m
/// of itself is doubted too.
StressFigure own_account(double heading_rad) {
  Looks looks;
  const auto make = [] {
    ModelChoice<self_checks> choice("own_motion");
    return model_row(self_checks(), "own_motion").make.make(choice.own);
  };
  const Vector2d u(std::cos(heading_rad), std::sin(heading_rad)), left(-u.y(), u.x());
  const GpsTime start = GpsTime::from_week_sow(1600, 0.0);
  const auto look = [&](SelfCheck& check, int k, double aside_m, double variance_m2) {
    if (k > 0) check.count({.t = start + 0.5 * k, .dt_s = 0.5, .ticks = 0, .speed_m_s = 3.2});
    NavEstimate e;
    e.t = start + 0.5 * k;
    e.X_WB.R = rotation_from({.yaw_rad = heading_rad, .pitch_rad = 0.0, .roll_rad = 0.0});
    const Vector2d p = 1.6 * k * u + aside_m * left;
    e.X_WB.p = {p.x() + 7.0, p.y() - 3.0, 1.0};
    e.v_WB_W = {3.2 * u.x(), 3.2 * u.y(), 0.0};
    e.pose_covariance.setZero();
    e.pose_covariance.diagonal().tail<3>().setConstant(variance_m2);
    check.see({}, e.X_WB, e);
  };
  for (const int before : {6, 11, 30}) {
    const int decisive = before / 2 + 1;  // looks back
    const double course = 0.01 * 1.6 * decisive;
    const double S = 2.0 * 0.25 + 4e-4 * decisive + course * course + 0.01;
    const double jump = std::sqrt(-2.0 * std::log(1e-4) * S);
    for (const double share : {0.995, 1.005}) {
      const auto check = make();
      for (int k = 0; k < before; ++k) look(*check, k, 0.0, 0.25);
      looks.right(check->trust() == Trust::kGood);
      look(*check, before, share * jump, 0.25);
      looks.right((check->trust() == Trust::kDoubtful) == (share > 1.0));
      if (share < 1.0) continue;
      looks.near(check->speed_limit_m_s(), 2.0, 1e-15);
      const auto other = make();
      for (int k = 0; k < before; ++k) look(*other, k, 0.0, 0.25);
      look(*other, before, 9.0, 0.25);
      look(*other, before + 1, 0.0, 0.25);
      looks.right(other->trust() == Trust::kGood);
      // Doubted for 12 s: 24 looks after the first.
      for (int k = 2; k <= 25; ++k) look(*other, before + k, 40.0, 0.25);
      looks.right(other->trust() == Trust::kDoubtful);
      look(*other, before + 26, 40.0, 0.25);
      looks.right(other->trust() == Trust::kLost);
    }
  }
  for (const double sigma_m : {4.9, 5.1}) {
    const auto check = make();
    look(*check, 0, 0.0, sigma_m * sigma_m);
    looks.right((check->trust() == Trust::kDoubtful) == (sigma_m > 5.0));
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> self_check_cases() {
  StressRows rows;
  rows.of(autonomy_part());
  for (const double heading : {0.0, 2.2})
    rows.add("self_check/own_account_heading_" + stress::text(heading), [heading] { return own_account(heading); });
  for (const double yaw : {0.0, 0.02, -0.03})
    rows.add("self_check/matched_walls_turned_by_" + stress::text(yaw), [yaw] { return matched_walls(yaw); });
  return rows.take();
}

}  // namespace canyon::mission
