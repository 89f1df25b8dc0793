#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "canyon/core/units.h"
#include "canyon/gnss/paths/clutter/clutter.h"
#include "canyon/gnss/paths/clutter/clutter_scatterers.h"
#include "canyon/gnss/paths/clutter/street_number.h"
#include "canyon/gnss/paths/clutter/street_shading.h"
#include "canyon/gnss/paths/scatter/delay_bins.h"
#include "canyon/gnss/paths/sight/point_sight.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {
namespace {

constexpr float kAcross_m = 100.0F;

struct StreetClutterParameters {
  std::string environment = "suburban";
  double shaded_scale = 1.0;
  double echo_db = 0.0;
  double moving_share = 0.2;
  double coherence_s = 2.0;
  double cell_m = 8.0;
  double reach_m = 80.0;
  std::int64_t street = 0;
};
void visit(FieldVisitor& f, StreetClutterParameters& c) {
  f.choice("clutter_environment", c.environment, TwoStateLaw::environments(),
           "clutter street: table of ITU-R P.681; suburban stands for what fills a street whose houses the scene has");
  f.number("clutter_shaded_scale", c.shaded_scale, {0.0, 5.0},
           "clutter street: the table's share of the bad state is taken this many times");
  f.number("clutter_echo_db", c.echo_db, {-40.0, 20.0},
           "clutter street: power of the scatterers against the table's multipath");
  f.number("clutter_moving_share", c.moving_share, {0.0, 1.0},
           "clutter street: share of variance and power that changes with time; 0.2 is assumed");
  f.number("clutter_coherence_s", c.coherence_s, {0.05, 3600.0},
           "clutter street: time after which what moves is another; 2 s are assumed");
  f.number("clutter_cell_m", c.cell_m, {1.0, 50.0}, "clutter street: one scatterer in each square of this side");
  f.number("clutter_reach_m", c.reach_m, {10.0, 500.0}, "clutter street: scatterers farther away do not count");
  f.integer(
      "clutter_street", c.street, {0, 1000000000},
      "clutter street: number of the draw of what stands; each is the same street on every pass and for every seed");
}

/// A scatterer that is seen from the antenna, and the field that it would send on if it is lit.
struct Seen {
  std::uint32_t number;
  Eigen::Vector3d p_W, to_W;  ///< unit, from the antenna
  double r_m;
  std::complex<double> co, cross;  ///< variance over streets: half of its share of the multipath's power
};

/// What a street has beside the scene. Two parts:
///
/// - **Shading** (street_shading.h) of the straight way and of every echo of the scene, by where they come from, by the
///   two states of ITU-R P.681 for the environment. Its urban table counts houses as its bad state; those the scene
///   has, so it is not the default.
/// - **Scatterers** (clutter_scatterers.h), points about the antenna with complex normal fields. Their power at r
///   follows the radar equation, 1 / (r^2 + b^2) with b^2 = cell / (2 pi), fading out over the last fifth of the reach;
///   together, all in sight, they have the power that the table gives for multipath: each that the satellite lights
///   as in the good state, each in the shadow as in the bad one, where light comes to it off what stands across the
///   street, later by that way; where nothing stands there it is dark. A scatterer counts as far as it is seen, and
///   lit, by shares that change evenly (PointSight). So delays and Doppler come from geometry, where Lehner & Steingass
///   (2005) draw them. In the open the sum is complex normal: Rayleigh by itself, Rician with what else arrives.
///
/// A scene without a house is no street, and has neither. Everything is a function of place, direction and, for the
/// moving share, seed and time. Not shaded: scatterers, which stand among the clutter themselves.
class StreetClutter final : public ClutterModel {
 public:
  StreetClutter(const StreetClutterParameters& own, const PathParameters& p)
      : own_(own),
        law_(own.environment, own.shaded_scale),
        shading_(law_, {.moving_share = own.moving_share, .coherence_s = own.coherence_s},
                 static_cast<std::uint64_t>(own.street), p.seed),
        scatterers_(own.cell_m, static_cast<std::uint64_t>(own.street)),
        passing_(p.seed, "gnss.clutter.traffic"),
        weakest_(std::pow(10.0, std::min(p.weakest_db, p.weakest_nlos_db) / 20.0)) {}

  void trace(const Eigen::Vector3d& p_A_W, const PlaneWaves& waves, const scene::SceneAt& scene,
             std::span<SignalPaths> out, GnssCounters& counters) const override {
    if (scene.scene().facets().facets().empty()) return;
    const SightPool::Loan sight = sights_.borrow(scene.scene());
    thread_local std::vector<Seen> seen;
    look(p_A_W, waves.t(), scene, *sight, counters, seen);
    DelayBins bins;
    for (std::size_t k = 0; k < out.size(); ++k) {
      shade(p_A_W, waves.direction_W(k), waves.t(), out[k]);
      bins.clear(waves.wavelength_m(k));
      gather(seen, waves, k, scene, *sight, counters, bins);
      bins.append(0.5 * weakest_, SignalPath::kClutter, out[k].echoes);
    }
  }

 private:
  void shade(const Eigen::Vector3d& p_W, const Eigen::Vector3d& s_W, GpsTime t, SignalPaths& paths) const {
    const auto left = [&](const Eigen::Vector3d& from_W) {
      return std::pow(10.0, shading_.level_db(p_W, from_W, t) / 20.0);
    };
    if (paths.line_of_sight) paths.direct *= left(s_W);
    for (SignalPath& echo : paths.echoes) {
      const double factor = left(echo.arrival_W);
      echo.gathered_copolar *= factor * factor;
      echo.gathered_crosspolar *= factor * factor;
      echo.copolar *= factor;
      echo.crosspolar *= factor;
    }
  }

  void look(const Eigen::Vector3d& p_W, GpsTime t, const scene::SceneAt& scene, PointSight& sight,
            GnssCounters& counters, std::vector<Seen>& seen) const {
    thread_local std::vector<ClutterScatterer> near;
    scatterers_.near(scene.scene(), p_W, own_.reach_m, near);
    seen.clear();
    const PointSight::From from = sight.from(p_W);
    const double blunt_m2 = own_.cell_m * own_.cell_m / (2.0 * kPi);
    double whole = 0.0;
    for (const ClutterScatterer& one : near) {
      const Eigen::Vector3d way_W = one.p_W - p_W;
      const double r_m = way_W.norm(), fade = std::min(5.0 * (1.0 - way_W.head<2>().norm() / own_.reach_m), 1.0);
      const double power = fade * fade / (r_m * r_m + blunt_m2);
      whole += power;
      if (r_m < 1e-3) continue;
      const double share = from.share(one.number, one.p_W, counters);
      if (share == 0.0) continue;
      const double amplitude = share * std::sqrt(0.5 * power);
      seen.push_back({one.number, one.p_W, way_W / r_m, r_m, amplitude * now(one.co, one.id, 0, t),
                      amplitude * now(one.cross, one.id, 1, t)});
    }
    const double scale = whole > 0.0 ? 1.0 / std::sqrt(whole) : 0.0;
    for (Seen& one : seen) {
      one.co *= scale;
      one.cross *= scale;
    }
  }

  /// Of the same variance, at that time.
  std::complex<double> now(const std::complex<double>& still, std::uint64_t id, std::uint32_t hand, GpsTime t) const {
    if (own_.moving_share == 0.0) return still;
    const double seconds = static_cast<double>(t.ns) / static_cast<double>(kNsPerSecond);
    // Cells of time do not begin at once for all; the identity is a whole number of cells.
    const double place = seconds / own_.coherence_s + static_cast<double>(id % 1021) / 1021.0;
    const auto draw = [&](std::uint32_t layer) {
      return passing_.at<3>({place, static_cast<double>(id >> 32), static_cast<double>(id & 0xffffffffu)}, layer);
    };
    const std::complex<double> moving(std::sqrt(0.5) * draw(2 * hand), std::sqrt(0.5) * draw(2 * hand + 1));
    return std::sqrt(1.0 - own_.moving_share) * still + std::sqrt(own_.moving_share) * moving;
  }

  void gather(const std::vector<Seen>& seen, const PlaneWaves& waves, std::size_t k, const scene::SceneAt& scene,
              PointSight& sight, GnssCounters& counters, DelayBins& bins) const {
    const Eigen::Vector3d& s = waves.direction_W(k);
    const PointSight::Towards towards = sight.towards(s);
    const double elevation_rad = std::asin(std::clamp(s.z(), -1.0, 1.0)), level = s.head<2>().norm();
    const double extra = std::pow(10.0, own_.echo_db / 20.0);
    const double lit = extra * std::sqrt(law_.multipath_power(false, elevation_rad));
    const double unlit = extra * std::sqrt(law_.multipath_power(true, elevation_rad));
    for (const Seen& one : seen) {
      const double straight_m = one.r_m * (1.0 - one.to_W.dot(s));
      const auto send = [&](double scale, double detour_m) {
        const double power = scale * scale * (std::norm(one.co) + std::norm(one.cross));
        bins.add({scale * one.co, scale * one.cross}, straight_m + detour_m, one.to_W, power * power);
      };
      // One way across of the nodes' mean length: several, each with its share, would add up out of phase, and power
      // be lost between nodes.
      double in_light = 0.0, across = 0.0, across_m_sum = 0.0;
      for (const auto& corner : towards.corners()) {
        if (corner.weight == 0.0) continue;
        if (towards.lit(corner, one.number, one.p_W, counters)) {
          in_light += corner.weight;
          continue;
        }
        const float level_m = corner.node->number(one.number, [&] {
          ++counters.occlusion_rays;
          return across_m(one.p_W, corner.s_W, scene.scene());
        });
        if (!std::isfinite(level_m)) continue;
        across += corner.weight;
        across_m_sum += corner.weight * static_cast<double>(level_m);
      }
      if (across > 0.0) send(across * unlit, 2.0 * level * across_m_sum / across);
      if (in_light > 0.0) send(in_light * lit, 0.0);
    }
  }

  /// How far behind a place in the shadow, as the satellite sees it, a wall stands across the street: light comes to it
  /// from there 2 w cos(elevation) later. Infinite if nothing stands there within 100 m (assumed).
  static float across_m(const Eigen::Vector3d& p_W, const Eigen::Vector3d& s_W, const scene::Scene& scene) {
    const double level = s_W.head<2>().norm();
    if (level < 1e-6) return 0.0F;
    const Eigen::Vector3f away_W(static_cast<float>(-s_W.x() / level), static_cast<float>(-s_W.y() / level), 0.0F);
    const scene::Hit hit = scene::SceneAt(scene).trace({p_W, away_W, kAcross_m});
    return hit.hit() ? hit.range_m : std::numeric_limits<float>::infinity();
  }

  StreetClutterParameters own_;
  TwoStateLaw law_;
  StreetShading shading_;
  ClutterScatterers scatterers_;
  LatticeNoise passing_;
  mutable SightPool sights_;
  double weakest_;
};

}  // namespace

void street_clutter_parameters(ModelParameters& section) {
  section.add<StreetClutterParameters>();
}

void move_to_street(ModelParameters& clutter, std::int64_t by) {
  clutter.get<StreetClutterParameters>().street += by;
}

std::unique_ptr<ClutterModel> make_street_clutter(const ModelParameters& own, const PathParameters& p) {
  return std::make_unique<StreetClutter>(own.get<StreetClutterParameters>(), p);
}

}  // namespace canyon::gnss
