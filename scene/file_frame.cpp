#include "canyon/scene/file_frame.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "canyon/core/earth/geoid.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/scene/importers/raw_points.h"

namespace canyon::scene {
namespace {

/// Latitude and longitude of the outermost corners of all files on a map, and heights of the ground.
struct Spread {
  Eigen::Vector2d low_rad = Eigen::Vector2d::Constant(1e300), high_rad = -low_rad;
  std::vector<double> heights_m;

  bool none() const { return low_rad.x() > high_rad.x(); }
  Geodetic middle() const { return {0.5 * (low_rad.x() + high_rad.x()), 0.5 * (low_rad.y() + high_rad.y()), 0.0}; }
};

Spread spread_of(const FileScenes& files) {
  Spread out;
  Eigen::Vector2d &low = out.low_rad, &high = out.high_rad;
  for (std::size_t i = 0; i < files.scenes.size(); ++i) {
    if (!files.projections[i]) continue;
    for (const RawFootprint& f : files.scenes[i].footprints)
      if (std::isfinite(f.ground_m)) out.heights_m.push_back(f.ground_m);
    std::vector<double> lowest(files.scenes[i].objects.size(), 1e300);
    for (const RawPolygon& polygon : files.scenes[i].polygons)
      for (const auto& ring : polygon.rings)
        for (const Eigen::Vector3d& p : ring) lowest[polygon.object] = std::min(lowest[polygon.object], p.z());
    for (const double h : lowest)
      if (h < 1e300 && out.heights_m.size() < 1000000 && files.scenes[i].footprints.empty()) out.heights_m.push_back(h);
    // A few points of a large scene tell its middle well enough only if they are its outermost: all are looked at.
    for_corners(files.scenes[i], [&](const RawPoint& point) {
      const auto g = files.projections[i]->to_geodetic({point.p.x(), point.p.y(), 0.0});
      if (!g || !(std::abs(g->lat_rad) <= 0.5 * kPi)) return;
      // All on the same side of the date line as the first.
      const double lon_rad = low.x() > high.x() ? g->lon_rad : low.y() + std::remainder(g->lon_rad - low.y(), 2 * kPi);
      low = low.cwiseMin(Eigen::Vector2d(g->lat_rad, lon_rad));
      high = high.cwiseMax(Eigen::Vector2d(g->lat_rad, lon_rad));
    });
  }
  return out;
}

double median(std::vector<double>& values) {
  const auto half = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), half, values.end());
  return *half;
}

Eigen::Vector3d z_up(const RawScene& scene, const Eigen::Vector3d& p) {
  return scene.y_up ? Eigen::Vector3d(p.x(), -p.z(), p.y()) : p;
}

/// Where W's origin lies in local metres. Far from the file's own origin they are those of a map: W goes to their
/// middle, for single precision is finest there. An elevation model tells the ground's height; without one the middle
/// of the lowest corners does.
Eigen::Vector3d origin_in_local_metres(const FileScenes& files, bool with_height) {
  constexpr double kNear_m = 2000.0;
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e300), high = -low;
  std::vector<double> heights;
  for (const RawScene& scene : files.scenes) {
    std::vector<double> lowest(scene.objects.size() + scene.meshes.size(), 1e300);
    for_corners(scene, [&](const RawPoint& point) {
      const Eigen::Vector3d p = z_up(scene, point.p);
      if (!p.head<2>().allFinite()) return;
      low = low.cwiseMin(p.head<2>());
      high = high.cwiseMax(p.head<2>());
      if (point.object < scene.objects.size()) lowest[point.object] = std::min(lowest[point.object], p.z());
    });
    for (const RawMesh& mesh : scene.meshes)
      for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (const std::uint32_t v : mesh.triangles[i])
          lowest[mesh.object[i]] = std::min(lowest[mesh.object[i]], z_up(scene, mesh.vertices[v]).z());
    for (const double h : lowest)
      if (std::abs(h) < 1e300) heights.push_back(h);
  }
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  if (low.x() > high.x()) return at;
  const Eigen::Vector2d middle = 0.5 * (low + high);
  if (!(middle.norm() > kNear_m && middle.norm() > 0.5 * (high - low).norm())) return at;
  at.head<2>() = middle.array().round();
  if (with_height && !heights.empty()) at.z() = std::round(median(heights));
  return at;
}

std::string moved_warning(const Eigen::Vector3d& at, const Geodetic& origin) {
  char place[200];
  std::snprintf(place, sizeof place, "(%.0f, %.0f, %.0f) of the file is set down at %.6f, %.6f deg, %.1f m", at.x(),
                at.y(), at.z(), origin.lat_rad / kDegree, origin.lon_rad / kDegree, origin.h_m);
  return "no coordinate system is said (scene.crs) and none is local: " + std::string(place) +
         " (scene.lat_deg, scene.lon_deg, scene.base_height_m)";
}

/// What is added to heights above the geoid; 0 where they are above the ellipsoid already.
double undulation(const ImportConfig& config, const Geodetic& middle, ImportReport& report) {
  const bool ellipsoidal = config.heights == HeightDatum::kEllipsoidal ||
                           (config.heights == HeightDatum::kAuto && report.vertical == "ellipsoid");
  if (report.vertical.empty()) report.vertical = ellipsoidal ? "ellipsoid" : "orthometric (assumed)";
  if (ellipsoidal) return 0.0;
  if (config.undulation_m) {
    report.undulation_source = "stated";
    return *config.undulation_m;
  }
  const GeoidHeight geoid = geoid_height(middle);
  report.undulation_source = geoid.model;
  return geoid.undulation_m;
}

}  // namespace

Result<FileFrame> find_frame(const FileScenes& files, const ImportConfig& config, const Geodetic& origin,
                             ImportReport& report) {
  if (!config.center_deg.empty() && config.center_deg.size() != 2)
    return Error{"", 0, "scene.center_deg", std::to_string(config.center_deg.size()) + " numbers",
                 "latitude, longitude"};
  FileFrame at;
  report.undulation_source = "none";
  Spread spread = spread_of(files);
  if (spread.none()) {  // all in metres about the origin that is stated
    at.frame = LocalFrame(origin);
    at.file_origin_m = origin_in_local_metres(files, config.terrain.empty());
    if (!at.file_origin_m.isZero(0.0)) report.warnings.push_back(moved_warning(at.file_origin_m, origin));
    if (!config.terrain.empty()) at.undulation_m = undulation(config, origin, report);
    return at;
  }
  Geodetic middle = spread.middle();
  if (config.center_deg.size() == 2) middle = {config.center_deg[0] * kDegree, config.center_deg[1] * kDegree, 0.0};
  at.undulation_m = undulation(config, middle, report);
  double ground_m = 0.0;
  if (!config.terrain.empty()) {
    CANYON_TRY(at.terrain, TerrainFile::read(config.terrain, config.crs));
    ground_m = at.terrain->height(middle).value_or(0.0);
  } else if (!spread.heights_m.empty()) {
    ground_m = median(spread.heights_m);
  }
  middle.h_m = std::round(ground_m) + at.undulation_m;
  at.frame = LocalFrame(middle);
  return at;
}

int set_down(RawScene& scene, const std::optional<Projection>& projection, const FileFrame& at) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  int dropped = 0;
  const auto to_W = [&](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    throw_if_cancelled();
    if (!projection) return z_up(scene, p) - at.file_origin_m;
    const auto g = projection->to_geodetic(p);
    if (!g || !(std::abs(g->lat_rad) <= 0.5 * kPi)) {
      ++dropped;
      return Eigen::Vector3d::Constant(nan);
    }
    return at.frame.from_geodetic({g->lat_rad, g->lon_rad, g->h_m + at.undulation_m});
  };
  const double level_m = projection ? at.frame.origin().h_m - at.undulation_m : 0.0;
  for (RawPolygon& polygon : scene.polygons)
    for (auto& ring : polygon.rings)
      for (Eigen::Vector3d& p : ring) p = to_W(p);
  for (RawMesh& mesh : scene.meshes)
    for (Eigen::Vector3d& p : mesh.vertices) p = to_W(p);
  for (RawFootprint& f : scene.footprints) {
    const bool known = std::isfinite(f.ground_m);
    double sum_m = 0.0;
    for (auto& ring : f.rings) {
      for (Eigen::Vector2d& p : ring) {
        const Eigen::Vector3d p_W = to_W({p.x(), p.y(), known ? f.ground_m : level_m});
        p = p_W.head<2>();
        if (&ring == &f.rings[0]) sum_m += p_W.z();
      }
    }
    if (known) f.ground_m = sum_m / static_cast<double>(f.rings[0].size());
  }
  for (RawStreet& street : scene.streets)
    for (Eigen::Vector2d& p : street.points) p = to_W({p.x(), p.y(), level_m}).head<2>();
  for (RawTree& tree : scene.trees) tree.place = to_W({tree.place.x(), tree.place.y(), level_m}).head<2>();
  const auto lost = [](const auto& ring) {
    return std::any_of(ring.begin(), ring.end(), [](const auto& p) { return !p.allFinite(); });
  };
  std::erase_if(scene.polygons,
                [&](const RawPolygon& p) { return projection && std::any_of(p.rings.begin(), p.rings.end(), lost); });
  std::erase_if(scene.footprints,
                [&](const RawFootprint& f) { return std::any_of(f.rings.begin(), f.rings.end(), lost); });
  std::erase_if(scene.streets, [&](const RawStreet& s) { return lost(s.points); });
  std::erase_if(scene.trees, [&](const RawTree& t) { return !t.place.allFinite(); });
  return dropped;
}

}  // namespace canyon::scene
