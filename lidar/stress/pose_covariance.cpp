// How sure a registration is of its pose: directions that the surfaces leave open, and forms of covariance.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/lidar/registration/engine/covariance_forms.h"
#include "canyon/lidar/registration/engine/open_directions.h"
#include "canyon/lidar/registration/engine/witnesses.h"
#include "canyon/lidar/registration/registration_covariance.h"
#include "canyon/lidar/stress/engine_pieces.h"
#include "canyon/lidar/stress/subjects.h"

namespace canyon::lidar {
namespace {

using Eigen::Vector3d;
using made::alike;
using made::drawn_positive;
using stress::kEpsilon;
using stress::Looks;

/// Projections where a turn counts by what it moves at the radius: idempotent, complementary, and held at a prior;
/// sizes of up to 50, of which 1e3 eps.
StressFigure open_directions_algebra(double radius_m) {
  Looks looks;
  const Vector6d root = (Vector6d() << Vector3d::Constant(radius_m), Vector3d::Ones()).finished();
  const RandomStream draws(20, "stress.open");
  const auto drawn = [&](std::uint64_t k) {
    Vector6d v;
    for (int i = 0; i < 6; ++i) v[i] = draws.normal(static_cast<std::uint32_t>(i), k) / root[i];
    return v;
  };
  OpenDirections open(radius_m);
  looks.right(open.add(drawn(0)) && open.add(drawn(1)) && !open.add(0.3 * open.open()[0] - 2.0 * open.open()[1]));
  const double grain = 1e3 * kEpsilon;
  Matrix6d held = Matrix6d::Zero();
  for (std::size_t i = 0; i < 2; ++i) {
    const Vector6d u = root.cwiseProduct(open.open()[i]);
    looks.near(u.norm(), 1.0, grain);
    looks.near(u.dot(root.cwiseProduct(open.open()[1 - i])), 0.0, grain);
    held += u * u.transpose();
  }
  const Matrix6d free = Matrix6d::Identity() - held;
  const Vector6d xi = drawn(3);
  looks.near((root.cwiseProduct(open.closed_part(xi)) - free * root.cwiseProduct(xi)).norm(), 0.0, grain * 10.0);
  const Eigen::MatrixXd basis = open.closed_basis(), dual = open.closed_dual();
  looks.near((dual * basis - Eigen::MatrixXd::Identity(4, 4)).norm(), 0.0, grain);
  looks.near((root.asDiagonal() * (basis * dual) * root.cwiseInverse().asDiagonal() - free).norm(), 0.0, grain);
  const Matrix6d C = root.cwiseInverse().asDiagonal() * drawn_positive(4) * root.cwiseInverse().asDiagonal();
  const Matrix6d whole = root.asDiagonal() * open.with_open(C, 7.0) * root.asDiagonal(),
                 scaled = root.asDiagonal() * C * root.asDiagonal();
  looks.near((whole - free * scaled * free - 49.0 * held).norm(), 0.0, 100.0 * grain);
  // Of xi along the open directions, given the others: what the prior's precision has there.
  Eigen::MatrixXd U(6, 2);
  for (int i = 0; i < 2; ++i) U.col(i) = root.cwiseProduct(open.open()[static_cast<std::size_t>(i)]);
  const Eigen::MatrixXd along = (U.transpose() * scaled.inverse() * U).inverse();
  const auto closed_by = [&](const Matrix6d& H) -> Matrix6d {
    const Eigen::MatrixXd euclidean = root.asDiagonal() * basis;
    return euclidean * (euclidean.transpose() * H * euclidean).inverse() * euclidean.transpose();
  };
  const auto unscaled = [&](const Matrix6d& m) -> Matrix6d {
    return root.cwiseInverse().asDiagonal() * m * root.cwiseInverse().asDiagonal();
  };
  // Of few blocks the bound, of many what they scatter.
  const Matrix6d few = drawn_positive(5);
  const Matrix6d bound = (along * U.transpose() * few * U).trace() / 9.0 * closed_by(few);
  alike(looks, open.leaning(std::vector<Matrix6d>(9, root.asDiagonal() * few * root.asDiagonal() / 9.0), C).covariance,
        unscaled(bound), 1e-10);
  std::vector<Matrix6d> blocks;
  Matrix6d sum = Matrix6d::Zero(), scatter = Matrix6d::Zero();
  for (int k = 0; k < 30; ++k) {
    const Matrix6d one = drawn_positive(40 + k);
    blocks.emplace_back(root.asDiagonal() * one * root.asDiagonal());
    sum += one;
    scatter += 30.0 / 24.0 * one * (U * along * U.transpose()) * one;
  }
  alike(looks, open.leaning(blocks, C).covariance, unscaled(closed_by(sum) * scatter * closed_by(sum)), 1e-10);
  // Held where no move along its open directions makes it likelier.
  const Pose at{rotation_from({.yaw_rad = 0.4, .pitch_rad = 0.1, .roll_rad = -0.2}), {5.0, -3.0, 1.0}};
  const PriorLaw prior = *PriorLaw::of({.X_TS = at, .covariance = C});
  const Pose off = at * Pose::exp(0.1 * drawn(6));
  const Pose back = open.held_at(prior, off);
  const Matrix6d precision = (root.asDiagonal() * prior.covariance_at(back) * root.asDiagonal()).inverse();
  const Vector6d left = root.cwiseProduct(prior.off(back));
  looks.near((U.transpose() * precision * left).norm(), 0.0, 1e-8 * precision.norm());
  const Vector6d way = (off.inverse() * back).log();
  looks.near((free * root.cwiseProduct(way)).norm(), 0.0, 0.05 * root.cwiseProduct(way).norm() + 1e-9);
  OpenDirections wide(radius_m);
  const double most_m = 1.5, most_rad = 1.2 / radius_m;
  wide.open_wide(C, most_m, most_rad);
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(scaled);
  int expected = 0;
  for (int k = 0; k < 6; ++k) {
    const Vector6d one_sigma = std::sqrt(eigen.eigenvalues()[k]) * eigen.eigenvectors().col(k);
    expected += one_sigma.tail<3>().norm() > most_m || one_sigma.head<3>().norm() / radius_m > most_rad ? 1 : 0;
  }
  looks.right(static_cast<int>(wide.open().size()) == expected);
  for (const Vector6d& v : wide.open()) {
    const Vector6d u = root.cwiseProduct(v), Su = scaled * u;
    looks.near((Su - u.dot(Su) * u).norm(), 0.0, 1e-11 * Su.norm());
  }
  return looks.figure();
}

/// Forms of covariance from sums that are known, each by its formula; the bootstrap to what 200 drawings leave.
StressFigure forms(int blocks) {
  Looks looks;
  CovarianceSums sums;
  sums.A = 50.0 * drawn_positive(30);
  sums.H = 0.9 * sums.A;
  sums.cost = 3.0, sums.weight = 700.0, sums.matched = 900;
  sums.along << 0.1, -0.2, 0.05, 0.3, 0.0, 0.1;
  sums.point_noise = drawn_positive(31);
  sums.common_range << 1.0, -2.0, 0.5, 3.0, -1.0, 0.2;
  const RandomStream draws(32, "stress.forms");
  Matrix6d squares = Matrix6d::Zero();
  Vector6d total = Vector6d::Zero();
  for (std::uint64_t b = 0; b < static_cast<std::uint64_t>(blocks); ++b) {
    Vector6d g;
    for (int i = 0; i < 6; ++i) g[i] = draws.normal(static_cast<std::uint32_t>(i), b);
    sums.block_gradients.push_back(g);
    total += g;
  }
  for (Vector6d& g : sums.block_gradients) {
    g -= total / blocks;
    squares += g * g.transpose();
    sums.block_curvatures.push_back(sums.A / blocks);
  }
  std::vector<Vector6d> restarts;
  Matrix6d spread = Matrix6d::Zero();
  for (std::uint64_t k = 0; k < 12; ++k) {
    Vector6d xi;
    for (int i = 0; i < 6; ++i) xi[i] = 0.01 * draws.normal(static_cast<std::uint32_t>(10 + i), k);
    restarts.push_back(xi);
    spread += xi * xi.transpose() / 12.0;
  }
  const CovarianceCase of{sums, 0.02, 0.03, restarts};
  const auto form = [&](const char* name) { return model_row(covariance_forms(), name).make.gradient(of); };
  const double n = 900.0, b = blocks;
  Matrix6d scatter = 1e-6 * 700.0 / n * sums.A + sums.along * sums.along.transpose();
  if (blocks < 24)
    scatter += 3.0 / (n - 6.0) * (n / b) * sums.A;
  else
    scatter += b / (b - 6.0) * squares;
  alike(looks, form("hessian"), Matrix6d(3.0 / (n - 6.0) * sums.A), 1e-12);
  alike(looks, form("sandwich"), scatter, 1e-12);
  alike(looks, form("calibrated"), scatter, 1e-12);
  const Matrix6d noise = 2.0 * 0.02 * 0.02 * sums.point_noise;
  alike(looks, form("censi"), noise, 1e-12);
  alike(looks, form("guess_and_bias"),
        Matrix6d(sums.A * spread * sums.A + noise +
                 2.0 * 0.03 * 0.03 * sums.common_range * sums.common_range.transpose()),
        1e-12);
  if (blocks < 12)
    alike(looks, form("sampled"), scatter, 1e-12);
  else
    // Of equal curvatures a drawing's gradient is that of so many blocks: its scatter is the sum of their squares, each
    // of 36 numbers to sqrt(2 / 200), and as a whole to five of it.
    alike(looks, form("sampled"), squares, 5.0 * std::sqrt(2.0 / 200.0));
  // Where nothing is open, A^-1 B A^-1 but for what errors of the normals feign, here next to nothing.
  sums.radius2 = n * 25.0;
  sums.N = 1e-9 * Matrix6d::Identity();
  const RegistrationPrecision precision = registration_precision(sums, scatter);
  const Matrix6d plain = sums.A.inverse() * scatter * sums.A.inverse();
  looks.right(precision.unconstrained == 0 && precision.open.empty());
  alike(looks, precision.covariance, plain, 1e-4);
  looks.near(precision.rms_m, std::sqrt(3.0 / 700.0), 1e-14);
  // With tilts: ratio r has its part scaled by r / (r - 4), below 4 it is open with 10 m at the radius.
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(sums.H);
  const Matrix6d U = eigen.eigenvectors();
  const Vector6d ratios = (Vector6d() << 2.0, 5.0, 8.0, 20.0, 100.0, 1e4).finished();
  sums.N = U * eigen.eigenvalues().cwiseQuotient(ratios).asDiagonal() * U.transpose();
  sums.radius2 = n;  // a metre: the metric is the identity
  const RegistrationPrecision open = registration_precision(sums, scatter);
  looks.right(open.unconstrained == 1 && open.open.size() == 1);
  Matrix6d gained = Matrix6d::Zero();
  for (int k = 1; k < 6; ++k) gained += ratios[k] / (ratios[k] - 4.0) * U.col(k) * U.col(k).transpose();
  const Matrix6d expected = gained * plain * gained.transpose() + 100.0 * U.col(0) * U.col(0).transpose();
  // 1e-9 of (weight + n / 2) is added to N, of some 10: a part in 1e6 of ratios, times r / (r - 4) once more.
  alike(looks, open.covariance, expected, 1e-4);
  return looks.figure();
}

/// Share of Student's distribution beyond -t and t: with x = sqrt(degrees) tan(angle) an integral of a power of a
/// cosine, by the rule of midpoints to 1e-6.
double student_tail(double t, double degrees) {
  constexpr int kParts = 4000;
  const double from = std::atan(t / std::sqrt(degrees)), step = (0.5 * kPi - from) / kParts;
  double sum = 0.0;
  for (int k = 0; k < kParts; ++k) sum += std::pow(std::cos(from + (k + 0.5) * step), degrees - 1.0);
  return 2.0 / std::sqrt(kPi) * std::exp(std::lgamma(0.5 * (degrees + 1.0)) - std::lgamma(0.5 * degrees)) * sum * step;
}

/// Student's bound over the normal's of 3.2905: as wide as it must be, and no wider than is said.
StressFigure student_bounds() {
  Looks looks;
  for (const double degrees : {1.0, 1.1, 1.5, 1.9, 2.0, 2.4, 3.0, 3.5, 4.5, 7.5, 9.0, 13.0, 25.0, 40.0, 90.0, 300.0}) {
    const double t = 3.2905 * student_over_normal(degrees), wide = degrees < 2.0 ? 0.3 : degrees < 3.0 ? 0.04 : 0.01;
    looks.right(student_tail(t * (1.0 + 2e-4), degrees) < 1e-3);
    looks.right(student_tail(t / (1.0 + wide), degrees) > 1e-3);
  }
  looks.near(student_over_normal(1e9), 1.0, 1e-6);
  looks.right(std::isinf(student_over_normal(0.99)) &&
              std::isinf(student_over_normal(std::numeric_limits<double>::quiet_NaN())));
  return looks.figure();
}

/// A cloud of so many blocks of which three alone tell of the first direction, and one more of an open one: by
/// definition, and each axis as wide as its own witnesses make it.
StressFigure told_by_few(int blocks) {
  Looks looks;
  const double radius_m = 5.0;
  const Vector6d root = (Vector6d() << Vector3d::Constant(radius_m), Vector3d::Ones()).finished();
  CovarianceSums sums;
  for (int b = 0; b < blocks; ++b) {
    // Where a turn counts by what it moves: the fourth of xi by three blocks, the fifth by one, the others by all.
    Vector6d told = Vector6d::Constant(2.0 / blocks);
    told[3] = b < 3 ? 0.5 : 0.0;
    told[4] = b == 7 ? 0.1 : 0.0;
    const Vector6d of_xi = told.cwiseProduct(root.cwiseAbs2());
    sums.block_surfaces.emplace_back(of_xi.asDiagonal());
    sums.A += sums.block_surfaces.back();
  }
  const Vector6d alone = Vector6d::Unit(3), mixed = (Vector6d() << 0.1, 0.0, 0.0, 0.3, 0.0, 0.7).finished();
  double sum = 0.0, squares = 0.0;
  for (const Matrix6d& H : sums.block_surfaces) {
    const double w = mixed.dot(H * mixed);
    sum += w, squares += w * w;
  }
  const double grain = 1e3 * kEpsilon;
  looks.near(witnesses(sums, alone), 3.0, grain);
  looks.near(witnesses(sums, mixed), sum * sum / squares, grain * blocks);
  looks.right(witnesses(sums, Vector6d::Zero()) == 0.0);
  OpenDirections open(radius_m);
  open.add(Vector6d::Unit(4));
  Vector6d variances;
  variances << 1e-6, 2e-6, 3e-6, 4e-4, 100.0, 5e-4;
  const Vector6d of_xi = variances.cwiseQuotient(root.cwiseAbs2());
  const Vector6d wider = widened_by_witnesses(of_xi.asDiagonal(), sums, open).diagonal().cwiseQuotient(of_xi);
  const bool few = blocks < 24;  // their residuals are taken together
  const double by_all = few ? 1.0 : student_over_normal(blocks - 1.0), by_three = few ? 1.0 : student_over_normal(2.0);
  Vector6d expected = Vector6d::Constant(by_all * by_all);
  expected[3] = by_three * by_three;
  expected[4] = 1.0;
  for (int k = 0; k < 6; ++k) looks.near(wider[k], expected[k], grain * expected[k]);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> pose_covariance_cases() {
  StressRows rows;
  rows.of(made::said_of_a_pose());
  for (const double radius_m : {1.0, 14.0, 0.2})
    rows.add("pose_covariance/open_directions_at_" + stress::text(radius_m) + "_m",
             [radius_m] { return open_directions_algebra(radius_m); });
  for (const int blocks : {8, 20, 60})
    rows.add("pose_covariance/covariance_of_" + std::to_string(blocks) + "_blocks", [blocks] { return forms(blocks); });
  rows.add("pose_covariance/bounds_of_few", student_bounds);
  for (const int blocks : {20, 30, 200})
    rows.add("pose_covariance/told_by_few_of_" + std::to_string(blocks) + "_blocks",
             [blocks] { return told_by_few(blocks); });
  return rows.take();
}

}  // namespace canyon::lidar
