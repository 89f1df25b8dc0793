#pragma once

#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "gnss/model_table.h"
#include "gnss/paths/fresnel.h"
#include "gnss/sensor.h"

namespace canyon::gnss {

/// One reflected way from a satellite to the antenna.
struct Reflection {
  double excess_m = 0.0;       ///< longer than the direct way by this
  double incidence_rad = 0.0;  ///< from the reflector's normal
  Eigen::Vector3d arrival_W;   ///< unit, from the antenna to the reflection point
  double foliage_m = 0.0;      ///< way through tree crowns
  std::uint32_t facet = 0;     ///< index into Scene::facets()
  Fresnel coefficients;        ///< of its material at L1
};

/// How the signal of one satellite reaches the antenna.
struct SignalPaths {
  bool line_of_sight = true;
  double foliage_m = 0.0;               ///< of the direct way
  std::vector<Reflection> reflections;  ///< by growing excess
};

/// Finds the ways through the scene.
class PathModel {
 public:
  virtual ~PathModel() = default;
  /// directions_W: unit, from the antenna to each satellite (the wave is plane over the scene). out.size() ==
  /// directions.size().
  virtual void trace(const Eigen::Vector3d& p_A_W, std::span<const Eigen::Vector3d> directions_W,
                     const scene::SceneAt& scene, std::span<SignalPaths> out, GnssCounters& counters) const = 0;
};

struct PathParameters {
  double reach_m = 150.0;  ///< farthest reflection point from the antenna
};

using MakePathModel = std::unique_ptr<PathModel>(const PathParameters&);
std::span<const ModelRow<MakePathModel>> path_models();

/// Direct ways only: is each blocked, how far does it pass through foliage. One occlusion ray per satellite, outward
/// from the antenna; tree crowns do not block.
std::unique_ptr<PathModel> make_visibility(const PathParameters& p);

/// Direct ways and all single specular reflections off the scene's facets whose reflection point lies within reach of
/// the antenna. Exact (image method, plane wave): a wall at perpendicular distance d adds 2 d cos(incidence), and the
/// reflection point lies d / cos(incidence) away; so a high satellite, which meets walls at large incidence, sees them
/// from much farther than half the excess delay. What lies beyond reach is not found: with 150 m, of the reflections
/// with excess < 45 m, those with incidence above acos(sqrt(45 / 300)) = 67 deg that need a wall more than 150 m away.
/// Terrain does not reflect here.
std::unique_ptr<PathModel> make_specular1(const PathParameters& p);

}  // namespace canyon::gnss
