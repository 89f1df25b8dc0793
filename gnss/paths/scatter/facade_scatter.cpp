#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>

#include "canyon/core/units.h"
#include "canyon/gnss/paths/bounce.h"
#include "canyon/gnss/paths/scatter/delay_bins.h"
#include "canyon/gnss/paths/scatter/directive_lobe.h"
#include "canyon/gnss/paths/scatter/facade_tiles.h"
#include "canyon/gnss/paths/scatter/scatter.h"
#include "canyon/gnss/paths/sight/point_sight.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {
namespace {

struct DirectiveParameters {
  double coefficient = 0.4;
  std::int64_t lobe = 4;
  double tile_m = 8.0;
  double reach_m = 150.0;
};
void visit(FieldVisitor& f, DirectiveParameters& c) {
  f.number("scatter_coefficient", c.coefficient, {0.0, 0.95},
           "scatter directive: S, field scattered over field given back; 0.4 is assumed for all walls");
  f.integer("scatter_lobe", c.lobe, {1, 20}, "scatter directive: exponent of the lobe; 4 is assumed");
  f.number("scatter_tile_m", c.tile_m, {1.0, 50.0}, "scatter directive: walls are cut into squares of this side");
  f.number("scatter_reach_m", c.reach_m, {10.0, 1000.0}, "scatter directive: walls farther away do not count");
}

/// Share of the power that a material gives back, both polarizations alike, by the cosine of incidence.
class ReturnTable {
 public:
  ReturnTable(const scene::Material& material, double carrier_hz) {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const double cosine = static_cast<double>(i) / static_cast<double>(nodes_.size() - 1);
      const Eigen::Vector3d incoming(std::sqrt(1.0 - cosine * cosine), 0.0, -cosine);
      const Bounce b = bounce_off(material, incoming, Eigen::Vector3d::UnitZ(), 0.0, carrier_hz);
      nodes_[i] = 0.5 * (std::norm(b.coefficients.te) + std::norm(b.coefficients.tm));
    }
  }
  double at(double cosine) const {
    const double x = cosine * static_cast<double>(nodes_.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(x), nodes_.size() - 2);
    return nodes_[i] + (x - static_cast<double>(i)) * (nodes_[i + 1] - nodes_[i]);
  }

 private:
  std::array<double, 65> nodes_;
};

/// Each tile of a wall that is lit scatters S^2 of what the wall gives back, G^2 of the power that falls on it, into
/// the lobe about its mirror's direction; the mirrors are left sqrt(1 - S^2) of their field. At the antenna, r away,
/// relative to the free direct signal:
///
///   |E|^2 = S^2 G^2 A cos(incidence) lobe(psi) / (integral of the lobe x (r^2 + A / (2 pi))),
///
/// the last term because a tile nearby is no point. Both ways are tested for obstacles at the tile's middle, as a share
/// of the field that changes evenly with place and direction (PointSight): a tile of 8 m comes out of a shadow by and
/// by. Fields fade out towards the reach (its last fifth), and over 6 dB above a tenth of the weakest field that
/// matters, so that nothing starts or ends at once. Foliage and what moves are not looked at.
class DirectiveScatter final : public ScatterModel {
 public:
  DirectiveScatter(const DirectiveParameters& own, const PathParameters& p)
      : own_(own),
        lobe_{static_cast<int>(own.lobe)},
        weakest_(std::pow(10.0, std::min(p.weakest_db, p.weakest_nlos_db) / 20.0)) {
    for (std::size_t i = 0; i < lobe_sr_.size(); ++i)
      lobe_sr_[i] = lobe_.integral_sr(static_cast<double>(i) / static_cast<double>(lobe_sr_.size() - 1));
  }

  double scattered_share() const override { return own_.coefficient * own_.coefficient; }

  void trace(const Eigen::Vector3d& p_A_W, const PlaneWaves& waves, const scene::SceneAt& scene,
             std::span<SignalPaths> out, GnssCounters& counters) const override {
    if (waves.empty() || own_.coefficient == 0.0) return;
    const FacadeTiles& tiles = tiles_of(scene.scene());
    const SightPool::Loan sight = sights_.borrow(scene.scene());
    thread_local std::vector<Seen> seen;
    look(tiles, p_A_W, *sight, counters, seen);
    DelayBins bins;
    for (std::size_t k = 0; k < out.size(); ++k) {
      bins.clear(waves.wavelength_m(k));
      gather(seen, waves, k, scene, *sight, counters, bins);
      bins.append(0.5 * weakest_, SignalPath::kScattered, out[k].echoes);
    }
  }

 private:
  /// A tile that is seen from the antenna.
  struct Seen {
    std::uint32_t id;
    const FacadeTile* tile;
    Eigen::Vector3d to_W;  ///< unit, from the antenna
    double r_m, fade;      ///< 0 to 1, of the field
  };

  void look(const FacadeTiles& tiles, const Eigen::Vector3d& p_W, PointSight& sight, GnssCounters& counters,
            std::vector<Seen>& seen) const {
    seen.clear();
    const PointSight::From from = sight.from(p_W);
    thread_local std::vector<std::uint32_t> near;
    tiles.near(p_W, own_.reach_m, near);
    for (const std::uint32_t i : near) {
      const FacadeTile& tile = tiles.tiles()[i];
      const Eigen::Vector3d way_W = tile.center_W - p_W;
      if (way_W.dot(tile.normal_W) >= 0.0) continue;
      const double r_m = way_W.norm(), fade = std::min(5.0 * (1.0 - r_m / own_.reach_m), 1.0);
      if (fade <= 0.0 || r_m < 1e-3) continue;
      const double share = from.share(i, tile.center_W, counters);
      if (share > 0.0) seen.push_back({i, &tile, way_W / r_m, r_m, fade * share});
    }
  }

  void gather(const std::vector<Seen>& seen, const PlaneWaves& waves, std::size_t k, const scene::SceneAt& scene,
              PointSight& sight, GnssCounters& counters, DelayBins& bins) const {
    const Eigen::Vector3d& s = waves.direction_W(k);
    const PointSight::Towards towards = sight.towards(s);
    const double faint = 0.1 * weakest_;
    const ReturnTable* table = nullptr;  // of the tile before, mostly the same wall's
    std::uint16_t of_table = 0;
    for (const Seen& one : seen) {
      const FacadeTile& tile = *one.tile;
      if (table == nullptr || of_table != tile.material) {
        table = &returned(scene, tile.material, waves.carrier_hz(k));
        of_table = tile.material;
      }
      const double cosine = tile.normal_W.dot(s);
      if (cosine <= 0.0) continue;
      const double excess_m = one.r_m * (1.0 - one.to_W.dot(s));
      // The mirror's direction is 2 (n.s) n - s; the tile scatters towards -to.
      const double cos_psi = one.to_W.dot(s) - 2.0 * cosine * tile.normal_W.dot(one.to_W);
      const double power = scattered_share() * table->at(cosine) * tile.area_m2 * cosine * lobe_.at(cos_psi) /
                           (lobe_sr(cosine) * (one.r_m * one.r_m + tile.area_m2 / (2.0 * kPi)));
      const double amplitude = std::sqrt(power);
      const double kept = one.fade * std::clamp(amplitude / faint - 1.0, 0.0, 1.0);
      if (kept == 0.0) continue;
      const double lit = towards.share(one.id, tile.center_W, counters);
      if (lit == 0.0) continue;
      // Half of the power to each hand: an assumption.
      const double a = lit * kept * amplitude * std::sqrt(0.5);
      bins.add({a * tile.phase, a * tile.cross_phase}, excess_m, one.to_W, a * a);
    }
  }

  double lobe_sr(double cosine) const {
    const double x = cosine * static_cast<double>(lobe_sr_.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(x), lobe_sr_.size() - 2);
    return lobe_sr_[i] + (x - static_cast<double>(i)) * (lobe_sr_[i + 1] - lobe_sr_[i]);
  }

  /// Of the scene, made when it is first met; a sensor serves one.
  const FacadeTiles& tiles_of(const scene::Scene& scene) const {
    const std::scoped_lock lock(mutex_);
    if (scene_ != &scene) {
      tiles_ = std::make_unique<FacadeTiles>(scene, own_.tile_m);
      returns_.clear();
      scene_ = &scene;
    }
    return *tiles_;
  }

  /// At the first carrier met within 50 MHz.
  const ReturnTable& returned(const scene::SceneAt& scene, std::uint16_t material, double carrier_hz) const {
    const std::scoped_lock lock(mutex_);
    const std::pair key(material, std::lround(carrier_hz / 50e6));
    auto at = returns_.find(key);
    if (at == returns_.end())
      at = returns_
               .emplace(key, ReturnTable(scene.scene().materials()[material], 50e6 * static_cast<double>(key.second)))
               .first;
    return at->second;
  }

  DirectiveParameters own_;
  DirectiveLobe lobe_;
  double weakest_;
  std::array<double, 257> lobe_sr_;
  mutable SightPool sights_;
  mutable std::mutex mutex_;
  mutable const scene::Scene* scene_ = nullptr;
  mutable std::unique_ptr<FacadeTiles> tiles_;
  mutable std::map<std::pair<std::uint16_t, long>, ReturnTable> returns_;
};

}  // namespace

void directive_scatter_parameters(ModelParameters& section) {
  section.add<DirectiveParameters>();
}

std::unique_ptr<ScatterModel> make_directive_scatter(const ModelParameters& own, const PathParameters& p) {
  return std::make_unique<DirectiveScatter>(own.get<DirectiveParameters>(), p);
}

}  // namespace canyon::gnss
