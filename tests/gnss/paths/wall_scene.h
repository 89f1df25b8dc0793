#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "canyon/core/units.h"
#include "canyon/scene/scene.h"

/// Small scenes made of rectangles, for path tests.
namespace canyon::gnss::testing {

inline constexpr double kVicksburgLat = 32.35 * kDegree;
inline constexpr double kVicksburgLon = -90.88 * kDegree;

class WallScene {
 public:
  explicit WallScene(const Geodetic& origin = {kVicksburgLat, kVicksburgLon, 60.0}) {
    parts_.name = "walls";
    parts_.frame = LocalFrame(origin);
    parts_.materials = scene::builtin_materials();
  }

  std::uint16_t material(const std::string& name) const {
    for (std::size_t i = 0; i < parts_.materials.size(); ++i)
      if (parts_.materials[i].name == name) return static_cast<std::uint16_t>(i);
    throw std::runtime_error("no material " + name);
  }

  /// A rectangle: corner, and two edges; it faces the side that edge_u x edge_v points to.
  WallScene& wall(const Eigen::Vector3d& corner, const Eigen::Vector3d& edge_u, const Eigen::Vector3d& edge_v,
                  const std::string& material_name = "concrete") {
    parts_.objects.push_back({"wall " + std::to_string(parts_.objects.size()), scene::ObjectKind::kWall});
    return face(corner, edge_u, edge_v, material_name);
  }

  /// A closed box, all faces outward, one object.
  WallScene& box(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                 const std::string& material_name = "concrete") {
    const Eigen::Vector3d x(high.x() - low.x(), 0, 0), y(0, high.y() - low.y(), 0), z(0, 0, high.z() - low.z());
    wall(low, y, x, material_name).face(low + z, x, y, material_name);
    face(low, x, z, material_name).face(low + y, z, x, material_name);
    return face(low, z, y, material_name).face(low + x, y, z, material_name);
  }

  /// One more rectangle of the last object.
  WallScene& face(const Eigen::Vector3d& corner, const Eigen::Vector3d& edge_u, const Eigen::Vector3d& edge_v,
                  const std::string& material_name) {
    const auto first = static_cast<std::uint32_t>(parts_.mesh.vertices.size());
    for (const Eigen::Vector3d& p : {corner, Eigen::Vector3d(corner + edge_u),
                                     Eigen::Vector3d(corner + edge_u + edge_v), Eigen::Vector3d(corner + edge_v)})
      parts_.mesh.vertices.push_back(p.cast<float>());
    const auto object = static_cast<std::uint32_t>(parts_.objects.size() - 1);
    for (const auto& t : {std::array<std::uint32_t, 3>{first, first + 1, first + 2}, {first, first + 2, first + 3}}) {
      parts_.mesh.triangles.push_back(t);
      parts_.mesh.material.push_back(material(material_name));
      parts_.mesh.object.push_back(object);
    }
    return *this;
  }

  WallScene& crown(const Eigen::Vector3d& center, const Eigen::Vector3d& radii) {
    parts_.foliage.push_back({center, radii});
    return *this;
  }

  std::unique_ptr<scene::Scene> build() { return std::make_unique<scene::Scene>(parts_); }

 private:
  scene::SceneParts parts_;
};

/// Unit direction in W (east, north, up) of a satellite.
inline Eigen::Vector3d direction(double azimuth_deg, double elevation_deg) {
  const double a = azimuth_deg * kDegree, e = elevation_deg * kDegree;
  return {std::cos(e) * std::sin(a), std::cos(e) * std::cos(a), std::sin(e)};
}

}  // namespace canyon::gnss::testing
