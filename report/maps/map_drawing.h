#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "canyon/report/read/results.h"

/// Plans of the scene as SVG. All plans share one coordinate system, metres east and south of the scene's north-west
/// corner, so that the scene is drawn once and reused; a plan is a window onto it.
namespace canyon::report {

/// The part of the scene a plan shows, in W.
struct MapWindow {
  Eigen::Vector2d min_W, max_W;
  Eigen::Vector2d size_m() const { return max_W - min_W; }
};

class MapDrawing {
 public:
  explicit MapDrawing(const SceneDrawing& scene) : scene_(scene) {}

  /// Once per page: the scene and its buildings alone as symbols for windows to use. Buildings in `of_interest` are
  /// marked.
  std::string definitions(const std::vector<std::string>& of_interest) const;

  /// A window with `svg` drawn over the scene and `html` (placed with place()) over that. `ground`: "scene" or
  /// "outlines".
  std::string window(const MapWindow& window, std::string_view ground, std::string_view id, std::string_view title,
                     std::string_view description, const std::string& svg, const std::string& html) const;

  /// "left:12.3%;top:4.5%" of a point in a window.
  static std::string place(const MapWindow& window, const Eigen::Vector2d& p_W);

  /// "x y" in the plans' coordinates.
  std::string point(const Eigen::Vector2d& p_W, int decimals = 1) const;
  /// "Mx yLx y..." through all points.
  std::string path(std::span<const Eigen::Vector2d> points_W, int decimals = 1) const;

  /// The classes of building height and their legend.
  std::string height_legend() const;

 private:
  const SceneDrawing& scene_;
};

/// A bar of a round length about a fifth of the window, and an arrow to the north.
std::string scale_and_north(const MapWindow& window);

}  // namespace canyon::report
