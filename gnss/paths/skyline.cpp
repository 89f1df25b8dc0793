#include "canyon/gnss/paths/skyline.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "canyon/core/units.h"

namespace canyon::gnss {
namespace {

constexpr double kMargin_m = 0.02;   // more than facets deviate from their planes
constexpr double kUpright = 1e-3;    // |n_z| of a wall that hides
constexpr double kLeast = 3e-4;      // solid angle below which a wall is not worth adding
constexpr double kNearest_m = 0.05;  // closer than this, sectors say nothing

/// Grows with the azimuth from east, counter-clockwise, from 0 to 4: quarter turns, each by the ratio of the sides.
/// Much cheaper than the arc tangent, and as good for telling which direction lies between which.
double turn_of(double x, double y) {
  const double sum = std::abs(x) + std::abs(y);
  const double part = y / sum;
  if (x < 0.0) return 2.0 - part;
  return y < 0.0 ? 4.0 + part : part;
}

/// Where the sectors' borders point to; horizontal, of any length.
template <int kSectors>
std::array<Eigen::Vector2d, kSectors + 1> borders() {
  std::array<Eigen::Vector2d, kSectors + 1> out;
  for (int i = 0; i <= kSectors; ++i) {
    const double t = 4.0 * i / kSectors;
    const double x = t < 2.0 ? 1.0 - t : t - 3.0;
    const double y = t < 1.0 ? t : t < 3.0 ? 2.0 - t : t - 4.0;
    out[static_cast<std::size_t>(i)] = {x, y};
  }
  return out;
}

double distance_to_segment(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp(-a.dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (a + t * ab).norm();
}

}  // namespace

Skyline::Skyline(const Eigen::Vector3d& p_W, const std::vector<scene::Facet>& facets,
                 std::span<const std::uint32_t> candidates)
    : p_W_(p_W), sectors_(kSectors) {
  for (const std::uint32_t i : candidates) add(facets[i]);
}

bool Skyline::span(const scene::Facet& facet, Span& out) const {
  std::array<Eigen::Vector2d, 4> corners;
  out.near_m = 1e300;
  for (std::size_t k = 0; k < 4; ++k) corners[k] = (facet.rectangle_W[k] - p_W_).head<2>();
  for (std::size_t k = 0; k < 4; ++k)
    out.near_m = std::min(out.near_m, distance_to_segment(corners[k], corners[(k + 1) % 4]));
  if (out.near_m < kNearest_m) return false;
  // As seen from outside of it a convex figure fills less than half a turn: unwrap the others around the first corner.
  const double first = turn_of(corners[0].x(), corners[0].y());
  double low = 0.0, high = 0.0;
  for (std::size_t k = 1; k < 4; ++k) {
    double t = turn_of(corners[k].x(), corners[k].y()) - first;
    if (t > 2.0) t -= 4.0;
    if (t < -2.0) t += 4.0;
    low = std::min(low, t);
    high = std::max(high, t);
  }
  if (high - low >= 1.999) return false;
  constexpr double kPerTurn = kSectors / 4.0;
  out.first = (first + low) * kPerTurn;
  out.last = (first + high) * kPerTurn;
  if (out.first < 0.0) {
    out.first += kSectors;
    out.last += kSectors;
  }
  return true;
}

void Skyline::add(const scene::Facet& wall) {
  static const auto kBorders = borders<kSectors>();
  if (!wall.fills_rectangle || std::abs(wall.normal_W.z()) > kUpright) return;
  for (const Eigen::Vector3d& corner : wall.rectangle_W)
    if (std::min(std::abs(corner.z() - wall.top_m), std::abs(corner.z() - wall.bottom_m)) > kMargin_m) return;
  if (wall.area_m2 < kLeast * (wall.center_W - p_W_).squaredNorm()) return;
  Span s;
  if (!span(wall, s)) return;
  const Eigen::Vector2d normal = wall.normal_W.head<2>();
  const double to_plane_m = wall.offset_m - wall.normal_W.dot(p_W_);
  const double top_m = wall.top_m - p_W_.z() - kMargin_m, bottom_m = wall.bottom_m - p_W_.z() + kMargin_m;
  const int first = static_cast<int>(std::ceil(s.first + 1e-6)), last = static_cast<int>(std::floor(s.last - 1e-6));
  for (int i = first; i < last; ++i) {
    const auto k = static_cast<std::size_t>(i % kSectors);
    const double at_first = normal.dot(kBorders[k]), at_last = normal.dot(kBorders[k + 1]);
    const double a_m = to_plane_m / at_first * kBorders[k].norm(), b_m = to_plane_m / at_last * kBorders[k + 1].norm();
    if (!(a_m > 0.0 && b_m > 0.0)) continue;
    const double far_m = std::max(a_m, b_m), near_m = std::min({a_m, b_m, std::abs(to_plane_m)});
    const double top = top_m / (top_m > 0.0 ? far_m : near_m);
    if (top <= sectors_[k].top) continue;
    sectors_[k] = {top, bottom_m / (bottom_m > 0.0 ? near_m : far_m), far_m};
  }
}

bool Skyline::hides(const scene::Facet& facet) const {
  Span s;
  if (!span(facet, s)) return false;
  const double top_m = facet.top_m - p_W_.z(), bottom_m = facet.bottom_m - p_W_.z();
  const double far_m = s.near_m + 2.0 * facet.radius_m;
  const double top = top_m / (top_m > 0.0 ? s.near_m : far_m), bottom = bottom_m / (bottom_m > 0.0 ? far_m : s.near_m);
  const int last = static_cast<int>(std::floor(s.last + 1e-6));
  for (int i = static_cast<int>(std::floor(s.first - 1e-6)); i <= last; ++i) {
    const Sector& sector = sectors_[static_cast<std::size_t>((i + kSectors) % kSectors)];
    if (!(sector.top >= top && sector.bottom <= bottom && sector.far_m + kMargin_m <= s.near_m)) return false;
  }
  return true;
}

}  // namespace canyon::gnss
