#include "canyon/gnss/paths/diffraction/mirror_borders.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/gnss/paths/diffraction/knife_edge.h"
#include "canyon/gnss/paths/diffraction/wedge.h"
#include "canyon/gnss/paths/diffraction/wedge_bound.h"

namespace canyon::gnss {
namespace {

constexpr double kLeast = 3e-3;  // what a side makes fades out from twice that down to it

constexpr double kFarField = 0.2251;  // |knife_edge_field(nu)| is no more than this over nu, nor than 1/2

double largest_knife_edge_field(double nu) {
  return nu > 0.45 ? kFarField / nu : 0.5;
}

/// How the wave passes a side: as of finite_edge_field, and no more than so much comes of it; 0 if nothing.
struct Passage {
  double nu = 0.0, u1 = 0.0, u2 = 0.0, most = 0.0;
};

Passage passage(const scene::FacetBorder& side, const MirroredWave& wave) {
  const Eigen::Vector3d from_image_W = side.from_W - wave.image_W, whole_W = side.to_W - side.from_W;
  const double length_m = whole_W.norm();
  if (length_m < 1e-6) return {};
  const Eigen::Vector3d along_W = whole_W / length_m;
  const double foot_m = -from_image_W.dot(along_W);
  const double across_m = (from_image_W + foot_m * along_W).norm();
  const double cosine = wave.towards_W.dot(along_W), sine2 = 1.0 - cosine * cosine;
  if (sine2 < 1e-6 || across_m < 1e-3) return {};
  const double sine_beta = std::sqrt(sine2);
  // Where the way over the side is shortest: equal angles with it on both legs.
  const double at_m = foot_m + across_m * cosine / sine_beta;
  const Eigen::Vector3d way_W = from_image_W + at_m * along_W;
  const double forward_m = way_W.dot(wave.towards_W);
  if (forward_m <= 0.0) return {};
  const double distance_m = way_W.norm();
  const double detour_m = (way_W - forward_m * wave.towards_W).squaredNorm() / (distance_m + forward_m);
  Passage p;
  p.nu = knife_edge_nu(detour_m, wave.wavelength_m);
  const double per_m = sine_beta * std::sqrt(2.0 / (wave.wavelength_m * distance_m));
  p.u1 = -at_m * per_m;
  p.u2 = (length_m - at_m) * per_m;
  p.most = largest_knife_edge_field(p.nu) * largest_finite_edge_factor(p.nu, p.u1, p.u2);
  return p;
}

}  // namespace

std::complex<double> mirrored_share(const scene::Facet& facet, bool holds, const MirroredWave& wave, double least) {
  std::complex<double> share = holds ? 1.0 : 0.0;
  thread_local std::vector<Passage> passages;
  passages.clear();
  double most = std::abs(share);
  for (const scene::FacetBorder& side : facet.borders) most += passages.emplace_back(passage(side, wave)).most;
  if (most < least) return 0.0;
  for (std::size_t i = 0; i < passages.size(); ++i) {
    const Passage& p = passages[i];
    if (p.most <= kLeast) continue;
    const scene::FacetBorder& side = facet.borders[i];
    const Eigen::Vector3d inward_W = facet.normal_W.cross(side.to_W - side.from_W);
    // On a side as facet_contains has it.
    const bool inner = inward_W.dot(wave.at_W - side.from_W) >= -1e-9 * inward_W.norm();
    const std::complex<double> made = std::min(p.most / kLeast - 1.0, 1.0) * finite_edge_field(p.nu, p.u1, p.u2);
    share += inner ? -made : made;
  }
  return share;
}

double largest_border_nu(double weakest_db) {
  return kFarField * std::pow(10.0, -weakest_db / 20.0);
}

Eigen::Vector3d nearest_of_border(const scene::Facet& facet, const Eigen::Vector3d& at_W) {
  Eigen::Vector3d nearest_W = at_W;
  double least_m2 = std::numeric_limits<double>::infinity();
  for (const scene::FacetBorder& side : facet.borders) {
    const Eigen::Vector3d whole_W = side.to_W - side.from_W;
    const double share = whole_W.dot(at_W - side.from_W) / whole_W.squaredNorm();
    const Eigen::Vector3d point_W = side.from_W + std::clamp(share, 0.0, 1.0) * whole_W;
    const double distance_m2 = (point_W - at_W).squaredNorm();
    if (!(distance_m2 < least_m2)) continue;
    least_m2 = distance_m2;
    nearest_W = point_W;
  }
  return nearest_W;
}

}  // namespace canyon::gnss
