// A smoother back over states that begin anew, and poses that are solved for far from where they were put.
#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/stress/looks.h"
#include "canyon/fusion/smoothing/pose_graph/pose_graph.h"
#include "canyon/fusion/smoothing/rts_smoother.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/stress/drawn_numbers.h"
#include "canyon/fusion/stress/parts/subjects.h"
#include "canyon/fusion/stress/simulated_drive.h"

namespace canyon::fusion {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using stress::Looks;

/// An instant, a step of the unit, states renewed in part, a measurement of several states, a restart in between or
/// none, another instant: what the measurement says of the first one, by P H' S^-1 r with H carried back over step and
/// renewal as plain matrices. Roundings of 15 x 15 products.
StressFigure over_renewals(bool restarted) {
  Looks looks;
  const Drive drive = simulated_drive(11, {.seconds = 1.0, .rate_hz = 20.0, .keys = "states = [\"biases\"]"});
  ErrorStateFilter filter(drive.config, drive.noise, drive.frame, drive.lever_U_B, drive.lever_A_B);
  filter.initialize(drive.start, drive.X_WB, drive.v_WB_W);
  for (int k = 0; k < 10; ++k) filter.predict(drive.imu[static_cast<std::size_t>(k)]);
  ErrorState state({"biases"}, drive.config.own, {.noise = drive.noise});
  state.start(filter.nav_state());
  const int n = state.size(), padded = state.padded_size();
  ErrorPropagation step(state, drive.noise);
  step.set_interval(0.3);
  const Increments in{.dt_s = 0.3, .dtheta_U = {0.02, -0.01, 0.05}, .dv_U = {0.3, 0.1, 2.9}};
  step.set_step(state, in, Calibration{}, Eigen::Matrix3d::Zero());
  ErrorMatrix moved = ErrorMatrix::Identity(padded, padded);
  step.move(moved);
  MatrixXd Phi = MatrixXd(moved).topLeftCorner(n, n);
  const std::vector<Renewal> renewals{{10, 0.25}, {13, 0.0}, {14, 0.5}};
  for (const auto& [row, kept] : renewals) Phi.row(row) *= kept;

  DrawnNumbers draw(5);
  Measurement m(3, state, ErrorIndex::kPosition);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < n; ++j) m.H(i, j) = draw.next();
  m.residual = 0.01 * draw.three();
  Correction correction{.measurement = m, .gain = MatrixXd::Zero(padded, 3), .S_inverse = MatrixXd(3, 3)};
  correction.gain.topRows(n) = 1e-3 * draw.any(n, 3);
  correction.S_inverse = draw.positive(3, 0.5);

  RtsSmoother smoother;
  smoother.begin(state);
  smoother.keep(filter);
  smoother.predicted(step);
  smoother.renewed(renewals);
  if (restarted) smoother.restarted(m);
  smoother.corrected(correction);
  smoother.keep(filter);

  const MatrixXd P = MatrixXd(filter.covariance()).topLeftCorner(n, n);
  MatrixXd H = MatrixXd(m.H).leftCols(n);
  if (restarted) H.setZero();
  const MatrixXd back = H * Phi;
  const VectorXd error = P * back.transpose() * correction.S_inverse * VectorXd(m.residual);
  const MatrixXd smoothed = P - P * back.transpose() * correction.S_inverse * back * P;
  int instant = 0;
  smoother.smooth([&](const SmoothedState& found, const VectorXd& values, const MatrixXd& covariance) {
    const NavState now = filter.nav_state();
    const bool first = ++instant == 2;
    const VectorXd e = first ? error : VectorXd::Zero(n);
    const Eigen::Matrix<double, 9, 1> off = error_of(found.nav, now);
    // Places on Earth round by a nanometre.
    for (int i = 0; i < 9; ++i) looks.near(off[i], e[i], 1e-9 * e.head<9>().norm() + (i / 3 == 1 ? 4e-9 : 1e-12));
    for (int i = 9; i < n; ++i) looks.near(values[i - 9], e[i], 1e-12 * (1.0 + e.norm()));
    looks.near((found.gyro_bias_U - filter.calibration().gyro_bias - e.segment<3>(9)).norm(), 0.0, 1e-12);
    looks.near((found.accel_bias_U - filter.calibration().accel_bias - e.segment<3>(12)).norm(), 0.0, 1e-12);
    looks.near((found.w_EU_U - filter.angular_rate() + e.segment<3>(9)).norm(), 0.0, 1e-12);
    const MatrixXd expected = first ? smoothed : P;
    looks.near((covariance - expected).norm() / P.norm(), 0.0, 1e-12);
    looks.right(covariance == covariance.transpose() && found.covariance == covariance.topLeftCorner(9, 9));
  });
  looks.right(instant == 2 && smoother.smooth().size() == 2);
  return looks.figure();
}

/// A round of poses, each known from the one before and from the one across, begun far from where they are: the sum of
/// squares is level there (its gradient by the rows themselves), the same from another start, and as Gauss and Newton
/// say of one step more. Ceres ends where a step gains less than 1e-10 of the cost, which the weakest direction may
/// hold.
StressFigure rounds_of_poses() {
  Looks looks;
  DrawnNumbers draw(8);
  constexpr std::size_t kPoses = 9;
  PoseGraph graph;
  std::vector<Pose> truth;
  for (std::size_t k = 0; k < kPoses; ++k) {
    const double a = 2.0 * 3.141592653589793 * static_cast<double>(k) / kPoses;
    truth.push_back({rotation_from({.yaw_rad = a, .pitch_rad = 0.1 * std::sin(a), .roll_rad = 0.05}),
                     {20.0 * std::cos(a), 20.0 * std::sin(a), std::sin(2.0 * a)}});
  }
  const auto relate = [&](std::size_t source, std::size_t target) {
    const Matrix6d P = 1e-4 * draw.positive(6, 1.0);
    graph.relative.push_back({.source = source,
                              .target = target,
                              .X_TS = truth[target].inverse() * truth[source] * Pose::exp(draw.xi(0.01, 0.02)),
                              .covariance = P});
  };
  for (std::size_t k = 0; k < kPoses; ++k) relate((k + 1) % kPoses, k), relate((k + 4) % kPoses, k);
  graph.absolute.push_back({2, truth[2] * Pose::exp(draw.xi(0.01, 0.02)), 1e-4 * draw.positive(6, 1.0)});
  graph.absolute.push_back({6, truth[6] * Pose::exp(draw.xi(0.01, 0.02)), 1e-4 * draw.positive(6, 1.0)});
  std::vector<Pose> before;
  double cost_before = 0.0;
  for (const double off : {0.3, 0.05}) {
    graph.X_WS.clear();
    for (const Pose& X : truth) graph.X_WS.push_back(X * Pose::exp(draw.xi(0.5 * off, 2.0 * off)));
    const auto cost_of = [&] {
      double sum = 0.0;
      for (const auto& known : graph.relative)
        sum += 0.5 * relative_rows(known, graph.X_WS[known.source], graph.X_WS[known.target]).residual.squaredNorm();
      for (const auto& known : graph.absolute)
        sum += 0.5 * absolute_rows(known, graph.X_WS[known.node]).residual.squaredNorm();
      return sum;
    };
    const double begun = cost_of();
    const auto report = solve(graph, {});
    if (!report.ok()) return {stress::kInfinity, 1.0};
    looks.right(report->converged && report->iterations > 1 && report->iterations < 30);
    looks.near(report->initial_cost / begun, 1.0, 1e-12);
    looks.near(report->final_cost / cost_of(), 1.0, 1e-9);
    MatrixXd N = MatrixXd::Zero(6 * kPoses, 6 * kPoses);
    VectorXd g = VectorXd::Zero(6 * kPoses);
    const auto at = [](std::size_t k) { return static_cast<Eigen::Index>(6 * k); };
    for (const auto& known : graph.relative) {
      const RelativeRows rows = relative_rows(known, graph.X_WS[known.source], graph.X_WS[known.target]);
      MatrixXd J = MatrixXd::Zero(6, 6 * kPoses);
      J.middleCols<6>(at(known.source)) = rows.by_source, J.middleCols<6>(at(known.target)) = rows.by_target;
      N += J.transpose() * J, g += J.transpose() * rows.residual;
    }
    for (const auto& known : graph.absolute) {
      const AbsoluteRows rows = absolute_rows(known, graph.X_WS[known.node]);
      N.block<6, 6>(at(known.node), at(known.node)) += rows.by_node.transpose() * rows.by_node;
      g.segment<6>(at(known.node)) += rows.by_node.transpose() * rows.residual;
    }
    // What one more step would gain, of the cost: less than the last one gained; and how far off poses may then be.
    looks.near(0.5 * g.dot(N.fullPivLu().solve(g)) / report->final_cost, 0.0, 1e-10);
    const double least = Eigen::SelfAdjointEigenSolver<MatrixXd>(N, Eigen::EigenvaluesOnly).eigenvalues()[0];
    for (std::size_t k = 0; k < before.size(); ++k)
      looks.near((before[k].inverse() * graph.X_WS[k]).log().norm(), 0.0,
                 2.0 * std::sqrt(2e-10 * report->final_cost / least));
    if (!before.empty()) looks.near(report->final_cost / cost_before, 1.0, 2e-10);
    before = graph.X_WS, cost_before = report->final_cost;
  }
  return looks.figure();
}

/// What is refused, each by its words.
StressFigure refused_graphs() {
  StressFigure out;
  const auto with = [](const auto& change) {
    PoseGraph g;
    g.X_WS.resize(3);
    g.absolute.push_back({0, Pose{}, Matrix6d::Identity()});
    g.relative.push_back({.source = 1, .target = 0, .X_TS = Pose{}, .covariance = Matrix6d::Identity()});
    change(g);
    return g;
  };
  const auto says = [&](PoseGraph g, const std::string& words) {
    const auto found = solve(g, {});
    out.figure += !found.ok() && found.error().what.find(words) != std::string::npos ? 0.0 : 1.0;
  };
  says(with([](PoseGraph& g) { g.absolute.clear(); }), "nothing holds the others");
  says(with([](PoseGraph& g) { g.X_WS[2].p.y() = kNaN; }), "pose 2 is not finite");
  says(with([](PoseGraph& g) { g.absolute[0].node = 3; }), "pose 3 of 3");
  says(with([](PoseGraph& g) { g.absolute[0].covariance(2, 2) = -1.0; }), "known of pose 0");
  says(with([](PoseGraph& g) { g.absolute[0].X_WS.p.x() = kNaN; }), "known of pose 0");
  says(with([](PoseGraph& g) { g.relative[0].source = 3; }), "poses 0 and 3 of 3");
  says(with([](PoseGraph& g) { g.relative[0].target = 3; }), "poses 3 and 1 of 3");
  says(with([](PoseGraph& g) { g.relative[0].source = 0; }), "poses 0 and 0 of 3");
  says(with([](PoseGraph& g) { g.relative[0].covariance.setZero(); }), "known of poses 0 and 1");
  says(with([](PoseGraph& g) { g.relative[0].X_TS.p.z() = kNaN; }), "known of poses 0 and 1");
  return out;
}

}  // namespace

std::vector<StressCase> renewed_state_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kData,
           .mechanism = "a smoother back over states that begin anew",
           .why = "a state that keeps what it was, a step before its renewal, evidence that survives a restart",
           .expected = "P H' S^-1 r with plain matrices: roundings of their products",
           .unit = "of the bound",
           .loose = "of a restart nothing is left, so that its figures are nothing"});
  rows.add("renewals/smoothed_back", [] { return over_renewals(false); });
  rows.add("renewals/smoothed_back_to_a_restart", [] { return over_renewals(true); });
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "rounds of poses, solved from far off",
           .why = "a row of the other pose, a Jacobian at another tangent, an end before the least sum",
           .expected = "a level sum of squares, the same from anywhere: the solver's own 1e-10",
           .unit = "of the bound",
           .loose = "the solver may end far below what it must"});
  rows.add("renewals/rounds_of_poses", rounds_of_poses);
  rows.of({StressGroup::kData, "pose graphs that cannot be solved", "a check of another index",
           "each refused by its words: exact", "let through"});
  rows.add("renewals/refused_graphs", refused_graphs);
  return rows.take();
}

}  // namespace canyon::fusion
