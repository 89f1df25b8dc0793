#pragma once

#include <vector>

#include "canyon/core/motion/route_segment.h"
#include "canyon/core/need.h"
#include "canyon/gnss/paths/need/ball.h"
#include "canyon/gnss/paths/need/obstacle_heights.h"
#include "canyon/gnss/paths/need/sky_span.h"
#include "canyon/gnss/paths/path_model.h"
#include "canyon/scene/scene.h"

namespace canyon::gnss {

/// Of what is received no wave is longer: L5, the lowest carrier, has 0.2548 m.
inline constexpr double kLongestWave_m = 0.26;

/// What a model of propagation is asked: can its effects act on what an antenna receives that is carried along here?
struct PathQuestion {
  const RouteSegment& segment;
  double antenna_reach_m = 0.0;  ///< |antenna in B|
  double antenna_above_m = 0.0;  ///< least height of the antenna over B, however the body is tilted
  const scene::Scene& scene;
  const SkySpan& sky;
  const ObstacleHeights& heights;
  PathParameters limits;

  Ball antenna() const;  ///< wherever it may be
};

/// The names of the effects.
inline constexpr const char* kOcclusion = "occlusion rays";
inline constexpr const char* kFoliage = "foliage on straight ways";
inline constexpr const char* kDiffraction = "diffraction at edges";
inline constexpr const char* kScattering = "scattering off walls";
inline constexpr const char* kClutter = "clutter of the street";
inline constexpr const char* kReflections[] = {"reflection off one wall", "reflection off two walls",
                                               "reflection off three walls"};

/// Occlusion, foliage, and reflections off up to `order` walls (image_search.h).
std::vector<Need> specular_needs(int order, const PathQuestion& question);
/// Can any sequence of exactly `order` facets mirror a satellite's wave onto the antenna?
Need reflection_need(int order, const PathQuestion& question);
/// Diffraction around one edge or two (diffraction.h): both begin with an edge beside the straight way.
std::vector<Need> diffraction_needs(const PathQuestion& question);
/// The same by wedges, which reach farther: a lossy wedge may be stronger than a screen (kOverScreen_db).
std::vector<Need> wedge_needs(const PathQuestion& question);
/// Scattering by upright walls, of which an open field has none.
std::vector<Need> scatter_needs(const PathQuestion& question);
/// What a street has and the scene lacks, of which a place without houses has nothing.
std::vector<Need> clutter_needs(const PathQuestion& question);

}  // namespace canyon::gnss
