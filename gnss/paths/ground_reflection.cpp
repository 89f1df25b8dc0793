#include "canyon/gnss/paths/ground_reflection.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "canyon/gnss/paths/bounce.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {
namespace {

constexpr double kGroundClearance_m = 0.05;  // between plane and terrain where legs start
constexpr int kSteps = 30;
constexpr double kFound_m = 1e-4;

struct Plane {
  Eigen::Vector3d normal_W;
  double offset_m;
  double above_m;  ///< the terrain's height above it at the middle
  std::uint16_t material;
};

/// Fits heights `radius_m` east, west, north and south; nullopt at the terrain's end.
std::optional<Plane> fit(const scene::Scene& scene, double x, double y, double radius_m) {
  const auto middle = scene.ground(x, y);
  const auto east = scene.ground(x + radius_m, y), west = scene.ground(x - radius_m, y);
  const auto north = scene.ground(x, y + radius_m), south = scene.ground(x, y - radius_m);
  if (!middle || !east || !west || !north || !south) return std::nullopt;
  const double slope_x = (east->height_m - west->height_m) / (2.0 * radius_m);
  const double slope_y = (north->height_m - south->height_m) / (2.0 * radius_m);
  const double z = 0.25 * (east->height_m + west->height_m + north->height_m + south->height_m);
  Plane plane;
  plane.normal_W = Eigen::Vector3d(-slope_x, -slope_y, 1.0).normalized();
  plane.offset_m = plane.normal_W.dot(Eigen::Vector3d(x, y, z));
  plane.above_m = middle->height_m - z;
  plane.material = middle->material;
  return plane;
}

struct Found {
  Eigen::Vector3d point_W;
  Plane plane;
};

std::optional<Found> reflection_point(const scene::Scene& scene, const Eigen::Vector3d& p_W, const Eigen::Vector3d& s,
                                      double radius_m) {
  Eigen::Vector3d point_W = p_W;
  for (int step = 0; step < kSteps; ++step) {
    const auto plane = fit(scene, point_W.x(), point_W.y(), radius_m);
    if (!plane) return std::nullopt;
    const double height_m = plane->normal_W.dot(p_W) - plane->offset_m, cosine = plane->normal_W.dot(s);
    if (height_m <= 0.0 || cosine <= 0.0) return std::nullopt;
    const Eigen::Vector3d next_W = p_W - 2.0 * height_m * plane->normal_W + height_m / cosine * s;
    const bool found = (next_W - point_W).head<2>().norm() < kFound_m;
    point_W = next_W;
    if (found) return Found{point_W, *plane};
  }
  return std::nullopt;
}

}  // namespace

void add_ground_reflections(const PathParameters& p, const Eigen::Vector3d& p_A_W, const PlaneWaves& waves,
                            const scene::SceneAt& scene, std::span<SignalPaths> out, GnssCounters& counters) {
  const auto under = scene.scene().ground(p_A_W.x(), p_A_W.y());
  if (!under || p_A_W.z() <= under->height_m) return;
  const double height_m = p_A_W.z() - under->height_m;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Eigen::Vector3d& s = waves.direction_W(i);
    if (s.z() <= 0.0) continue;
    const double radius_m = std::clamp(std::sqrt(waves.wavelength_m(i) * height_m / s.z()), 0.3, 10.0);
    const auto found = reflection_point(scene.scene(), p_A_W, s, radius_m);
    if (!found) continue;
    const Plane& plane = found->plane;
    const scene::Material& material = scene.scene().materials()[plane.material];
    const double cosine = std::min(plane.normal_W.dot(s), 1.0);
    const double excess_m = 2.0 * (plane.normal_W.dot(p_A_W) - plane.offset_m) * cosine;
    if (material.rf_absorbing || (out[i].line_of_sight && excess_m > p.cutoff_m)) continue;
    const Bounce bounce = bounce_off(material, -s, plane.normal_W, p.roughness_m, waves.carrier_hz(i));
    const CircularField field = reflected_field({&bounce, 1});
    const double weakest_db = out[i].line_of_sight ? p.weakest_db : p.weakest_nlos_db;
    if (std::norm(field.copolar) + std::norm(field.crosspolar) < std::pow(10.0, weakest_db / 10.0)) continue;

    const Eigen::Vector3d start_W =
        found->point_W + (std::max(plane.above_m, 0.0) + kGroundClearance_m) * plane.normal_W;
    const Eigen::Vector3d leg_W = start_W - p_A_W;
    const double leg_m = leg_W.norm();
    if (leg_m < 1e-6) continue;
    counters.occlusion_rays += 2;
    if (scene.blocked_towards(start_W, s) || scene.blocked_towards(p_A_W, leg_W / leg_m, leg_m)) continue;
    SignalPath path;
    path.excess_m = excess_m;
    path.copolar = field.copolar;
    path.crosspolar = field.crosspolar;
    path.arrival_W = (found->point_W - p_A_W).normalized();
    path.foliage_m = scene.foliage_m(start_W, s) + scene.foliage_m(p_A_W, leg_W / leg_m, leg_m);
    path.reflections = 1;
    path.facets[0] = SignalPath::kTerrain;
    out[i].echoes.push_back(path);
    ++counters.reflected_paths;
  }
}

}  // namespace canyon::gnss
