#include "canyon/lidar/map_quality/wall_thickness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "canyon/core/math/median.h"
#include "canyon/core/units.h"

namespace canyon::lidar {
namespace {

constexpr double kPatch_m = 2.0;
constexpr double kSteepest = 0.5;  // |z| of the normal: 30 degrees from the vertical
constexpr std::size_t kFewestOfAWall = 20;
constexpr double kTwoLayers = 0.85, kLeastShare = 0.1, kLeastGap_m = 0.1;

/// A patch: object, direction of the wall in steps of 5 degrees, place along it and height.
using Patch = std::array<std::int64_t, 5>;

Patch patch_of(const WallPoint& point, const scene::Scene& scene) {
  const Eigen::Vector3d& n = point.offset.normal_W;
  const Eigen::Vector3d foot = point.p_W.cast<double>() - point.offset.offset_W;
  const double azimuth = std::atan2(n.y(), n.x());
  const auto direction = std::llround(azimuth * 36.0 / kPi);
  const double turned = static_cast<double>(direction) * kPi / 36.0;
  const double along = -std::sin(turned) * foot.x() + std::cos(turned) * foot.y();
  const double out = std::cos(turned) * foot.x() + std::sin(turned) * foot.y();
  return {scene.mesh().object[point.offset.triangle], direction,
          static_cast<std::int64_t>(std::floor(along / kPatch_m)),
          static_cast<std::int64_t>(std::floor(foot.z() / kPatch_m)),
          static_cast<std::int64_t>(std::floor(out / kPatch_m))};
}

double quantile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto i = static_cast<std::size_t>(place);
  const double part = place - static_cast<double>(i);
  return i + 1 < sorted.size() ? sorted[i] + part * (sorted[i + 1] - sorted[i]) : sorted[i];
}

/// The gap between two layers; 0 where there is one.
double layer_gap_m(const std::vector<double>& sorted) {
  const auto n = static_cast<double>(sorted.size());
  double sum = 0.0, squares = 0.0;
  for (const double d : sorted) sum += d;
  const double mean = sum / n;
  for (const double d : sorted) squares += (d - mean) * (d - mean);
  double best = 0.0, gap = 0.0, below = 0.0;
  for (std::size_t k = 1; k < sorted.size(); ++k) {
    below += sorted[k - 1];
    const auto low_n = static_cast<double>(k), high_n = n - low_n;
    if (std::min(low_n, high_n) < kLeastShare * n) continue;
    const double apart = (sum - below) / high_n - below / low_n;
    const double between = low_n * high_n / n * apart * apart;
    if (between <= best) continue;
    best = between;
    gap = apart;
  }
  return best >= kTwoLayers * squares && gap >= kLeastGap_m ? gap : 0.0;
}

}  // namespace

WallThickness wall_thickness(std::span<const WallPoint> points, const scene::Scene& scene) {
  std::map<Patch, std::vector<double>> patches;
  for (const WallPoint& point : points) {
    if (!point.offset.found || std::abs(point.offset.normal_W.z()) > kSteepest) continue;
    const std::uint32_t object = scene.mesh().object[point.offset.triangle];
    if (scene.objects()[object].kind == scene::ObjectKind::kTree) continue;
    patches[patch_of(point, scene)].push_back(point.offset.distance_m);
  }
  std::vector<double> thickness, gaps;
  for (auto& [patch, distances] : patches) {
    if (distances.size() < kFewestOfAWall) continue;
    std::sort(distances.begin(), distances.end());
    thickness.push_back(quantile(distances, 0.95) - quantile(distances, 0.05));
    if (const double gap = layer_gap_m(distances); gap > 0.0) gaps.push_back(gap);
  }
  WallThickness out;
  out.patches = static_cast<std::int64_t>(thickness.size());
  if (thickness.empty()) return out;
  out.median_m = median(thickness);
  std::sort(thickness.begin(), thickness.end());
  out.p95_m = quantile(thickness, 0.95);
  out.doubled_share = static_cast<double>(gaps.size()) / static_cast<double>(thickness.size());
  if (!gaps.empty()) out.doubled_gap_median_m = median(gaps);
  return out;
}

}  // namespace canyon::lidar
