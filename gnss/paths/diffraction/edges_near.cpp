#include "canyon/gnss/paths/diffraction/edges_near.h"

#include <algorithm>
#include <cmath>

#include "canyon/gnss/paths/rows/near_waves.h"

namespace canyon::gnss {
namespace {

using Outline = scene::EdgeIndex::Outline;

/// The whole edge, and how far a wave may bend there, lie in a cone around its middle. Along the direction of a wave
/// its middle lies so far at least, m.
double least_along_m(double half_m, double distance_m, double detour_m) {
  const double near_m = std::max(distance_m - half_m, 0.1);
  const double angle_rad = std::asin(std::min(half_m / distance_m, 1.0)) + 1.1 * std::sqrt(2.0 * detour_m / near_m);
  return angle_rad < 3.0 ? std::cos(angle_rad) * distance_m : -distance_m;
}

/// The middles as axes, with a bound of least_along_m from below, for many edges at once. Of the two parts of the
/// angle, a = asin(h / d) and b: cos(a + b) >= cos(a) (1 - b^2 / 2) - sin(a) b, since 0 <= a <= pi / 2. Where a + b >=
/// 3 that is below -1.4.
void axes_of(const std::vector<Outline>& edges, const Eigen::Vector3d& p_W, double detour_m, WaveAxes& out) {
  constexpr std::size_t kRow = 8;
  using Row = Eigen::Array<double, static_cast<int>(kRow), 1>;
  using FloatRow = Eigen::Array<float, static_cast<int>(kRow), 1>;
  out.resize((edges.size() + kRow - 1) / kRow * kRow);
  for (std::size_t begin = 0; begin < edges.size(); begin += kRow) {
    Row x_m, y_m, z_m, half_m;
    for (std::size_t j = 0; j < kRow; ++j) {
      const Outline& e = edges[std::min(begin + j, edges.size() - 1)];
      const auto k = static_cast<Eigen::Index>(j);
      x_m[k] = e.middle_W.x() - p_W.x(), y_m[k] = e.middle_W.y() - p_W.y(), z_m[k] = e.middle_W.z() - p_W.z();
      half_m[k] = e.half_m;
    }
    const Row distance2 = x_m * x_m + y_m * y_m + z_m * z_m, distance_m = distance2.sqrt();
    const Row bend2 = 1.1 * 1.1 * 2.0 * detour_m / (distance_m - half_m).max(0.1);
    const Row sine_m = half_m.min(distance_m), cosine_m = (distance2 - sine_m * sine_m).max(0.0).sqrt();
    const Row least_m = cosine_m * (1.0 - 0.5 * bend2) - sine_m * bend2.sqrt() - WaveAxes::kRounding * distance_m;
    const auto put = [begin](const Row& row, std::vector<float>& to) {
      Eigen::Map<FloatRow>(to.data() + begin) = row.cast<float>();
    };
    put(x_m, out.x), put(y_m, out.y), put(z_m, out.z), put(least_m, out.least);
  }
  out.resize(edges.size());
}

}  // namespace

void find_edges_near(const Eigen::Vector3d& p_W, const PlaneWaves& waves, const scene::SceneAt& scene, double detour_m,
                     std::vector<EdgeAndWave>& out) {
  double lowest = 1.0;
  for (const Eigen::Vector3d& s : waves.directions_W()) lowest = std::min(lowest, s.z());
  thread_local std::vector<Outline> candidates;
  scene.scene().edges().shading(p_W, std::asin(std::clamp(lowest, 0.0, 1.0)), detour_m, candidates);
  thread_local WaveAxes axes;
  thread_local NearWaves near;
  thread_local std::vector<AxisAndWave> pairs;
  axes_of(candidates, p_W, detour_m, axes);
  near.fill(waves.directions_W());
  near.find(axes, pairs);
  // What the bound let pass, as it is.
  out.clear();
  std::uint32_t place = ~0U;
  Eigen::Vector3d to_middle_W = Eigen::Vector3d::Zero();
  double least_m = 0.0;
  for (const AxisAndWave& one : pairs) {
    const Outline& edge = candidates[one.axis];
    if (one.axis != place) {
      place = one.axis;
      to_middle_W = edge.middle_W - p_W;
      least_m = least_along_m(edge.half_m, to_middle_W.norm(), detour_m);
    }
    if (to_middle_W.dot(waves.direction_W(one.wave)) >= least_m) out.push_back({edge.edge, one.wave});
  }
}

}  // namespace canyon::gnss
