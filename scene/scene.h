#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/earth/local_frame.h"
#include "canyon/scene/city/street_graph.h"
#include "canyon/scene/surfaces/edge.h"
#include "canyon/scene/surfaces/facade.h"
#include "canyon/scene/surfaces/facet.h"
#include "canyon/scene/surfaces/foliage_index.h"
#include "canyon/scene/surfaces/material.h"

namespace canyon::scene {

/// Triangles in W, single precision (that is what the ray tracer works in).
struct Mesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint16_t> material;  ///< per triangle, index into Scene::materials()
  std::vector<std::uint32_t> object;    ///< per triangle, index into Scene::objects()
};

enum class ObjectKind : std::uint8_t { kTerrain, kBuilding, kVehicle, kTree, kWall, kPole, kOther, kPerson };

struct SceneObject {
  std::string name;  ///< "building 17"; unique
  ObjectKind kind = ObjectKind::kOther;
};

/// A building as planners and reports see it; its surfaces are in the mesh.
struct Building {
  std::string name;
  std::uint32_t object = 0;
  std::vector<Eigen::Vector2d> footprint_W;                ///< counter-clockwise
  std::vector<std::vector<Eigen::Vector2d>> courtyards_W;  ///< holes of the footprint, clockwise
  double base_m = 0.0;                                     ///< lowest ground at the footprint, W height
  double height_m = 0.0;                                   ///< roof above base
};

/// Everything a scene is made of, before it becomes immutable.
struct SceneParts {
  std::string name;
  LocalFrame frame;
  double undulation_m = 0.0;  ///< geoid undulation used to set the origin's ellipsoidal height
  Mesh mesh;
  std::vector<Material> materials;
  std::vector<SceneObject> objects;
  std::vector<Building> buildings;
  std::vector<Foliage> foliage;
  StreetGraph streets;
};

struct Extent {
  Eigen::Vector3d min = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d max = Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity());
};

class TiledTracer;

/// A static scene: immutable and shared by all runs and threads.
class Scene {
 public:
  /// Triangles that no ray can meet (a vertex not finite, or thinner than a micrometre) are dropped from the mesh and
  /// counted. Index errors (a vertex, material or object that does not exist) are a programmer's mistake and throw.
  explicit Scene(SceneParts parts);
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  const SceneParts& parts() const { return parts_; }
  const std::string& name() const { return parts_.name; }
  const LocalFrame& frame() const { return parts_.frame; }
  const Mesh& mesh() const { return parts_.mesh; }
  const std::vector<Material>& materials() const { return parts_.materials; }
  const std::vector<SceneObject>& objects() const { return parts_.objects; }
  const std::vector<Building>& buildings() const { return parts_.buildings; }
  const std::vector<Foliage>& foliage() const { return parts_.foliage; }
  const StreetGraph& streets() const { return parts_.streets; }
  const Extent& extent() const { return extent_; }
  std::size_t dropped_triangles() const { return dropped_triangles_; }

  /// Planar surfaces of at least kMinFacetArea_m2 merged from triangles, with their spatial index; built on first use,
  /// so that a scene whose sensors need no reflections never pays for them. Thread-safe.
  static constexpr double kMinFacetArea_m2 = 1.0;
  const FacetIndex& facets() const;
  bool facets_built() const;
  /// What was made so far; how much of it is asked for depends on the sensors alone, not on threads.
  struct Made {
    std::int64_t acceleration_structures = 0;  ///< trees over triangles, and over instances at one time
    std::int64_t tiles = 0;                    ///< of those, over a tile each; one in a scene without tiles
    std::int64_t facets = 0, edges = 0;        ///< in their indices; none where nobody asked for the index
  };
  Made made() const;
  /// Convex edges of at least kMinEdge_m with their spatial index; built on first use. Thread-safe.
  static constexpr double kMinEdge_m = 0.5;
  const EdgeIndex& edges() const;

  /// Facets that are walls of buildings, by triangle; built on first use, and facets() with them. Thread-safe.
  const FacadeIndex& facades() const;

  /// Height of the terrain (ObjectKind::kTerrain only) at x, y in W and its upward unit normal; nullopt outside.
  struct Ground {
    double height_m = 0.0;
    Eigen::Vector3d normal_W{0, 0, 1};
    std::uint16_t material = 0;  ///< index into materials()
  };
  std::optional<Ground> ground(double x, double y) const;
  /// Height of the terrain within 5 cm of x, y, the lowest that is found there: for the borders of the holes that
  /// terrain may have where buildings stand.
  std::optional<double> ground_beside(double x, double y) const;

  /// The building whose footprint, courtyards left out, contains (x, y); nullptr if none.
  const Building* building_at(const Eigen::Vector2d& xy) const;

  /// SHA-256 over geometry, materials and frame, for the manifest.
  std::string hash() const;

 private:
  friend class SceneAt;
  SceneParts parts_;
  Extent extent_;
  std::size_t dropped_triangles_ = 0;
  std::unique_ptr<TiledTracer> tracer_;
  FoliageIndex crowns_;
  mutable std::once_flag facets_once_;
  mutable std::atomic<bool> facets_built_{false};
  mutable FacetIndex facets_;
  mutable std::once_flag facades_once_;
  mutable FacadeIndex facades_;
  mutable std::once_flag edges_once_;
  mutable EdgeIndex edges_;
  mutable std::atomic<bool> edges_built_{false};
  mutable std::atomic<std::int64_t> instance_sets_{0};
};

}  // namespace canyon::scene
