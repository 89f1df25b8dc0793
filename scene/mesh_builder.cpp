#include "canyon/scene/mesh_builder.h"

#include "canyon/core/check.h"

namespace canyon::scene {

std::uint16_t MeshBuilder::material(const std::string& name) const {
  for (std::size_t i = 0; i < parts_.materials.size(); ++i) {
    if (parts_.materials[i].name == name) return static_cast<std::uint16_t>(i);
  }
  CANYON_CHECK(false, "no material ", name);
}

std::uint32_t MeshBuilder::begin_object(std::string name, ObjectKind kind) {
  object_ = static_cast<std::uint32_t>(parts_.objects.size());
  parts_.objects.push_back({std::move(name), kind});
  return object_;
}

void MeshBuilder::triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                           std::uint16_t material) {
  CANYON_CHECK(!parts_.objects.empty(), "begin_object() comes first");
  Mesh& mesh = parts_.mesh;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(a.cast<float>());
  mesh.vertices.push_back(b.cast<float>());
  mesh.vertices.push_back(c.cast<float>());
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.material.push_back(material);
  mesh.object.push_back(object_);
}

void MeshBuilder::quad(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                       const Eigen::Vector3d& d, std::uint16_t material) {
  triangle(a, b, c, material);
  Mesh& mesh = parts_.mesh;
  const auto next = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(d.cast<float>());
  mesh.triangles.push_back({next - 3, next - 1, next});
  mesh.material.push_back(material);
  mesh.object.push_back(object_);
}

void MeshBuilder::walls(const std::vector<Eigen::Vector2d>& outline, const std::vector<double>& bottom_m,
                        const std::vector<double>& top_m, std::uint16_t material) {
  CANYON_CHECK(outline.size() == bottom_m.size() && outline.size() == top_m.size(), "corners = ", outline.size());
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const std::size_t j = (i + 1) % outline.size();
    const Eigen::Vector2d &a = outline[i], &b = outline[j];
    quad({a.x(), a.y(), bottom_m[i]}, {b.x(), b.y(), bottom_m[j]}, {b.x(), b.y(), top_m[j]}, {a.x(), a.y(), top_m[i]},
         material);
  }
}

void MeshBuilder::block(const std::vector<Eigen::Vector2d>& outline, double bottom_m, double top_m, std::uint16_t wall,
                        std::uint16_t roof, std::size_t fan_corner) {
  const std::size_t n = outline.size();
  walls(outline, std::vector<double>(n, bottom_m), std::vector<double>(n, top_m), wall);
  const auto corner = [&](std::size_t i) {
    const Eigen::Vector2d& p = outline[(fan_corner + i) % n];
    return Eigen::Vector3d(p.x(), p.y(), top_m);
  };
  for (std::size_t i = 1; i + 1 < n; ++i) triangle(corner(0), corner(i), corner(i + 1), roof);
}

void MeshBuilder::box(const Eigen::Vector3d& center_W, const Eigen::Matrix3d& axes, const Eigen::Vector3d& half_m,
                      std::uint16_t material) {
  const auto corner = [&](double x, double y, double z) -> Eigen::Vector3d {
    return center_W + axes * Eigen::Vector3d(x * half_m.x(), y * half_m.y(), z * half_m.z());
  };
  quad(corner(-1, -1, -1), corner(-1, 1, -1), corner(1, 1, -1), corner(1, -1, -1), material);
  quad(corner(-1, -1, 1), corner(1, -1, 1), corner(1, 1, 1), corner(-1, 1, 1), material);
  quad(corner(-1, -1, -1), corner(1, -1, -1), corner(1, -1, 1), corner(-1, -1, 1), material);
  quad(corner(1, -1, -1), corner(1, 1, -1), corner(1, 1, 1), corner(1, -1, 1), material);
  quad(corner(1, 1, -1), corner(-1, 1, -1), corner(-1, 1, 1), corner(1, 1, 1), material);
  quad(corner(-1, 1, -1), corner(-1, -1, -1), corner(-1, -1, 1), corner(-1, 1, 1), material);
}

std::vector<Eigen::Vector2d> rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

}  // namespace canyon::scene
