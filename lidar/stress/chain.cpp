// The vehicle's own body, the light of special surfaces, and what a registration says of its precision.
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "canyon/core/random/random.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/lidar/beam/surfaces.h"
#include "canyon/lidar/ego_mask.h"
#include "canyon/lidar/lidar_config.h"
#include "canyon/lidar/registration/prepared_cloud.h"
#include "canyon/lidar/registration/registration_covariance.h"
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
using stress::Worst;

/// Does a ray from o along d meet the box? By its six faces, one by one, or because it starts inside; `margin_m`: how
/// near that was to being otherwise.
bool meets(const Vector3d& o, const Vector3d& d, const Vector3d& low, const Vector3d& high, double& margin_m) {
  bool met = (o.array() > low.array()).all() && (o.array() < high.array()).all();
  margin_m = std::min((o - low).cwiseAbs().minCoeff<Eigen::PropagateNaN>(),
                      (o - high).cwiseAbs().minCoeff<Eigen::PropagateNaN>());
  for (int axis = 0; axis < 3; ++axis)
    for (const double face : {low[axis], high[axis]}) {
      const double way = (face - o[axis]) / d[axis];
      if (!(way > 0.0)) continue;
      const Vector3d p = o + way * d;
      bool within = true;
      for (int other = 0; other < 3; ++other) {
        if (other == axis) continue;
        within = within && p[other] > low[other] && p[other] < high[other];
        margin_m = std::min({margin_m, std::abs(p[other] - low[other]), std::abs(p[other] - high[other])});
      }
      met = met || within;
    }
  return met;
}

/// Sixteen shots that leave from sixteen places in as many directions, of a sensor that sits askew: hidden are those
/// that meet the box, no other, beyond a micrometre of its edges; a box without volume hides none. A figure counts.
StressFigure own_body(std::uint64_t seed) {
  const RandomStream draw(seed, "stress.ego");
  const Pose X_BL{rotation_from({.yaw_rad = 0.7, .pitch_rad = -0.3, .roll_rad = 2.0}), {0.4, -0.2, 1.8}};
  const EgoConfig box{{-1.0, -0.9, 0.2}, {3.0, 0.9, 1.6}};
  const EgoMask mask(box, X_BL);
  StressFigure out;
  int hidden = 0;
  for (std::uint64_t k = 0; k < 300; ++k) {
    AimPacket aim{};
    scene::RayPacket rays{};
    for (std::size_t i = 0; i < AimPacket::kShots; ++i) {
      const auto n = k * AimPacket::kShots + i;
      const Vector3d o = 0.8 * draw.normal3(n, 0), d = draw.direction(1, n);
      aim.origin_x[i] = static_cast<float>(o.x()), aim.origin_y[i] = static_cast<float>(o.y());
      aim.origin_z[i] = static_cast<float>(o.z()), aim.direction_x[i] = static_cast<float>(d.x());
      aim.direction_y[i] = static_cast<float>(d.y()), aim.direction_z[i] = static_cast<float>(d.z());
      rays.max_m[i] = 77.0f;
    }
    mask.hide(aim, rays);
    for (std::size_t i = 0; i < AimPacket::kShots; ++i) {
      double margin_m = 0.0;
      const bool expected = meets(X_BL * Vector3d(aim.origin_x[i], aim.origin_y[i], aim.origin_z[i]),
                                  X_BL.R * Vector3d(aim.direction_x[i], aim.direction_y[i], aim.direction_z[i]),
                                  box.min_m, box.max_m, margin_m);
      if (margin_m > 1e-6) out.figure += rays.max_m[i] == (expected ? -1.0f : 77.0f) ? 0.0 : 1.0;
      hidden += expected ? 1 : 0;
    }
  }
  out.figure += hidden > 500 && hidden < 4300 ? 0.0 : 1.0;
  out.figure +=
      mask.any() && !EgoMask({}, X_BL).any() && !EgoMask({box.min_m, {3.0, -0.9, 1.6}}, X_BL).any() ? 0.0 : 1.0;
  return out;
}

/// A retroreflector, a mirror and both: of each the documented sum, and one by one, as echoes and as packets the same
/// bits. Six single-precision operations of each term, and of the mirror's exponent its size.
StressFigure special_light() {
  scene::SceneParts parts;
  parts.name = "materials";
  const auto make = [&](const char* name, double reflectance, double mirror, double lobe_deg, double retro) {
    scene::Material m;
    m.name = name, m.lidar_reflectance = reflectance, m.lidar_specular = mirror, m.lidar_specular_lobe_deg = lobe_deg;
    m.lidar_retro_1_sr = retro;
    parts.materials.push_back(m);
  };
  make("matt", 0.4, 0.0, 1.0, 0.0);
  make("sheet", 0.3, 0.0, 1.0, 300.0);
  make("metal", 0.2, 0.5, 5.0, 0.0);
  make("both", 0.1, 0.04, 1.0, 7.0);
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("squares", scene::ObjectKind::kWall);
  for (int k = 0; k < 4; ++k)
    mesh.quad({5, 2.0 * k + 1, -1}, {5, 2.0 * k, -1}, {5, 2.0 * k, 1}, {5, 2.0 * k + 1, 1},
              static_cast<std::uint16_t>(k));
  const scene::Scene scene(std::move(parts));
  const scene::SceneAt at(scene);
  const Surfaces surfaces(at, 905.0);
  Worst worst;
  for (const double degrees : {0.0, 0.3, 2.0, 8.0, 45.0, 89.0}) {
    const auto cosine = static_cast<float>(std::cos(degrees * kDegree));
    scene::HitPacket hits{};
    float many[EchoPacket::kShots];
    for (std::uint32_t k = 0; k < 4; ++k) {
      const scene::Material& m = scene.materials()[k];
      const double c = cosine, tan2 = (1.0 - c * c) / (c * c), s = m.lidar_specular_lobe_deg * kDegree;
      const double mirror = m.lidar_specular * std::exp(-tan2 / (2.0 * s * s)) / (8.0 * s * s * std::pow(c, 5));
      const double exact = m.lidar_reflectance * c + mirror + kPi * m.lidar_retro_1_sr * c;
      // 1 - cos^2 in single precision is off by half a unit, over 2 s^2 of the exponent.
      const double exponent = kHalfUlp * (2.0 / (c * c) + tan2) / (2.0 * s * s);
      worst.look(surfaces.of_material(static_cast<std::uint16_t>(k), cosine) - exact,
                 16.0 * kHalfUlp * exact + 2.0 * exponent * mirror + 1e-14);
      // Lanes 0..15 in turn over the four squares, two triangles each; one lane misses.
      for (std::size_t i = 0; i < EchoPacket::kShots; ++i) {
        hits.triangle[i] = i == 13 ? scene::Hit::kMiss : static_cast<std::uint32_t>(2 * ((k + i / 5) % 4) + i % 2);
        hits.cos_incidence[i] = i == 13 ? 0.0f : cosine;
        hits.range_m[i] = 5.0f + static_cast<float>(i);
      }
      EchoPacket echoes{};
      surfaces.echoes({}, hits, Vector3d::Zero(), echoes);
      surfaces.reflectivities({}, hits, Vector3d::Zero(), many);
      for (std::size_t i = 0; i < EchoPacket::kShots; ++i) {
        const float one = i == 13 ? 0.0f : surfaces.reflectivity(hits.triangle[i], cosine);
        worst.look(many[i] == one && (i == 13 || echoes.reflectivity[i] == one) ? 0.0 : kInfinity, 1.0);
        if (i != 13)
          worst.look(
              echoes.range_m[i] == hits.range_m[i] && echoes.truth[i].material == (k + i / 5) % 4 ? 0.0 : kInfinity,
              1.0);
      }
      for (std::uint32_t& triangle : hits.triangle) triangle = 2 * k;
      surfaces.reflectivities({}, hits, Vector3d::Zero(), many);
      worst.look(many[3] == surfaces.reflectivity(2 * k, hits.cos_incidence[3]) ? 0.0 : kInfinity, 1.0);
    }
  }
  return worst.figure();
}

/// A whole scan in a closed room reports a point for every shot, each the right laser's and azimuth's, in the order of
/// firing, with the true range along the beam that the scanner itself gives; limits and quanta of the report beside it;
/// lasers sit `off_m` off the middle at most.
StressFigure every_shot(const std::string& beams, double quantum_m, double bias_m, double off_m) {
  scene::SceneParts parts;
  parts.name = "room";
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("room", scene::ObjectKind::kBuilding);
  mesh.box({1.0, -0.5, 0.7}, Eigen::Matrix3d::Identity(), {16.0, 12.0, 4.0}, mesh.material("concrete"));
  const scene::Scene scene(std::move(parts));
  LidarConfig c;
  c.beams = beams;
  c.mount_m.setZero();
  c.range_noise_m = 0.0;
  c.report.range_quantum_m = quantum_m;
  c.report.range_bias_m = bias_m;
  c.report.min_range_m = 1e-3;
  c.azimuth_steps = 360;
  auto scanner = make_scanner(c, 3);
  if (!scanner.ok()) return {kInfinity, 1.0};
  const GpsTime t{1'000'000'000'000'000'000};
  Trajectory still;
  for (const double dt : {-1.0, 1.0}) still.append({t + dt, Pose{}});
  const scene::SceneAt at(scene);
  const LidarOutput out = (*scanner)->scan(0, t, still, at);
  const std::vector<float> ranges = (*scanner)->true_ranges(0, t, still, at);
  Worst worst;
  std::size_t finite = 0;
  for (const float r : ranges) finite += std::isfinite(r) ? 1 : 0;
  worst.look(out.scan.points.size() == finite && out.truth.size() == finite && finite > 3000 ? 0.0 : kInfinity, 1.0);
  float before_s = -1e9f;
  for (std::size_t k = 0; k < out.scan.points.size(); ++k) {
    const LidarPoint& p = out.scan.points[k];
    const double range_m = Vector3d(p.x, p.y, p.z).norm();
    worst.look(range_m - out.truth[k].range_m, 0.5 * quantum_m + 6.0 * bias_m + 64.0 * kHalfUlp * 20.0 + 1e-4 + off_m);
    worst.look(p.time_s >= before_s && p.time_s <= 0.0f && p.return_index == 0 ? 0.0 : kInfinity, 1.0);
    before_s = p.time_s;
  }
  return worst.figure();
}

/// Points on three pairs of planes, matched with errors of `sigma_m` across them: the covariance of a motion along one
/// axis is that of a mean, sigma^2 over the points on its planes; of a turn, sigma^2 over the sum of squared arms. From
/// a scatter of 96 blocks: 5 sigma of its square; and 1 mm of resolution a match, documented.
StressFigure precision(double sigma_m, std::uint64_t seed) {
  const RandomStream draw(seed, "stress.matches");
  std::vector<Correspondence> matches;
  double arms2[3] = {0.0, 0.0, 0.0};
  std::uint64_t n = 0;
  constexpr int kOnEach = 600;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0})
      for (int k = 0; k < kOnEach; ++k, ++n) {
        Correspondence match;
        Vector3d normal = Vector3d::Zero();
        normal[axis] = 1.0;
        // Pairs on opposite sides of the middle, so that turns and ways have nothing in common.
        match.p_S =
            10.0 *
            Vector3d(draw.uniform(-1, 1, 0, n / 2), draw.uniform(-1, 1, 1, n / 2), draw.uniform(-1, 1, 2, n / 2)) *
            (n % 2 == 0 ? 1.0 : -1.0);
        match.p_S[axis] = 10.0 * side;
        match.residual = sigma_m * draw.normal(3, n) * normal;
        match.information = 0.5 * Eigen::Matrix3d::Identity() + 499.5 * normal * normal.transpose();
        const Vector3d arm = match.p_S.cross(normal);
        for (int turn = 0; turn < 3; ++turn) arms2[turn] += arm[turn] * arm[turn];
        matches.push_back(match);
      }
  const RegistrationPrecision found = registration_precision(matches, Eigen::Matrix3d::Identity(), 5.0);
  Worst worst;
  worst.look(found.unconstrained == 0 && found.covariance.allFinite() ? 0.0 : kInfinity, 1.0);
  worst.look(found.rms_m / sigma_m - 1.0, 5.0 / std::sqrt(2.0 * static_cast<double>(matches.size())));
  const double five =
      5.0 * std::sqrt(2.0 / 60.0);  // 4 x 4 blocks on either of two planes of each axis, and turns on four
  for (int axis = 0; axis < 3; ++axis) {
    const double way2 = sigma_m * sigma_m / (2.0 * kOnEach), turn2 = sigma_m * sigma_m / arms2[axis];
    worst.look(found.covariance(3 + axis, 3 + axis) / way2 - 1.0, five + 1e-3 / sigma_m);
    worst.look(found.covariance(axis, axis) / turn2 - 1.0, five + 1e-3 / sigma_m);
  }
  worst.look((found.covariance - found.covariance.transpose()).norm(), 1e-300);
  return worst.figure();
}

/// A level patch seen with noise: normals of a prepared cloud are tilted by as much as their own variance says. It is
/// that of a line fit along the narrower direction of the patch; both axes together are between once and twice it, 5
/// sigma of as many tilts, neighbours sharing 20 points.
StressFigure tilts(double noise_m) {
  const RandomStream draw(4, "stress.patch");
  std::vector<Eigen::Vector3f> points;
  for (std::uint64_t k = 0; k < 20'000; ++k)
    points.emplace_back(static_cast<float>(draw.uniform(-5, 5, 0, k)), static_cast<float>(draw.uniform(-5, 5, 1, k)),
                        static_cast<float>(2.0 + noise_m * draw.normal(2, k)));
  const PreparedCloud cloud = prepare_cloud(points, 0.2);
  double tilt2 = 0.0, told2 = 0.0;
  std::size_t n = 0;
  for (std::size_t k = 0; k < cloud.points.size(); ++k) {
    if (cloud.normals[k].isZero() || cloud.points[k].head<2>().cwiseAbs().maxCoeff<Eigen::PropagateNaN>() > 4.0f)
      continue;
    tilt2 += cloud.normals[k].head<2>().squaredNorm();
    told2 += cloud.tilt_variance[k];
    ++n;
  }
  const double ratio = tilt2 / told2, five = 5.0 * std::sqrt(2.0 / (static_cast<double>(n) / 20.0));
  return {n > 1000 ? std::abs(ratio - 1.5) : kInfinity, 0.5 + 1.5 * five};
}

}  // namespace

std::vector<StressCase> chain_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "shots that meet the vehicle itself",
           "a shot of another lane, a box in another frame",
           "those that meet the box by one of its faces, or start in it", "wrong"});
  for (const std::uint64_t seed : {1U, 2U})
    rows.add("chain/own_body_" + std::to_string(seed), [seed] { return own_body(seed); });
  rows.of({StressGroup::kGeometry, "mirrors and retroreflectors, one by one and in packets",
           "pi in the wrong place, a lane's light for its neighbour's", "the documented sum, the same bits in packets",
           "of the bound"});
  rows.add("chain/special_light", special_light);
  rows.of({StressGroup::kData, "every shot of a scan in a closed room",
           "counts of lanes that do not add up, a layer left out",
           "a point a shot, at its true range but for quanta and bias", "of the bound"});
  rows.add("chain/every_shot_of_vlp16", [] { return every_shot("vlp16", 0.0, 0.0, 0.05); })
      .add("chain/every_shot_of_os1_64", [] { return every_shot("os1_64", 0.01, 0.02, 0.02); })
      .add("chain/every_shot_of_hdl32e", [] { return every_shot("hdl32e", 0.0, 0.0, 0.0); });
  rows.of({StressGroup::kStiff, "the precision that a registration states",
           "a curvature along surfaces that counts as across",
           "a mean's and a turn's variance over the matches: 5 sigma of the blocks", "of the bound"});
  for (const double sigma_m : {0.02, 0.5})
    rows.add("chain/precision_of_" + stress::text(sigma_m) + "_m", [sigma_m] { return precision(sigma_m, 5); });
  rows.of({StressGroup::kStiff, "tilts of a patch's normals", "a variance of the points in place of the normal's",
           "between once and twice what is told", ""});
  for (const double noise_m : {1e-3, 0.03})
    rows.add("chain/tilts_at_noise_of_" + stress::text(noise_m) + "_m", [noise_m] { return tilts(noise_m); });
  return rows.take();
}

}  // namespace canyon::lidar
