// How beams meet a scene: through panes and crowns, by one ray and by sixteen; beams that shake; what moves meanwhile;
// and shots that end where nobody keeps a return.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/lidar/beam/firing_pattern.h"
#include "canyon/lidar/beam/footprint/footprint_rays.h"
#include "canyon/lidar/beam/surfaces.h"
#include "canyon/lidar/deskew.h"
#include "canyon/lidar/lidar_config.h"
#include "canyon/lidar/scan_drive.h"
#include "canyon/lidar/scanner.h"
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

/// A closed room of 80 x 70 x 12 m on the plane z = 0, with pillars if there are any.
std::unique_ptr<scene::Scene> closed_room(bool pillars) {
  scene::SceneParts parts;
  parts.name = "room";
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("room", scene::ObjectKind::kBuilding);
  mesh.box({0, 0, 6}, Eigen::Matrix3d::Identity(), {40, 35, 6}, mesh.material("concrete"));
  mesh.begin_object("pillars", scene::ObjectKind::kPole);
  for (int k = 0; pillars && k < 9; ++k)
    mesh.box({13.0 * std::cos(0.7 * k), 13.0 * std::sin(0.7 * k), 2.5}, Eigen::Matrix3d::Identity(), {0.4, 0.3, 2.5},
             mesh.material("brick"));
  return std::make_unique<scene::Scene>(std::move(parts));
}
double way_to_the_walls(const Vector3d& o, const Vector3d& d) {
  double best = kInfinity;
  const Vector3d low(-40, -35, 0), high(40, 35, 12);
  for (int a = 0; a < 3; ++a) {
    const double way = ((d[a] > 0.0 ? high[a] : low[a]) - o[a]) / d[a];
    if (way < best) best = way;
  }
  return best;
}
const GpsTime kScanAt{1'100'000'000'000'000'000};

/// Beams that point beside where the sensor believes: each range is that along the direction which the documented
/// stream gives, each point along the nominal one; the true ranges alike. Single precision of 50 m and of directions,
/// over a slant of 10.
StressFigure shaken(std::int64_t index) {
  Looks looks;
  const auto scene = closed_room(false);
  LidarConfig c;
  c.beams = "grid:8:-8:25", c.azimuth_steps = 200, c.mount_m = {0.4, -0.3, 1.9};
  c.mount_yaw_pitch_roll_deg = {20.0, 3.0, -2.0};
  c.range_noise_m = 0.0, c.angle_noise_deg = 0.7, c.report.range_quantum_m = 0.0, c.report.min_range_m = 0.01;
  auto scanner = make_scanner(c, 51);
  const auto table = load_beam_table(c.beams);
  looks.right(scanner.ok() && table.ok());
  if (!scanner || !table) return looks.figure();
  const FiringPattern pattern(*table, 10.0, 200);
  const Pose X_WB{rotation_from({.yaw_rad = 0.4, .pitch_rad = -0.02, .roll_rad = 0.03}), {3.0, -5.0, 0.2}};
  Trajectory still;
  for (const double dt : {-1.0, 1.0}) still.append({kScanAt + dt, X_WB});
  const scene::SceneAt at(*scene);
  const LidarOutput out = (*scanner)->scan(index, kScanAt, still, at);
  const std::vector<float> ranges = (*scanner)->true_ranges(index, kScanAt, still, at);
  looks.right(out.scan.points.size() == 1600 && ranges.size() == 1600);
  if (out.scan.points.size() != 1600 || ranges.size() != 1600) return looks.figure();
  const Pose X_BL = sensor_in_body(c), X_WL = X_WB * X_BL;
  const RandomStream stream(51, "lidar.angle");
  const auto sweep = pattern.sweep(index);
  const double sigma = 0.7 * kDegree;
  double square = 0.0;
  for (std::size_t laser = 0; laser < 8; ++laser)
    for (std::size_t cycle = 0; cycle < 200; cycle += 16) {
      AimPacket aim;
      pattern.aim(sweep, laser, cycle, aim);
      for (std::size_t i = 0; i < 16 && cycle + i < 200; ++i) {
        const Vector3d d(aim.direction_x[i], aim.direction_y[i], aim.direction_z[i]);
        const Vector3d across = d.unitOrthogonal(), along = d.cross(across);
        const auto entity = static_cast<std::uint32_t>(laser);
        const auto n = static_cast<std::uint64_t>(index) * 200 + cycle + i;
        const Vector3d u =
            (d + sigma * (stream.normal(entity, n, 0) * across + stream.normal(entity, n, 1) * along)).normalized();
        const double exact = way_to_the_walls(X_WL.p, X_WL.R * u), grain = 10.0 * 50.0 * 8.0 * kHalfUlp;
        const LidarPoint& p = out.scan.points[(cycle + i) * 8 + laser];
        looks.right(p.ring == laser);
        looks.near(Vector3d(p.x, p.y, p.z).norm(), exact, grain);
        looks.near((Vector3d(p.x, p.y, p.z) - exact * d).norm(), 0.0, 2.0 * grain);
        looks.near(ranges[laser * 200 + cycle + i], exact, grain);
        square += (u - d).squaredNorm() / (2.0 * sigma * sigma) / 1600.0;
      }
    }
  // The stream's own scatter: 1600 pairs of normals.
  looks.near(square, 1.0, 5.0 / std::sqrt(1600.0));
  return looks.figure();
}

/// A cube that drives away while it is scanned: it is where it was in the middle of every 32 firing cycles, less the
/// latency, and so are the points on its face. Single precision of 20 m.
StressFigure driven_meanwhile(double latency_s) {
  Looks looks;
  const auto scene = closed_room(false);
  scene::SceneParts cube;
  cube.name = "cube", cube.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(cube);
  mesh.begin_object("cube", scene::ObjectKind::kVehicle);
  mesh.box({0, 0, 3}, Eigen::Matrix3d::Identity(), {1, 30, 3}, mesh.material("brick"));
  const auto shape = std::make_shared<const scene::RigidShape>("cube", scene::ObjectKind::kVehicle, cube.mesh);
  LidarConfig c;
  c.beams = "grid:4:-5:5", c.azimuth_steps = 300, c.mount_m = {0, 0, 2.0}, c.latency_s = latency_s;
  c.range_noise_m = 0.0, c.report.range_quantum_m = 0.0, c.report.min_range_m = 0.01;
  auto scanner = make_scanner(c, 3);
  looks.right(scanner.ok());
  if (!scanner) return looks.figure();
  Trajectory still;
  for (const double dt : {-1.0, 1.0}) still.append({kScanAt + dt, Pose{}});
  std::mutex mutex;
  std::vector<double> asked_s;
  const auto place_m = [](double after_s) { return 15.0 + 40.0 * after_s; };
  const auto moving = [&](double after_s) {
    const std::lock_guard lock(mutex);
    asked_s.push_back(after_s);
    return std::vector<scene::Instance>{
        {shape, "cube", Pose{Eigen::Quaterniond::Identity(), {place_m(after_s), 0.0, 0.0}}}};
  };
  scene::SceneAt at(*scene);
  at.set_instances(moving(0.0));
  asked_s.clear();
  LidarOutput out;
  (*scanner)->scan(2, kScanAt, still, at, moving, out);
  std::sort(asked_s.begin(), asked_s.end());
  // 300 cycles of a third of a millisecond, the last of them at the stamp: nine volleys of 32 and one of twelve.
  const double step_s = 0.1 / 300.0;
  looks.right(asked_s.size() == 10);
  std::vector<double> middle_s;
  for (int v = 0; v < 10; ++v) middle_s.push_back(-0.1 + step_s * (1.0 + 32.0 * v + (v < 9 ? 16.0 : 6.0)) - latency_s);
  for (std::size_t v = 0; v < asked_s.size() && v < 10; ++v) looks.near(asked_s[v], middle_s[v], 1e-9);
  int on_it = 0;
  for (std::size_t k = 0; k < out.scan.points.size(); ++k) {
    if (out.truth[k].object != scene->objects().size()) continue;
    const LidarPoint& p = out.scan.points[k];
    const auto cycle = static_cast<std::size_t>(std::lround((p.time_s + 0.1) / step_s)) - 1;
    looks.near(p.x, place_m(middle_s[std::min<std::size_t>(cycle / 32, 9)]) - 1.0, 16.0 * kHalfUlp * 20.0);
    ++on_it;
  }
  looks.right(on_it > 200);
  return looks.figure();
}

/// With a room that is kept every return within it is still there, to the bit and in order, of a vehicle that moves and
/// turns by what it is said to; others are followed no farther than a return could be kept, and not fired at all where
/// nothing stands that near.
StressFigure kept_alone(bool pillars, double tilt_rad) {
  Looks looks;
  const auto scene = closed_room(pillars);
  LidarConfig c;
  c.beams = "grid:24:-24:24", c.azimuth_steps = 240, c.mount_m = {0.5, 0.2, 1.9};
  c.mount_yaw_pitch_roll_deg = {10.0, 1.0, -1.5};
  c.report.range_bias_m = 0.01;
  Trajectory motion;
  for (int k = -12; k <= 1; ++k) {
    const double t = 0.01 * k;
    motion.append(
        {kScanAt + t, Pose{rotation_from({.yaw_rad = 0.5 * t, .pitch_rad = tilt_rad + 0.08 * t, .roll_rad = -0.06 * t}),
                           {1.0 + 0.4 * t, 0.0, 0.02}}});
  }
  KeptRoom room{.low_m = -0.4, .high_m = 2.6, .reach_m = 12.0, .turned_rad = 0.0112, .moved_m = 0.045};
  if (!pillars) {
    // From B's origin the nearest wall is 34.9 m off; the ground is level, so that it rises with the tilt.
    room.clear_m = 34.5, room.ground_rise = std::abs(tilt_rad) + 0.02, room.above_ground_m = 1.5;
  }
  const scene::SceneAt at(*scene);
  auto all = make_scanner(c, 5), kept = make_scanner(c, 5);
  looks.right(all.ok() && kept.ok());
  if (!all || !kept) return looks.figure();
  (*kept)->keep(&room);
  const LidarOutput whole = (*all)->scan(4, kScanAt, motion, at), part = (*kept)->scan(4, kScanAt, motion, at);
  const Pose X_BL = sensor_in_body(c);
  const auto within = [&](const LidarScan& scan) {
    std::vector<LidarPoint> out;
    for (const LidarPoint& p : deskew(scan, motion, X_BL).points) {
      const Vector3d p_B = X_BL * Vector3d(p.x, p.y, p.z);
      if (p_B.z() >= room.low_m && p_B.z() <= room.high_m && p_B.norm() <= room.reach_m) out.push_back(p);
    }
    return out;
  };
  const auto a = within(whole.scan), b = within(part.scan);
  looks.right(a.size() == b.size() && a.size() > 200);
  for (std::size_t k = 0; k < a.size() && k < b.size(); ++k)
    looks.right(a[k].x == b[k].x && a[k].y == b[k].y && a[k].z == b[k].z && a[k].time_s == b[k].time_s &&
                a[k].ring == b[k].ring && a[k].intensity == b[k].intensity);
  // How far a return can be that is kept: the reach and the sensor's place, what it moved, and its noise ten times;
  // above and below by its rise, less what it may have turned.
  const Vector3d up_L = X_BL.R.conjugate() * Vector3d::UnitZ();
  const double arm_m = X_BL.p.norm() + 0.2, slack_m = 0.045 + 0.0112 * arm_m + 0.2;
  const double noise_m = 10.0 * (0.02 + 0.01) + 0.002 + 0.15;
  for (const LidarPoint& p : part.scan.points) {
    const Vector3d q(p.x, p.y, p.z);
    const double range = q.norm(), rise = up_L.dot(q) / range;
    looks.right(range <= room.reach_m + arm_m + 0.045 + noise_m + 0.05);
    if (rise > 0.02) looks.right(range <= (room.high_m - 1.9 + slack_m) / (rise - 0.0112) + noise_m + 0.05);
    if (rise < -0.02) looks.right(range <= (1.9 - room.low_m + slack_m) / (-rise - 0.0112) + noise_m + 0.05);
  }
  const std::int64_t rays = (*all)->rays(), fewer = (*kept)->rays();
  looks.right(rays == 24 * 240 && (pillars ? fewer == rays : fewer < rays - 1500 && fewer > 1500));
  // Once nothing is said to be kept, all of it is there again.
  (*kept)->keep(nullptr);
  looks.right((*kept)->scan(5, kScanAt, motion, at).scan.points.size() ==
              (*all)->scan(5, kScanAt, motion, at).scan.points.size());
  return looks.figure();
}

/// Drives of scans whose motion begins or ends a little too late or too soon are refused before anything is scanned, as
/// are scans of a negative number; a microsecond is rounding. A figure counts.
StressFigure not_covered() {
  StressFigure out;
  ScanDrive drive;
  drive.scene = closed_room(false);
  drive.lidar.beams = "grid:2:-5:5", drive.lidar.azimuth_steps = 40, drive.lidar.latency_s = 0.03;
  drive.start = kScanAt, drive.scans = 5;
  // From a period, the latency and a millisecond before the first stamp to the last one, 0.4 s on.
  const auto covers = [&](double from_s, double to_s) {
    drive.motion = {};
    for (const double dt : {from_s, 0.1, to_s}) drive.motion.append({kScanAt + dt, Pose{}});
    int scans = 0;
    const bool refused = stress::not_refused([&] {
                           const auto cost = scan_drive(drive, 1, [&](auto, auto, const auto&, const auto&) {
                             ++scans;
                             return Status(Ok{});
                           });
                           out.figure += cost.ok() ? 0.0 : 1.0;
                         }) == 0;
    out.figure += scans == (refused ? 0 : 5) ? 0.0 : 1.0;
    return !refused;
  };
  out.figure += covers(-0.131, 0.4) && covers(-0.131 + 5e-7, 0.4 - 5e-7) && covers(-1.0, 2.0) ? 0.0 : 1.0;
  out.figure += covers(-0.1305, 0.4) || covers(-0.131, 0.3999) || covers(-0.05, 0.4) || covers(-0.131, 0.2) ? 1.0 : 0.0;
  auto scanner = make_scanner(drive.lidar, 1);
  if (!scanner) return {1e9, 0.0};
  out.figure += stress::not_refused([&] { (*scanner)->scan(-1, kScanAt, drive.motion, scene::SceneAt(*drive.scene)); });
  return out;
}

}  // namespace

std::vector<StressCase> beam_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "shots through panes and crowns, one by one",
           "light that passed once in place of twice, draws of another crown, an echo's mean without its energy",
           "plane geometry, the documented stream and merging: single precision", "of the bound"});
  for (const char* model : {"single_ray", "footprint"})
    for (const auto& row : see_through_rows())
      rows.add(std::string("beams/") + model + "_through_" + row.name,
               [model, through = row.make] { return met_one_by_one(model, through); });
  rows.of({StressGroup::kGeometry, "beams that point beside where the sensor believes",
           "an axis twice, draws of another scan, a point along the beam that was truly fired",
           "the documented stream against the walls of a room: single precision over a slant", "of the bound"});
  rows.add("beams/shaken", [] { return shaken(0); }).add("beams/shaken_in_a_later_scan", [] { return shaken(7); });
  rows.of({StressGroup::kData, "what drives while it is scanned", "the place at the stamp, or at the end of a volley",
           "where it is in the middle of every 32 cycles: single precision", "of the bound"});
  rows.add("beams/driven_meanwhile", [] { return driven_meanwhile(0.0); }).add("beams/driven_meanwhile_told_late", [] {
    return driven_meanwhile(0.04);
  });
  rows.of({StressGroup::kData, "shots that end where nobody keeps a return",
           "a room in another frame, a shot that is shortened by what the vehicle moved in place of lengthened",
           "every return that is kept, to the bit; others no farther than they could be", "of the bound"});
  for (const double tilt : {0.0, 0.03, -0.03})
    for (const bool pillars : {true, false})
      rows.add("beams/kept_alone_at_a_tilt_of_" + stress::text(tilt) + (pillars ? "_among_pillars" : ""),
               [=] { return kept_alone(pillars, tilt); });
  rows.of({StressGroup::kData, "scans that the motion does not cover", "a time before that is added, an end left out",
           "refused before the first scan, to a microsecond", "wrong"});
  rows.add("beams/not_covered", not_covered);
  return rows.take();
}

}  // namespace canyon::lidar
