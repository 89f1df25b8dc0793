#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/scene/scene.h"

namespace canyon::scene {

/// Adds shapes to the mesh of a scene under construction. Faces are wound counter-clockwise seen from outside.
class MeshBuilder {
 public:
  explicit MeshBuilder(SceneParts& parts) : parts_(parts) {}

  /// Index of a material by name; the scene must have it.
  std::uint16_t material(const std::string& name) const;
  /// A new object; later shapes belong to it until the next call.
  std::uint32_t begin_object(std::string name, ObjectKind kind);
  /// Later shapes belong to an object that is there already.
  void resume_object(std::uint32_t object) { object_ = object; }

  void triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, std::uint16_t material);
  /// Two triangles, a b c and a c d.
  void quad(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, const Eigen::Vector3d& d,
            std::uint16_t material);
  /// Vertical walls over a counter-clockwise outline; bottom and top heights per corner.
  void walls(const std::vector<Eigen::Vector2d>& outline, const std::vector<double>& bottom_m,
             const std::vector<double>& top_m, std::uint16_t material);
  /// Vertical walls between two level heights and a flat roof; the outline must be star-shaped from its corner
  /// `fan_corner`.
  void block(const std::vector<Eigen::Vector2d>& outline, double bottom_m, double top_m, std::uint16_t wall,
             std::uint16_t roof, std::size_t fan_corner = 0);
  /// Closed box: center, half lengths along the unit axes of a right-handed frame.
  void box(const Eigen::Vector3d& center_W, const Eigen::Matrix3d& axes, const Eigen::Vector3d& half_m,
           std::uint16_t material);

 private:
  SceneParts& parts_;
  std::uint32_t object_ = 0;
};

/// Counter-clockwise corners of an axis-aligned rectangle.
std::vector<Eigen::Vector2d> rectangle(double x0, double y0, double x1, double y1);

}  // namespace canyon::scene
