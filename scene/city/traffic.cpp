#include "canyon/scene/city/traffic.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "canyon/core/config/text.h"
#include "canyon/scene/city/site.h"
#include "canyon/scene/mesh_builder.h"

namespace canyon::scene {
namespace {

struct Box {
  Eigen::Vector3d center, half_m;
  const char* material;
};
struct Shape {
  const char* name;
  ObjectKind kind;
  std::vector<Box> boxes;
};

/// Sizes of a middle-class car, a two-axle city bus (Directive 96/53/EC allows 2.55 m) and a standing adult.
const std::vector<Shape>& shapes() {
  static const std::vector<Shape> all = {
      {"car",
       ObjectKind::kVehicle,
       {{{0.0, 0.0, 0.55}, {2.25, 0.9, 0.35}, "painted_metal"}, {{-0.3, 0.0, 1.2}, {1.2, 0.8, 0.3}, "painted_metal"}}},
      {"bus", ObjectKind::kVehicle, {{{0.0, 0.0, 1.65}, {6.0, 1.275, 1.35}, "painted_metal"}}},
      {"person", ObjectKind::kPerson, {{{0.0, 0.0, 0.875}, {0.15, 0.25, 0.875}, "clothing"}}},
  };
  return all;
}

std::shared_ptr<const RigidShape> make_shape(const Shape& shape, const Scene& scene) {
  SceneParts parts;
  parts.materials = scene.materials();
  MeshBuilder mesh(parts);
  mesh.begin_object(shape.name, shape.kind);
  for (const Box& box : shape.boxes)
    mesh.box(box.center, Eigen::Matrix3d::Identity(), box.half_m, mesh.material(box.material));
  return std::make_shared<const RigidShape>(shape.name, shape.kind, std::move(parts.mesh));
}

std::string thing_key(std::size_t i) {
  return "scene.moving[" + std::to_string(i + 1) + "]";
}
std::string way_key(std::size_t i) {
  return thing_key(i) + ".path_m";
}

std::string moving_name(const MovingConfig& config, std::size_t i) {
  return config.name.empty() ? config.shape + " " + std::to_string(i + 1) : config.name;
}

Error is_taken(std::size_t i, const std::string& name, const std::string& by) {
  return Error{"", 0, thing_key(i) + ".name", "\"" + name + "\" is the name of " + by + " too", "a name of its own"};
}

/// Results tell things by their names. `standing`: what else the scene has.
template <class Named>
Status check_names(const std::vector<MovingConfig>& moving, const std::vector<Named>& standing) {
  std::map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < moving.size(); ++i) {
    const auto [first, is_new] = places.emplace(moving_name(moving[i], i), i);
    if (!is_new) return is_taken(i, first->first, thing_key(first->second));
  }
  if (places.empty()) return Ok{};
  for (const Named& thing : standing)
    if (const auto taken = places.find(thing.name); taken != places.end())
      return is_taken(taken->second, thing.name, "something that stands in the scene");
  return Ok{};
}

Status check_size(const MovingConfig& config, std::size_t i) {
  if (config.path_m.size() < 2 || config.path_m.size() % 2 != 0)
    return Error{"", 0, way_key(i), std::to_string(config.path_m.size()) + " numbers", "x, y of at least one point"};
  return Ok{};
}

Error lies_outside(std::size_t i, const Eigen::Vector2d& p, const std::string& expected) {
  return Error{"", 0, way_key(i), "(" + number_text(p.x()) + ", " + number_text(p.y()) + ") lies outside the scene",
               expected};
}

}  // namespace

void visit(FieldVisitor& f, MovingConfig& c) {
  f.text("name", c.name, "of this moving thing, and of nothing else; else its shape and number");
  f.choice("shape", c.shape, moving_shapes(), "what it looks like");
  f.numbers("path_m", c.path_m, 0, {-1e5, 1e5}, "x, y, x, y, ... of its way in W");
  f.number("speed_m_s", c.speed_m_s, {0.0, 100.0}, "along the way");
  f.number("start_s", c.start_s, {0.0, 1e6}, "when it starts; it stands until then, and after its way's end");
}

std::vector<std::string> moving_shapes() {
  std::vector<std::string> names;
  for (const Shape& shape : shapes()) names.emplace_back(shape.name);
  return names;
}

Status check_ways(const std::vector<MovingConfig>& moving, const Site& site) {
  CANYON_TRY_STATUS(check_names(moving, site.buildings));
  for (std::size_t i = 0; i < moving.size(); ++i) {
    CANYON_TRY_STATUS(check_size(moving[i], i));
    for (std::size_t k = 0; k + 1 < moving[i].path_m.size(); k += 2) {
      const Eigen::Vector2d p(moving[i].path_m[k], moving[i].path_m[k + 1]);
      if (!site.contains(p)) return lies_outside(i, p, "a point on the terrain (" + site.extent_keys + ")");
    }
  }
  return Ok{};
}

Result<Traffic> Traffic::make(const std::vector<MovingConfig>& moving, const Scene& scene) {
  Traffic out;
  out.scene_ = &scene;
  CANYON_TRY_STATUS(check_names(moving, scene.objects()));
  for (std::size_t i = 0; i < moving.size(); ++i) {
    const MovingConfig& config = moving[i];
    CANYON_TRY_STATUS(check_size(config, i));
    Moving m{moving_name(config, i), nullptr, {}, config.speed_m_s, config.start_s};
    for (std::size_t k = 0; k + 1 < config.path_m.size(); k += 2) {
      m.path_W.emplace_back(config.path_m[k], config.path_m[k + 1]);
      if (!scene.ground(m.path_W.back().x(), m.path_W.back().y()))
        return lies_outside(i, m.path_W.back(), "a point on the terrain");
    }
    for (const Moving& other : out.moving_)
      if (other.shape->name() == config.shape) m.shape = other.shape;
    const auto shape =
        std::find_if(shapes().begin(), shapes().end(), [&](const Shape& s) { return s.name == config.shape; });
    CANYON_CHECK(shape != shapes().end(), "shape ", config.shape);
    if (!m.shape) m.shape = make_shape(*shape, scene);
    out.moving_.push_back(std::move(m));
  }
  return out;
}

std::vector<Instance> Traffic::at(double t_s) const {
  std::vector<Instance> out;
  for (const Moving& m : moving_) {
    double left_m = std::max(0.0, t_s - m.start_s) * m.speed_m_s;
    Eigen::Vector2d p = m.path_W[0], ahead(1.0, 0.0);
    for (std::size_t k = 0; k + 1 < m.path_W.size(); ++k) {
      const Eigen::Vector2d way = m.path_W[k + 1] - m.path_W[k];
      const double length_m = way.norm();
      if (length_m > 0.0) ahead = way / length_m;
      p = m.path_W[k] + std::min(left_m, length_m) * ahead;
      if (left_m <= length_m) break;
      left_m -= length_m;
    }
    const auto ground = scene_->ground(p.x(), p.y());
    // Headed along the way; upright to the ground, but for people.
    const bool level = !ground || m.shape->kind() == ObjectKind::kPerson;
    const Eigen::Vector3d up = level ? Eigen::Vector3d(Eigen::Vector3d::UnitZ()) : ground->normal_W;
    const Eigen::Vector3d left = up.cross(Eigen::Vector3d(ahead.x(), ahead.y(), 0.0)).normalized();
    Eigen::Matrix3d R;
    R << left.cross(up), left, up;
    out.push_back({m.shape, m.name, {Eigen::Quaterniond(R), {p.x(), p.y(), ground ? ground->height_m : 0.0}}});
  }
  return out;
}

std::vector<std::size_t> Traffic::standing(double from_s, double to_s) const {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    const Moving& m = moving_[i];
    double way_m = 0.0;
    for (std::size_t k = 0; k + 1 < m.path_W.size(); ++k) way_m += (m.path_W[k + 1] - m.path_W[k]).norm();
    const bool goes = way_m > 0.0 && m.speed_m_s > 0.0;
    if (!goes || to_s <= m.start_s || from_s >= m.start_s + way_m / m.speed_m_s) out.push_back(i);
  }
  return out;
}

Eigen::AlignedBox2d SweptRoom::around() const {
  const Eigen::Vector2d wide = Eigen::Vector2d::Constant(radius_m);
  return {from_W.cwiseMin(to_W) - wide, from_W.cwiseMax(to_W) + wide};
}

std::vector<SweptRoom> Traffic::swept() const {
  constexpr double kStep_m = 1.0, kBetween_m = 0.5;  // between heights that are looked at; what lies between them
  std::vector<SweptRoom> out;
  for (const Moving& m : moving_) {
    double reach_m = 0.0;
    for (const Eigen::Vector3f& corner : m.shape->mesh().vertices)
      reach_m = std::max(reach_m, static_cast<double>(corner.norm()));
    for (std::size_t k = 0; k == 0 || k + 1 < m.path_W.size(); ++k) {
      const Eigen::Vector2d a = m.path_W[k], b = m.path_W[std::min(k + 1, m.path_W.size() - 1)];
      SweptRoom room{a, b, reach_m, -std::numeric_limits<double>::infinity()};
      const int steps = static_cast<int>(std::ceil((b - a).norm() / kStep_m)) + 1;
      for (int i = 0; i <= steps; ++i) {
        const Eigen::Vector2d p = a + (b - a) * i / steps;
        const auto ground = scene_->ground(p.x(), p.y());
        room.top_m = std::max(room.top_m, (ground ? ground->height_m : 0.0) + reach_m + kBetween_m);
      }
      out.push_back(room);
    }
  }
  return out;
}

}  // namespace canyon::scene
