// Far from the origin, and across the borders of tiles.
#include <cmath>
#include <limits>

#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/scene/city/city.h"
#include "canyon/scene/scene_cost.h"
#include "canyon/scene/stress/made_scenes.h"
#include "canyon/scene/stress/subjects.h"

namespace canyon::scene {
namespace {

using stress::kEpsilon;
using stress::kHalfUlp;
constexpr float kAnyRange = std::numeric_limits<float>::infinity();

/// A box of 64 x 32 x 16 m whose corners are whole metres, about a far place; rays from inside it. Each range is that
/// to the box's sides, as if it stood at the origin: half a unit of single precision, and a direction's reciprocal.
StressFigure far_box(double x_m, double y_m, double z_m, bool packets) {
  const Eigen::Vector3d middle(x_m, y_m, z_m), half(32.0, 16.0, 8.0);
  SceneParts parts = made::nothing();
  made::add_box(parts, middle, half);
  const auto scene = made::scene_of(std::move(parts));
  const SceneAt now(*scene);
  StressFigure out{0.0, 1.02 * kHalfUlp};
  std::vector<Ray> rays;
  for (int k = 0; k < 960; ++k) {
    const double up = 1.0 - 2.0 * (k + 0.5) / 960.0, turn = 2.399963 * k, level = std::sqrt(1.0 - up * up);
    rays.push_back({middle + Eigen::Vector3d(0.5 * (k % 9), -0.25 * (k % 5), 0.125 * (k % 7)),
                    Eigen::Vector3d(level * std::cos(turn), level * std::sin(turn), up).cast<float>(), kAnyRange});
  }
  std::vector<Hit> hits(rays.size());
  if (packets)
    now.trace(rays, hits);
  else
    for (std::size_t k = 0; k < rays.size(); ++k) hits[k] = now.trace(rays[k]);
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const Eigen::Vector3d o = rays[k].origin - middle, d = rays[k].direction.cast<double>();
    double exact = std::numeric_limits<double>::infinity();
    for (int a = 0; a < 3; ++a)
      if (d[a] != 0.0) exact = std::min(exact, ((d[a] > 0.0 ? half[a] : -half[a]) - o[a]) / d[a]);
    take_worst(out, hits[k].hit() ? std::abs(hits[k].range_m / exact - 1.0) : 1.0);
  }
  return out;
}

/// Sixteen of a packet about the scene's own packet origin: the same as single rays, to the bit. A figure counts.
StressFigure packet_like_single(double x_m) {
  const Eigen::Vector3d middle(x_m, -x_m, 64.0);
  SceneParts parts = made::nothing();
  made::add_box(parts, middle, {32.0, 16.0, 8.0});
  const auto scene = made::scene_of(std::move(parts));
  const SceneAt now(*scene);
  const Eigen::Vector3d about = now.packet_origin(middle);
  StressFigure out;
  for (int p = 0; p < 60; ++p) {
    RayPacket packet{};
    for (std::size_t i = 0; i < RayPacket::kRays; ++i) {
      const double turn = 0.1 * p + 0.002 * static_cast<double>(i);
      const Eigen::Vector3f o = (middle - about).cast<float>();
      const Eigen::Vector3f d =
          Eigen::Vector3d(std::cos(turn), std::sin(turn), 0.3 * std::sin(p)).normalized().cast<float>();
      packet.origin_x[i] = o.x(), packet.origin_y[i] = o.y(), packet.origin_z[i] = o.z();
      packet.direction_x[i] = d.x(), packet.direction_y[i] = d.y(), packet.direction_z[i] = d.z();
      packet.max_m[i] = i == 11 ? -1.0f : 1e4f;
    }
    HitPacket hits;
    now.trace(std::span(&packet, 1), std::span(&hits, 1), about);
    for (std::size_t i = 0; i < RayPacket::kRays; ++i) {
      const Ray ray{about + Eigen::Vector3f(packet.origin_x[i], packet.origin_y[i], packet.origin_z[i]).cast<double>(),
                    {packet.direction_x[i], packet.direction_y[i], packet.direction_z[i]},
                    packet.max_m[i]};
      const Hit one = now.trace(ray);
      const bool same =
          packet.max_m[i] < 0.0f ? hits.triangle[i] == Hit::kMiss : one.range_m == hits.range_m[i] && one.hit();
      out.figure += same ? 0.0 : 1.0;
    }
  }
  return out;
}

/// A box of 64 x 32 x 16 m on ground of 8 km, which is tiled: from a place in it whose coordinates are no numbers of
/// single precision, by packets. They are about a point within half a tile of 512 m either way, so that an origin is
/// off by half a unit of 256 m along each axis; a range by that over the direction's part along it, and its own half
/// unit.
StressFigure packets_about_a_near_point(double x_m, double y_m) {
  const Eigen::Vector3d middle(x_m, y_m, 64.0), half(32.0, 16.0, 8.0), from(0.1, 1.0 / 3.0, 0.7);
  SceneParts parts = made::nothing();
  made::add_square(parts, {0.0, 0.0, 0.0}, 4096.0);
  made::add_box(parts, middle, half);
  const auto scene = made::scene_of(std::move(parts));
  const SceneAt now(*scene);
  const Eigen::Vector3d about = now.packet_origin(middle + from);
  stress::Worst worst;
  worst.look((middle + from - about).head<2>().cwiseAbs().maxCoeff<Eigen::PropagateNaN>(), 256.0);
  const Eigen::Vector3f o = (middle + from - about).cast<float>();
  for (int p = 0; p < 60; ++p) {
    RayPacket packet{};
    for (std::size_t i = 0; i < RayPacket::kRays; ++i) {
      const double n = 16.0 * p + static_cast<double>(i), up = 1.0 - 2.0 * (n + 0.5) / 960.0, turn = 2.399963 * n;
      const double level = std::sqrt(1.0 - up * up);
      packet.origin_x[i] = o.x(), packet.origin_y[i] = o.y(), packet.origin_z[i] = o.z();
      packet.direction_x[i] = static_cast<float>(level * std::cos(turn));
      packet.direction_y[i] = static_cast<float>(level * std::sin(turn));
      packet.direction_z[i] = static_cast<float>(up);
      packet.max_m[i] = 1e4f;
    }
    HitPacket hits;
    now.trace(std::span(&packet, 1), std::span(&hits, 1), about);
    for (std::size_t i = 0; i < RayPacket::kRays; ++i) {
      const Eigen::Vector3d d(packet.direction_x[i], packet.direction_y[i], packet.direction_z[i]);
      double exact = stress::kInfinity, along = 1.0;
      for (int a = 0; a < 3; ++a)
        if (const double to = ((d[a] > 0.0 ? half[a] : -half[a]) - from[a]) / d[a]; d[a] != 0.0 && to < exact)
          exact = to, along = std::abs(d[a]);
      worst.look(hits.range_m[i] - exact, 1.02 * kHalfUlp * (256.0 / along + exact));
    }
  }
  return worst.figure();
}

/// Packets whose rays begin at places of their own, leave the tile they begin in and meet walls one to three kilometres
/// away, ground, or nothing: the same triangle as single rays, and the same range to half a unit of it and of half a
/// tile over the direction. A figure is the worst share.
StressFigure packets_that_leave_their_tile() {
  SceneParts parts = made::nothing();
  made::add_square(parts, {0.0, 0.0, 0.0}, 4096.0);
  for (int k = 0; k < 6; ++k) {
    const double turn = 1.05 * k + 0.2, away_m = 1000.0 + 400.0 * k;
    made::add_box(parts, {away_m * std::cos(turn), away_m * std::sin(turn), 60.0}, {200.0, 200.0, 60.0});
  }
  const auto scene = made::scene_of(std::move(parts));
  const SceneAt now(*scene);
  const Eigen::Vector3d middle(40.0, -30.0, 30.0), about = now.packet_origin(middle);
  stress::Worst worst;
  int far = 0;
  for (int p = 0; p < 90; ++p) {
    RayPacket packet{};
    for (std::size_t i = 0; i < RayPacket::kRays; ++i) {
      const auto n = static_cast<double>(i);
      const Eigen::Vector3f o =
          (middle + Eigen::Vector3d(11.0 * n - 80.0, 60.0 - 9.0 * n, 2.0 * n) - about).cast<float>();
      const double turn = 2.0 * kPi / 90.0 * p + 0.001 * n;
      const Eigen::Vector3f d =
          Eigen::Vector3d(std::cos(turn), std::sin(turn), 0.004 * (n - 9.0)).normalized().cast<float>();
      packet.origin_x[i] = o.x(), packet.origin_y[i] = o.y(), packet.origin_z[i] = o.z();
      packet.direction_x[i] = d.x(), packet.direction_y[i] = d.y(), packet.direction_z[i] = d.z();
      packet.max_m[i] = i == 5 ? 700.0f : 1e5f;
    }
    HitPacket hits;
    now.trace(std::span(&packet, 1), std::span(&hits, 1), about);
    for (std::size_t i = 0; i < RayPacket::kRays; ++i) {
      const Ray ray{about + Eigen::Vector3f(packet.origin_x[i], packet.origin_y[i], packet.origin_z[i]).cast<double>(),
                    {packet.direction_x[i], packet.direction_y[i], packet.direction_z[i]},
                    packet.max_m[i]};
      const Hit one = now.trace(ray);
      const bool met = hits.triangle[i] != Hit::kMiss;
      worst.look(one.hit() == met && (!met || one.triangle == hits.triangle[i]) ? 0.0 : stress::kInfinity, 1.0);
      if (!met || !one.hit()) continue;
      const double approach = std::abs(one.normal.cast<double>().dot(ray.direction.cast<double>()));
      worst.look(hits.range_m[i] - one.range_m, kHalfUlp * (2.0 * one.range_m + 512.0 / approach));
      worst.look(hits.cos_incidence[i] - approach, 8.0 * kHalfUlp);
      far += one.range_m > 600.0f ? 1 : 0;
    }
  }
  worst.look(far > 200 ? 0.0 : stress::kInfinity, 1.0);
  return worst.figure();
}

/// Level ground of 8 km at z = 16 m: rays from 32 m straight down exactly on the borders of tiles (of 512 m about whole
/// multiples), a rounding beside them, and at the scene's own border. How many do not meet it at 16 m.
StressFigure on_borders() {
  SceneParts parts = made::nothing();
  made::add_square(parts, {0.0, 0.0, 16.0}, 4096.0);
  const auto scene = made::scene_of(std::move(parts));
  const SceneAt now(*scene);
  StressFigure out;
  const Eigen::Vector3f down(0.0f, 0.0f, -1.0f);
  for (double x = -4096.0; x <= 4096.0; x += 256.0)
    for (double y = -4096.0; y <= 4096.0; y += 256.0)
      for (const double beside : {0.0, 1e-9, -1e-9}) {
        const double sx = x == 4096.0 ? -1.0 : x == -4096.0 ? 1.0 : 0.0;
        // On the ground's own border a rounding decides: 1 mm inside.
        const Eigen::Vector3d o(x + beside + 1e-3 * sx, y + (y == 4096.0 ? -1e-3 : y == -4096.0 ? 1e-3 : beside), 32.0);
        const Hit hit = now.trace({o, down, kAnyRange});
        out.figure += hit.hit() && hit.range_m == 16.0f ? 0.0 : 1.0;
        out.figure += now.blocked_towards(o, {0.0, 0.0, -1.0}, 1e5, false) ? 0.0 : 1.0;
        const auto ground = scene->ground(o.x(), o.y());
        out.figure += ground && ground->height_m == 16.0 ? 0.0 : 1.0;
      }
  return out;
}

/// Walls every 512 m, seen by level rays that run exactly along borders of tiles and through their corners: range to
/// the next wall, half a unit.
StressFigure along_borders(double turn) {
  SceneParts parts = made::nothing();
  made::add_square(parts, {0.0, 0.0, -64.0}, 4096.0);
  made::add_wall(parts, {3800.0, 0.0, 0.0}, 4000.0);
  const auto scene = made::scene_of(std::move(parts));
  const SceneAt now(*scene);
  StressFigure out{0.0, 1.02 * kHalfUlp};
  const Eigen::Vector3f d(static_cast<float>(std::cos(turn)), static_cast<float>(std::sin(turn)), 0.0f);
  for (double x = -3840.0; x <= 3584.0; x += 256.0)
    for (const double y : {-256.0, 0.0, 256.0, 768.0}) {
      const double exact = (3800.0 - x) / static_cast<double>(d.x());
      if (std::abs(y + exact * static_cast<double>(d.y())) > 3999.0) continue;
      const Hit hit = now.trace({{x, y, 1.0}, d, kAnyRange});
      take_worst(out, hit.hit() ? std::abs(hit.range_m / exact - 1.0) : 1.0);
    }
  return out;
}

/// A scene of two small things 2e7 m apart, or of 1e30 m: it is made, and what stands near is met exactly.
StressFigure wide(double apart_m) {
  SceneParts parts = made::nothing();
  made::add_wall(parts, {0.0, 0.0, 0.0}, 8.0);
  made::add_wall(parts, {apart_m, 0.0, 0.0}, 0.25 * apart_m);
  const auto scene = made::scene_of(std::move(parts));
  const SceneAt now(*scene);
  StressFigure out{0.0, 1.02 * kHalfUlp};
  for (int k = 0; k < 100; ++k) {
    const Eigen::Vector3f d = Eigen::Vector3d(1.0, 0.01 * k - 0.5, 0.3).normalized().cast<float>();
    const Hit hit = now.trace({{-4.0, 0.0, 0.0}, d, kAnyRange});
    take_worst(out, hit.hit() ? std::abs(hit.range_m * static_cast<double>(d.x()) / 4.0 - 1.0) : 1.0);
  }
  return out;
}

std::shared_ptr<const RigidShape> cube() {
  SceneParts parts = made::nothing();
  made::add_box(parts, {0.0, 0.0, 1.0}, {1.0, 1.0, 1.0});
  return std::make_shared<const RigidShape>("cube", ObjectKind::kVehicle, parts.mesh);
}

/// A moving cube of 2 m, turned about its middle, met from 10 m away square on to its face: range 9 m whatever the
/// place and the turn. A rotation by a quaternion rounds by some eps of 1 m, a place by eps of its coordinates.
StressFigure moving(double place_m, double yaw_rad) {
  SceneParts parts = made::nothing();
  made::add_square(parts, {place_m, place_m, -1.0}, 64.0);
  const auto scene = made::scene_of(std::move(parts));
  SceneAt now(*scene);
  const Eigen::Vector3d at(place_m, place_m, 0.0);
  const Eigen::Quaterniond R(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()));
  now.set_instances({{cube(), "cube", {R, at}}});
  StressFigure out{0.0, 2.02 * kHalfUlp * 9.0 + 8.0 * kEpsilon * place_m};
  for (int k = 0; k < 4; ++k) {
    const double a = yaw_rad + 0.5 * kPi * k;
    const Eigen::Vector3d way(std::cos(a), std::sin(a), 0.0);
    // A direction in single precision is off by up to half a unit: 9 m * that, twice (its length and its tilt).
    const Hit hit = now.trace({at - 10.0 * way + Eigen::Vector3d(0.0, 0.0, 1.0), way.cast<float>(), kAnyRange});
    take_worst(out, hit.hit() && now.surface(hit.triangle).moving ? std::abs(hit.range_m - 9.0) : 1e9);
  }
  return out;
}

/// Traffic before and behind walls, by packets and one by one: the same object and the same bits, and of cubes that
/// are square on 9 m exactly, whatever stands 20 m behind them. In a wide scene the traffic is about the tile of its
/// first thing, another than the sensor's. Coordinates are whole quarters, no sum of which rounds. A figure counts.
StressFigure traffic_in_packets(bool wide) {
  SceneParts parts = made::nothing();
  made::add_square(parts, {0.0, 0.0, -1.0}, wide ? 4096.0 : 64.0);
  made::add_box(parts, {0.0, 0.0, 8.0}, {30.0, 30.0, 8.0});
  const auto scene = made::scene_of(std::move(parts));
  SceneAt now(*scene);
  std::vector<Instance> traffic;
  // The first far away; then one each way, turned by quarters, of which the last two stand behind the walls.
  traffic.push_back({cube(), "far", {Eigen::Quaterniond::Identity(), {wide ? 3000.0 : 60.0, 1000.0, 0.0}}});
  for (int k = 0; k < 4; ++k) {
    const Eigen::Quaterniond R(Eigen::AngleAxisd(0.5 * kPi * k, Eigen::Vector3d::UnitZ()));
    traffic.push_back({cube(), "cube", {R, R * Eigen::Vector3d(k < 2 ? 10.0 : 40.0, 0.0, 0.0)}});
  }
  now.set_instances(traffic);
  const Eigen::Vector3d from(0.0, 0.0, 1.25), about = now.packet_origin(from);
  const Eigen::Vector3f o = (from - about).cast<float>();
  int wrong = 0, moving = 0, square_on = 0;
  for (int p = 0; p < 120; ++p) {
    RayPacket packet{};
    for (std::size_t i = 0; i < RayPacket::kRays; ++i) {
      // Every fifteenth packet leaves square on to a cube's face, or to where one hides.
      const double turn = 2.0 * kPi / 120.0 * (p + (p % 30 == 0 ? 0.0 : static_cast<double>(i) / 16.0));
      const double up = p % 30 == 0 ? 0.0 : 0.01 * (static_cast<double>(i) - 8.0);
      const Eigen::Vector3f d = Eigen::Vector3d(std::cos(turn), std::sin(turn), up).normalized().cast<float>();
      packet.origin_x[i] = o.x(), packet.origin_y[i] = o.y(), packet.origin_z[i] = o.z();
      packet.direction_x[i] = d.x(), packet.direction_y[i] = d.y(), packet.direction_z[i] = d.z();
      packet.max_m[i] = 1e4f;
    }
    HitPacket hits;
    now.trace(std::span(&packet, 1), std::span(&hits, 1), about);
    for (std::size_t i = 0; i < RayPacket::kRays; ++i) {
      const Hit one =
          now.trace({from, {packet.direction_x[i], packet.direction_y[i], packet.direction_z[i]}, packet.max_m[i]});
      const bool met = hits.triangle[i] != Hit::kMiss, moves = met && now.surface(hits.triangle[i]).moving;
      const bool same = one.hit() == met && one.range_m == hits.range_m[i] &&
                        (!met || now.surface(one.triangle).object == now.surface(hits.triangle[i]).object);
      wrong += same ? 0 : 1;
      moving += moves ? 1 : 0;
      if (p % 30 != 0) continue;
      // A quarter turn's cosine and sine are half a unit off what they should be: so is the range, of 30 m at most.
      const bool before = p < 60;
      square_on += moves == before && std::abs(hits.range_m[i] - (before ? 9.0 : 30.0)) <= 4.0 * kHalfUlp * 30.0;
    }
  }
  wrong += moving > 100 ? 0 : 1;
  return {1.0 * (wrong + 64 - square_on), 0.0};
}

/// 3000 m in cells of 0.5 m is 72 million triangles of ground alone, and is refused in those words; of 1000 m in cells
/// of 20 m what was made is what was foretold, whose streets are counted to a tenth.
StressFigure size_foretold() {
  CityConfig city;
  city.extent_m = 3000.0, city.terrain_cell_m = 0.5;
  const SceneCost cost = predicted_cost(city);
  const Status looked = check_cost(cost, kMaxTriangles, "scene.extent_m", "a smaller one");
  StressFigure out{0.0, 1.0};
  take_worst(out, beyond(72e6, cost.triangles));
  if (looked.ok() || looked.error().str().find(cost_text(cost)) == std::string::npos) out.figure = 2.0;
  city.extent_m = 1000.0, city.terrain_cell_m = 20.0;
  const double made = static_cast<double>(make_city(city).mesh.triangles.size());
  take_worst(out, std::abs(made / predicted_cost(city).triangles - 1.0) / 0.1);
  return out;
}

}  // namespace

std::vector<StressCase> far_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "a city larger than memory",
           "made for 84 s before anything else is looked at, with nothing to foretell it (2026-11-22)",
           "two triangles a cell and what stands in the streets by the area: refused, and a small one as foretold to a "
           "tenth",
           "of the bound"});
  rows.add("far/city_of_3000_m_in_cells_of_half_a_metre", size_foretold);
  rows.of({StressGroup::kGeometry, "coordinates far from the origin",
           "single precision resolves 1 mm at 10 km and 1 m at 1e7 m: ranges in steps",
           "of a box of whole metres its own ranges, to half a unit, wherever it stands", ""});
  for (const double x : {0.0, 1999.0, 1e4, 123456.0, 1e7}) {
    const std::string name = std::to_string(std::lround(x));
    rows.add("far/box_at_" + name + "_m", [x] { return far_box(x, -x, 0.0, false); });
    rows.add("far/box_at_" + name + "_m_in_packets", [x] { return far_box(x, -x, 0.0, true); });
  }
  rows.add("far/box_20000_m_high", [] { return far_box(100.0, 0.0, 20000.0, false); });
  rows.of({StressGroup::kGeometry, "packets about an origin of their own",
           "an origin added twice, or rounded to single precision", "the same as single rays, to the bit",
           "differences"});
  rows.add("far/packets_at_0_m", [] { return packet_like_single(0.0); }).add("far/packets_at_1e6_m", [] {
    return packet_like_single(1e6);
  });
  rows.of({StressGroup::kGeometry, "packets far from the origin, along one axis or both",
           "the middle of another row's or column's tile, kilometres off: single precision of that way",
           "half a unit of half a tile over the direction's part, and of the range", "of the bound"});
  rows.add("far/packets_3_km_east", [] { return packets_about_a_near_point(3000.0, 0.0); })
      .add("far/packets_3_km_north", [] { return packets_about_a_near_point(0.0, 3000.0); })
      .add("far/packets_east_and_south", [] { return packets_about_a_near_point(2000.0, -3500.0); });
  rows.of({StressGroup::kGeometry, "packets that meet what moves, before walls and behind them",
           "what moves is looked for behind what was met, or about another tile's middle",
           "the same as single rays, to the bit, and square on the true range", "wrong"});
  rows.add("far/traffic_in_packets", [] { return traffic_in_packets(false); })
      .add("far/traffic_in_packets_of_a_wide_scene", [] { return traffic_in_packets(true); });
  rows.of({StressGroup::kGeometry, "rays on the borders of tiles",
           "a point on a border belongs to no tile, or a ray is lost between two",
           "the ground at 16 m, everywhere and to the bit", "misses"});
  rows.add("far/down_on_tile_borders", on_borders);
  rows.of({StressGroup::kGeometry, "rays along the borders of tiles and through their corners",
           "both tiles are left at once: neither is next", "the wall's range to half a unit", ""});
  rows.add("far/along_tile_borders", [] { return along_borders(0.0); })
      .add("far/through_tile_corners", [] { return along_borders(0.25 * kPi); })
      .add("far/through_tile_corners_downwards", [] { return along_borders(-0.25 * kPi); });
  rows.of({StressGroup::kGeometry, "a scene of a planet's size", "more tiles than a count holds; a border at infinity",
           "it is made, and the near wall's range holds to half a unit", ""});
  rows.add("far/two_walls_2e7_m_apart", [] { return wide(2e7); }).add("far/two_walls_1e30_m_apart", [] {
    return wide(1e30);
  });
  rows.of({StressGroup::kGeometry, "a moving thing far from the origin",
           "a pose in single precision: a car shakes by decimetres",
           "9 m square on to its face: two half units and 8 eps of the coordinates", "m"});
  rows.add("far/cube_at_0_m", [] { return moving(0.0, 0.3); })
      .add("far/cube_at_100_km", [] { return moving(1e5, 1.1); })
      .add("far/cube_at_1e7_m", [] { return moving(1e7, -2.0); });
  rows.of({StressGroup::kGeometry, "packets whose rays leave their tile",
           "the first ray's origin for another's, a tile beyond the first that is not looked at",
           "the same triangles as single rays, ranges to single precision of half a tile", "of the bound"});
  rows.add("far/packets_that_leave_their_tile", packets_that_leave_their_tile);
  return rows.take();
}

}  // namespace canyon::scene
