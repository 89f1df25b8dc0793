#include "canyon/tests/gnss/paths/berlin_street.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "canyon/core/units.h"
#include "canyon/scene/mesh_builder.h"

namespace canyon::gnss::testing {
namespace {

constexpr double kUndulation_m = 39.5;  // of the geoid, at the site
constexpr double kStart_sow = 126641.7;

double signed_area(const std::vector<Eigen::Vector2d>& outline) {
  double twice = 0.0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d &a = outline[i], &b = outline[(i + 1) % outline.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

bool in_triangle(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                 const Eigen::Vector2d& c) {
  const auto side = [](const Eigen::Vector2d& u, const Eigen::Vector2d& v, const Eigen::Vector2d& q) {
    return (v - u).x() * (q - u).y() - (v - u).y() * (q - u).x();
  };
  return side(a, b, p) >= 0.0 && side(b, c, p) >= 0.0 && side(c, a, p) >= 0.0;
}

/// Cuts a counter-clockwise outline into triangles by its ears.
std::vector<std::array<std::size_t, 3>> ears(const std::vector<Eigen::Vector2d>& outline) {
  std::vector<std::size_t> left(outline.size());
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = i;
  std::vector<std::array<std::size_t, 3>> out;
  while (left.size() > 3) {
    bool cut = false;
    for (std::size_t k = 0; k < left.size() && !cut; ++k) {
      const std::size_t ia = left[(k + left.size() - 1) % left.size()], ib = left[k], ic = left[(k + 1) % left.size()];
      const Eigen::Vector2d &a = outline[ia], &b = outline[ib], &c = outline[ic];
      if (signed_area({a, b, c}) <= 1e-9) continue;
      bool free = true;
      for (const std::size_t i : left)
        free = free && (i == ia || i == ib || i == ic || !in_triangle(outline[i], a, b, c));
      if (!free) continue;
      out.push_back({ia, ib, ic});
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(k));
      cut = true;
    }
    if (!cut) break;  // the rest is flat
  }
  if (left.size() == 3) out.push_back({left[0], left[1], left[2]});
  return out;
}

void add_prisms(const std::string& file, scene::SceneParts& parts) {
  std::ifstream in(file);
  scene::MeshBuilder mesh(parts);
  std::string line;
  while (std::getline(in, line)) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream fields(line);
    std::string id, corner;
    double y0_dm = 0.0, h_dm = 0.0;
    if (!(fields >> id >> y0_dm >> h_dm)) throw std::runtime_error("prism: " + line);
    std::vector<Eigen::Vector2d> outline_m;  // easting, northing
    while (fields >> corner) {
      double x = 0.0, z = 0.0;
      if (std::sscanf(corner.c_str(), "%lf,%lf", &x, &z) != 2) throw std::runtime_error("prism: " + line);
      outline_m.emplace_back(389500.0 + 0.1 * x, 5820000.0 - 0.1 * z);
    }
    if (signed_area(outline_m) < 0.0) std::reverse(outline_m.begin(), outline_m.end());
    const double bottom_m = 0.1 * y0_dm + 30.0 + kUndulation_m, top_m = bottom_m + 0.1 * h_dm;
    const auto at = [&](std::size_t i, double h_m) {
      const Eigen::Vector2d& p = outline_m[i % outline_m.size()];
      return parts.frame.from_geodetic(from_utm33(p.x(), p.y(), h_m));
    };
    mesh.begin_object("building " + id, scene::ObjectKind::kBuilding);
    for (std::size_t i = 0; i < outline_m.size(); ++i)
      mesh.quad(at(i, bottom_m), at(i + 1, bottom_m), at(i + 1, top_m), at(i, top_m), mesh.material("concrete"));
    for (const auto& t : ears(outline_m))
      mesh.triangle(at(t[0], top_m), at(t[1], top_m), at(t[2], top_m), mesh.material("concrete"));
  }
}

struct Track {
  std::vector<double> sow;
  std::vector<Eigen::Vector3d> p_E;

  Eigen::Vector3d at(double t) const {
    for (std::size_t i = 0; i + 1 < sow.size(); ++i) {
      if (t < sow[i] - 1e-6 || t > sow[i + 1] + 1e-6) continue;
      const double f = (t - sow[i]) / (sow[i + 1] - sow[i]);
      return (1.0 - f) * p_E[i] + f * p_E[i + 1];
    }
    throw std::runtime_error("no true position at " + std::to_string(t));
  }
};

Track read_track(const std::string& file) {
  Track track;
  std::ifstream in(file);
  std::string word;
  double t = 0.0;
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream fields(line);
    Eigen::Vector3d p;
    if (!(fields >> word >> t >> p.x() >> p.y() >> p.z())) continue;
    track.sow.push_back(kStart_sow + t);
    track.p_E.push_back(p);
  }
  if (track.sow.size() < 100) throw std::runtime_error("no trajectory in " + file);
  return track;
}

}  // namespace

Geodetic from_utm33(double easting_m, double northing_m, double h_m) {
  constexpr double a = 6378137.0, f = 1.0 / 298.257222101, k0 = 0.9996;  // GRS80
  constexpr double n = f / (2.0 - f), n2 = n * n, n3 = n2 * n, n4 = n3 * n;
  const double radius = a / (1.0 + n) * (1.0 + n2 / 4.0 + n4 / 64.0);
  const double beta[4] = {n / 2.0 - 2.0 * n2 / 3.0 + 37.0 * n3 / 96.0 - n4 / 360.0,
                          n2 / 48.0 + n3 / 15.0 - 437.0 * n4 / 1440.0, 17.0 * n3 / 480.0 - 37.0 * n4 / 840.0,
                          4397.0 * n4 / 161280.0};
  const double xi = northing_m / (k0 * radius), eta = (easting_m - 500000.0) / (k0 * radius);
  double xi1 = xi, eta1 = eta;
  for (int j = 1; j <= 4; ++j) {
    xi1 -= beta[j - 1] * std::sin(2 * j * xi) * std::cosh(2 * j * eta);
    eta1 -= beta[j - 1] * std::cos(2 * j * xi) * std::sinh(2 * j * eta);
  }
  const double chi = std::asin(std::sin(xi1) / std::cosh(eta1));  // conformal latitude
  const double delta[4] = {2.0 * n - 2.0 * n2 / 3.0 - 2.0 * n3 + 116.0 * n4 / 45.0,
                           7.0 * n2 / 3.0 - 8.0 * n3 / 5.0 - 227.0 * n4 / 45.0, 56.0 * n3 / 15.0 - 136.0 * n4 / 35.0,
                           4279.0 * n4 / 630.0};
  double lat_rad = chi;
  for (int j = 1; j <= 4; ++j) lat_rad += delta[j - 1] * std::sin(2 * j * chi);
  const double lon_rad = 15.0 * kDegree + std::atan2(std::sinh(eta1), std::cos(xi1));
  return {lat_rad, lon_rad, h_m};
}

Street read_street(const std::string& prisms, const std::string& trajectory, const std::string& observations,
                   bool ground) {
  scene::SceneParts parts;
  parts.name = "Potsdamer Platz";
  parts.frame = LocalFrame(from_utm33(389740.0, 5818850.0, 35.0 + kUndulation_m));
  parts.undulation_m = kUndulation_m;
  parts.materials = scene::builtin_materials();
  add_prisms(prisms, parts);
  const Track track = read_track(trajectory);

  Street street;
  std::ifstream in(observations);
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    StreetObservation o;
    char sat[8] = {};
    int visible = 0, n = 0;
    double excess = std::numeric_limits<double>::quiet_NaN();
    const int read = std::sscanf(line.c_str(), "%lf,%7[^,],%lf,%lf,%lf,%lf,%d,%d,%lf", &o.sow, sat, &o.elevation_deg,
                                 &o.azimuth_deg, &o.cn0_dbhz, &o.residual_m, &visible, &n, &excess);
    if (read < 8) throw std::runtime_error("observation: " + line);
    o.satellite = sat;
    o.cast_visible = visible != 0;
    o.cast_excess_m = read == 9 ? excess : std::numeric_limits<double>::quiet_NaN();
    o.antenna_W = parts.frame.to_W(track.at(o.sow));
    street.observations.push_back(o);
  }
  if (ground) {
    scene::MeshBuilder mesh(parts);
    mesh.begin_object("street", scene::ObjectKind::kTerrain);
    double lowest_m = 1e9;
    for (const StreetObservation& o : street.observations) lowest_m = std::min(lowest_m, o.antenna_W.z());
    const double z = lowest_m - 1.5, r = 1500.0;
    mesh.quad({-r, -r, z}, {r, -r, z}, {r, r, z}, {-r, r, z}, mesh.material("asphalt"));
  }
  street.scene = std::make_unique<scene::Scene>(std::move(parts));
  return street;
}

}  // namespace canyon::gnss::testing
