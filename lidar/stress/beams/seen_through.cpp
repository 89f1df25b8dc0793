// How beams meet a scene through panes and crowns, by one ray and by sixteen.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/lidar/beam/footprint/footprint_rays.h"
#include "canyon/lidar/beam/surfaces.h"
#include "canyon/lidar/beam/volley.h"
#include "canyon/lidar/lidar_config.h"
#include "canyon/lidar/stress/subjects.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/scene_at.h"

namespace canyon::lidar {
namespace {

using Eigen::Vector3d;
using stress::kHalfUlp;
using stress::kInfinity;
using stress::Looks;

/// A wall across x, from low to high in y and z.
struct Screen {
  double x = 0.0;
  Eigen::Vector2d low, high;
  std::string material;
  bool tree = false;
};

/// Panes behind one another, walls that end within the field, and leaves: two crowns, with leaves of the mesh in one of
/// them and beside it.
std::vector<Screen> screens() {
  return {{4.0, {-9, -9}, {-0.3, 9}, "glass"},
          {6.5, {-2.0, -9}, {9, 0.4}, "glass"},
          {7.1, {-9, -9}, {-1.0, 0.3}, "glass"},
          {8.0, {1.5, -1}, {2.2, 2}, "brick"},
          {8.4, {2.2, -1}, {3.0, 2}, "concrete"},
          {15.0, {-3.0, 0.0}, {3.0, 3.0}, "foliage", true},
          {16.0, {-30, -30}, {-3.5, 30}, "foliage", true},
          {22.0, {-40, -40}, {40, 40}, "concrete"}};
}
std::vector<scene::Foliage> crowns() {
  scene::Foliage near, far;
  near.center_W = {12.0, 0.5, 0.6}, near.radii_m = {1.2, 2.5, 1.5}, near.leaf_density_m2_m3 = 0.5;
  // The leaves at 15 m lie in this one, by the middle of either triangle.
  far.center_W = {15.2, 0.0, 1.5}, far.radii_m = {1.5, 4.0, 2.5}, far.leaf_density_m2_m3 = 0.8;
  return {far, near};
}
scene::SceneParts screens_as_parts() {
  scene::SceneParts parts;
  parts.name = "screens";
  parts.materials = scene::builtin_materials();
  parts.foliage = crowns();
  scene::MeshBuilder mesh(parts);
  int number = 0;
  for (const Screen& s : screens()) {
    mesh.begin_object("screen " + std::to_string(++number),
                      s.tree ? scene::ObjectKind::kTree : scene::ObjectKind::kWall);
    mesh.quad({s.x, s.high.x(), s.low.y()}, {s.x, s.low.x(), s.low.y()}, {s.x, s.low.x(), s.high.y()},
              {s.x, s.high.x(), s.high.y()}, mesh.material(s.material));
  }
  return parts;
}

struct Glint {
  double range_m = 0.0, cosine = 0.0, reflectivity = 0.0;
  std::uint16_t material = 0;
  std::uint32_t object = 0;
};

/// Everything that a thin ray meets, by plane geometry, in order: what its light comes back from.
class Met {
 public:
  Met(const scene::Scene& scene, const scene::SceneAt& at, Transparent through, std::uint64_t seed)
      : scene_(scene), surfaces_(at, 905.0), through_(through), stream_(seed, "lidar.leaves") {}

  std::vector<Glint> operator()(const Vector3d& o, const Vector3d& d, double most_m, std::uint32_t laser,
                                std::uint64_t draw, std::uint32_t sub_ray) const {
    Glint leaf{kInfinity};
    if (through_.leaves) {
      std::vector<std::array<double, 3>> chords;  // from, to, density
      for (const scene::Foliage& f : scene_.foliage()) {
        const Vector3d q = (o - f.center_W).cwiseQuotient(f.radii_m), u = d.cwiseQuotient(f.radii_m);
        const double a = u.dot(u), b = u.dot(q), root = b * b - a * (q.dot(q) - 1.0);
        if (root <= 0.0) continue;
        const double enter = (-b - std::sqrt(root)) / a, leave = (-b + std::sqrt(root)) / a;
        if (enter > 0.0 && enter < most_m) chords.push_back({enter, leave, f.leaf_density_m2_m3});
      }
      std::sort(chords.begin(), chords.end());
      for (std::uint32_t k = 0; k < chords.size(); ++k) {
        const auto& [enter, leave, density] = chords[k];
        const std::uint32_t n = 32 * sub_ray + 2 * k;
        const double at = enter - 2.0 * std::log(1.0 - stream_.uniform(laser, draw, n)) / density;
        if (at >= leave || at >= leaf.range_m) continue;
        const auto cosine = static_cast<float>(std::sqrt(1.0 - stream_.uniform(laser, draw, n + 1)));
        leaf = {at, cosine, surfaces_.leaf(cosine), surfaces_.foliage(), kNoObject};
      }
    }
    std::vector<Glint> out;
    double light = 1.0;
    std::uint32_t object = 0;
    for (const Screen& s : screens()) {
      const std::uint32_t index = object++;
      const double range = (s.x - o.x()) / d.x();
      const Vector3d p = o + range * d;
      if (p.y() < s.low.x() || p.y() > s.high.x() || p.z() < s.low.y() || p.z() > s.high.y()) continue;
      if (range >= most_m || range >= leaf.range_m) break;
      if (through_.leaves && s.tree && s.x == 15.0) continue;  // shown in the place of a crown
      std::uint16_t material = 0;
      while (scene_.materials()[material].name != s.material) ++material;
      const auto cosine = static_cast<float>(std::abs(d.x()));
      out.push_back({range, cosine, light * surfaces_.of_material(material, cosine), material, index});
      const double t = scene_.materials()[material].lidar_transmittance;
      if (!through_.panes || t <= 0.0) light = 0.0;
      if (light > 0.0) light *= std::pow(pane_transmittance(t, cosine), 2);
      if (light < 1e-4) return out;
    }
    if (leaf.range_m < most_m) {
      leaf.reflectivity *= light;
      out.push_back(leaf);
    }
    return out;
  }

 private:
  const scene::Scene& scene_;
  Surfaces surfaces_;
  Transparent through_;
  RandomStream stream_;
};

/// What comes back within a pulse's length of the light before it is one echo, of its energy's mean range.
std::vector<Glint> merged_within(std::vector<Glint> glints, double pulse_m, double overlap_m) {
  std::stable_sort(glints.begin(), glints.end(), [](const Glint& a, const Glint& b) { return a.range_m < b.range_m; });
  std::vector<Glint> out;
  for (std::size_t begin = 0, end = 0; begin < glints.size(); begin = end) {
    double power = 0.0, range = 0.0, cosine = 0.0, most = -1.0;
    Glint echo;
    for (end = begin; end == begin || (end < glints.size() && glints[end].range_m - glints[end - 1].range_m <= pulse_m);
         ++end) {
      const Glint& g = glints[end];
      const double least = g.range_m > overlap_m ? g.range_m : overlap_m, p = g.reflectivity / (least * least);
      power += p, range += p * g.range_m, cosine += p * g.cosine;
      if (p > most) most = p, echo.material = g.material, echo.object = g.object;
    }
    echo.range_m = range / power, echo.cosine = cosine / power;
    const double least = echo.range_m > overlap_m ? echo.range_m : overlap_m;
    echo.reflectivity = power * least * least / 16.0;
    out.push_back(echo);
  }
  return out;
}

/// A volley into panes, walls and crowns: each shot's echoes by plane geometry, the documented stream of leaves and, of
/// sixteen rays, the documented merging. Single precision of 30 m, and of sums of some hundred terms.
StressFigure met_one_by_one(const std::string& model, Transparent through) {
  Looks looks;
  const scene::Scene scene(screens_as_parts());
  const scene::SceneAt at(scene);
  const Surfaces surfaces(at, 905.0);
  LidarConfig config;
  config.model.name = model, config.see_through = through;
  config.signal.pulse_m = 0.5, config.signal.full_overlap_m = 5.0;
  const auto echo_model = config.model.make("model", config, std::uint64_t{41});
  looks.right(echo_model.ok());
  if (!echo_model) return looks.figure();
  const bool spread = model == "footprint";
  looks.right((*echo_model)->rays_per_shot() == (spread ? 16U : 1U));
  Volley volley;
  volley.lasers = 3, volley.cycles = 32, volley.first_draw = 500, volley.origin_W = {0.25, -0.5, 0.125};
  volley.aims.resize(volley.packets()), volley.rays.resize(volley.packets());
  for (PlacementPacket& p : volley.placements)
    for (std::size_t i = 0; i < PlacementPacket::kShots; ++i)
      for (std::size_t k = 0; k < 9; ++k) p.R[k][i] = k % 4 == 0 ? 1.0f : 0.0f;
  for (std::size_t shot = 0; shot < volley.shots(); ++shot) {
    const auto laser = static_cast<double>(shot / 32), cycle = static_cast<double>(shot % 32);
    const double a = -0.45 + 0.0287 * cycle, e = -0.061 + 0.13 * laser;
    scene::RayPacket& r = volley.rays[shot / 16];
    const std::size_t i = shot % 16;
    r.origin_x[i] = 0.5f, r.origin_y[i] = 0.03125f * static_cast<float>(laser), r.origin_z[i] = 0.25f;
    r.direction_x[i] = static_cast<float>(std::cos(e) * std::cos(a));
    r.direction_y[i] = static_cast<float>(std::cos(e) * std::sin(a));
    r.direction_z[i] = static_cast<float>(std::sin(e));
    r.max_m[i] = shot % 23 == 5 ? -1.0f : shot % 23 == 7 ? 14.0f : 60.0f;
  }
  Echoes echoes;
  (*echo_model)->trace(volley, at, surfaces, echoes);
  const Met met(scene, at, through, 41);
  const FootprintOffsets offsets = footprint_offsets(3e-3 / 4.0, 1.5e-3 / 4.0);  // the default's divergence
  const float up[3] = {0.0f, 0.0f, 1.0f};
  int several = 0, leaves = 0;
  for (std::size_t shot = 0; shot < volley.shots(); ++shot) {
    const scene::RayPacket& r = volley.rays[shot / 16];
    const std::size_t lane = shot % 16;
    std::vector<Glint> expected;
    const auto of = [&](const scene::RayPacket& p, std::size_t i, std::uint32_t sub) {
      const Vector3d o = volley.origin_W + Vector3d(p.origin_x[i], p.origin_y[i], p.origin_z[i]);
      const Vector3d d(p.direction_x[i], p.direction_y[i], p.direction_z[i]);
      return met(o, d, p.max_m[i], static_cast<std::uint32_t>(shot / 32), 500 + shot % 32, sub);
    };
    if (r.max_m[lane] >= 0.0f && !spread) expected = of(r, lane, 0);
    if (r.max_m[lane] >= 0.0f && spread) {
      scene::RayPacket beam{};
      spread_beam(r, lane, up, offsets, beam);
      std::vector<Glint> all;
      for (std::uint32_t i = 0; i < 16; ++i)
        for (const Glint& g : of(beam, i, i)) all.push_back(g);
      expected = merged_within(all, 0.5, 5.0);
    }
    std::vector<Echo> found;
    for (std::size_t k = 0; k < echoes.layers(); ++k)
      if (const Echo e = echoes.layer(k)[shot / 16].at(lane); e.any()) found.push_back(e);
    looks.right(found.size() == expected.size());
    for (std::size_t k = 0; k < found.size() && k < expected.size(); ++k) {
      const Glint& e = expected[k];
      looks.near(found[k].truth.range_m, e.range_m, 16.0 * kHalfUlp * 30.0);
      looks.near(found[k].truth.cos_incidence, e.cosine, 64.0 * kHalfUlp);
      looks.near(found[k].reflectivity, e.reflectivity, 128.0 * kHalfUlp * (e.reflectivity + 1e-3));
      looks.right(found[k].truth.material == e.material && found[k].truth.object == e.object);
      leaves += e.object == kNoObject ? 1 : 0;
    }
    several += found.size() > 1 ? 1 : 0;
  }
  looks.right(several > 0 || (!spread && through == Transparent{}) || (!spread && !through.panes));
  looks.right(through.leaves == (leaves > 0));
  return looks.figure();
}

}  // namespace

std::vector<StressCase> seen_through_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "shots through panes and crowns, one by one",
           "light that passed once in place of twice, draws of another crown, an echo's mean without its energy",
           "plane geometry, the documented stream and merging: single precision", "of the bound"});
  for (const char* model : {"single_ray", "footprint"})
    for (const auto& row : see_through_rows())
      rows.add(std::string("beams/") + model + "_through_" + row.name,
               [model, through = row.make] { return met_one_by_one(model, through); });
  return rows.take();
}

}  // namespace canyon::lidar
