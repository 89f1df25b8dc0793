#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace canyon::scene {

class Scene;

/// A wall of a building, a facet within 30 degrees of the vertical of an object of ObjectKind::kBuilding, divided into
/// floors and bays.
///
/// ASSUMPTIONS, of houses as they are commonly built: floors of 3 m counted from the building's base, bays of 3 m or as
/// much wider as makes them come out even along the wall. A wall narrower than a bay has none; a floor is the wall's
/// own where it lies within its height as a whole.
struct Facade {
  static constexpr double kFloor_m = 3.0, kBay_m = 3.0;

  Eigen::Vector2d along_W;             ///< level unit vector in its plane
  double begin_m = 0.0, end_m = 0.0;   ///< along_W . (x, y) of its ends
  double bottom_m = 0.0, top_m = 0.0;  ///< lowest and highest z
  double base_m = 0.0;                 ///< z from which the building's floors count

  double bays = 0.0, bays_per_m = 0.0;        ///< whole number
  double first_floor = 0.0, end_floor = 0.0;  ///< whole numbers; the second is not its own any more

  /// Lays out bays and floors from what is above them.
  void divide();
};

/// The walls of a scene's buildings, by triangle. Floors count from Building::base_m, and where the scene lists no
/// such building from the wall's own lowest point. Machine rooms on roofs, chimneys and dormers are walls as well.
class FacadeIndex {
 public:
  FacadeIndex() = default;
  explicit FacadeIndex(const Scene& scene);

  const std::vector<Facade>& facades() const { return facades_; }
  static constexpr std::uint32_t kNone = 0xffffffffu;
  /// Index of the wall that a triangle of the scene's mesh belongs to, or kNone.
  std::uint32_t of(std::uint32_t triangle) const { return triangle < of_.size() ? of_[triangle] : kNone; }
  /// Whether any wall is of that material: most triangles need not be looked up.
  bool any_of(std::uint16_t material) const { return material < materials_.size() && materials_[material] != 0; }

 private:
  std::vector<Facade> facades_;
  std::vector<std::uint32_t> of_;  ///< by triangle
  std::vector<std::uint8_t> materials_;
};

}  // namespace canyon::scene
