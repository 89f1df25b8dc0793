#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace canyon::scene {

/// Twice the signed area of a ring, positive if counter-clockwise.
double twice_area(const std::vector<Eigen::Vector2d>& ring);
/// True if p lies inside the ring, which may run in any sense; on the border either may come out.
bool polygon_contains(const std::vector<Eigen::Vector2d>& ring, const Eigen::Vector2d& p);

/// Triangles of a polygon with holes by ear clipping (holes joined to the outline by bridges; Eberly, Triangulation by
/// Ear Clipping, 2002). Rings may run in any sense, and are counted through: the corners of the first, then those of
/// the second. All triangles are counter-clockwise. No corner is left out, so that neighbours find their edges again,
/// except where all that remains has no area. A ring that crosses itself gives some triangles, which may overlap.
std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<std::vector<Eigen::Vector2d>>& rings);

/// The same for a planar polygon in space: seen along its own normal (Newell's), so that the triangles keep the sense
/// of the outer ring.
std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<std::vector<Eigen::Vector3d>>& rings);

}  // namespace canyon::scene
