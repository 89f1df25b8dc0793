#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace canyon::scene {

/// Where the ground of an imported scene is wanted in full detail: where things stand and where a vehicle drives, as
/// squares of kSquare_m of W. Only edges are noted (of outlines, of triangles, of streets): the ground in the middle of
/// a large hall matters to nobody.
class GroundDetail {
 public:
  static constexpr double kSquare_m = 16.0;

  /// A square's place, counted from W's origin.
  struct Square {
    std::int32_t x, y;
    bool operator==(const Square&) const = default;
  };

  /// The squares that the way from a to b passes, ends included; not finite ends are left out.
  void add(const Eigen::Vector2d& a, const Eigen::Vector2d& b);
  /// All of them, once each, from the south-west.
  std::vector<Square> squares() const;

 private:
  std::vector<Square> noted_;
};

/// Distances between a rectangle and a square: of the nearest of their points, and of the rectangle's point that is
/// farthest from the square.
double nearest_m(const Eigen::Vector2d& low, const Eigen::Vector2d& high, const GroundDetail::Square& square);
double farthest_m(const Eigen::Vector2d& low, const Eigen::Vector2d& high, const GroundDetail::Square& square);

}  // namespace canyon::scene
