// The backward pass against batch least squares of a linear chain, whose solution is known in closed form.
#include "canyon/fusion/smoothing/later_evidence.h"

#include <vector>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "canyon/core/random/random.h"

namespace canyon::fusion {
namespace {

constexpr Eigen::Index kStates = 12, kSteps = 8;

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, std::uint64_t number) {
  const RandomStream stream(5, "test.chain");
  Eigen::MatrixXd out(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i)
    for (Eigen::Index j = 0; j < columns; ++j)
      out(i, j) = stream.normal(static_cast<std::uint32_t>(i * columns + j), number);
  return out;
}

/// x+ = Phi x + w, z = H x + v.
struct Chain {
  std::vector<Transition> steps;
  std::vector<Eigen::MatrixXd> Q, H, R;
  std::vector<Eigen::VectorXd> z;
  Eigen::MatrixXd P0;
};

Eigen::MatrixXd whole(const Transition& step) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(kStates, kStates);
  out.topRows<9>() = step.moving;
  out.diagonal().tail(kStates - 9) = step.kept;
  return out;
}

/// One state is known from the start and never moves: its variance is zero throughout.
Chain chain() {
  Chain c;
  Eigen::MatrixXd root = random_matrix(kStates, kStates, 0);
  root.row(kStates - 1).setZero();
  c.P0 = root * root.transpose();
  for (std::uint64_t k = 0; k < kSteps; ++k) {
    c.steps.push_back({.moving = 0.4 * random_matrix(9, kStates, 100 + k), .kept = Eigen::Vector3d(0.9, 1.0, 1.0)});
    Eigen::MatrixXd drive = random_matrix(kStates, 4, 200 + k);
    drive.bottomRows<2>().setZero();
    c.Q.push_back(drive * drive.transpose());
    c.H.push_back(random_matrix(k % 3 + 1, kStates, 300 + k));
    c.R.push_back(0.1 * Eigen::MatrixXd::Identity(c.H.back().rows(), c.H.back().rows()));
    c.z.push_back(random_matrix(c.H.back().rows(), 1, 400 + k));
  }
  return c;
}

// All states of the chain are one Gaussian before any measurement; given all of them it is C H' (H C H' + R)^-1 z off,
// with covariance C - C H' (H C H' + R)^-1 H C.
TEST(LaterEvidence, IsBatchLeastSquaresOfALinearChain) {
  const Chain c = chain();
  constexpr Eigen::Index kAllStates = kStates * (kSteps + 1);
  Eigen::MatrixXd prior = Eigen::MatrixXd::Zero(kAllStates, kAllStates);
  prior.topLeftCorner<kStates, kStates>() = c.P0;
  Eigen::Index rows = 0;
  for (const auto& z : c.z) rows += z.size();
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(rows, kAllStates), R = Eigen::MatrixXd::Zero(rows, rows);
  Eigen::VectorXd z(rows);
  Eigen::Index row = 0;
  for (Eigen::Index k = 0; k < kSteps; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const Eigen::MatrixXd Phi = whole(c.steps[at]);
    const Eigen::Index from = k * kStates, to = from + kStates;
    prior.block(to, 0, kStates, to) = Phi * prior.block(from, 0, kStates, to);
    prior.block(0, to, to, kStates) = prior.block(to, 0, kStates, to).transpose();
    prior.block<kStates, kStates>(to, to) = Phi * prior.block<kStates, kStates>(from, from) * Phi.transpose() + c.Q[at];
    const Eigen::Index n = c.z[at].size();
    H.block(row, to, n, kStates) = c.H[at];
    R.block(row, row, n, n) = c.R[at];
    z.segment(row, n) = c.z[at];
    row += n;
  }
  const Eigen::MatrixXd gain = prior * H.transpose() * (H * prior * H.transpose() + R).inverse();
  const Eigen::VectorXd mean = gain * z;
  const Eigen::MatrixXd covariance = prior - gain * H * prior;

  // Forwards.
  std::vector<Eigen::MatrixXd> P{c.P0}, K, S_inverse;
  std::vector<Eigen::VectorXd> x{Eigen::VectorXd::Zero(kStates)}, residual;
  for (std::size_t k = 0; k < kSteps; ++k) {
    const Eigen::MatrixXd Phi = whole(c.steps[k]), predicted = Phi * P.back() * Phi.transpose() + c.Q[k];
    S_inverse.push_back((c.H[k] * predicted * c.H[k].transpose() + c.R[k]).inverse());
    K.push_back(predicted * c.H[k].transpose() * S_inverse.back());
    residual.push_back(c.z[k] - c.H[k] * (Phi * x.back()));
    x.push_back(Phi * x.back() + K.back() * residual.back());
    P.push_back(predicted - K.back() * c.H[k] * predicted);
  }
  // Backwards. Rounding: some hundred operations on numbers of up to 1e3, of which differences are taken.
  const double tolerance = 1e-9;
  LaterEvidence later(kStates);
  for (Eigen::Index k = kSteps;; --k) {
    const auto at = static_cast<std::size_t>(k);
    const Eigen::Index from = k * kStates;
    EXPECT_LT((x[at] + later.mean(P[at]) - mean.segment<kStates>(from)).cwiseAbs().maxCoeff(), tolerance) << k;
    const Eigen::MatrixXd smoothed = later.covariance(P[at]);
    EXPECT_LT((smoothed - covariance.block<kStates, kStates>(from, from)).cwiseAbs().maxCoeff(), tolerance) << k;
    EXPECT_EQ(smoothed(kStates - 1, kStates - 1), 0.0);
    if (k == 0) break;
    later.before_correction(K[at - 1], c.H[at - 1], S_inverse[at - 1], residual[at - 1]);
    later.before(c.steps[at - 1]);
  }
}

}  // namespace
}  // namespace canyon::fusion
