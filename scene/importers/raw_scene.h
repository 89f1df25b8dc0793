#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/printable_text.h"
#include "canyon/scene/scene.h"

namespace canyon::scene {

/// The coordinates that a file is written in.
struct SourceFrame {
  /// What PROJ knows it by: "EPSG:7415", WKT, a PROJ string. Empty: metres, x east, y north, z up.
  std::string crs;
  /// Axes as the authority defines them (EPSG:6697: latitude first); else always east, north.
  bool authority_order = false;
};

/// Where something stands in a file, for what has to be said of it.
struct RawPlace {
  std::uint32_t file = 0;  ///< index into RawScene::files
  std::uint32_t line = 0;  ///< 1-based; 0: not known
};

/// A planar surface with holes; rings are not closed.
struct RawPolygon {
  std::uint32_t object = 0;
  std::uint32_t material = 0;                         ///< index into RawScene::materials
  std::vector<std::vector<Eigen::Vector3d>> rings{};  ///< the outer one first
  bool ground_surface = false;                        ///< the bottom of a building: what must reach the terrain
  RawPlace from{};
};

struct RawMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> object, material;  ///< per triangle
  std::uint32_t file = 0;                       ///< index into RawScene::files
  std::vector<std::uint32_t> line;              ///< of the file, per vertex; empty: not known
};

/// Roofs that a footprint may carry.
enum class RoofShape : std::uint8_t { kFlat, kGabled, kHipped, kPyramidal };

/// A building as an outline with a height.
struct RawFootprint {
  std::uint32_t object = 0;
  std::vector<std::vector<Eigen::Vector2d>> rings{};           ///< the outer one first; any sense, not closed
  double ground_m = std::numeric_limits<double>::quiet_NaN();  ///< height of the ground; NaN: the terrain tells
  double height_m = std::numeric_limits<double>::quiet_NaN();  ///< of the roof's top above ground
  double lift_m = 0.0;                                         ///< the building begins this high above ground
  RoofShape roof = RoofShape::kFlat;
  double roof_height_m = 0.0;  ///< of a pitched roof, part of height_m
  bool ridge_across = false;   ///< the ridge runs along the shorter side
  std::string wall_material{}, roof_material{};
  bool only_outline = false;  ///< of a building whose parts follow: they are built, this is its outline
  RawPlace from{};
};

/// A tree of which only place and size are known.
struct RawTree {
  std::uint32_t object = 0;
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
  double height_m = 10.0;
  double crown_m = 5.0;  ///< diameter
  RawPlace from{};
};

struct RawStreet {
  std::vector<Eigen::Vector2d> points;
  double width_m = 6.0;
  RawPlace from{};
};

/// What a file holds, in the file's coordinates, before it is set into W.
struct RawScene {
  std::vector<std::string> files{""};  ///< the first: the scene's own; then those that it names
  SourceFrame frame;
  bool y_up = false;                       ///< y is up and z towards the viewer, who stands in the south
  std::vector<std::string> materials{""};  ///< names as the file has them; the first: the default for where it faces
  std::vector<SceneObject> objects;
  std::vector<RawPolygon> polygons;
  std::vector<RawMesh> meshes;
  std::vector<RawFootprint> footprints;
  std::vector<RawStreet> streets;
  std::vector<RawTree> trees;
  std::vector<std::string> warnings;  ///< counted: "5 buildings without a height are left out"

  /// Index of a material's name, which is added if it is new.
  std::uint32_t material(const std::string& name) {
    const std::string material_name = escaped_text(name);
    const auto found = std::find(materials.begin(), materials.end(), material_name);
    if (found == materials.end()) {
      materials.push_back(material_name);
      return static_cast<std::uint32_t>(materials.size() - 1);
    }
    return static_cast<std::uint32_t>(found - materials.begin());
  }
  std::uint32_t add_object(const std::string& name, ObjectKind kind) {
    objects.push_back({escaped_text(name), kind});
    return static_cast<std::uint32_t>(objects.size() - 1);
  }
};

}  // namespace canyon::scene
