// The engine of the own registrations, piece by piece: sums over matches, trees, planes, open directions and forms of
// covariance, each against the definition written out over all points.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "canyon/core/motion/adjoint.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/lidar/loops/loop_closures.h"
#include "canyon/lidar/registration/cloud_pair.h"
#include "canyon/lidar/registration/engine/covariance_forms.h"
#include "canyon/lidar/registration/engine/leaf_tree.h"
#include "canyon/lidar/registration/engine/match_form.h"
#include "canyon/lidar/registration/engine/match_sums.h"
#include "canyon/lidar/registration/engine/open_directions.h"
#include "canyon/lidar/registration/engine/robust_kernels.h"
#include "canyon/lidar/registration/engine/surface_cloud.h"
#include "canyon/lidar/registration/engine/surface_target.h"
#include "canyon/lidar/registration/neighbour_tree.h"
#include "canyon/lidar/registration/registration_covariance.h"
#include "canyon/lidar/stress/made_clouds.h"
#include "canyon/lidar/stress/subjects.h"

namespace canyon::lidar {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3f;
using Matrix36 = Eigen::Matrix<double, 3, 6>;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Looks;

/// Drawn points with normals and tilts of their own, and a few without a plane.
std::shared_ptr<PreparedCloud> drawn_cloud(std::uint64_t number, int n, double half_m) {
  const RandomStream draws(number, "stress.engine");
  auto cloud = std::make_shared<PreparedCloud>();
  for (std::uint64_t k = 0; k < static_cast<std::uint64_t>(n); ++k) {
    cloud->points.emplace_back(static_cast<float>(draws.uniform(-half_m, half_m, 0, k)),
                               static_cast<float>(draws.uniform(-half_m, half_m, 1, k)),
                               static_cast<float>(draws.uniform(-0.3 * half_m, 0.3 * half_m, 2, k)));
    const Vector3d normal = Vector3d(draws.normal(3, k), draws.normal(4, k), draws.normal(5, k)).normalized();
    cloud->normals.push_back(k % 17 == 3 ? Vector3f(0, 0, 0) : Vector3f(normal.cast<float>()));
    cloud->tilt_variance.push_back(k % 17 == 3 ? 0.0f : static_cast<float>(draws.uniform(1e-5, 1e-3, 6, k)));
  }
  const auto tree = std::make_shared<LeafTree>(cloud->points);
  PreparedCloud ordered;
  for (const std::uint32_t k : tree->order()) {
    ordered.points.push_back(cloud->points[k]);
    ordered.normals.push_back(cloud->normals[k]);
    ordered.tilt_variance.push_back(cloud->tilt_variance[k]);
  }
  ordered.tree = tree;
  *cloud = ordered;
  return cloud;
}

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

template <class A, class B>
void alike(Looks& looks, const A& found, const B& expected, double share) {
  looks.near((found - expected).norm(), 0.0, share * (expected.norm() + 1e-12));
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
  const CovarianceSums c = covariance_sums(matching, X, last, block_m);
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

/// Neighbours from both trees against all points in turn: squares of distances to their rounding, in order.
StressFigure trees(int n) {
  Looks looks;
  const auto cloud = drawn_cloud(5, n, 20.0);
  const std::vector<Vector3f>& points = cloud->points;
  const LeafTree& leaves = *cloud->tree;
  const NeighbourTree tree(points);
  const RandomStream draws(6, "stress.trees");
  looks.right(leaves.size() == points.size());
  for (std::uint64_t k = 0; k < 200; ++k) {
    const Vector3f q(static_cast<float>(draws.uniform(-24, 24, 0, k)), static_cast<float>(draws.uniform(-24, 24, 1, k)),
                     static_cast<float>(draws.uniform(-9, 9, 2, k)));
    const auto reach = static_cast<float>(draws.uniform(0.5, 12.0, 3, k));
    std::vector<std::pair<float, std::uint32_t>> all;
    for (std::uint32_t i = 0; i < points.size(); ++i) all.emplace_back((points[i] - q).squaredNorm(), i);
    std::sort(all.begin(), all.end());
    const auto within = static_cast<std::size_t>(
        std::count_if(all.begin(), all.end(), [&](const auto& p) { return p.first < reach * reach; }));
    // Squared distances of up to 40 m in single precision.
    const double grain = 8.0 * stress::kHalfUlp * static_cast<double>(reach) * static_cast<double>(reach);
    std::array<LeafTree::Nearest, 9> near;
    const std::size_t count = leaves.nearest(q, reach * reach, near);
    looks.right(count == (within < 9 ? within : 9));
    std::array<NeighbourTree::Neighbour, 9> others;
    const std::size_t found = tree.nearest(q, reach, others);
    looks.right(found == count);
    for (std::size_t i = 0; i < count; ++i) {
      looks.near(static_cast<double>(near[i].squared_m), static_cast<double>(all[i].first), grain);
      looks.near(static_cast<double>(others[i].squared_m), static_cast<double>(all[i].first), grain);
      looks.near(static_cast<double>((leaves.point(near[i].at) - q).squaredNorm()), static_cast<double>(all[i].first),
                 grain);
    }
    const auto first = leaves.nearest(q, reach * reach);
    looks.right((first.at == LeafTree::kNone) == (within == 0));
    if (within > 0) looks.near(static_cast<double>(first.squared_m), static_cast<double>(all[0].first), grain);
    const auto from = leaves.nearest_from(q, reach * reach, static_cast<std::uint32_t>(k) % leaves.size());
    looks.right((from.at == LeafTree::kNone) == (within == 0));
    if (within > 0) {
      looks.near(static_cast<double>(from.squared_m), static_cast<double>(all[0].first), grain);
      looks.right(points.size() < 2 || static_cast<double>(from.others_squared_m) <=
                                           static_cast<double>(all[1].first) * (1.0 + 8.0 * stress::kHalfUlp) + grain);
    }
  }
  // All of a leaf at once.
  std::size_t seen = 0;
  for (std::uint32_t leaf = 0; leaf < leaves.leaves(); ++leaf) {
    LeafTree::OfLeaf<5> of;
    leaves.nearest_of_leaf(leaf, 9.0f, of);
    for (std::uint32_t i = of.begin; i < of.end; ++i, ++seen) {
      std::vector<float> all;
      for (std::uint32_t k = 0; k < leaves.size(); ++k)
        all.push_back((leaves.point(k) - leaves.point(i)).squaredNorm());
      std::sort(all.begin(), all.end());
      const auto within =
          static_cast<std::size_t>(std::count_if(all.begin(), all.end(), [](float d) { return d < 9.0f; }));
      looks.right(of.count[i - of.begin] == (within < 5 ? within : 5));
      for (std::size_t k = 0; k < of.count[i - of.begin]; ++k)
        looks.near(static_cast<double>(of.nearest[i - of.begin][k].squared_m), static_cast<double>(all[k]),
                   8.0 * stress::kHalfUlp * 9.0);
    }
  }
  looks.right(seen == leaves.size());
  return looks.figure();
}

/// Thinned points are the means of their cubes, and each one's plane that of its 12 nearest within eight leaves: normal
/// and tilt from the scatter's eigenvalues. A plane that hardly is one has a normal that rounding turns, so only those
/// count whose two smaller values are apart by a fifth.
StressFigure prepared_surfaces() {
  Looks looks;
  made::Cloud raw = made::room(3);
  raw.resize(4000);
  raw.push_back(Vector3f::Zero());
  const double leaf = 0.5;
  const auto cloud = prepare_surfaces(raw, leaf);
  std::map<std::array<int, 3>, std::pair<Vector3d, int>> cubes;
  for (const Vector3f& p : raw) {
    if (p == Vector3f::Zero()) continue;
    std::array<int, 3> at{};
    for (std::size_t a = 0; a < 3; ++a)
      at[a] = static_cast<int>(std::floor(static_cast<double>(p[static_cast<int>(a)]) / leaf));
    auto& [sum, n] = cubes.try_emplace(at, Vector3d::Zero(), 0).first->second;
    sum += p.cast<double>(), ++n;
  }
  looks.right(cubes.size() == cloud->points.size());
  int planes = 0;
  for (std::size_t i = 0; i < cloud->points.size(); ++i) {
    const Vector3f& p = cloud->points[i];
    double nearest = kInfinity;
    for (const auto& [at, of] : cubes) nearest = std::min(nearest, (of.first / of.second - p.cast<double>()).norm());
    looks.near(nearest, 0.0, 4.0 * stress::kHalfUlp * 10.0);
    if (i % 7 != 0) continue;
    std::vector<std::pair<float, std::size_t>> all;
    for (std::size_t k = 0; k < cloud->points.size(); ++k) all.emplace_back((cloud->points[k] - p).squaredNorm(), k);
    std::sort(all.begin(), all.end());
    std::size_t n = 0;
    while (n < 12 && n < all.size() && all[n].first < 16.0f) ++n;
    if (n < 6 || (all.size() > n && all[n].first - all[n - 1].first < 1e-5f)) continue;
    Vector3d mean = Vector3d::Zero();
    for (std::size_t k = 0; k < n; ++k) mean += cloud->points[all[k].second].cast<double>() / static_cast<double>(n);
    Matrix3d S = Matrix3d::Zero();
    for (std::size_t k = 0; k < n; ++k) {
      const Vector3d d = cloud->points[all[k].second].cast<double>() - mean;
      S += d * d.transpose() / static_cast<double>(n);
    }
    const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(S);
    const Vector3d e = eigen.eigenvalues();
    if (e[1] < 0.11 * e[2] && e[1] > 0.09 * e[2]) continue;
    if (e[1] <= 0.09 * e[2]) {
      looks.right(cloud->normals[i].isZero(0.0f));
      continue;
    }
    if (e[0] > 0.8 * e[1]) continue;
    ++planes;
    const double turned = cloud->normals[i].cast<double>().cross(eigen.eigenvectors().col(0)).norm();
    looks.near(turned, 0.0, 64.0 * stress::kHalfUlp * e[1] / (e[1] - e[0]));
    const double tilt = e[0] / (static_cast<double>(n) - 3.0) / e[1];
    looks.near(static_cast<double>(cloud->tilt_variance[i]), tilt, 1e-5 * tilt + 1e-9);
  }
  looks.right(planes > 50);
  // Two of them in one frame: where both are in a cube of the frame, the later one's.
  const Pose moved{rotation_from({.yaw_rad = 0.5, .pitch_rad = 0.0, .roll_rad = 0.0}), {3.0, 1.0, 0.0}};
  const std::array<PlacedCloud, 2> placed{PlacedCloud{cloud.get(), Matrix3d::Identity(), Vector3d::Zero()},
                                          PlacedCloud{cloud.get(), moved.R.toRotationMatrix(), moved.p}};
  const auto both = unite_surfaces(placed, leaf);
  std::map<std::array<int, 3>, int> later;
  const auto cube = [&](const Vector3f& p) {
    std::array<int, 3> at{};
    for (std::size_t a = 0; a < 3; ++a)
      at[a] = static_cast<int>(std::floor(static_cast<double>(p[static_cast<int>(a)]) / leaf));
    return at;
  };
  std::size_t expected = cloud->points.size();
  for (const Vector3f& p : cloud->points) later[cube((placed[1].R * p.cast<double>() + placed[1].p).cast<float>())] = 1;
  for (const Vector3f& p : cloud->points) expected += later.count(cube(p)) == 0 ? 1 : 0;
  looks.right(both->points.size() == expected && both->normals.size() == expected);
  return looks.figure();
}

/// Means, averaged normals and the nearest of seven cubes, for a target of cubes.
StressFigure voxel_means() {
  Looks looks;
  const auto cloud = drawn_cloud(9, 3000, 6.0);
  const double voxel = 1.0;
  const auto target = voxel_target(*cloud, voxel);
  struct Sum {
    Vector3d p = Vector3d::Zero();
    Matrix3d nn = Matrix3d::Zero();
    double n = 0, planes = 0, tilt = 0;
  };
  std::map<std::array<int, 3>, Sum> cubes;
  const auto cube = [&](const Vector3f& p) {
    return std::array{static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y())),
                      static_cast<int>(std::floor(p.z()))};
  };
  for (std::size_t i = 0; i < cloud->points.size(); ++i) {
    Sum& s = cubes[cube(cloud->points[i])];
    const Vector3d n = cloud->normals[i].cast<double>();
    s.p += cloud->points[i].cast<double>(), s.nn += n * n.transpose(), s.n += 1, s.planes += n.isZero(0.0) ? 0 : 1;
    s.tilt += static_cast<double>(cloud->tilt_variance[i]);
  }
  looks.right(target->size() == cubes.size());
  const RandomStream draws(10, "stress.voxels");
  int met = 0;
  for (std::uint64_t k = 0; k < 400; ++k) {
    const Vector3f q(static_cast<float>(draws.uniform(-6.5, 6.5, 0, k)),
                     static_cast<float>(draws.uniform(-6.5, 6.5, 1, k)),
                     static_cast<float>(draws.uniform(-2.5, 2.5, 2, k)));
    const auto home = cube(q);
    double nearest = 0.9 * 0.9;
    const Sum* of = nullptr;
    for (const auto& d : {std::array{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}) {
      const auto there = cubes.find({home[0] + d[0], home[1] + d[1], home[2] + d[2]});
      if (there == cubes.end()) continue;
      const double square = (there->second.p / there->second.n - q.cast<double>()).squaredNorm();
      if (square < nearest) nearest = square, of = &there->second;
    }
    LastMatch last;
    target->find(q, 0.81f, last);
    looks.right((last.matched == LeafTree::kNone) == (of == nullptr));
    if (of == nullptr || last.matched == LeafTree::kNone) continue;
    ++met;
    looks.near((target->point(last.matched).cast<double>() - of->p / of->n).norm(), 0.0, 8.0 * stress::kHalfUlp * 7.0);
    if (of->planes == 0) continue;
    const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(of->nn / of->n);
    const Vector3d e = eigen.eigenvalues();
    looks.near(target->flat(last.matched), (1.0 - 1e-3) * (e[2] < 1.0 ? e[2] : 1.0), 1e-6);
    looks.near(static_cast<double>(target->tilt_variance(last.matched)), of->tilt / (of->planes * of->planes),
               1e-6 * of->tilt);
    if (e[2] - e[1] > 0.05)
      looks.near(target->normal(last.matched).cast<double>().cross(eigen.eigenvectors().col(2)).norm(), 0.0,
                 64.0 * stress::kHalfUlp / (e[2] - e[1]));
  }
  looks.right(met > 200);
  return looks.figure();
}

Matrix6d drawn_positive(std::uint64_t number) {
  const RandomStream draws(number, "stress.positive");
  Matrix6d m;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) m(i, j) = draws.normal(static_cast<std::uint32_t>(i), static_cast<std::uint64_t>(j));
  return m * m.transpose() + 0.1 * Matrix6d::Identity();
}

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
  alike(looks, open.leaning(std::vector<Matrix6d>(9, root.asDiagonal() * few * root.asDiagonal() / 9.0), C),
        unscaled(bound), 1e-10);
  std::vector<Matrix6d> blocks;
  Matrix6d sum = Matrix6d::Zero(), scatter = Matrix6d::Zero();
  for (int k = 0; k < 30; ++k) {
    const Matrix6d one = drawn_positive(40 + k);
    blocks.emplace_back(root.asDiagonal() * one * root.asDiagonal());
    sum += one;
    scatter += 30.0 / 24.0 * one * (U * along * U.transpose()) * one;
  }
  alike(looks, open.leaning(blocks, C), unscaled(closed_by(sum) * scatter * closed_by(sum)), 1e-10);
  // Held where no move along its open directions makes it likelier.
  const Pose prior{rotation_from({.yaw_rad = 0.4, .pitch_rad = 0.1, .roll_rad = -0.2}), {5.0, -3.0, 1.0}};
  const Pose off = prior * Pose::exp(0.1 * drawn(6));
  const Pose back = open.held_at(prior, C, off);
  const Matrix6d precision = (root.asDiagonal() * carried(C, prior, back) * root.asDiagonal()).inverse();
  const Vector6d left = root.cwiseProduct((prior.inverse() * back).log());
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
  alike(looks, form("calibrated"), Matrix6d(1.5 * scatter), 1e-12);
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

/// A pair of clouds in large coordinates: the same as about their own middles, its covariance carried to where the
/// source's own origin lies by the adjoint of the shift. Loops: who is held against whom, with priors of both.
class Answers final : public Registration {
 public:
  std::shared_ptr<const PreparedCloud> prepare(std::span<const Vector3f> points) const override {
    auto cloud = std::make_shared<PreparedCloud>();
    cloud->points.assign(points.begin(), points.end());
    return cloud;
  }
  RegistrationResult align(const PreparedCloud&, std::span<const Placed> targets, const Pose& guess) const override {
    RegistrationResult r;
    r.status = RegistrationStatus::kConverged;
    r.X_TS = guess * Pose::exp((Vector6d() << 0.01, 0.0, 0.02, 0.1, -0.2, 0.3).finished());
    r.overlap = 0.4 + 0.1 * static_cast<double>(targets.size());
    return r;
  }
  RegistrationResult align_with_prior(const PreparedCloud& source, std::span<const Placed> targets,
                                      const PosePrior& prior) const override {
    RegistrationResult r = align(source, targets, prior.X_TS);
    r.covariance = 0.25 * prior.covariance;
    r.open.push_back(Vector6d::Unit(3));
    if (source.points.size() > 50) return r;
    r.covariance = prior.covariance;
    return r;
  }
};

StressFigure pairs_and_loops() {
  Looks looks;
  const Answers method;
  CloudPlaces source, target;
  const Vector3d far(4e5, -3e5, 100.0);
  for (int k = 0; k < 101; ++k) {
    source.points.push_back(far + Vector3d(0.1 * k, std::sin(1.0 * k), 0.0));
    target.points.push_back(Vector3d(0.1 * k, std::cos(1.0 * k), 0.0));
  }
  PosePrior prior;
  prior.X_TS = Pose{rotation_from({.yaw_rad = 0.6, .pitch_rad = 0.02, .roll_rad = 0.01}), {10.0, 20.0, 3.0}};
  prior.covariance = drawn_positive(40);
  const CloudPair pair = register_pair(method, source, target, prior);
  // The stand-in moves by a fixed xi about the source's middle, the median in whole metres.
  const Pose middle{Eigen::Quaterniond::Identity(), {std::round(far.x() + 5.0), std::round(far.y()), 100.0}};
  const Pose expected =
      prior.X_TS * middle * Pose::exp((Vector6d() << 0.01, 0.0, 0.02, 0.1, -0.2, 0.3).finished()) * middle.inverse();
  looks.near((pair.result.X_TS.p - expected.p).norm(), 0.0, 64.0 * kEpsilon * 5e5);
  looks.near(pair.result.X_TS.R.angularDistance(expected.R), 0.0, 1e-7);
  // A quarter of the prior, whose frame has not changed: cancels 1e5 twice.
  alike(looks, pair.result.covariance, Matrix6d(0.25 * prior.covariance), 64.0 * kEpsilon * 1e12);
  looks.right(pair.source_points == 101 && pair.target_points == 101);

  std::vector<MappedCloud> frames;
  auto cloud = std::make_shared<PreparedCloud>();
  cloud->points.resize(3);
  for (int k = 0; k < 60; ++k) {
    // Two rounds of a circle of 20 m, 125.7 m each.
    const double a = 2.0 * kPi * k / 30.0;
    frames.push_back({cloud,
                      {rotation_from({.yaw_rad = a, .pitch_rad = 0.0, .roll_rad = 0.0}),
                       {20.0 * std::cos(a), 20.0 * std::sin(a), 0.01 * k}},
                      drawn_positive(50 + static_cast<std::uint64_t>(k))});
  }
  ClosureOptions options;
  options.within_m = 3.0;
  const auto trials = find_closures(method, frames, options);
  std::vector<double> way{0.0};
  for (std::size_t k = 1; k < 60; ++k) way.push_back(way.back() + (frames[k].X_WL.p - frames[k - 1].X_WL.p).norm());
  std::size_t i = 0;
  double last = -kInfinity;
  for (std::size_t k = 0; k < 60; ++k) {
    if (way[k] - last < options.apart_m) continue;
    double nearest = options.within_m;
    std::size_t at = 60;
    for (std::size_t j = 0; j < k; ++j) {
      const double apart = (frames[k].X_WL.p - frames[j].X_WL.p).norm();
      if (way[k] - way[j] >= options.least_way_m && apart <= nearest) nearest = apart, at = j;
    }
    if (at == 60) continue;
    last = way[k];
    if (i >= trials.size()) return {kInfinity, 1.0};
    const ClosureTrial& t = trials[i++];
    looks.right(t.source == k && t.target == at && t.status == RegistrationStatus::kConverged);
    const std::size_t targets = std::min(at + 4, k) - (at < 3 ? 0 : at - 3);
    looks.near(t.overlap, 0.4 + 0.1 * static_cast<double>(targets), 1e-12);
    looks.right(t.closes && t.open == 1);
    const Pose guess = frames[at].X_WL.inverse() * frames[k].X_WL;
    const Pose moved = guess * Pose::exp((Vector6d() << 0.01, 0.0, 0.02, 0.1, -0.2, 0.3).finished());
    looks.near((t.X_TS.p - moved.p).norm(), 0.0, 1e-12);
    // Both covariances in the source's frame: Ad of the way from target to source; and the floors.
    Matrix6d ad = Matrix6d::Zero();
    const Pose to = guess.inverse();
    ad.topLeftCorner<3, 3>() = ad.bottomRightCorner<3, 3>() = to.R.toRotationMatrix();
    ad.bottomLeftCorner<3, 3>() = skew(to.p) * to.R.toRotationMatrix();
    Matrix6d P = frames[k].covariance + ad * frames[at].covariance * ad.transpose();
    const double turn = 0.05 * kPi / 180.0;
    for (int d = 0; d < 3; ++d) P(d, d) += turn * turn, P(d + 3, d + 3) += 0.02 * 0.02;
    alike(looks, t.covariance, P, 1e-12);
  }
  looks.right(i == trials.size() && i > 5);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> engine_cases() {
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
      rows.add(std::string("engine/sums_") + kernel.name + (plane ? "_plane_to_plane" : "_to_the_plane"),
               [k = std::string(kernel.name), plane] { return sums_over_matches(k, plane); });
  rows.of({.group = StressGroup::kData,
           .mechanism = "neighbours and planes of a cloud's points",
           .why = "a branch of a tree left out, a scatter about the wrong point, a cube's corner",
           .expected = "all points tried in turn: single precision",
           .unit = "of the bound"});
  for (const int n : {1, 2, 9, 100, 1500}) rows.add("engine/trees_of_" + std::to_string(n), [n] { return trees(n); });
  rows.add("engine/prepared_surfaces", prepared_surfaces).add("engine/voxel_means", voxel_means);
  rows.of({.group = StressGroup::kData,
           .mechanism = "what a registration says of its pose",
           .why = "a turn that counts as metres, a factor of a variance on a sigma, a frame's shift the other way",
           .expected = "projections, formulas and adjoints written out: conditioning; a bootstrap to five deviations",
           .unit = "of the bound"});
  for (const double radius_m : {1.0, 14.0, 0.2})
    rows.add("engine/open_directions_at_" + stress::text(radius_m) + "_m",
             [radius_m] { return open_directions_algebra(radius_m); });
  for (const int blocks : {8, 20, 60})
    rows.add("engine/covariance_of_" + std::to_string(blocks) + "_blocks", [blocks] { return forms(blocks); });
  rows.add("engine/pairs_and_loops", pairs_and_loops);
  return rows.take();
}

}  // namespace canyon::lidar
