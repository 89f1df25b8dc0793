#include "canyon/lidar/beam/pane.h"

#include <algorithm>
#include <cmath>

namespace canyon::lidar {
namespace {

constexpr double kIndex = 1.52;  // soda-lime glass

/// Two faces that each reflect the share r pass (1 - r) / (1 + r) in all (Born and Wolf, Principles of Optics, 1.6).
double both_faces(double amplitude) {
  const double r = amplitude * amplitude;
  return (1.0 - r) / (1.0 + r);
}

/// What the faces let through, mean of both polarisations.
double faces(double cos_incidence, double cos_inside) {
  const double across = (cos_incidence - kIndex * cos_inside) / (cos_incidence + kIndex * cos_inside);
  const double along = (kIndex * cos_incidence - cos_inside) / (kIndex * cos_incidence + cos_inside);
  return 0.5 * (both_faces(across) + both_faces(along));
}

}  // namespace

double pane_transmittance(double at_normal, double cos_incidence) {
  const double cosine = std::clamp(cos_incidence, 0.0, 1.0);
  const double cos_inside = std::sqrt(1.0 - (1.0 - cosine * cosine) / (kIndex * kIndex));
  static const double faces_at_normal = faces(1.0, 1.0);
  const double inside = std::min(1.0, at_normal / faces_at_normal);  // along the shortest way
  if (!(inside > 0.0)) return 0.0;
  return at_normal * faces(cosine, cos_inside) / faces_at_normal * std::pow(inside, 1.0 / cos_inside - 1.0);
}

}  // namespace canyon::lidar
