#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace canyon::scene {

/// A triangle of a building's shell.
struct SolidFace {
  std::array<Eigen::Vector3d, 3> corners;
  std::uint32_t triangle = 0;  ///< of the mesh
  bool bottom = false;         ///< its file says that it is of the bottom
};

/// Where a shell ends below.
struct SolidBottom {
  std::vector<std::vector<Eigen::Vector3d>> rings;  ///< outlines clockwise seen from above, yards the other way
  std::vector<std::uint32_t> triangles;             ///< of the mesh; none: the shell is open below
  double low_m = 0.0;                               ///< the part's lowest corner
  bool sure = false;  ///< said by the file, or of the lowest part: it is to stand in the ground
};

/// The bottoms of a building's parts, which have no corner in common (to a millimetre), in the order of their first
/// faces: of each the faces that are said to be the bottom; in a building that says nothing, those that look down and
/// reach no higher than kBottom_m above the part's lowest corner (not eaves, balconies, passages); without such, where
/// a shell that is open below ends. Parts without any are left out.
inline constexpr double kBottom_m = 1.0;
std::vector<SolidBottom> bottoms_of(const std::vector<SolidFace>& faces);

/// Triangles that fill the rings of a bottom, as places seen from above, and look down.
std::vector<std::array<Eigen::Vector2d, 3>> floor_of(const SolidBottom& bottom);

}  // namespace canyon::scene
