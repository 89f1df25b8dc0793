#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>

#include "canyon/gnss/paths/diffraction/diffraction.h"
#include "canyon/gnss/paths/diffraction/edge_air.h"
#include "canyon/gnss/paths/diffraction/edges_near.h"
#include "canyon/gnss/paths/diffraction/knife_edge.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {
namespace {

/// Where a plane wave from s bends at an edge towards p.
struct Bend {
  Eigen::Vector3d point_W;
  double detour_m;
  double distance_m;  ///< from p
  bool shadow;        ///< the straight way passes on the solid's side of the edge
};

/// Does the straight way from p towards the unit vector s pass on the solid's side of the edge?
bool in_shadow(const scene::Edge& edge, const Eigen::Vector3d& p_W, const Eigen::Vector3d& point_W,
               const Eigen::Vector3d& s) {
  const Eigen::Vector3d way = point_W - p_W;
  return (way - way.dot(s) * s).dot(edge.outward_W) > 0.0;
}

/// nullopt if the bend lies beyond the edge's ends, or the edge throws no shadow of that satellite.
std::optional<Bend> bend(const scene::Edge& edge, const Eigen::Vector3d& p_W, const Eigen::Vector3d& s) {
  if (edge.normal_1_W.dot(s) * edge.normal_2_W.dot(s) >= 0.0) return std::nullopt;
  const Eigen::Vector3d along = edge.b_W - edge.a_W;
  const double length_m = along.norm();
  const Eigen::Vector3d e = along / length_m;
  const Eigen::Vector3d from_a = p_W - edge.a_W;
  const double foot_m = from_a.dot(e), across_m = (from_a - foot_m * e).norm();
  const double cosine = -s.dot(e), sine2 = 1.0 - cosine * cosine;
  if (sine2 < 1e-6 || across_m < 1e-3) return std::nullopt;
  const double at_m = foot_m - across_m * cosine / std::sqrt(sine2);
  if (at_m < 0.0 || at_m > length_m) return std::nullopt;
  Bend b;
  b.point_W = edge.a_W + at_m * e;
  const Eigen::Vector3d way = b.point_W - p_W;
  b.distance_m = way.norm();
  const double forward_m = way.dot(s);
  if (forward_m <= 0.0) return std::nullopt;
  // |way| - way . s without the difference of nearly equal numbers.
  const Eigen::Vector3d off = way - forward_m * s;
  b.detour_m = off.squaredNorm() / (b.distance_m + forward_m);
  b.shadow = in_shadow(edge, p_W, b.point_W, s);
  return b;
}

class KnifeEdges final : public DiffractionModel {
 public:
  KnifeEdges(const PathParameters& p, bool twice) : p_(p), twice_(twice) {
    weakest_ = std::pow(10.0, p.weakest_nlos_db / 20.0);
    largest_nu_ = largest_knife_edge_nu(p.weakest_nlos_db);
  }

  void trace(const Eigen::Vector3d& p_A_W, const PlaneWaves& waves, const scene::SceneAt& scene,
             std::span<SignalPaths> out, GnssCounters& counters) const override {
    if (waves.empty()) return;
    std::vector<double> nearest_nu(out.size(), kDeepestLitNu);
    look_at_edges_near(
        p_A_W, waves, scene, largest_detour_m(waves.longest_wavelength_m()),
        [&](const scene::Edge& edge, std::size_t k) {
          look(edge, p_A_W, {waves.direction_W(k), waves.wavelength_m(k)}, scene, counters, nearest_nu[k], out[k]);
        });
  }

 private:
  /// One satellite's wave: unit vector towards it, and its length.
  struct Wave {
    const Eigen::Vector3d& s;
    double length_m;
  };

  void look(const scene::Edge& edge, const Eigen::Vector3d& p_W, const Wave& wave, const scene::SceneAt& scene,
            GnssCounters& counters, double& nearest_nu, SignalPaths& out) const {
    const auto b = bend(edge, p_W, wave.s);
    if (!b || b->detour_m > largest_detour_m(wave.length_m) || b->shadow == out.line_of_sight) return;
    if (!out.line_of_sight) return bent_way(edge, *b, p_W, wave, scene, counters, out);
    const double nu = knife_edge_nu(b->detour_m, wave.length_m);
    if (nu < nearest_nu && clear(edge, *b, p_W, wave.s, scene, counters, nullptr) &&
        ends_in_air(edge, b->point_W, scene)) {
      nearest_nu = nu;
      out.direct = knife_edge_field(-nu);
    }
  }

  /// Beyond it the field is too weak to matter, and the lit side's ripples too small.
  double largest_detour_m(double wavelength_m) const { return gnss::largest_detour_m(largest_nu_, wavelength_m); }

  static Eigen::Vector3d outside(const scene::Edge& edge, const Bend& b) {
    return b.point_W + kOffEdge_m * edge.outward_W;
  }

  /// Legs from the edge to the satellite and to p. With `behind`, only the second must be clear, and *behind says
  /// whether the first is.
  bool clear(const scene::Edge& edge, const Bend& b, const Eigen::Vector3d& p_W, const Eigen::Vector3d& s,
             const scene::SceneAt& scene, GnssCounters& counters, bool* behind) const {
    const Eigen::Vector3d at_W = outside(edge, b);
    const Eigen::Vector3d leg_W = at_W - p_W;
    const double leg_m = leg_W.norm();
    counters.occlusion_rays += 2;
    const bool open = !scene.blocked_towards(at_W, s);
    if (behind != nullptr) *behind = open;
    if (!open && behind == nullptr) return false;
    return !scene.blocked_towards(p_W, leg_W / leg_m, leg_m);
  }

  void bent_way(const scene::Edge& edge, const Bend& b, const Eigen::Vector3d& p_W, const Wave& wave,
                const scene::SceneAt& scene, GnssCounters& counters, SignalPaths& out) const {
    const Eigen::Vector3d& s = wave.s;
    const std::complex<double> field = knife_edge_field(knife_edge_nu(b.detour_m, wave.length_m));
    if (std::abs(field) < weakest_) return;
    bool open = false;
    if (!clear(edge, b, p_W, s, scene, counters, twice_ ? &open : nullptr)) return;
    if (!twice_) open = true;
    if (!ends_in_air(edge, b.point_W, scene)) return;
    const Eigen::Vector3d at_W = outside(edge, b);
    if (!open) {
      second_edge(edge, b, at_W, p_W, wave, scene, counters, out);
      return;
    }
    const std::complex<double> beside = twice_ ? lit_beside(b, at_W, p_W, wave.length_m, scene, counters) : 1.0;
    add(field * beside, b.detour_m, wave.length_m, 1, at_W, p_W, scene.foliage_m(at_W, s), scene, out, counters);
  }

  /// What the edge that comes nearest to the way from p to a bend, without cutting it off, makes of its field.
  std::complex<double> lit_beside(const Bend& far, const Eigen::Vector3d& far_W, const Eigen::Vector3d& p_W,
                                  double wavelength_m, const scene::SceneAt& scene, GnssCounters& counters) const {
    const Eigen::Vector3d to_far_W = (far.point_W - p_W) / far.distance_m;
    const auto& edges = scene.scene().edges();
    std::vector<std::uint32_t> candidates;
    edges.shading(p_W, std::asin(std::clamp(to_far_W.z(), 0.0, 1.0)), largest_detour_m(wavelength_m), candidates);
    double nearest_nu = kDeepestLitNu;
    std::complex<double> field = 1.0;
    for (const std::uint32_t i : candidates) {
      const scene::Edge& edge = edges.edges()[i];
      const auto b = bend(edge, p_W, to_far_W);
      if (!b || b->shadow || b->distance_m > far.distance_m - kOffEdge_m) continue;
      const double detour_m = (far.point_W - b->point_W).norm() + b->distance_m - far.distance_m;
      const double nu = knife_edge_nu(std::max(detour_m, 0.0), wavelength_m);
      if (nu >= nearest_nu || !ends_in_air(edge, b->point_W, scene)) continue;
      const Eigen::Vector3d at_W = outside(edge, *b);
      counters.occlusion_rays += 2;
      if (scene.blocked(p_W, at_W) || scene.blocked(at_W, far_W)) continue;
      nearest_nu = nu;
      field = knife_edge_field(-nu);
    }
    return field;
  }

  /// The edge is itself in the shadow of another one.
  void second_edge(const scene::Edge& near, const Bend& first, const Eigen::Vector3d& first_W,
                   const Eigen::Vector3d& p_W, const Wave& wave, const scene::SceneAt& scene, GnssCounters& counters,
                   SignalPaths& out) const {
    const Eigen::Vector3d& s = wave.s;
    const double wavelength_m = wave.length_m, reach_m = largest_detour_m(wavelength_m);
    const auto& edges = scene.scene().edges();
    std::vector<std::uint32_t> candidates;
    edges.shading(first_W, std::asin(std::clamp(s.z(), 0.0, 1.0)), reach_m, candidates);
    for (const std::uint32_t i : candidates) {
      const scene::Edge& edge = edges.edges()[i];
      const auto b = bend(edge, first_W, s);
      if (!b || !b->shadow || b->detour_m > reach_m || b->distance_m < 0.1) continue;
      const Eigen::Vector3d second_W = outside(edge, *b);
      // The near edge sees the wave come from the far one. Where the way from there to p passes above it, that way is
      // an echo by itself, with the near edge beside it.
      const Eigen::Vector3d whole_W = b->point_W - p_W;
      const double whole_m = whole_W.norm();
      if (!in_shadow(near, p_W, first.point_W, whole_W / whole_m)) continue;
      const double detour_m = std::max((b->point_W - first.point_W).norm() + first.distance_m - whole_m, 0.0);
      const std::complex<double> near_field = knife_edge_field(knife_edge_nu(detour_m, wavelength_m));
      const std::complex<double> far_field = knife_edge_field(knife_edge_nu(b->detour_m, wavelength_m));
      std::complex<double> field = near_field * far_field;
      constexpr double kDeep = 0.17782794;  // 15 dB
      if (std::abs(near_field) < kDeep && std::abs(far_field) < kDeep)
        field *= std::sqrt(b->distance_m / (b->distance_m + first.distance_m));
      if (std::abs(field) < weakest_) continue;
      if (!clear(edge, *b, first_W, s, scene, counters, nullptr) || !ends_in_air(edge, b->point_W, scene)) continue;
      const Eigen::Vector3d leg_W = second_W - first_W;
      const double leg_m = leg_W.norm();
      const double foliage_m = scene.foliage_m(second_W, s) + scene.foliage_m(first_W, leg_W / leg_m, leg_m);
      add(field, b->detour_m + detour_m, wavelength_m, 2, first_W, p_W, foliage_m, scene, out, counters);
    }
  }

  static void add(std::complex<double> field, double detour_m, double wavelength_m, int edges,
                  const Eigen::Vector3d& at_W, const Eigen::Vector3d& p_W, double foliage_m,
                  const scene::SceneAt& scene, SignalPaths& out, GnssCounters& counters) {
    SignalPath path;
    const Eigen::Vector3d leg_W = at_W - p_W;
    const double leg_m = leg_W.norm();
    path.arrival_W = leg_W / leg_m;
    // The same edge may stand in the scene twice, once for each of two houses that share it.
    for (const SignalPath& other : out.echoes)
      if (other.diffractions == edges && other.reflections == 0 && std::abs(other.excess_m - detour_m) < 1e-3 &&
          (other.arrival_W - path.arrival_W).norm() < 1e-2)
        return;
    path.excess_m = detour_m;
    // The field's phase is relative to the straight way, an echo's to its own.
    path.copolar = field * std::polar(1.0, 2.0 * kPi * detour_m / wavelength_m);
    path.diffractions = edges;
    path.foliage_m = foliage_m + scene.foliage_m(p_W, path.arrival_W, leg_m);
    out.echoes.push_back(path);
    ++counters.diffracted_paths;
  }

  PathParameters p_;
  bool twice_;
  double weakest_, largest_nu_;
};

}  // namespace

std::unique_ptr<DiffractionModel> make_knife_edge(const PathParameters& p) {
  return std::make_unique<KnifeEdges>(p, false);
}

std::unique_ptr<DiffractionModel> make_double_knife_edge(const PathParameters& p) {
  return std::make_unique<KnifeEdges>(p, true);
}

}  // namespace canyon::gnss
