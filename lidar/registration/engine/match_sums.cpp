#include "canyon/lidar/registration/engine/match_sums.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "canyon/core/process/parallel.h"
#include "canyon/lidar/turned.h"
#include "canyon/lidar/voxels/voxel_index.h"

namespace canyon::lidar {
namespace {

constexpr std::size_t kChunk = 1024;

/// Upper triangle of a symmetric 6 x 6 matrix, row by row.
using Upper = std::array<double, 21>;

void add_outer(Upper& sum, double weight, const double* a) {
  std::size_t k = 0;
  for (int i = 0; i < 6; ++i) {
    const double wi = weight * a[i];
    for (int j = i; j < 6; ++j) sum[k++] += wi * a[j];
  }
}

void add_mixed(Upper& sum, double weight, const double* a, const double* b) {
  std::size_t k = 0;
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) sum[k++] += weight * (a[i] * b[j] + b[i] * a[j]);
  }
}

/// sum of w J^T J, which takes 10 numbers.
struct Isotropic {
  double w = 0, p[3] = {0, 0, 0}, xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  void add(double weight, const Eigen::Vector3d& q) {
    w += weight;
    for (int a = 0; a < 3; ++a) p[a] += weight * q[a];
    xx += weight * q.x() * q.x(), xy += weight * q.x() * q.y(), xz += weight * q.x() * q.z();
    yy += weight * q.y() * q.y(), yz += weight * q.y() * q.z(), zz += weight * q.z() * q.z();
  }
  void add(const Isotropic& o) {
    w += o.w;
    for (int a = 0; a < 3; ++a) p[a] += o.p[a];
    xx += o.xx, xy += o.xy, xz += o.xz, yy += o.yy, yz += o.yz, zz += o.zz;
  }
  Matrix6d matrix() const {
    Matrix6d m = Matrix6d::Zero();
    m.topLeftCorner<3, 3>() << yy + zz, -xy, -xz, -xy, xx + zz, -yz, -xz, -yz, xx + yy;
    m.topRightCorner<3, 3>() = skew({p[0], p[1], p[2]});
    m.bottomLeftCorner<3, 3>() = m.topRightCorner<3, 3>().transpose();
    m.bottomRightCorner<3, 3>() = w * Eigen::Matrix3d::Identity();
    return m;
  }
};

Matrix6d full(const Upper& upper) {
  Matrix6d m;
  std::size_t k = 0;
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) m(i, j) = m(j, i) = upper[k++];
  }
  return m;
}

/// A match in the source frame.
struct Match {
  Eigen::Vector3d p, d, n, m;
  double jn[6], jm[6];  // J^T n, J^T m
  MatchInformation information;
  double dn, dm;  // along the two normals

  Match(const Matching& matching, const Eigen::Matrix3d& R_ST, const Eigen::Vector3d& place_T, std::size_t i,
        std::size_t at) {
    const Eigen::Vector3f& normal_S = matching.source->normals[i];
    p = matching.source->points[i].cast<double>();
    d = turned(R_ST, place_T - matching.target->point(at).cast<double>());
    n = turned(R_ST, matching.target->normal(at));
    m = normal_S.cast<double>();
    const double flat_m = m.isZero(0.0) ? 0.0 : 1.0 - kSurfaceThickness;
    information = matching.form(matching.target->flat(at), flat_m, n.dot(m));
    const Eigen::Vector3d pn = p.cross(n), pm = p.cross(m);
    for (int a = 0; a < 3; ++a) jn[a] = pn[a], jn[a + 3] = n[a], jm[a] = pm[a], jm[a + 3] = m[a];
    dn = n.dot(d), dm = m.dot(d);
  }
  /// M' d, M' what the surfaces know: M without `along`.
  Eigen::Vector3d across_d() const {
    return n * (information.nn * dn + information.nm * dm) + m * (information.nm * dn + information.mm * dm);
  }
  double across_cost() const {
    return information.nn * dn * dn + 2.0 * information.nm * dn * dm + information.mm * dm * dm;
  }
  double across_trace() const { return information.nn + 2.0 * information.nm * n.dot(m) + information.mm; }
  /// As two squares: nn (jn + r jm)^2 + (mm - r nm) jm^2, r = nm / nn.
  void add_across(Upper& sum, double w) const {
    if (information.nn == 0) {
      if (information.mm != 0) add_outer(sum, w * information.mm, jm);
      return;
    }
    const double r = information.nm / information.nn, rest = information.mm - r * information.nm;
    double both[6];
    for (int a = 0; a < 6; ++a) both[a] = jn[a] + r * jm[a];
    add_outer(sum, w * information.nn, both);
    if (rest != 0) add_outer(sum, w * rest, jm);
  }
};

struct Part {
  Upper across{};
  Isotropic along;
  Vector6d g = Vector6d::Zero();
  double cost = 0, weight = 0, missed = 0, radius2 = 0;
  std::int64_t matched = 0;
};

void sum_part(const Matching& matching, const Pose& X_TS, std::size_t stride, std::size_t begin, std::size_t end,
              std::vector<LastMatch>& last, Part& part) {
  const Eigen::Matrix3d R = X_TS.R.toRotationMatrix(), R_ST = R.transpose();
  const auto squared_reach = static_cast<float>(matching.reach_m * matching.reach_m);
  const double across_scale = kAcrossScale / (matching.width_m * matching.width_m);
  for (std::size_t k = begin; k < end; ++k) {
    const std::size_t i = k * stride;
    const Eigen::Vector3d place = turned(R, matching.source->points[i]) + X_TS.p;
    matching.target->find(place.cast<float>(), squared_reach, last[k]);
    if (last[k].matched == LeafTree::kNone) {
      part.missed += 1.0;
      continue;
    }
    const Match match(matching, R_ST, place, i, last[k].matched);
    const double cost = match.information.along * match.d.squaredNorm() + match.across_cost();
    const double u = across_scale * cost;
    const double w = matching.kernel(u);
    match.add_across(part.across, w);
    if (match.information.along != 0) part.along.add(w * match.information.along, match.p);
    const Eigen::Vector3d Md = match.information.along * match.d + match.across_d();
    part.g.head<3>() += w * match.p.cross(Md);
    part.g.tail<3>() += w * Md;
    part.cost += w * cost;
    part.weight += w;
    part.missed += std::min(1.0, u);
    part.radius2 += match.p.squaredNorm();
    ++part.matched;
  }
}

}  // namespace

NormalEquations normal_equations(const Matching& matching, const Pose& X_TS, std::size_t stride,
                                 std::vector<LastMatch>& last) {
  const std::size_t n = (matching.source->points.size() + stride - 1) / stride;
  if (last.size() != n) last.assign(n, LastMatch{});
  std::vector<Part> parts((n + kChunk - 1) / kChunk);
  const auto sum = [&](std::size_t begin, std::size_t end) {
    sum_part(matching, X_TS, stride, begin, end, last, parts[begin / kChunk]);
  };
  if (parts.size() > 1) {
    parallel_for(n, kChunk, sum);
  } else if (n > 0) {
    sum(0, n);
  }
  Part all;
  for (const Part& part : parts) {
    for (std::size_t k = 0; k < all.across.size(); ++k) all.across[k] += part.across[k];
    all.along.add(part.along);
    all.g += part.g;
    all.cost += part.cost;
    all.weight += part.weight;
    all.missed += part.missed;
    all.radius2 += part.radius2;
    all.matched += part.matched;
  }
  NormalEquations out;
  out.A = full(all.across) + all.along.matrix();
  out.g = all.g;
  out.cost = all.cost;
  out.weight = all.weight;
  out.missed = n > 0 ? all.missed / static_cast<double>(n) : 1.0;
  out.radius2 = all.radius2;
  out.matched = all.matched;
  return out;
}

std::vector<double> missed_by_point(const Matching& matching, const Pose& X_TS, std::span<const LastMatch> matches) {
  const Eigen::Matrix3d R = X_TS.R.toRotationMatrix(), R_ST = R.transpose();
  const double across_scale = kAcrossScale / (matching.width_m * matching.width_m);
  std::vector<double> missed(matches.size(), -1.0);
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (matches[i].matched == LeafTree::kNone) continue;
    const Match match(matching, R_ST, turned(R, matching.source->points[i]) + X_TS.p, i, matches[i].matched);
    missed[i] = std::min(1.0, across_scale * match.across_cost());
  }
  return missed;
}

double share_still_on_surfaces(const Matching& matching, const Pose& X_TS, std::span<const LastMatch> matches,
                               std::span<const LastMatch> before) {
  std::int64_t on_planes = 0, still = 0;
  for (std::size_t i = 0; i < std::min(matches.size(), before.size()); ++i) {
    const std::uint32_t was = before[i].matched;
    if (was == LeafTree::kNone || matching.target->flat(was) == 0.0) continue;
    ++on_planes;
    const Eigen::Vector3d off =
        X_TS * matching.source->points[i].cast<double>() - matching.target->point(was).cast<double>();
    const double across_m = std::abs(matching.target->normal(was).cast<double>().dot(off));
    if (matches[i].matched != LeafTree::kNone || across_m < matching.reach_m) ++still;
  }
  return on_planes > 0 ? static_cast<double>(still) / static_cast<double>(on_planes) : 1.0;
}

double evidence_against(std::span<const double> a, std::span<const double> b, const PreparedCloud& source,
                        double block_m) {
  std::vector<double> by_block;
  VoxelIndex blocks(block_m);
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    if (a[i] < 0 || b[i] < 0) continue;
    const auto place = blocks.coordinates(source.points[i]);
    const std::uint32_t block = place ? blocks.insert(*place) : 0;
    if (block >= by_block.size()) by_block.resize(block + 1, 0.0);
    by_block[block] += b[i] - a[i];
  }
  double sum = 0, squares = 0;
  for (const double d : by_block) sum += d, squares += d * d;
  return squares > 0 ? sum / std::sqrt(squares) : 0.0;
}

CovarianceSums covariance_sums(const Matching& matching, const Pose& X_TS, std::span<const LastMatch> matches,
                               double block_m, bool of_noise) {
  const Eigen::Matrix3d R = X_TS.R.toRotationMatrix(), R_ST = R.transpose();
  const double across_scale = kAcrossScale / (matching.width_m * matching.width_m);
  CovarianceSums sums;
  Upper tilted{}, noise{};
  Isotropic tilted_all, noise_along;
  std::vector<Upper> block_across;
  std::vector<Isotropic> block_along;
  VoxelIndex blocks(block_m);
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (matches[i].matched == LeafTree::kNone) continue;
    const Match match(matching, R_ST, turned(R, matching.source->points[i]) + X_TS.p, i, matches[i].matched);
    const double cost = match.information.along * match.d.squaredNorm() + match.across_cost();
    const double w = matching.kernel(across_scale * cost);
    const double trace = w * match.across_trace();
    const double tilt = 0.25 * (matching.source->tilt_variance[i] + matching.target->tilt_variance(matches[i].matched));
    Upper one{};
    match.add_across(one, w);
    for (std::size_t k = 0; k < one.size(); ++k) tilted[k] += tilt * one[k];
    tilted_all.add(tilt * trace, match.p);
    const Eigen::Vector3d across_d = w * match.across_d();
    sums.cost += w * match.across_cost();
    sums.weight += trace;
    if (trace > 0) {
      const Eigen::Vector3d pull = w * match.information.along * (match.d - across_d / trace);
      sums.along.head<3>() += match.p.cross(pull);
      sums.along.tail<3>() += pull;
    }
    sums.radius2 += match.p.squaredNorm();
    ++sums.matched;
    const auto place = blocks.coordinates(matching.source->points[i]);
    const std::uint32_t block = place ? blocks.insert(*place) : 0;
    if (block >= block_across.size()) {
      block_across.resize(block + 1);
      block_along.resize(block + 1);
      sums.block_gradients.resize(block + 1, Vector6d::Zero());
    }
    const Eigen::Vector3d Md = w * match.information.along * match.d + across_d;
    sums.block_gradients[block].head<3>() += match.p.cross(Md);
    sums.block_gradients[block].tail<3>() += Md;
    for (std::size_t k = 0; k < one.size(); ++k) block_across[block][k] += one[k];
    block_along[block].add(w * match.information.along, match.p);
    if (!of_noise) continue;
    // A range error common to all returns moves each along its own beam.
    const double range_m = match.p.norm();
    if (range_m > 0) {
      const Eigen::Vector3d beam = match.p / range_m;
      const Eigen::Vector3d Mb =
          w * (match.information.along * beam +
               match.n * (match.information.nn * match.n.dot(beam) + match.information.nm * match.m.dot(beam)) +
               match.m * (match.information.nm * match.n.dot(beam) + match.information.mm * match.m.dot(beam)));
      sums.common_range.head<3>() += match.p.cross(Mb);
      sums.common_range.tail<3>() += Mb;
    }
    // J^T M M J: independent noise of every point, as Censi 2007 has it.
    const double c = match.n.dot(match.m);
    const MatchInformation& f = match.information;
    const double nn = f.nn * f.nn + 2 * f.nn * f.nm * c + f.nm * f.nm + 2 * f.along * f.nn;
    const double mm = f.mm * f.mm + 2 * f.mm * f.nm * c + f.nm * f.nm + 2 * f.along * f.mm;
    const double nm = f.nn * f.nm + f.nn * f.mm * c + f.nm * f.nm * c + f.nm * f.mm + 2 * f.along * f.nm;
    add_outer(noise, w * w * nn, match.jn);
    add_outer(noise, w * w * mm, match.jm);
    add_mixed(noise, w * w * nm, match.jn, match.jm);
    noise_along.add(w * w * f.along * f.along, match.p);
  }
  sums.point_noise = full(noise) + noise_along.matrix();
  sums.N = tilted_all.matrix() - full(tilted);
  for (std::size_t b = 0; b < block_across.size(); ++b) {
    sums.block_surfaces.push_back(full(block_across[b]));
    sums.block_curvatures.push_back(sums.block_surfaces[b] + block_along[b].matrix());
    sums.H += sums.block_surfaces[b];
    sums.A += sums.block_curvatures[b];
  }
  return sums;
}

}  // namespace canyon::lidar
