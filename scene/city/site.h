#pragma once

#include <optional>
#include <string>
#include <vector>

#include "canyon/scene/scene_source.h"

namespace canyon::scene {

/// The building whose footprint, courtyards left out, contains (x, y); nullptr if none.
const Building* building_at(const std::vector<Building>& buildings, const Eigen::Vector2d& xy);

/// What a mission is planned on: known of the built-in city before any terrain is made, so that a misplaced waypoint is
/// told at once and not after a minute.
struct Site {
  LocalFrame frame;
  Eigen::Vector2d low_W = Eigen::Vector2d::Zero(), high_W = Eigen::Vector2d::Zero();  ///< corners of the ground
  std::string extent_keys;                                                            ///< keys that they follow from
  StreetGraph streets;
  std::vector<Building> buildings;  ///< base_m and height_m are 0 where no terrain has been made

  bool contains(const Eigen::Vector2d& p_W) const {
    return (p_W.array() >= low_W.array()).all() && (p_W.array() <= high_W.array()).all();
  }
};

/// Of a configuration; none for a scene from files, which has to be read.
std::optional<Site> planned_site(const SceneConfig& config);
/// Of a scene that was made of that configuration.
Site site_of(const Scene& scene, const SceneConfig& config);
/// The keys that the corners of the ground follow from.
std::string extent_keys(const SceneConfig& config);

}  // namespace canyon::scene
