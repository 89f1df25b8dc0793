// Motions and poses against derivatives by differences, matrices and their exponentials.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <vector>

#include <Eigen/LU>

#include "canyon/core/motion/adjoint.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/motion/route_segment.h"
#include "canyon/core/motion/se3_jacobian.h"
#include "canyon/core/motion/trajectory.h"
#include "canyon/core/motion/true_motion.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/stress/subjects.h"
#include "canyon/core/units.h"

namespace canyon {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Looks;

Vector6d some_twist(const RandomStream& draws, std::uint64_t k, double most_rad) {
  Vector6d xi;
  xi << most_rad * draws.uniform(0, k) * draws.direction(1, k), 5.0 * draws.normal3(k, 3);
  return xi;
}

using LongMatrix4 = Eigen::Matrix<long double, 4, 4>;

/// By its series, of a sixteenth squared four times, in 64 bits of mantissa: no rounding beside that of doubles.
LongMatrix4 exponential(const Matrix4d& A) {
  const LongMatrix4 small = A.cast<long double>() / 16.0L;
  LongMatrix4 sum = LongMatrix4::Identity(), term = LongMatrix4::Identity();
  for (int n = 1; n < 24; ++n) term = (term * small / static_cast<long double>(n)).eval(), sum += term;
  for (int k = 0; k < 4; ++k) sum = (sum * sum).eval();
  return sum;
}

Matrix4d twist_matrix(const Vector6d& xi) {
  Matrix4d A = Matrix4d::Zero();
  A(0, 1) = -xi[2], A(0, 2) = xi[1], A(1, 0) = xi[2], A(1, 2) = -xi[0], A(2, 0) = -xi[1], A(2, 1) = xi[0];
  A.topRightCorner<3, 1>() = xi.tail<3>();
  return A;
}

/// Poses as 4 x 4 matrices: products, inverses, exponentials and logarithms, points, adjoints and Jacobians; angles as
/// turns about z, y and x. A pose is 16 epsilons of places of up to 20 m off (angle, sine and cosine four, the product
/// of three by three the rest), two of them and their product 4 times that. Jacobians by differences of h = 1e-5: 16
/// epsilons of 20 m in either logarithm over 2 h, 7.1e-9, and h^2 / 6 of third derivatives of 30, 5e-10.
StressFigure poses_as_matrices() {
  Looks looks;
  const RandomStream draws(1, "stress.motions");
  const double grain = 16.0 * kEpsilon * 20.0;
  for (std::uint64_t k = 0; k < 200; ++k) {
    const Vector6d xi = some_twist(draws, k, 3.0), eta = some_twist(draws, k + 500, 3.0);
    const Pose a = Pose::exp(xi), b = Pose::exp(eta);
    const LongMatrix4 exact = exponential(twist_matrix(xi)), of_eta = exponential(twist_matrix(eta));
    const Matrix4d A = exact.cast<double>();
    looks.near((a.matrix() - A).norm(), 0.0, grain);
    looks.near((b.matrix() - of_eta.cast<double>()).norm(), 0.0, grain);
    // The inverse of the Jacobian makes 1.5 of it at 3 rad, and has its own half.
    looks.near((a.log() - xi).norm(), 0.0, 2.0 * grain);
    looks.near(((a * b).matrix() - (exact * of_eta).cast<double>()).norm(), 0.0, 4.0 * grain);
    looks.near((a.inverse().matrix() - exact.inverse().cast<double>()).norm(), 0.0, 2.0 * grain);
    looks.near((Pose::from_matrix(A).matrix() - A).norm(), 0.0, grain);
    const Vector3d p(1.0, -2.0, 3.0);
    looks.near((a * p - (A.topLeftCorner<3, 3>() * p + A.topRightCorner<3, 1>())).norm(), 0.0, grain);
    looks.near((skew(p) * Vector3d(4.0, 5.0, -6.0) - p.cross(Vector3d(4.0, 5.0, -6.0))).norm(), 0.0, 1e-14);
    // X Exp(d) = Exp(Ad d) X.
    const Vector6d d = 1e-2 * some_twist(draws, k + 900, 1.0);
    looks.near(((a * Pose::exp(d)).matrix() - (Pose::exp(adjoint(a) * d) * a).matrix()).norm(), 0.0, 4.0 * grain);
    const double s = draws.uniform(2, k);
    looks.near((interpolate(a, b, s).matrix() - (a * Pose::exp(s * (a.inverse() * b).log())).matrix()).norm(), 0.0,
               4.0 * grain);
    looks.right(interpolate(a, b, 0.0).p == a.p && interpolate(a, b, 1.0).p == b.p);
    constexpr double h = 1e-5;
    const Vector6d small = some_twist(draws, k, 2.5);
    const Matrix6d J = se3_right_jacobian(small), inverse = se3_right_jacobian_inverse(small);
    for (int i = 0; i < 6; ++i) {
      const Vector6d step = h * Vector6d::Unit(i);
      const Vector6d column = (Pose::exp(small).inverse() * Pose::exp(small + step)).log() -
                              (Pose::exp(small).inverse() * Pose::exp(small - step)).log();
      looks.near((column / (2.0 * h) - J.col(i)).norm(), 0.0, 8e-9);
    }
    looks.near((J * inverse - Matrix6d::Identity()).norm(), 0.0, 36.0 * kEpsilon * J.norm() * inverse.norm());
    const YawPitchRoll angles{draws.uniform(-3.1, 3.1, 4, k), draws.uniform(-1.55, 1.55, 5, k),
                              draws.uniform(-3.1, 3.1, 6, k)};
    const Matrix3d R =
        (AngleAxisd(angles.yaw_rad, Vector3d::UnitZ()) * AngleAxisd(angles.pitch_rad, Vector3d::UnitY()) *
         AngleAxisd(angles.roll_rad, Vector3d::UnitX()))
            .toRotationMatrix();
    looks.near((rotation_from(angles).toRotationMatrix() - R).norm(), 0.0, 1e-15 * 8.0);
    const YawPitchRoll back = yaw_pitch_roll(Eigen::Quaterniond(R));
    const double sharp = 1e-15 * 16.0 / std::cos(angles.pitch_rad);
    looks.near(back.yaw_rad, angles.yaw_rad, sharp), looks.near(back.roll_rad, angles.roll_rad, sharp);
    looks.near(back.pitch_rad, angles.pitch_rad, 1e-15 * 16.0);
    // Heading: from north, clockwise, of the way that the body looks.
    const double heading = heading_from_yaw(angles.yaw_rad);
    looks.near(std::sin(heading), std::cos(angles.yaw_rad), 1e-15),
        looks.near(std::cos(heading), std::sin(angles.yaw_rad), 1e-15);
    looks.near(yaw_from_heading(heading), angles.yaw_rad, 2e-15);
  }
  return looks.figure();
}

KinematicState some_node(const RandomStream& draws, std::uint64_t k, GpsTime t) {
  KinematicState out;
  out.t = t;
  // Turned by less than 1 rad from node to node.
  out.X_WB = {so3_exp(0.4 * draws.normal3(k, 10) / (1.0 + draws.normal3(k, 10).norm())), 20.0 * draws.normal3(k, 11)};
  out.v_WB_W = 3.0 * draws.normal3(k, 12), out.a_WB_W = draws.normal3(k, 13);
  out.w_WB_B = 0.5 * draws.normal3(k, 14), out.alpha_WB_B = 0.3 * draws.normal3(k, 15);
  return out;
}

/// Through nodes of any kind: what is asked for between them is the derivative of what is asked for beside it, in
/// place, speed, attitude and rate, and comes to each node's own at its ends; seventh points on a polynomial of fifth
/// degree have no sixth difference. Steps of h = 1 ms in segments of 2 s, over which places differ by up to 60 m: the
/// terms of a polynomial are up to 15 times that, of which 8 roundings are 8e-13 m, and over 12 h / 18 1.2e-9; h^4 / 30
/// of its fifth derivative, 720 60 m / 2^5 s^5, is 4.5e-11. Of turns, with rates of up to 3 rad/s, h^4 / 30 of fifth
/// derivatives of 3e3 is 1e-10, and rounding 3e-12.
StressFigure motion_through_nodes() {
  Looks looks;
  const RandomStream draws(2, "stress.motions");
  TrueMotion motion;
  std::vector<KinematicState> nodes;
  const GpsTime start = GpsTime::from_week_sow(2000, 100.0);
  for (std::uint64_t k = 0; k < 9; ++k) {
    nodes.push_back(some_node(draws, k, start + 2.0 * static_cast<double>(k)));
    motion.append(nodes.back());
  }
  looks.right(motion.first() == start && motion.last() == start + 16.0 && motion.last_node().t == start + 16.0);
  for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
    for (double s = 0.1; s < 2.0; s += 0.173) {
      const GpsTime t = nodes[k].t + s;
      constexpr double h = 1e-3;
      const auto at = [&](double dt) { return motion.at(t + dt); };
      const KinematicState now = at(0.0), b1 = at(-h), f1 = at(h), b2 = at(-2.0 * h), f2 = at(2.0 * h);
      const auto slope = [&](const auto& of) {
        return Vector3d((8.0 * (of(f1) - of(b1)) - (of(f2) - of(b2))) / (12.0 * h));
      };
      looks.near((slope([](const auto& x) { return x.X_WB.p; }) - now.v_WB_W).norm(), 0.0, 1.3e-9);
      looks.near((slope([](const auto& x) { return x.v_WB_W; }) - now.a_WB_W).norm(), 0.0, 1.3e-9);
      looks.near((slope([&](const auto& x) { return so3_log(now.X_WB.R.conjugate() * x.X_WB.R); }) - now.w_WB_B).norm(),
                 0.0, 1.03e-10);
      looks.near((slope([](const auto& x) { return x.w_WB_B; }) - now.alpha_WB_B).norm(), 0.0, 1.03e-10);
    }
    Vector3d sixth = Vector3d::Zero();
    const double binomial[] = {1, -6, 15, -20, 15, -6, 1};
    for (int i = 0; i < 7; ++i) sixth += binomial[i] * motion.at(nodes[k].t + 0.2 + 0.25 * i).X_WB.p;
    looks.near(sixth.norm(), 0.0, 1e-11);
    // A nanosecond inside of either end: speeds of up to 12 m/s, accelerations of 4, rates of 2 rad/s and 1.2 rad/s^2,
    // four sigmas of each; of the accelerations 60 d / T^3 + 36 v / T^2 + 9 a / T: 580 m/s^3, and of up to 1 rad 31, to
    // which the cube of the rate adds 27.
    for (const auto& [node, t] :
         {std::pair{nodes[k], GpsTime{nodes[k].t.ns + 1}}, {nodes[k + 1], GpsTime{nodes[k + 1].t.ns - 1}}}) {
      const KinematicState found = motion.at(t);
      looks.near((found.X_WB.p - node.X_WB.p).norm(), 0.0, 1.2e-8),
          looks.near((found.v_WB_W - node.v_WB_W).norm(), 0.0, 4e-9);
      looks.near((found.a_WB_W - node.a_WB_W).norm(), 0.0, 5.8e-7);
      looks.near(so3_log(found.X_WB.R.conjugate() * node.X_WB.R).norm(), 0.0, 2e-9);
      looks.near((found.w_WB_B - node.w_WB_B).norm(), 0.0, 1.2e-9),
          looks.near((found.alpha_WB_B - node.alpha_WB_B).norm(), 0.0, 5.8e-8);
    }
  }
  // Pieces: cut at the nodes, end to end, five even points each, as at() has them. All lie on whole nanoseconds, so
  // that both are the same polynomial's: twice 8 roundings of its terms.
  for (const auto& [from_s, to_s, count] :
       {std::tuple{0.0, 16.0, 8}, {0.5, 1.5, 1}, {1.0, 5.0, 3}, {2.0, 4.0, 1}, {3.999, 4.001, 2}}) {
    GpsTime reached = start + from_s;
    int pieces = 0;
    motion.for_each_piece(start + from_s, start + to_s, [&](const TrueMotion::Piece& piece) {
      ++pieces;
      looks.right(piece.front().t == reached);
      const double length_s = piece.back().t - piece.front().t;
      looks.right(length_s > 0.0 && length_s <= 2.0);
      for (std::size_t i = 0; i < piece.size(); ++i) {
        looks.near(piece[i].t - piece.front().t, 0.25 * static_cast<double>(i) * length_s, 0.5e-9);
        const KinematicState exact = motion.at(piece[i].t);
        looks.near((piece[i].X_WB.p - exact.X_WB.p).norm(), 0.0, 1.6e-12);
        looks.near((piece[i].w_WB_B - exact.w_WB_B).norm(), 0.0, 64.0 * kEpsilon * 3.0);
      }
      reached = piece.back().t;
    });
    looks.right(pieces == count && reached == start + to_s);
  }
  // What lies before is forgotten, but for the node that the motion goes on from.
  motion.forget_before(start + 5.0);
  looks.right(motion.first() == start + 4.0 &&
              (motion.at(start + 5.5).X_WB.p - motion.at(start + 5.5).X_WB.p).isZero(0.0));
  motion.forget_before(start + 6.0);
  looks.right(motion.first() == start + 6.0);
  motion.forget_before(start + 100.0);
  looks.right(motion.first() == start + 14.0 && motion.last() == start + 16.0);
  return looks.figure();
}

/// Buffered poses: between two of them the geodesic's share, at one of them itself; what is forgotten and moved; and a
/// piece of a route by brute force over its polyline. Poses of two of 20 m, as above: 4 times 16 epsilons.
StressFigure buffered_poses() {
  Looks looks;
  const double grain = 4.0 * 16.0 * kEpsilon * 20.0;
  const RandomStream draws(3, "stress.motions");
  Trajectory path;
  std::vector<StampedPose> poses;
  const GpsTime start = GpsTime::from_week_sow(2000, 0.0);
  for (std::uint64_t k = 0; k < 8; ++k) {
    poses.push_back({start + 0.5 * static_cast<double>(k * k), Pose::exp(some_twist(draws, k, 2.0))});
    path.append(poses.back());
  }
  looks.right(stress::not_refused([&] { path.append(poses.back()); }) == 0);
  looks.right(stress::not_refused([&] { return Trajectory({poses[1], poses[0]}); }) == 0);
  looks.right(stress::not_refused([&] { return Trajectory({poses[1], poses[1]}); }) == 0);
  const auto expected = [&](double t_s) {
    std::size_t k = 0;
    while (k + 2 < poses.size() && poses[k + 1].t <= start + t_s) ++k;
    return interpolate(poses[k].X_WB, poses[k + 1].X_WB, (t_s - (poses[k].t - start)) / (poses[k + 1].t - poses[k].t));
  };
  for (double t_s = 0.0; t_s <= 24.5; t_s += 0.37)
    looks.near((path.at(start + t_s)->matrix() - expected(t_s).matrix()).norm(), 0.0, grain);
  for (const StampedPose& pose : poses) looks.right(path.at(pose.t)->p == pose.X_WB.p);
  looks.right(!path.at(GpsTime{start.ns - 1}) && !path.at(GpsTime{poses.back().t.ns + 1}) && !Trajectory().at(start));
  Trajectory later = path, moved = path;
  later.forget_before(start + 5.0);
  looks.right(later.poses().size() == 5 && later.poses().front().t == start + 4.5 && later.at(start + 4.6));
  later.forget_before(start + 8.0), looks.right(later.poses().size() == 4);
  later.forget_before(start), looks.right(later.poses().size() == 4);
  const Pose by = Pose::exp(some_twist(draws, 77, 1.0));
  moved.move(by);
  looks.near((moved.at(start + 3.3)->matrix() - (by * expected(3.3)).matrix()).norm(), 0.0, grain);
  RouteSegment route;
  for (std::uint64_t k = 0; k < 5; ++k)
    route.points_W.emplace_back(draws.uniform(-50, 50, 4, k), draws.uniform(-50, 50, 5, k), 99.0);
  route.points_W.push_back(route.points_W.back());
  route.half_width_m = 3.0, route.low_m = -1.0, route.high_m = 2.0;
  for (std::uint64_t k = 0; k < 60; ++k) {
    const Eigen::Vector2d p(draws.uniform(-60, 60, 6, k), draws.uniform(-60, 60, 7, k));
    double least = 1e9;
    for (std::size_t i = 0; i + 1 < route.points_W.size(); ++i)
      for (int step = 0; step <= 2000; ++step)
        least = std::min(
            least,
            (p - (route.points_W[i] + step / 2000.0 * (route.points_W[i + 1] - route.points_W[i])).head<2>()).norm());
    // Steps of 0.07 m beside a line.
    looks.right(route.distance_m(p) <= least + 1e-9 && route.distance_m(p) >= least - 0.036);
    const Eigen::Vector2d on = route.points_W[1].head<2>() + 0.3 * (route.points_W[2] - route.points_W[1]).head<2>();
    const Eigen::Vector2d along = (route.points_W[2] - route.points_W[1]).head<2>().normalized(),
                          across(-along.y(), along.x());
    const double tilt = draws.uniform(0.0, 0.9, 8, k), z = draws.uniform(-2.0, 3.0, 9, k),
                 off = draws.uniform(0.0, 2.99, 10, k);
    const Pose X{Eigen::Quaterniond(AngleAxisd(tilt, Vector3d(std::cos(1.0 * k), std::sin(1.0 * k), 0.0)) *
                                    AngleAxisd(0.7 * k, Vector3d::UnitZ())),
                 {on.x() + off * across.x(), on.y() + off * across.y(), z}};
    looks.right(route.contains(X) == (tilt <= 0.45 && z >= -1.0 && z <= 2.0));
  }
  looks.right(route.distance_m({1e3, 1e3}) > 900.0 &&
              !route.contains({Eigen::Quaterniond::Identity(), {1e3, 1e3, 0.0}}));
  return looks.figure();
}

}  // namespace

std::vector<StressCase> motion_cases() {
  StressRows rows;
  const auto group = StressGroup::kGeometry;
  rows.of({.group = group,
           .mechanism = "poses, their products and Jacobians",
           .why = "a product in the other order, an adjoint of the other half, a yaw for a heading",
           .expected = "4 x 4 matrices and their exponentials; Jacobians by differences",
           .unit = "of the bound"});
  rows.add("motions/poses_as_matrices", poses_as_matrices);
  rows.of({.group = group,
           .mechanism = "a motion through nodes and between them",
           .why = "a derivative with respect to the share and not to time, a piece that is left out",
           .expected = "what is asked for is the derivative of what is asked for beside it, and meets the nodes",
           .unit = "of the bound"});
  rows.add("motions/through_nodes", motion_through_nodes).add("motions/buffered_poses", buffered_poses);
  return rows.take();
}

}  // namespace canyon
