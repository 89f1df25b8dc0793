// Graphs of poses, against differences and least squares on a line; later evidence against dense matrices; what an IMU
// measured between two nodes, against differences.
#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/LU>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/motion/se3_jacobian.h"
#include "canyon/core/stress/looks.h"
#include "canyon/fusion/smoothing/graph/graph_layout.h"
#include "canyon/fusion/smoothing/graph/imu_factor.h"
#include "canyon/fusion/smoothing/graph/preintegration.h"
#include "canyon/fusion/smoothing/later_evidence.h"
#include "canyon/fusion/smoothing/pose_graph/pose_graph.h"
#include "canyon/fusion/stress/drawn_numbers.h"
#include "canyon/fusion/stress/simulated_drive.h"
#include "canyon/fusion/stress/subjects.h"

namespace canyon::fusion {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using stress::kInfinity;
using stress::Looks;

/// Residuals of relations are the whitened logarithm of what is left; derivatives by fourth-order differences over
/// 1e-3: h^4 of the fifth derivative and 1e-15 / h; Jacobians by the same of the exponential, and inverse to one
/// another.
StressFigure pose_rows() {
  Looks looks;
  DrawnNumbers draw(1);
  const auto slope = [](const std::function<Vector6d(double)>& f) -> Vector6d {
    constexpr double h = 1e-3;
    return (8.0 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12.0 * h);
  };
  for (int trial = 0; trial < 12; ++trial) {
    const Pose S = Pose::exp(draw.xi(0.8, 10.0)), T = Pose::exp(draw.xi(0.8, 10.0));
    const Matrix6d P = draw.positive(6, 0.2);
    const PoseGraph::Relative known{
        .source = 0, .target = 1, .X_TS = T.inverse() * S * Pose::exp(draw.xi(0.1, 0.4)), .covariance = P};
    const RelativeRows rows = relative_rows(known, S, T);
    const Vector6d left = (known.X_TS.inverse() * T.inverse() * S).log();
    looks.near(rows.residual.squaredNorm() / left.dot(P.inverse() * left), 1.0, 1e-11);
    const PoseGraph::Absolute at{0, S * Pose::exp(draw.xi(0.1, 0.4)), P};
    const AbsoluteRows by_itself = absolute_rows(at, S);
    const Vector6d off = (at.X_WS.inverse() * S).log();
    looks.near(by_itself.residual.squaredNorm() / off.dot(P.inverse() * off), 1.0, 1e-11);
    for (int i = 0; i < 6; ++i) {
      const auto moved = [&](const Pose& X, double s) { return X * Pose::exp(s * Vector6d::Unit(i)); };
      const Vector6d source = slope([&](double s) { return relative_rows(known, moved(S, s), T).residual; }),
                     target = slope([&](double s) { return relative_rows(known, S, moved(T, s)).residual; }),
                     alone = slope([&](double s) { return absolute_rows(at, moved(S, s)).residual; });
      looks.near((rows.by_source.col(i) - source).norm(), 0.0, 1e-8 * (1.0 + source.norm()));
      looks.near((rows.by_target.col(i) - target).norm(), 0.0, 1e-8 * (1.0 + target.norm()));
      looks.near((by_itself.by_node.col(i) - alone).norm(), 0.0, 1e-8 * (1.0 + alone.norm()));
    }
    Vector6d xi = draw.xi(1.0, 2.0);
    xi.head<3>() *= 0.5 / xi.head<3>().norm();
    const Matrix6d J = se3_right_jacobian(xi);
    looks.near((J * se3_right_jacobian_inverse(xi) - Matrix6d::Identity()).norm(), 0.0, 1e-8);
    for (int i = 0; i < 6; ++i) {
      const Vector6d by = slope([&](double s) -> Vector6d {
        return (Pose::exp(xi).inverse() * Pose::exp(xi + s * Vector6d::Unit(i))).log();
      });
      looks.near((J.col(i) - by).norm(), 0.0, 1e-8 * (1.0 + by.norm()));
    }
  }
  return looks.figure();
}

/// Poses on a line held at its ends, legs of their own sigmas: each gets its share of the misclosure, by variance; one
/// switch more has the weight c / (c + chi^2) at the end, and what contradicts is off.
StressFigure pose_lines() {
  Looks looks;
  PoseGraph graph;
  const std::array<double, 5> sigma{0.02, 0.05, 0.01, 0.04, 0.03}, leg{1.0, 2.0, 1.5, 0.7, 1.2};
  double total2 = 0.0, way = 0.0;
  for (const double s : sigma) total2 += s * s;
  Pose at;
  graph.X_WS.push_back(at);
  for (std::size_t k = 0; k < 5; ++k) {
    Vector6d step = Vector6d::Zero();
    step[3] = leg[k];
    Matrix6d P = 1e-8 * Matrix6d::Identity();
    P(3, 3) = sigma[k] * sigma[k];
    at = at * Pose::exp(step);
    graph.X_WS.push_back(at);
    graph.relative.push_back({.source = k + 1, .target = k, .X_TS = Pose::exp(step), .covariance = P});
    way += leg[k];
  }
  const double misclosure = 0.06;
  graph.absolute = {
      {0, Pose{}, 1e-14 * Matrix6d::Identity()},
      {5, Pose{Eigen::Quaterniond::Identity(), {way + misclosure, 0.0, 0.0}}, 1e-14 * Matrix6d::Identity()}};
  PoseGraph switched = graph;
  const auto report = solve(graph, {});
  if (!report.ok()) return {kInfinity, 1.0};
  looks.right(report->converged);
  double share = 0.0, x = 0.0;
  for (std::size_t k = 0; k < 5; ++k) {
    share += sigma[k] * sigma[k] / total2;
    x += leg[k];
    // Ends are held to 1e-7 m, a part in 1e12 of the legs' variance; the problem is linear.
    looks.near(graph.X_WS[k + 1].p.x(), x + share * misclosure, 1e-9);
    looks.near(graph.X_WS[k + 1].p.tail<2>().norm(), 0.0, 1e-9);
  }
  looks.near(report->final_cost / (0.5 * misclosure * misclosure / total2), 1.0, 1e-8);
  looks.right(report->initial_cost > report->final_cost);
  // A relation of poses 1 and 4 that is 2 m wrong, and may be switched off.
  Matrix6d P = 1e-4 * Matrix6d::Identity();
  Vector6d wrong = Vector6d::Zero();
  wrong[3] = leg[1] + leg[2] + leg[3] + 2.0;
  switched.relative.push_back(
      {.source = 4, .target = 1, .X_TS = Pose::exp(wrong), .covariance = P, .switchable = true});
  if (!solve(switched, {}).ok()) return {kInfinity, 1.0};
  const PoseGraph::Relative& last = switched.relative.back();
  const double chi2 = relative_rows(last, switched.X_WS[4], switched.X_WS[1]).residual.squaredNorm();
  // Rounds end where a weight moves by less than 1e-6, each by what the one before left.
  looks.near(last.weight, 22.5 / (22.5 + chi2), 1e-5);
  looks.right(last.weight < 0.01);
  return looks.figure();
}

/// Backwards over resets, corrections and steps, as one dense system: the smoothed mean is P times the gradient of what
/// comes later, the covariance P - P Lambda P.
StressFigure later() {
  Looks looks;
  DrawnNumbers draw(3);
  const Eigen::Index n = 14;
  LaterEvidence evidence(n);
  VectorXd lambda = VectorXd::Zero(n);
  MatrixXd Lambda = MatrixXd::Zero(n, n);
  for (int round = 0; round < 8; ++round) {
    const MatrixXd P = draw.positive(n, 0.5), H = draw.any(3, n), R = draw.positive(3, 1.0);
    const MatrixXd S = H * P * H.transpose() + R, K = P * H.transpose() * S.inverse();
    const VectorXd r = draw.any(3, 1);
    const Eigen::Matrix3d J = so3_exp(Vector3d(0.1 * draw.next(), 0.2, -0.1)).toRotationMatrix();
    MatrixXd G = MatrixXd::Identity(n, n);
    G.topLeftCorner<3, 3>() = J;
    lambda = (G.transpose() * lambda).eval();
    Lambda = (G.transpose() * Lambda * G).eval();
    evidence.before_reset(J);
    const MatrixXd kept = MatrixXd::Identity(n, n) - K * H;
    lambda = (kept.transpose() * lambda + H.transpose() * S.inverse() * r).eval();
    Lambda = (kept.transpose() * Lambda * kept + H.transpose() * S.inverse() * H).eval();
    evidence.before_correction(K, H, S.inverse(), r);
    Transition step{draw.any(9, n), VectorXd::LinSpaced(n - 9, 0.5, 1.0)};
    MatrixXd Phi = MatrixXd::Zero(n, n);
    Phi.topRows(9) = step.moving;
    Phi.bottomRightCorner(n - 9, n - 9) = step.kept.asDiagonal();
    lambda = (Phi.transpose() * lambda).eval();
    Lambda = (Phi.transpose() * Lambda * Phi).eval();
    evidence.before(step);
    looks.near((evidence.mean(P) - P * lambda).norm(), 0.0, 1e-13 * (1.0 + lambda.norm()) * P.norm());
    looks.near((evidence.covariance(P) - (P - P * Lambda * P)).norm(), 0.0,
               1e-13 * (1.0 + Lambda.norm()) * P.norm() * P.norm());
    if (Lambda.norm() > 1e8) {
      evidence.forget(n);
      lambda.setZero(), Lambda.setZero();
      looks.near(evidence.mean(P).norm(), 0.0, 1e-300);
    }
  }
  return looks.figure();
}

/// What an IMU measured between two nodes of a drive: its own prediction leaves nothing, differences give its
/// derivatives (as the factors' tests: 1e-7 of a row, and rounding of places in E), and to first order other values of
/// the states move it as integrating with them does.
StressFigure imu_factor(const char* keys) {
  Looks looks;
  const Drive drive = simulated_drive(4, {.seconds = 3.0, .outage_from_s = 1e9, .keys = keys});
  Preintegrator integrator(drive.config, drive.noise);
  const GraphLayout layout(integrator.state());
  const Eigen::Index others = layout.states() - 9;
  DrawnNumbers draw(5);
  VectorXd values(others);
  for (Eigen::Index i = 0; i < others; ++i) values[i] = 1e-4 * draw.next();
  const std::span<const ImuSample> samples(drive.imu.data() + 20, 60);
  const PreintegratedImu imu = integrator.integrate(samples, &drive.imu[19], values);
  double dt_s = 0.0;
  for (const ImuSample& s : samples) dt_s += s.dt_s;
  looks.near(imu.dt_s, dt_s, 1e-12);
  // Other values: central differences of the sum itself.
  for (Eigen::Index i = 0; i < others; ++i) {
    const double h = 1e-5;
    const VectorXd step = h * VectorXd::Unit(others, i);
    const PreintegratedImu up = integrator.integrate(samples, &drive.imu[19], values + step),
                           down = integrator.integrate(samples, &drive.imu[19], values - step);
    Eigen::Matrix<double, 9, 1> by;
    by.segment<3>(0) = so3_log(imu.dR.conjugate() * up.dR) - so3_log(imu.dR.conjugate() * down.dR);
    by.segment<3>(3) = up.dp - down.dp;
    by.segment<3>(6) = up.dv - down.dv;
    looks.near((imu.by_values.col(i) - by / (2.0 * h)).norm(), 0.0, 1e-6 * (1.0 + imu.by_values.col(i).norm()));
  }
  const PreintegratedImu moved = imu.moved_to(values + 1e-6 * VectorXd::Ones(others)),
                         again = integrator.integrate(samples, &drive.imu[19], values + 1e-6 * VectorXd::Ones(others));
  looks.near((moved.dp - again.dp).norm(), 0.0, 1e-9);
  looks.near((moved.dv - again.dv).norm(), 0.0, 1e-9);
  looks.near(moved.dR.angularDistance(again.dR), 0.0, 1e-7);
  const ImuFactor factor(layout, imu, drive.truth[20].p_EU_E);
  const VectorXd constants = layout.constants_of(values);
  GraphNode first{drive.truth[20], layout.walking_of(values)};
  const GraphNode second = factor.predict(layout, first, constants);
  // Roundings of 6.4e6 m over the least sigma, here of some 1e-4 m.
  const double kept = factor.rows(layout, first, second, constants, false).residual.norm();
  looks.near(kept, 0.0, 1e-3);
  looks.near(second.nav.t - first.nav.t, dt_s, 1e-6);
  // What the drive truly did, with true values unknown: within what its noise allows a chi-square of that size.
  GraphNode off_first = first, off_second = second;
  VectorXd small(layout.node_size());
  for (Eigen::Index i = 0; i < small.size(); ++i) small[i] = 1e-3 * draw.next();
  off_first = fusion::moved(first, small);
  for (Eigen::Index i = 0; i < small.size(); ++i) small[i] = 1e-3 * draw.next();
  off_second = fusion::moved(second, small);
  const FactorRows rows = factor.rows(layout, off_first, off_second, constants, true);
  VectorXd steps = VectorXd::Constant(layout.node_size(), 1e-4);
  steps.segment<3>(3).setConstant(16.0), steps.segment<3>(6).setConstant(0.5);
  const auto check = [&](const MatrixXd& exact, const std::function<VectorXd(const VectorXd&)>& f, const VectorXd& h) {
    MatrixXd by(exact.rows(), exact.cols());
    for (Eigen::Index i = 0; i < exact.cols(); ++i) {
      const VectorXd step = h[i] * VectorXd::Unit(h.size(), i);
      by.col(i) = (f(step) - f(-step)) / (2.0 * h[i]);
    }
    for (Eigen::Index row = 0; row < exact.rows(); ++row) {
      const double size = exact.row(row).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
      looks.near((exact.row(row) - by.row(row)).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(), 0.0, 1e-6 * size + 1e-8);
    }
  };
  check(
      rows.by_first,
      [&](const VectorXd& e) {
        return factor.rows(layout, fusion::moved(off_first, e), off_second, constants, false).residual;
      },
      steps);
  check(
      rows.by_second,
      [&](const VectorXd& e) {
        return factor.rows(layout, off_first, fusion::moved(off_second, e), constants, false).residual;
      },
      steps);
  if (layout.constants() > 0)
    check(
        rows.by_constants,
        [&](const VectorXd& e) { return factor.rows(layout, off_first, off_second, constants + e, false).residual; },
        VectorXd::Constant(layout.constants(), 1e-4));
  // Errors of nodes add up as they are seen, and parts of values are put together again.
  looks.near((difference(first, off_first) - difference(off_first, first) * -1.0).norm(), 0.0, 1e-5);
  looks.near((layout.values(layout.walking_of(values), constants) - values).norm(), 0.0, 1e-15 + values.norm());
  return looks.figure();
}

}  // namespace

std::vector<StressCase> graph_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "graphs of poses and of what an IMU measured between them",
           .why =
               "a derivative by the other pose, a term of the Earth's turning left out, a variance in the place of a "
               "sigma",
           .expected = "differences, least squares on a line and dense matrices: truncation and rounding",
           .unit = "of the bound"});
  rows.add("graphs/rows_of_poses", pose_rows)
      .add("graphs/poses_on_a_line", pose_lines)
      .add("graphs/later_evidence", later);
  rows.add("graphs/imu_with_biases", [] { return imu_factor("states = [\"biases\"]"); })
      .add("graphs/imu_with_gains", [] { return imu_factor("states = [\"biases\", \"gains\"]"); });
  return rows.take();
}

}  // namespace canyon::fusion
