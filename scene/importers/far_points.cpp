#include "canyon/scene/importers/far_points.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "canyon/core/config/text.h"
#include "canyon/scene/importers/raw_points.h"

namespace canyon::scene {
namespace {

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Eigen::Vector3d median_point(const std::vector<RawScene>& scenes) {
  std::array<std::vector<double>, 3> values;
  for (const RawScene& scene : scenes)
    for_corners(scene, [&](const RawPoint& point) {
      for (int k = 0; k < 3; ++k)
        if (std::isfinite(point.p[k])) values[static_cast<std::size_t>(k)].push_back(point.p[k]);
    });
  return {median(std::move(values[0])), median(std::move(values[1])), median(std::move(values[2]))};
}

}  // namespace

Status refuse_far_points(const std::vector<RawScene>& scenes) {
  const Eigen::Vector3d middle = median_point(scenes);
  std::optional<Error> first;
  for (const RawScene& scene : scenes) {
    const auto check = [&](const RawPoint& point) {
      if (first || !point.p.head<2>().allFinite()) return;
      Eigen::Vector3d way = point.p - middle;
      if (!std::isfinite(way.z())) way.z() = 0.0;  // of what has no height
      if (way.cwiseAbs().maxCoeff() <= kSceneReach_m) return;
      first = Error{scene.files[point.from.file], static_cast<int>(point.from.line), name_of(point, scene),
                    "lies " + number_text(std::round(way.stableNorm() / 1e3)) + " km from the middle of the scene",
                    "coordinates within 100 km of it, or scene.center_deg and scene.radius_m to leave out what is "
                    "farther"};
    };
    for_corners(scene, check);
    for_courtyard_corners(scene, check);
    for_street_points_and_trees(scene, check);
  }
  if (first) return *first;
  return Ok{};
}

}  // namespace canyon::scene
