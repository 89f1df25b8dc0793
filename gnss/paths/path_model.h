#pragma once

#include <array>
#include <complex>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "gnss/model_table.h"
#include "gnss/paths/fresnel.h"
#include "gnss/sensor.h"

namespace canyon::gnss {

/// One way from a satellite to the antenna beside the straight one: reflected, diffracted over an edge, or both.
struct SignalPath {
  static constexpr std::size_t kMaxReflections = 3;
  static constexpr std::uint32_t kNoFacet = 0xffffffffu;
  static constexpr std::uint32_t kTerrain = 0xfffffffeu;  ///< reflected by the ground

  double excess_m = 0.0;  ///< longer than the straight way by this; >= 0
  /// Field at the antenna relative to the free direct signal of that satellite: right-hand circular that stays
  /// right-hand, and that arrives left-hand. Reflections, roughness and diffraction are in it; foliage, the antenna's
  /// pattern and the phase of the longer way (-2 pi excess / wavelength) are not.
  std::complex<double> copolar, crosspolar;
  Eigen::Vector3d arrival_W = Eigen::Vector3d::UnitZ();  ///< unit, from the antenna to where the signal comes from
  double foliage_m = 0.0;                                ///< way through tree crowns, all legs
  int reflections = 0;
  int diffractions = 0;
  /// Reflectors in order from the antenna, the first `reflections` of them: index into Scene::facets(), or kTerrain.
  std::array<std::uint32_t, kMaxReflections> facets{kNoFacet, kNoFacet, kNoFacet};
};

/// How the signal of one satellite reaches the antenna.
struct SignalPaths {
  bool line_of_sight = true;
  double foliage_m = 0.0;  ///< of the straight way
  /// Field of the straight way relative to a free one: 1 in the clear, 0 if blocked; with a diffraction model also what
  /// an edge beside the way makes of it. The signal that bends around the edge into the shadow is an echo.
  std::complex<double> direct = 1.0;
  std::vector<SignalPath> echoes;  ///< by growing excess
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
