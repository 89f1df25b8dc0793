#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>

#include "canyon/core/units.h"
#include "canyon/gnss/paths/bounce.h"
#include "canyon/gnss/paths/diffraction/diffraction.h"
#include "canyon/gnss/paths/diffraction/edge_air.h"
#include "canyon/gnss/paths/diffraction/edges_near.h"
#include "canyon/gnss/paths/diffraction/knife_edge.h"
#include "canyon/gnss/paths/diffraction/wedge.h"
#include "canyon/gnss/paths/diffraction/wedge_bound.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {
namespace {

/// Where a plane wave from s meets the line of an edge on its way to p.
struct WedgeMeeting {
  double at_m;        ///< from the edge's first end; outside of it where the law of diffraction leads beyond
  double length_m;    ///< of the edge
  double detour_m;    ///< over that point
  double distance_m;  ///< from it to p
  double sine_beta;
  Eigen::Vector3d along_W, point_W;  ///< the point held within the edge
};

/// An edge as it lies about p, for all waves.
struct EdgeAbout {
  const scene::Edge* edge = nullptr;
  Eigen::Vector3d along_W = Eigen::Vector3d::Zero();
  double length_m = 0.0, foot_m = 0.0, across_m = 0.0;  ///< p stands beside foot_m of it, across_m away
  double n = 0.0;                                       ///< exterior angle / pi

  void look_at(const scene::Edge& e, const Eigen::Vector3d& p_W) {
    edge = &e;
    length_m = (e.b_W - e.a_W).norm();
    along_W = (e.b_W - e.a_W) / length_m;
    const Eigen::Vector3d from_a = p_W - e.a_W;
    foot_m = from_a.dot(along_W);
    across_m = (from_a - foot_m * along_W).norm();
    n = 1.0 + std::acos(std::clamp(e.normal_1_W.dot(e.normal_2_W), -1.0, 1.0)) / kPi;
  }
};

std::optional<WedgeMeeting> wedge_meeting(const EdgeAbout& about, const Eigen::Vector3d& p_W,
                                          const Eigen::Vector3d& s) {
  const scene::Edge& edge = *about.edge;
  // An edge throws a shadow where the wave meets one of its faces alone.
  if (edge.normal_1_W.dot(s) * edge.normal_2_W.dot(s) >= 0.0) return std::nullopt;
  WedgeMeeting m;
  m.length_m = about.length_m;
  m.along_W = about.along_W;
  const double cosine = -s.dot(m.along_W), sine2 = 1.0 - cosine * cosine;
  if (sine2 < 1e-6 || about.across_m < 1e-3) return std::nullopt;
  m.sine_beta = std::sqrt(sine2);
  m.at_m = about.foot_m - about.across_m * cosine / m.sine_beta;
  const Eigen::Vector3d way = edge.a_W + m.at_m * m.along_W - p_W;
  const double forward_m = way.dot(s);
  if (forward_m <= 0.0) return std::nullopt;
  m.distance_m = way.norm();
  m.detour_m = (way - forward_m * s).squaredNorm() / (m.distance_m + forward_m);
  m.point_W = edge.a_W + std::clamp(m.at_m, 0.0, m.length_m) * m.along_W;
  return m;
}

/// About the edge from its first face, which lies at 0, to the air before it; [0, n pi].
double angle_about(const scene::Edge& edge, const Eigen::Vector3d& along_W, const Eigen::Vector3d& towards_W,
                   double n) {
  Eigen::Vector3d in_face_W = along_W.cross(edge.normal_1_W);
  if (in_face_W.dot(edge.outward_W) > 0.0) in_face_W = -in_face_W;
  double angle_rad = std::atan2(towards_W.dot(edge.normal_1_W), towards_W.dot(in_face_W));
  if (angle_rad < 0.0) angle_rad += 2.0 * kPi;
  // Within the solid by rounding: the nearer face.
  if (angle_rad > n * kPi) angle_rad = angle_rad < 0.5 * (n + 2.0) * kPi ? n * kPi : 0.0;
  return angle_rad;
}

/// As a plane wave reflects that such a bend would turn: in the direction of a reflection's border the angle is the
/// mirror's own, and it is the same both ways, as Luebbers's, of the wave's alone, is not (Holm 2000 says what that
/// costs).
Fresnel mirror_of(const scene::Material& material, double grazing_rad, double carrier_hz) {
  const Eigen::Vector3d incoming(std::cos(grazing_rad), 0.0, -std::sin(grazing_rad));
  return bounce_off(material, incoming, Eigen::Vector3d::UnitZ(), 0.0, carrier_hz).coefficients;
}

class Wedges final : public DiffractionModel {
 public:
  explicit Wedges(const PathParameters& p)
      : weakest_(std::pow(10.0, p.weakest_db / 20.0)),
        weakest_nlos_(std::pow(10.0, p.weakest_nlos_db / 20.0)),
        largest_nu_(largest_knife_edge_nu(std::min(p.weakest_db, p.weakest_nlos_db) - kOverScreen_db)),
        reflection_borders_(p.reflection_borders) {}

  void trace(const Eigen::Vector3d& p_A_W, const PlaneWaves& waves, const scene::SceneAt& scene,
             std::span<SignalPaths> out, GnssCounters& counters) const override {
    if (waves.empty()) return;
    thread_local std::vector<Found> found;
    found.clear();
    EdgeAbout about;
    look_at_edges_near(p_A_W, waves, scene, largest_detour_m(largest_nu_, waves.longest_wavelength_m()),
                       [&](const scene::Edge& edge, std::size_t k) {
                         if (about.edge != &edge) about.look_at(edge, p_A_W);
                         bend(about, p_A_W, waves, k, scene, counters, found, out[k]);
                       });
  }

 private:
  /// A way that was found; the same edge may stand in the scene twice, once for each of two houses that share it.
  struct Found {
    std::size_t k;
    double excess_m;
    Eigen::Vector3d arrival_W, along_W;
    bool same(const Found& other) const {
      return k == other.k && std::abs(excess_m - other.excess_m) < 1e-3 &&
             (arrival_W - other.arrival_W).squaredNorm() < 1e-4 && std::abs(along_W.dot(other.along_W)) > 0.999;
    }
  };

  void bend(const EdgeAbout& about, const Eigen::Vector3d& p_W, const PlaneWaves& waves, std::size_t k,
            const scene::SceneAt& scene, GnssCounters& counters, std::vector<Found>& found, SignalPaths& out) const {
    const Eigen::Vector3d& s = waves.direction_W(k);
    const scene::Edge& edge = *about.edge;
    const auto m = wedge_meeting(about, p_W, s);
    const double wavelength_m = waves.wavelength_m(k);
    if (!m || m->detour_m > largest_detour_m(largest_nu_, wavelength_m)) return;
    const double nu = knife_edge_nu(m->detour_m, wavelength_m);
    const double per_m = m->sine_beta * std::sqrt(2.0 / (wavelength_m * m->distance_m));
    const double u1 = -m->at_m * per_m, u2 = (m->length_m - m->at_m) * per_m;
    const double least = out.line_of_sight ? weakest_ : weakest_nlos_;
    // Most pairs are too weak, which a bound of what they make tells; of the others most are hidden.
    const double largest_part = largest_finite_edge_factor(nu, u1, u2);
    if (largest_part < 0.5 * least) return;
    const WedgeWay way = wedge_way(about, *m, p_W, s, wavelength_m);
    if (largest_part * largest_wedge_field(way) < least) return;
    if (!clear(edge, *m, p_W, s, scene, counters)) return;
    const std::complex<double> part = finite_edge_factor(nu, u1, u2);
    if (std::abs(part) < 0.5 * least) return;
    SignalPath path = field(edge, *m, way, p_W, s, waves.carrier_hz(k), scene);
    const double amplitude = std::abs(part) * std::sqrt(std::norm(path.copolar) + std::norm(path.crosspolar));
    // A field fades out over 3.5 dB to the weakest that is followed, so that none appears at once.
    const double kept = std::clamp(2.0 * (amplitude / least - 1.0), 0.0, 1.0);
    if (kept == 0.0) return;
    path.copolar *= kept * part;
    path.crosspolar *= kept * part;
    if (!ends_in_air(edge, m->point_W, scene)) return;
    const Eigen::Vector3d leg_W = outside(edge, *m) - p_W;
    const Found one{k, m->detour_m, leg_W.normalized(), m->along_W};
    if (std::any_of(found.begin(), found.end(), [&](const Found& other) { return other.same(one); })) return;
    found.push_back(one);
    path.arrival_W = one.arrival_W;
    path.excess_m = m->detour_m;
    path.diffractions = 1;
    path.foliage_m = scene.foliage_m(outside(edge, *m), s) + scene.foliage_m(p_W, path.arrival_W, leg_W.norm());
    out.echoes.push_back(path);
    ++counters.diffracted_paths;
  }

  static WedgeWay wedge_way(const EdgeAbout& about, const WedgeMeeting& m, const Eigen::Vector3d& p_W,
                            const Eigen::Vector3d& s, double wavelength_m) {
    const scene::Edge& edge = *about.edge;
    const Eigen::Vector3d from_W = edge.a_W + m.at_m * m.along_W;
    WedgeWay way;
    way.n = about.n;
    way.phi_in_rad = angle_about(edge, m.along_W, s, way.n);
    way.phi_out_rad = angle_about(edge, m.along_W, p_W - from_W, way.n);
    way.sine_beta = m.sine_beta;
    way.distance_m = m.distance_m;
    way.wavelength_m = wavelength_m;
    return way;
  }

  SignalPath field(const scene::Edge& edge, const WedgeMeeting& m, const WedgeWay& way, const Eigen::Vector3d& p_W,
                   const Eigen::Vector3d& s, double carrier_hz, const scene::SceneAt& scene) const {
    const auto& materials = scene.scene().materials();
    const Eigen::Vector3d from_W = edge.a_W + m.at_m * m.along_W;
    const double cosine = -s.dot(p_W - from_W) / m.distance_m;
    const double grazing_rad = 0.5 * std::acos(std::clamp(cosine, -1.0, 1.0));
    Fresnel one = mirror_of(materials[edge.material_1], grazing_rad, carrier_hz);
    Fresnel two = mirror_of(materials[edge.material_2], grazing_rad, carrier_hz);
    // The borders of what such a face mirrors are the image search's.
    const auto mirrors = [&](const Eigen::Vector3d& normal_W) {
      return reflection_borders_ && normal_W.dot(s) > 0.0 && normal_W.dot(p_W - from_W) > 0.0;
    };
    if (mirrors(edge.normal_1_W)) one = {};
    if (mirrors(edge.normal_2_W)) two = {};
    const WedgeBorders borders(way);
    const std::complex<double> soft = borders.field(one.te, two.te), hard = borders.field(one.tm, two.tm);
    SignalPath path;
    path.copolar = 0.5 * (soft + hard);
    path.crosspolar = 0.5 * (hard - soft);
    return path;
  }

  static Eigen::Vector3d outside(const scene::Edge& edge, const WedgeMeeting& m) {
    return m.point_W + kOffEdge_m * edge.outward_W;
  }

  static bool clear(const scene::Edge& edge, const WedgeMeeting& m, const Eigen::Vector3d& p_W,
                    const Eigen::Vector3d& s, const scene::SceneAt& scene, GnssCounters& counters) {
    const Eigen::Vector3d at_W = outside(edge, m), leg_W = at_W - p_W;
    const double leg_m = leg_W.norm();
    counters.occlusion_rays += 2;
    return !scene.blocked_towards(at_W, s) && !scene.blocked_towards(p_W, leg_W / leg_m, leg_m);
  }

  double weakest_, weakest_nlos_, largest_nu_;
  bool reflection_borders_;
};

}  // namespace

std::unique_ptr<DiffractionModel> make_wedge(const PathParameters& p) {
  return std::make_unique<Wedges>(p);
}

}  // namespace canyon::gnss
