// Sums over the matches of two clouds, against each match by its definition, of the nearest of all points.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/LU>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/stress/looks.h"
#include "canyon/lidar/registration/engine/match_form.h"
#include "canyon/lidar/registration/engine/match_sums.h"
#include "canyon/lidar/registration/engine/robust_kernels.h"
#include "canyon/lidar/registration/engine/surface_target.h"
#include "canyon/lidar/registration/registration_covariance.h"
#include "canyon/lidar/stress/engine_pieces.h"
#include "canyon/lidar/stress/subjects.h"

namespace canyon::lidar {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3f;
using made::alike;
using made::drawn_cloud;
using stress::Looks;
using Matrix36 = Eigen::Matrix<double, 3, 6>;

double loss_slope(const std::string& kernel, double u) {
  if (kernel == "huber") return u <= 1.0 ? 1.0 : 1.0 / std::sqrt(u);
  if (kernel == "cauchy") return 1.0 / (1.0 + u);
  if (kernel == "geman_mcclure") return std::pow(1.0 + u, -2.0);
  return 1.0;
}

/// A match by its definition: in the source frame, M from the inverse of the sum of both covariances.
struct DenseMatch {
  Matrix36 J;
  Matrix3d M, across;
  Vector3d p, d;
  double cost, u, w, tilt;
};

/// Of the nearest target point, tried one by one.
std::vector<std::pair<std::size_t, DenseMatch>> dense_matches(const PreparedCloud& source, const PreparedCloud& target,
                                                              const Pose& X, const std::string& kernel, double reach_m,
                                                              double width_m, bool plane_to_plane_form) {
  std::vector<std::pair<std::size_t, DenseMatch>> out;
  const Matrix3d R = X.R.toRotationMatrix();
  for (std::size_t i = 0; i < source.points.size(); ++i) {
    const Vector3f place = (R * source.points[i].cast<double>() + X.p).cast<float>();
    std::size_t at = 0;
    for (std::size_t k = 1; k < target.points.size(); ++k)
      if ((target.points[k] - place).squaredNorm() < (target.points[at] - place).squaredNorm()) at = k;
    if (!((target.points[at] - place).norm() < static_cast<float>(reach_m))) continue;
    DenseMatch m;
    m.p = source.points[i].cast<double>();
    m.d = R.transpose() * (R * m.p + X.p - target.points[at].cast<double>());
    const Vector3d n = R.transpose() * target.normals[at].cast<double>(), s = source.normals[i].cast<double>();
    const double flat = 1.0 - 1e-3;
    // Normals in single precision are of length 1 to 1e-7 only: the closed form takes them for 1.
    const Matrix3d Cn = Matrix3d::Identity() - flat * n * n.transpose(),
                   Cs = Matrix3d::Identity() - flat * s * s.transpose();
    if (plane_to_plane_form) {
      m.M = (Cn + Cs).inverse();
      m.across = m.M - 0.5 * Matrix3d::Identity();
    } else {
      m.across = n * n.transpose() / 2e-3;
      m.M = m.across + 1e-3 * Matrix3d::Identity();
    }
    m.J << -skew(m.p), Matrix3d::Identity();
    m.cost = m.d.dot(m.M * m.d);
    m.u = 2e-3 / (width_m * width_m) * m.cost;
    m.w = loss_slope(kernel, m.u);
    m.tilt = 0.25 * (static_cast<double>(source.tilt_variance[i]) + static_cast<double>(target.tilt_variance[at]));
    out.emplace_back(i, m);
  }
  return out;
}

/// Sums of a round and of the covariance. Normals of single precision, of length 1 to 2 half ulps, enter the closed
/// form and the inverse of a matrix of condition 1000 differently: 1000 times 4 half ulps of it, and more of residuals.
StressFigure sums_over_matches(const std::string& kernel, bool plane_to_plane_form) {
  Looks looks;
  const auto source = drawn_cloud(1, 500, 10.0), target = drawn_cloud(2, 900, 10.0);
  const Pose X{rotation_from({.yaw_rad = 0.3, .pitch_rad = -0.2, .roll_rad = 0.1}), {0.4, -0.7, 0.2}};
  const double reach_m = 1.4, width_m = 0.5, block_m = 5.0;
  const auto surfaces = point_target(target);
  const Matching matching{.source = source.get(),
                          .target = surfaces.get(),
                          .form = plane_to_plane_form ? plane_to_plane : to_target_plane,
                          .kernel = model_row(robust_kernels(), kernel).make,
                          .reach_m = reach_m,
                          .width_m = width_m};
  std::vector<LastMatch> last;
  normal_equations(matching, X * Pose::exp(Vector6d::Constant(0.02)), 1, last);  // what was found a way off
  const NormalEquations found = normal_equations(matching, X, 1, last);
  const auto all = dense_matches(*source, *target, X, kernel, reach_m, width_m, plane_to_plane_form);
  const auto blocks = [&](const Vector3d& p) {
    return std::array{std::floor(p.x() / block_m), std::floor(p.y() / block_m), std::floor(p.z() / block_m)};
  };
  NormalEquations sum;
  CovarianceSums parts;
  std::map<std::array<double, 3>, std::pair<Vector6d, Matrix6d>> by_block;
  double missed = static_cast<double>(source->points.size() - all.size());
  for (const auto& [i, m] : all) {
    sum.A += m.w * m.J.transpose() * m.M * m.J;
    sum.g += m.w * m.J.transpose() * m.M * m.d;
    sum.cost += m.w * m.cost;
    sum.weight += m.w;
    sum.radius2 += m.p.squaredNorm();
    missed += m.u < 1.0 ? m.u : 1.0;
    const double trace = m.w * m.across.trace(), along = plane_to_plane_form ? 0.5 : 1e-3;
    parts.H += m.w * m.J.transpose() * m.across * m.J;
    parts.N += m.tilt * (trace * m.J.transpose() * m.J - m.w * m.J.transpose() * m.across * m.J);
    parts.cost += m.w * m.d.dot(m.across * m.d);
    parts.weight += trace;
    if (trace > 0) parts.along += m.w * along * m.J.transpose() * (m.d - m.w * m.across * m.d / trace);
    parts.point_noise += m.w * m.w * m.J.transpose() * m.M * m.M * m.J;
    parts.common_range += m.w * m.J.transpose() * m.M * m.p.normalized();
    auto& [gradient, curvature] = by_block.try_emplace(blocks(m.p), Vector6d::Zero(), Matrix6d::Zero()).first->second;
    gradient += m.w * m.J.transpose() * m.M * m.d;
    curvature += m.w * m.J.transpose() * m.M * m.J;
  }
  const double share = plane_to_plane_form ? 1000.0 * 8.0 * stress::kHalfUlp : 32.0 * stress::kHalfUlp;
  looks.right(found.matched == static_cast<std::int64_t>(all.size()) && all.size() > 200);
  alike(looks, found.A, sum.A, share);
  alike(looks, found.g, sum.g, share);
  looks.near(found.cost / sum.cost, 1.0, share);
  looks.near(found.weight / sum.weight, 1.0, share);
  looks.near(found.radius2 / sum.radius2, 1.0, 1e-12);
  looks.near(found.missed, missed / static_cast<double>(source->points.size()), share);
  const CovarianceSums c = covariance_sums(matching, X, last, block_m, true);
  alike(looks, c.A, sum.A, share);
  alike(looks, c.H, parts.H, share);
  alike(looks, c.N, parts.N, share);
  alike(looks, c.along, parts.along, share);
  alike(looks, c.point_noise, parts.point_noise, 2.0 * share);
  alike(looks, c.common_range, parts.common_range, 4.0 * share);
  looks.near(c.cost / parts.cost, 1.0, share);
  looks.near(c.weight / parts.weight, 1.0, share);
  looks.near(c.radius2 / sum.radius2, 1.0, 1e-12);
  looks.right(c.matched == found.matched && c.block_gradients.size() == by_block.size() &&
              c.block_curvatures.size() == by_block.size());
  std::vector<bool> met(c.block_gradients.size(), false);
  for (const auto& [i, m] : all) {
    const auto& [gradient, curvature] = by_block.at(blocks(m.p));
    // Blocks are numbered as they are met.
    std::size_t number = 0;
    std::vector<std::array<double, 3>> seen;
    for (const auto& [k, other] : all) {
      if (std::find(seen.begin(), seen.end(), blocks(other.p)) == seen.end()) seen.push_back(blocks(other.p));
      if (k == i) break;
    }
    number = static_cast<std::size_t>(std::find(seen.begin(), seen.end(), blocks(m.p)) - seen.begin());
    if (met.at(number)) continue;
    met[number] = true;
    alike(looks, c.block_gradients[number], gradient, share * 10.0);
    alike(looks, c.block_curvatures[number], curvature, share);
  }
  // What single points leave unexplained, and two poses against each other.
  const std::vector<double> a = missed_by_point(matching, X, last);
  const Pose Y = X * Pose::exp((Vector6d() << 0.01, 0.0, -0.02, 0.1, 0.05, 0.0).finished());
  std::vector<LastMatch> of_Y;
  normal_equations(matching, Y, 1, of_Y);
  const std::vector<double> b = missed_by_point(matching, Y, of_Y);
  std::vector<double> expected(source->points.size(), -1.0);
  for (const auto& [i, m] : all) {
    const double u = 2e-3 / (width_m * width_m) * m.d.dot(m.across * m.d);
    expected[i] = u < 1.0 ? u : 1.0;
  }
  std::map<std::array<double, 3>, double> witnesses;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    looks.near(a[i], expected[i], share);
    if (a[i] >= 0.0 && b[i] >= 0.0) witnesses[blocks(source->points[i].cast<double>())] += b[i] - a[i];
  }
  double total = 0.0, squares = 0.0;
  for (const auto& [block, d] : witnesses) total += d, squares += d * d;
  looks.near(evidence_against(a, b, *source, block_m), total / std::sqrt(squares), 1e-9);
  // Every third point alone.
  std::vector<LastMatch> third;
  const NormalEquations some = normal_equations(matching, X, 3, third);
  Matrix6d A3 = Matrix6d::Zero();
  for (const auto& [i, m] : all)
    if (i % 3 == 0) A3 += m.w * m.J.transpose() * m.M * m.J;
  alike(looks, some.A, A3, share);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> match_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kData,
           .mechanism = "sums over the matches of two clouds",
           .why = "a term of a closed form with the other normal, a weight that is not squared, a neighbour remembered",
           .expected =
               "each match by its definition, of the nearest of all points: normals' single precision times the "
               "condition",
           .unit = "of the bound"});
  for (const auto& kernel : robust_kernels())
    for (const bool plane : {true, false})
      rows.add(std::string("matches/sums_") + kernel.name + (plane ? "_plane_to_plane" : "_to_the_plane"),
               [k = std::string(kernel.name), plane] { return sums_over_matches(k, plane); });
  return rows.take();
}

}  // namespace canyon::lidar
