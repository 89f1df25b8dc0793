#include "canyon/gnss/paths/diffraction/screen_edge.h"

#include <algorithm>
#include <cmath>

#include "canyon/gnss/paths/diffraction/knife_edge.h"
#include "canyon/gnss/paths/diffraction/wedge.h"
#include "canyon/gnss/paths/diffraction/wedge_bound.h"

namespace canyon::gnss {
namespace {

double largest_knife_edge_field(double nu) {
  return nu > 0.45 ? kFarEdgeField / nu : 0.5;
}

}  // namespace

ScreenEdge::ScreenEdge(const Eigen::Vector3d& a_W, const Eigen::Vector3d& b_W, const Eigen::Vector3d& to_W,
                       const Eigen::Vector3d& towards_W, double wavelength_m) {
  const Eigen::Vector3d from_image_W = a_W - to_W, whole_W = b_W - a_W;
  const double length_m = whole_W.norm();
  if (length_m < 1e-6) return;
  const Eigen::Vector3d along_W = whole_W / length_m;
  const double foot_m = -from_image_W.dot(along_W);
  const double across_m = (from_image_W + foot_m * along_W).norm();
  const double cosine = towards_W.dot(along_W), sine2 = 1.0 - cosine * cosine;
  if (sine2 < 1e-6 || across_m < 1e-3) return;
  const double sine_beta = std::sqrt(sine2);
  // Where the way over the edge is shortest: equal angles with it on both legs.
  const double at_m = foot_m + across_m * cosine / sine_beta;
  const Eigen::Vector3d way_W = from_image_W + at_m * along_W;
  const double forward_m = way_W.dot(towards_W);
  if (forward_m <= 0.0) return;
  const double distance_m = way_W.norm();
  const double detour_m = (way_W - forward_m * towards_W).squaredNorm() / (distance_m + forward_m);
  nu_ = knife_edge_nu(detour_m, wavelength_m);
  const double per_m = sine_beta * std::sqrt(2.0 / (wavelength_m * distance_m));
  u1_ = -at_m * per_m;
  u2_ = (length_m - at_m) * per_m;
  most_ = largest_knife_edge_field(nu_) * largest_finite_edge_factor(nu_, u1_, u2_);
  at_m_ = std::clamp(at_m, 0.0, length_m);
  // The detour grows with the square of how far along the edge one is from where it is least.
  strength_ = largest_knife_edge_field(std::hypot(nu_, std::max({u1_, -u2_, 0.0})));
}

std::complex<double> ScreenEdge::field(double weakest) const {
  if (is_faded(weakest)) return 0.0;
  const double kept = std::min(most_ / kLeast - 1.0, 1.0) * std::min(strength_ / weakest - 1.0, 1.0);
  return kept * finite_edge_field(nu_, u1_, u2_);
}

}  // namespace canyon::gnss
