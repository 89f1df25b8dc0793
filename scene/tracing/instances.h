#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/motion/rotation.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/tracing/ray_packet.h"

namespace canyon::scene {

struct Ray;
struct Hit;
struct Plane;

/// The shape of a thing that moves without bending: a car, a person. Triangles in its own frame S: x forward, y left, z
/// up, origin on the ground below its middle. Immutable; many instances share one shape.
class RigidShape {
 public:
  /// `mesh.material` are indices into the scene's materials; `mesh.object` is not used. Triangles that no ray can meet
  /// are dropped, as in a Scene.
  RigidShape(std::string name, ObjectKind kind, Mesh mesh);
  ~RigidShape();
  RigidShape(const RigidShape&) = delete;
  RigidShape& operator=(const RigidShape&) = delete;

  const std::string& name() const { return name_; }
  ObjectKind kind() const { return kind_; }
  const Mesh& mesh() const { return mesh_; }

 private:
  friend class InstanceSet;
  struct Embree;
  std::string name_;
  ObjectKind kind_;
  Mesh mesh_;
  std::unique_ptr<Embree> embree_;
};

/// A shape at a place.
struct Instance {
  std::shared_ptr<const RigidShape> shape;
  std::string name;  ///< unique among instances
  Pose X_WS;
};

/// Instances at one time with the acceleration structure over them; immutable. Triangles are counted through: first
/// those of the first instance, then those of the second.
class InstanceSet {
 public:
  /// Works in W moved to `center_W`, which should be near.
  explicit InstanceSet(std::vector<Instance> instances, const Eigen::Vector3d& center_W = Eigen::Vector3d::Zero());
  ~InstanceSet();
  InstanceSet(const InstanceSet&) = delete;
  InstanceSet& operator=(const InstanceSet&) = delete;

  const std::vector<Instance>& instances() const { return instances_; }
  /// The instance that a triangle belongs to, and the triangle's index in its shape.
  struct Member {
    std::uint32_t instance, triangle;
  };
  Member member(std::uint32_t triangle) const;

  /// Replaces a hit by a nearer one on an instance, whose triangle is then `first_triangle` + the index counted
  /// through.
  void trace(const Ray& ray, std::uint32_t first_triangle, Hit& hit) const;
  void trace(std::span<const Ray> rays, std::uint32_t first_triangle, std::span<Hit> hits) const;
  /// Origins of packets are relative to `origin_W`.
  void trace(std::span<const RayPacket> rays, const Eigen::Vector3d& origin_W, std::uint32_t first_triangle,
             std::span<HitPacket> hits) const;
  bool occluded(const Eigen::Vector3d& origin_W, const Eigen::Vector3f& direction, float min_m, float max_m) const;

 private:
  struct Embree;
  /// The plane of a triangle of an instance's shape, about the center.
  Plane plane(const Member& member) const;
  std::vector<Instance> instances_;
  Eigen::Vector3d center_W_;
  std::vector<std::uint32_t> first_;  ///< of each instance, its first triangle; at the end the number of all
  std::unique_ptr<Embree> embree_;
};

}  // namespace canyon::scene
