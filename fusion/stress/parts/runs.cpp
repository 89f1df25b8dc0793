// Whole runs in their parts: a graph against one dense system, what comes with which sample, the body's estimate of the
// unit's; and what fixes and steps do to an estimate, against other runs.
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "canyon/core/earth/earth.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/fusion/observers/fix_response.h"
#include "canyon/fusion/observers/predicted_motion.h"
#include "canyon/fusion/observers/step_response.h"
#include "canyon/fusion/smoothing/graph/chain_builder.h"
#include "canyon/fusion/smoothing/graph/chain_graph.h"
#include "canyon/fusion/smoothing/rts_smoother.h"
#include "canyon/fusion/smoothing/run_filter.h"
#include "canyon/fusion/smoothing/smoothed_state.h"
#include "canyon/fusion/smoothing/smoother.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/stress/drawn_numbers.h"
#include "canyon/fusion/stress/parts/subjects.h"
#include "canyon/fusion/stress/simulated_drive.h"

namespace canyon::fusion {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Looks;

/// All factors of a graph as one system in [node 0, node 1, ..., constants]: rows and residuals.
struct Dense {
  MatrixXd J;
  VectorXd r;
};
Dense dense_of(const ChainGraph& graph, NodeMeasurements& measurements) {
  const Eigen::Index n = graph.layout.node_size(), c = graph.layout.constants();
  const auto count = static_cast<Eigen::Index>(graph.nodes.size());
  Dense out{MatrixXd(0, count * n + c), VectorXd(0)};
  const auto add = [&](const FactorRows& rows, double weight, Eigen::Index first) {
    const Eigen::Index at = out.J.rows(), more = rows.residual.size();
    out.J.conservativeResize(at + more, Eigen::NoChange);
    out.J.bottomRows(more).setZero();
    out.J.block(at, first * n, more, n) = weight * rows.by_first;
    if (rows.by_second.cols() > 0) out.J.block(at, (first + 1) * n, more, n) = weight * rows.by_second;
    if (c > 0) out.J.block(at, count * n, more, c) = weight * rows.by_constants;
    out.r.conservativeResize(at + more);
    out.r.tail(more) = weight * rows.residual;
  };
  add(prior_rows(graph.layout, graph.prior, graph.nodes[0], graph.constants), 1.0, 0);
  for (std::size_t k = 0; k < graph.edges.size(); ++k)
    add(edge_rows(graph.layout, graph.edges[k], graph.nodes[k], graph.nodes[k + 1], graph.constants, true,
                  first_estimate_of(graph, k)),
        1.0, static_cast<Eigen::Index>(k));
  for (std::size_t k = 0; k < graph.nodes.size(); ++k)
    for (const NodeMeasurement& m : graph.measurements[k])
      add(measurements.rows(m, graph.layout, graph.nodes[k], graph.constants), m.weight, static_cast<Eigen::Index>(k));
  return out;
}

/// Largest difference of two matrices, each element by the roots of its two diagonal ones.
double apart_by_sigma(const MatrixXd& A, const MatrixXd& B) {
  double out = 0.0;
  for (Eigen::Index i = 0; i < A.rows(); ++i)
    for (Eigen::Index j = 0; j < A.cols(); ++j)
      out = worse(out, std::abs(A(i, j) - B(i, j)) / std::sqrt(A(i, i) * A(j, j)));
  return out;
}

/// A graph of seven nodes: the covariance of each node is that block of the whole system's inverse, weights and all;
/// the first one taken out leaves the same of the others, and the same gradient. The system has a condition of some
/// 1e10, and its roots half the digits of that: 1e-9 of a sigma squared.
StressFigure dense_graph(const char* keys) {
  Looks looks;
  const Drive drive = simulated_drive(9, {.seconds = 3.4, .rate_hz = 20.0, .outage_from_s = 1e9, .keys = keys});
  const SmootherInput run = drive.input();
  ChainBuilder builder(run, *samples_of(run), 0.6);
  while (!builder.done()) builder.add_node();
  ChainGraph& graph = builder.graph();
  NodeMeasurements& measurements = builder.measurements();
  looks.right(graph.nodes.size() == graph.edges.size() + 1 && graph.measurements.size() == graph.nodes.size());
  double weight = 1.0;
  for (auto& all : graph.measurements)
    for (NodeMeasurement& m : all) m.weight = weight *= 0.8;
  // Away from where residuals vanish.
  DrawnNumbers draw(2);
  for (GraphNode& node : graph.nodes) {
    VectorXd off = 1e-3 * draw.any(graph.layout.node_size(), 1);
    node = moved(node, off);
  }
  const Eigen::Index n = graph.layout.node_size(), c = graph.layout.constants();
  const auto covariance_of = [](const MatrixXd& J) {
    // By scaled columns, so that units do not count.
    const VectorXd scale = J.colwise().norm().cwiseInverse().transpose();
    const MatrixXd S = J * scale.asDiagonal();
    return MatrixXd(scale.asDiagonal() * (S.transpose() * S).inverse() * scale.asDiagonal());
  };
  const Dense all = dense_of(graph, measurements);
  const MatrixXd P = covariance_of(all.J);
  const auto found = marginal_covariances(graph, measurements);
  looks.right(found.size() == graph.nodes.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k) * n;
    looks.near(apart_by_sigma(P.block(at, at, n, n), found[k]), 0.0, 1e-6);
  }
  looks.near(apart_by_sigma(found[0], first_covariance(graph, measurements)), 0.0, 1e-7);
  // What is left by elimination: information and gradient of the rest.
  const MatrixXd H = all.J.transpose() * all.J;
  const VectorXd g = all.J.transpose() * all.r;
  const Eigen::Index rest = H.rows() - n;
  const MatrixXd gain = H.bottomLeftCorner(rest, n) * H.topLeftCorner(n, n).inverse(),
                 left = H.bottomRightCorner(rest, rest) - gain * H.topRightCorner(n, rest);
  const VectorXd left_g = g.tail(rest) - gain * g.head(n);
  builder.marginalize_first();
  looks.right(graph.prior.of_factors && first_estimate_of(graph, 0) == &graph.prior.node &&
              first_estimate_of(graph, 1) == nullptr);
  const Dense after = dense_of(graph, measurements);
  const MatrixXd H_after = after.J.transpose() * after.J;
  looks.near(apart_by_sigma(left, H_after), 0.0, 1e-6);
  const VectorXd size = left.diagonal().cwiseSqrt();
  looks.near((after.J.transpose() * after.r - left_g).cwiseQuotient(size).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(),
             0.0, 1e-6 * (1.0 + g.norm() / size.norm()));
  looks.right(c == graph.layout.constants());
  return looks.figure();
}

/// The prior of a filter's own covariance: whitened it is the error's square over that covariance, node and constants
/// in whatever order; its derivative is that of its residual.
StressFigure priors() {
  Looks looks;
  const Drive drive = simulated_drive(
      3,
      {.seconds = 0.5, .keys = "states = [\"gains\", \"in_run_biases\", \"wheel_scale\", \"fix_error\", \"clone\"]"});
  const SmootherInput run = drive.input();
  const ErrorStateFilter filter = started_filter(run);
  const GraphLayout layout(filter.state());
  // Gains and the wheel never change; biases and the fixes' errors wander; the clone is known.
  looks.right(layout.states() == 9 + 18 + 6 + 1 + 3 + 6 && layout.node_size() == 9 + 9 && layout.constants() == 7);
  DrawnNumbers draw(7);
  const MatrixXd P = draw.positive(layout.states(), 0.5);
  const GraphNode node{filter.nav_state(), draw.any(9, 1)};
  const VectorXd constants = draw.any(layout.constants(), 1);
  const LinearPrior prior = prior_of(layout, node, constants, P);
  const VectorXd error = 0.1 * draw.any(layout.node_size(), 1), more = 0.1 * draw.any(layout.constants(), 1);
  const GraphNode off = moved(node, error);
  const FactorRows rows = prior_rows(layout, prior, off, constants + more);
  std::vector<int> order;
  for (int i = 0; i < 9; ++i) order.push_back(i);
  for (const int i : layout.walking()) order.push_back(i);
  for (const int i : layout.constant()) order.push_back(i);
  const auto size = static_cast<Eigen::Index>(order.size());
  MatrixXd Q(size, size);
  VectorXd e(size);
  e << error, more;
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index j = 0; j < size; ++j)
      Q(i, j) = P(order[static_cast<std::size_t>(i)], order[static_cast<std::size_t>(j)]);
  looks.near(rows.residual.squaredNorm() / e.dot(Q.inverse() * e), 1.0, 1e-8);
  for (Eigen::Index i = 0; i < layout.node_size(); ++i) {
    const VectorXd step = 1e-4 * VectorXd::Unit(layout.node_size(), i);
    const VectorXd by = (prior_rows(layout, prior, moved(off, step), constants + more).residual -
                         prior_rows(layout, prior, moved(off, -step), constants + more).residual) /
                        2e-4;
    // A place of 6e6 m rounds by 1e-9 over the step.
    looks.near((rows.by_first.col(i) - by).norm() / (1.0 + by.norm()), 0.0, 1e-4);
  }
  looks.near((rows.by_constants - prior.A.rightCols(layout.constants())).norm(), 0.0, 1e-300);
  // Values in parts and whole again, columns where they belong.
  const VectorXd values = draw.any(layout.states() - 9, 1);
  VectorXd again = layout.values(layout.walking_of(values), layout.constants_of(values));
  const MatrixXd columns = draw.any(4, layout.states()), nodes = layout.node_columns(columns),
                 fixed = layout.constant_columns(columns);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    looks.right((at < layout.node_size() ? nodes.col(at) : fixed.col(at - layout.node_size())) ==
                columns.col(order[i]));
    if (i >= 9) looks.right(again[order[i] - 9] == values[order[i] - 9]), again[order[i] - 9] = 0.0;
  }
  looks.right(again.isZero(0.0));
  return looks.figure();
}

/// Nodes where fixes come, and else where the interval is full; messages with the sample whose end is nearest, none of
/// before the start; and samples that do not follow one another named.
StressFigure coming() {
  int wrong = 0;
  Drive drive = simulated_drive(5, {.seconds = 4.0, .rate_hz = 20.0, .outage_from_s = 1e9});
  const SmootherInput run = drive.input();
  const auto samples = samples_of(run);
  if (!samples) return {kInfinity, 0.0};
  // Fixes each second, at 20, 40, 60, 80 samples; nodes each 0.4 s between.
  const ChainBuilder builder(run, *samples, 0.4);
  const std::vector<std::size_t> expected = {8, 16, 20, 28, 36, 40, 48, 56, 60, 68, 76, 80};
  wrong += builder.ends() == expected ? 0 : 1;
  std::vector<OdometerSample> wheels;
  for (const double t : {-0.2, -0.026, -0.024, 0.0, 0.024, 0.026, 0.1, 0.1, 3.9, 3.976, 4.024, 4.3}) {
    OdometerSample one;
    one.t = drive.start + t;
    wheels.push_back(one);
  }
  Queue<OdometerSample> queue(wheels);
  queue.begin(samples->front());
  std::vector<int> with(samples->size(), 0);
  for (std::size_t k = 0; k < samples->size(); ++k) with[k] = static_cast<int>(queue.with(*samples, k).size());
  // Those from half a sample before the start on come with the first, whose end is 0.05 s: up to 0.075.
  wrong += with[0] == 4 && with[1] == 2 && with[77] == 1 && with[78] == 0 && with[79] == 2 ? 0 : 1;
  int all = 0;
  for (const int count : with) all += count;
  wrong += all == 9 ? 0 : 1;
  // Samples of before the start are left out; those that do not follow are an error.
  SmootherInput later = run;
  later.start = drive.start + 1.0;
  wrong += samples_of(later).ok() && samples_of(later)->size() == samples->size() - 20 ? 0 : 1;
  later.start = drive.start + 1.02;
  wrong += samples_of(later).ok() && samples_of(later)->size() == samples->size() - 20 ? 0 : 1;
  later.start = drive.start + 5.0;
  wrong += samples_of(later).ok() ? 1 : 0;
  auto with_gap = drive.imu;
  with_gap.erase(with_gap.begin() + 30);
  SmootherInput gap = run;
  gap.imu = with_gap;
  wrong += samples_of(gap).ok() ? 1 : 0;
  auto slow = drive.imu;
  for (std::size_t k = 0; k < slow.size(); ++k)
    slow[k].dt_s = 0.25, slow[k].t = drive.start + 0.25 * static_cast<double>(k + 1);
  gap.imu = slow;
  wrong += samples_of(gap).ok() ? 1 : 0;
  // Loosening at ends of samples, each once, none of before the start; states after the first
  // sample and then each tenth of a second, or after each.
  const std::vector<Loosening> loosened = {{drive.start, 1.0, 1.0, 1.0}, {drive.imu[9].t, 0.01, 0.5, 0.2}};
  SmootherInput loose = run;
  loose.loosened = loosened, loose.fixes = {};
  ErrorStateFilter one = started_filter(loose), other = started_filter(loose);
  std::size_t after = 0;
  run_filter(loose, *samples, one, [&](const ImuSample& s) { wrong += s.t == drive.imu[after++].t ? 0 : 1; });
  for (std::size_t k = 0; k < samples->size(); ++k) {
    other.predict((*samples)[k]);
    if (k == 9) other.loosen(0.01, 0.5, 0.2);
  }
  wrong += one.covariance() == other.covariance() && after == samples->size() ? 0 : 1;
  drive.fixes.clear();
  wrong += smoothed_by("none", drive).states.size() == 41 &&
                   smoothed_by("none", drive, "smoothed_interval_s = 0").states.size() == 80 &&
                   smoothed_by("rts", drive, "smoothed_interval_s = 0.5").states.size() == 9
               ? 0
               : 1;
  return {1.0 * wrong, 0.0};
}

/// Of the unit's state the body's: place, velocity and covariances of a filter that has turned, moved and been
/// corrected, as the filter itself says them, but for what it knows of the gyroscopes' biases.
StressFigure of_the_body() {
  Looks looks;
  Drive drive = simulated_drive(6, {.seconds = 3.0, .outage_from_s = 1e9});
  drive.lever_U_B = Vector3d(0.4, -0.3, 0.9);
  ErrorStateFilter filter(drive.config, drive.noise, drive.frame, drive.lever_U_B, drive.lever_A_B);
  filter.initialize(drive.start, drive.X_WB, drive.v_WB_W);
  for (std::size_t k = 0; k < drive.imu.size(); ++k) filter.predict(drive.imu[k]);
  for (const GnssFix& fix : drive.fixes)
    if (fix.t == filter.nav_state().t) filter.update(fix);
  const NavEstimate by_filter = filter.estimate(),
                    found = estimate_of(RtsSmoother::filtered(filter), drive.frame, drive.lever_U_B);
  looks.right(found.t == by_filter.t && found.gyro_bias_U == by_filter.gyro_bias_U &&
              found.accel_bias_U == by_filter.accel_bias_U);
  looks.near((found.X_WB.p - by_filter.X_WB.p).norm(), 0.0, 1e-8),
      looks.near(found.X_WB.R.angularDistance(by_filter.X_WB.R), 0.0, 1e-7);
  looks.near((found.v_WB_W - by_filter.v_WB_W).norm(), 0.0, 1e-12);
  looks.near(apart_by_sigma(by_filter.pose_covariance, found.pose_covariance), 0.0, 1e-9);
  // A metre of lever arm times the biases' 2e-4 rad/s, beside 5 cm/s.
  const Matrix3d less = by_filter.velocity_covariance_W - found.velocity_covariance_W;
  looks.near(less.norm() / by_filter.velocity_covariance_W.norm(), 0.0, 0.02);
  const auto both = filter.body_covariance();
  looks.near(apart_by_sigma(by_filter.pose_covariance, both.topLeftCorner<6, 6>()), 0.0, 1e-9);
  looks.near(apart_by_sigma(by_filter.velocity_covariance_W, both.bottomRightCorner<3, 3>()), 0.0, 1e-9);
  looks.near((both - both.transpose()).norm(), 0.0, 1e-14 * both.norm());
  return looks.figure();
}

/// The run of a filter with one of its fixes moved, and without: what it is told to do to the body's place, first order
/// (errors a thousandth of the usual ones, moved by a third of a sigma): a thousandth.
StressFigure moved_fixes() {
  Looks looks;
  const Drive drive = simulated_drive(
      4, {.seconds = 6.0, .rate_hz = 20.0, .outage_from_s = 1e9, .noise_scale = 1e-3, .keys = "states = [\"biases\"]"});
  const double by_m = 1.6e-4;
  const auto end_of = [&](int moved_fix, const Vector3d& by, FixResponse* response) {
    ErrorStateFilter filter(drive.config, drive.noise, drive.frame, drive.lever_U_B, drive.lever_A_B);
    filter.initialize(drive.start, drive.X_WB, drive.v_WB_W);
    if (response != nullptr) filter.watch(response);
    std::size_t next = 0;
    for (const ImuSample& sample : drive.imu) {
      filter.predict(sample);
      for (; next < drive.fixes.size() && drive.fixes[next].t <= sample.t; ++next) {
        GnssFix fix = drive.fixes[next];
        if (static_cast<int>(next) == moved_fix) fix.p_A_E += by;
        if (response != nullptr) response->expect(1.0 + 0.5 * static_cast<double>(next));
        filter.update(fix);
      }
      if (sample.t == drive.imu[drive.imu.size() - 7].t) break;
    }
    return filter;
  };
  FixResponse response;
  const ErrorStateFilter plain = end_of(-1, Vector3d::Zero(), &response);
  const Vector3d up = drive.frame.R_EW().col(2);
  Eigen::Matrix<double, 3, 9> of_unit = Eigen::Matrix<double, 3, 9>::Zero();
  of_unit.middleCols<3>(3).setIdentity();
  const FixResponse::Moved told = response.moved(of_unit, up);
  double any = 0.0, upwards = 0.0;
  for (int k = 0; k < 5; ++k) {
    Matrix3d J;
    for (int axis = 0; axis < 3; ++axis)
      J.col(axis) = (end_of(k, by_m * Vector3d::Unit(axis), nullptr).nav_state().p_EU_E -
                     end_of(k, -by_m * Vector3d::Unit(axis), nullptr).nav_state().p_EU_E) /
                    (2.0 * by_m);
    const double moved = 1.0 + 0.5 * k;
    any += moved * std::sqrt(Eigen::SelfAdjointEigenSolver<Matrix3d>(J * J.transpose()).eigenvalues()[2]);
    upwards += moved * (J.transpose() * up).norm();
  }
  looks.right(plain.nav_state().t == drive.imu[drive.imu.size() - 7].t);
  // A place on Earth rounds by 1e-9 of 3e-4 m.
  looks.near(told.any_m / any, 1.0, 2e-3), looks.near(told.up_m / upwards, 1.0, 2e-3);
  return looks.figure();
}

/// What steps do to an estimate by chance is the sum, over steps, of the squares of what each does alone, corrections
/// in between; and all together what they do one by one. Roundings of 60 steps.
StressFigure moved_steps() {
  Looks looks;
  const Drive drive = simulated_drive(8, {.seconds = 3.0,
                                          .rate_hz = 20.0,
                                          .outage_from_s = 1e9,
                                          .keys = "states = [\"biases\", \"fix_error\"]\nfix_error_way_m = 5"});
  DrawnNumbers draw(6);
  std::vector<StepMove> moves;
  for (std::size_t k = 0; k < drive.imu.size(); ++k)
    moves.push_back({1e-4 * draw.three(), 1e-3 * draw.three(), 1e-3 * draw.three()});
  Eigen::Matrix<double, 3, 9> J = Eigen::Matrix<double, 3, 9>::Zero();
  J.middleCols<3>(3).setIdentity(), J.leftCols<3>() = 0.3 * draw.any(3, 3);
  // Effects at once: all steps; and a few steps alone.
  const std::vector<std::size_t> alone = {0, 7, 19, 20, 33, 58};
  const auto run = [&](bool all, std::size_t only) {
    auto response = std::make_unique<StepResponse>();
    ErrorStateFilter filter(drive.config, drive.noise, drive.frame, drive.lever_U_B, drive.lever_A_B);
    filter.initialize(drive.start, drive.X_WB, drive.v_WB_W);
    filter.watch(response.get());
    std::size_t next = 0;
    for (std::size_t k = 0; k < drive.imu.size(); ++k) {
      const bool among = std::find(alone.begin(), alone.end(), k) != alone.end();
      response->expect({(all ? among : k == only) ? moves[k] : StepMove{}, StepMove{}});
      filter.predict(drive.imu[k]);
      for (; next < drive.fixes.size() && drive.fixes[next].t <= drive.imu[k].t; ++next)
        filter.update(drive.fixes[next]);
    }
    filter.watch(nullptr);
    return response;
  };
  const auto together = run(true, 0);
  Vector3d sum = Vector3d::Zero();
  Matrix3d squares = Matrix3d::Zero();
  for (const std::size_t k : alone) {
    const auto one = run(false, k);
    const Vector3d moved = one->moved_E(0, J);
    looks.near((one->by_chance_E(0, J) - moved * moved.transpose()).norm() / moved.squaredNorm(), 0.0, 1e-13);
    sum += moved, squares += moved * moved.transpose();
  }
  looks.near((together->moved_E(0, J) - sum).norm() / sum.norm(), 0.0, 1e-13);
  looks.near((together->by_chance_E(0, J) - squares).norm() / squares.norm(), 0.0, 1e-13);
  looks.right(together->moved_E(1, J).isZero(0.0) && together->by_chance_E(1, J).isZero(0.0));
  return looks.figure();
}

/// Motion by prediction alone, of a unit without noise: B now in B then, and its covariance by the differences of runs
/// from starts that are off by a little, as far off as the filter says they may be. First order: a part in 1e4, and of
/// turns a hundredth.
StressFigure predicted_motion() {
  Looks looks;
  Drive drive = simulated_drive(2, {.seconds = 2.0,
                                    .rate_hz = 20.0,
                                    .outage_from_s = 1e9,
                                    .noise_scale = 1e-2,
                                    .keys = "states = [\"wheel_scale\"]"});
  drive.noise = {};
  drive.lever_U_B = Vector3d(0.3, -0.5, 0.8);
  const auto at_end = [&](const Eigen::Matrix<double, 9, 1>& off, RelativePose* told) {
    ErrorStateFilter filter(drive.config, drive.noise, drive.frame, drive.lever_U_B, drive.lever_A_B);
    // Errors of the unit: attitude about its own axes, place and velocity along W's.
    const Pose X_WU = drive.X_WB * Pose{Eigen::Quaterniond::Identity(), drive.lever_U_B};
    const Pose moved{X_WU.R * so3_exp(off.head<3>()), X_WU.p + off.segment<3>(3)};
    filter.initialize(drive.start, moved * Pose{Eigen::Quaterniond::Identity(), -drive.lever_U_B},
                      drive.v_WB_W + off.tail<3>());
    const Pose start = filter.body_pose().X_EB;
    PredictedMotion motion(filter);
    for (const ImuSample& sample : drive.imu) filter.predict(sample), motion.predict(sample);
    if (told != nullptr) *told = motion.motion();
    return start.inverse() * filter.body_pose().X_EB;
  };
  RelativePose told;
  const Pose plain = at_end(Eigen::Matrix<double, 9, 1>::Zero(), &told);
  looks.right(told.target == drive.start && told.source == drive.imu.back().t);
  looks.near((plain.inverse() * told.X_TS).log().norm(), 0.0, 1e-8);
  ErrorStateFilter filter(drive.config, drive.noise, drive.frame, drive.lever_U_B, drive.lever_A_B);
  filter.initialize(drive.start, drive.X_WB, drive.v_WB_W);
  Eigen::Matrix<double, 9, 9> T = Eigen::Matrix<double, 9, 9>::Identity();
  T.block<3, 3>(3, 3) = T.block<3, 3>(6, 6) = drive.frame.R_EW().transpose();
  const Eigen::Matrix<double, 9, 9> P = T * filter.covariance().topLeftCorner<9, 9>() * T.transpose();
  Eigen::Matrix<double, 6, 9> J;
  for (int i = 0; i < 9; ++i) {
    const double h = i < 3 ? 1e-4 : 1e-2;
    const Eigen::Matrix<double, 9, 1> off = h * Eigen::Matrix<double, 9, 1>::Unit(i);
    J.col(i) =
        ((plain.inverse() * at_end(off, nullptr)).log() - (plain.inverse() * at_end(-off, nullptr)).log()) / (2.0 * h);
  }
  const MatrixXd expected = J * P * J.transpose();
  // Turns about its own start are known: beside the largest of each kind.
  const double turn = expected.diagonal().head<3>().maxCoeff<Eigen::PropagateNaN>() + 1e-14,
               way = expected.diagonal().tail<3>().maxCoeff<Eigen::PropagateNaN>();
  looks.near((told.covariance.bottomRightCorner<3, 3>() - expected.bottomRightCorner<3, 3>())
                     .cwiseAbs()
                     .maxCoeff<Eigen::PropagateNaN>() /
                 way,
             0.0, 1e-4);
  looks.near((told.covariance.topLeftCorner<3, 3>() - expected.topLeftCorner<3, 3>())
                     .cwiseAbs()
                     .maxCoeff<Eigen::PropagateNaN>() /
                 turn,
             0.0, 1e-2);
  looks.right(told.covariance == told.covariance.transpose());
  looks.right(is_of_motion(OdometerSample{}) && is_of_motion(BarometerSample{}) && is_of_motion(MagnetometerSample{}) &&
              is_of_motion(HeadingSample{}) && !is_of_motion(GnssFix{}) && !is_of_motion(GnssEpoch{}) &&
              !is_of_motion(PoseInMap{}) && !is_of_motion(RelativePose{}));
  PredictedMotion motion(filter);
  looks.right(stress::not_refused([&] { motion.update(AidingMessage(GnssFix{})); }) == 0);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> run_cases() {
  StressRows rows;
  rows.of({StressGroup::kStiff, "a graph against one dense system",
           "a row of another node, a weight that counts twice, a term lost in elimination",
           "blocks of the inverse, and the Schur complement: a millionth of a sigma", "of the bound"});
  rows.add("runs/dense_graph", [] { return dense_graph("states = [\"biases\", \"gains\"]"); });
  rows.add("runs/dense_graph_of_a_vehicle", [] {
    return dense_graph(
        "states = [\"turn_on_biases\", \"in_run_biases\", \"fix_error\"]\nmeasurements = [\"position\", "
        "\"non_holonomic\"]\nfix_error_sigma_m = 0.2");
  });
  rows.add("runs/priors", priors);
  rows.of({StressGroup::kData, "what comes with which sample",
           "a message of before the start, a node too late, a loosening twice", "by hand: exact", "wrong"});
  rows.add("runs/what_comes_when", coming);
  rows.of({StressGroup::kGeometry, "the body's estimate, and what moves an estimate",
           "a lever arm of the other sign, a response of another fix, a step that counts twice",
           "the filter's own words, other runs' differences, sums over steps: first order and roundings",
           "of the bound"});
  rows.add("runs/of_the_body", of_the_body)
      .add("runs/moved_fixes", moved_fixes)
      .add("runs/moved_steps", moved_steps)
      .add("runs/predicted_motion", predicted_motion);
  return rows.take();
}

}  // namespace canyon::fusion
