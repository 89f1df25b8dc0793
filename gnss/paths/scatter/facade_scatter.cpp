#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>

#include "canyon/core/units.h"
#include "canyon/gnss/paths/bounce.h"
#include "canyon/gnss/paths/rows/near_waves.h"
#include "canyon/gnss/paths/scatter/delay_bins.h"
#include "canyon/gnss/paths/scatter/directive_lobe.h"
#include "canyon/gnss/paths/scatter/facade_tiles.h"
#include "canyon/gnss/paths/scatter/scatter.h"
#include "canyon/gnss/paths/sight/point_sight.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {
namespace {

struct DirectiveParameters {
  std::optional<double> coefficient;
  std::int64_t lobe = 0;
  double tile_m = 8.0;
  double reach_m = 150.0;
};
void visit(FieldVisitor& f, DirectiveParameters& c) {
  f.optional_number("scatter_coefficient", c.coefficient, -1.0, {0.0, 0.95},
                    "scatter directive: S, field scattered over field given back, of all walls; -1 = each material's");
  f.integer("scatter_lobe", c.lobe, {0, 20},
            "scatter directive: exponent of the lobe of all walls; 0 = each material's");
  f.number("scatter_tile_m", c.tile_m, {1.0, 50.0}, "scatter directive: walls are cut into squares of this side");
  f.number("scatter_reach_m", c.reach_m, {10.0, 1000.0}, "scatter directive: walls farther away do not count");
}

constexpr double kConeSlack = 1e-5;  // of a projection, far beyond its rounding

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

  static constexpr std::size_t kNodes = 65;

 private:
  std::array<double, kNodes> nodes_;
};

/// What a material gives back, and where to it is scattered.
struct Scattering {
  Scattering(const scene::Material& material, double share_of_power, int exponent, double carrier_hz)
      : table(material, carrier_hz), share(share_of_power), lobe{exponent} {
    for (std::size_t i = 0; i < kNodes; ++i)
      integral_sr_[i] = lobe.integral_sr(static_cast<double>(i) / static_cast<double>(kNodes - 1));
    // Between two neighbours of these nodes, of which the table's are some, either function is straight.
    static_assert((kNodes - 1) % (ReturnTable::kNodes - 1) == 0);
    for (std::size_t i = 0; i + 1 < kNodes; ++i) {
      const double from = static_cast<double>(i) / static_cast<double>(kNodes - 1);
      const double to = static_cast<double>(i + 1) / static_cast<double>(kNodes - 1);
      most = std::max(
          most, share * std::max(table.at(from), table.at(to)) * to / std::min(integral_sr_[i], integral_sr_[i + 1]));
    }
  }
  double integral_sr(double cosine) const {
    const double x = cosine * static_cast<double>(kNodes - 1);
    const auto i = std::min(static_cast<std::size_t>(x), kNodes - 2);
    return integral_sr_[i] + (x - static_cast<double>(i)) * (integral_sr_[i + 1] - integral_sr_[i]);
  }

  ReturnTable table;
  double share;  ///< S^2
  DirectiveLobe lobe;
  double most = 0.0;  ///< of S^2 G^2 cos(incidence) over the lobe's integral

 private:
  static constexpr std::size_t kNodes = 257;
  std::array<double, kNodes> integral_sr_;
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
/// matters, so that nothing starts or ends at once. S and the lobe are the material's. Foliage and what moves are not
/// looked at.
class DirectiveScatter final : public ScatterModel {
 public:
  DirectiveScatter(const DirectiveParameters& own, const PathParameters& p)
      : own_(own), weakest_(std::pow(10.0, std::min(p.weakest_db, p.weakest_nlos_db) / 20.0)) {}

  ScatteredShare scattered_share() const override {
    return {.scatters = own_.coefficient != 0.0, .coefficient = own_.coefficient};
  }

  void trace(const Eigen::Vector3d& p_A_W, const PlaneWaves& waves, const scene::SceneAt& scene,
             std::span<SignalPaths> out, GnssCounters& counters) const override {
    if (waves.empty() || !scattered_share().scatters) return;
    const FacadeTiles& tiles = tiles_of(scene.scene());
    const SightPool::Loan sight = sights_.borrow(scene.scene());
    thread_local Bright bright;
    find_bright(tiles, p_A_W, waves, scene, bright);
    look(p_A_W, *sight, counters, bright);
    DelayBins bins;
    for (std::size_t k = 0; k < out.size(); ++k) {
      bins.clear(waves.wavelength_m(k));
      gather(bright, waves, k, scene, *sight, counters, bins);
      bins.append(0.5 * weakest_, SignalPath::kScattered, out[k].echoes);
    }
  }

 private:
  /// A tile that may send something that counts.
  struct Seen {
    std::uint32_t id;
    const FacadeTile* tile;
    Eigen::Vector3d to_W;  ///< unit, from the antenna
    double r_m, fade;      ///< 0 to 1, of the field
  };
  /// The tiles of an epoch that are near enough and stand in the right direction for some wave, and for which ones.
  struct Bright {
    std::vector<Seen> tiles;
    std::vector<std::vector<std::uint32_t>> of_wave;  ///< places in `tiles`, in their order
    std::vector<double> most_scattered;               ///< by material, of all waves
    std::vector<std::uint32_t> near;
    WaveAxes axes;
    NearWaves waves;
    std::vector<AxisAndWave> pairs;
  };

  /// Most tiles send less than counts towards the antenna, whatever hides them. The power above is no more than
  ///
  ///   A / (r^2 + A / (2 pi)) x most of S^2 G^2 cos(incidence) / (integral of the lobe) x ((1 + cos psi) / 2)^exponent,
  ///
  /// and cos psi is the direction's projection on the way to the antenna as the wall mirrors it: what may count comes
  /// from a cone about that.
  void find_bright(const FacadeTiles& tiles, const Eigen::Vector3d& p_W, const PlaneWaves& waves,
                   const scene::SceneAt& scene, Bright& out) const {
    out.tiles.clear();
    out.axes.clear();
    const double faint2 = 0.01 * weakest_ * weakest_;
    tiles.near(p_W, std::min(own_.reach_m, largest_reach_m(waves, scene, faint2, out)), out.near);
    for (const std::uint32_t i : out.near) {
      const FacadeTile& tile = tiles.tiles()[i];
      const Eigen::Vector3d way_W = tile.center_W - p_W;
      const double approach_m = way_W.dot(tile.normal_W);
      if (approach_m >= 0.0) continue;
      const double r2_m2 = way_W.squaredNorm();
      const double power = out.most_scattered[tile.material] * tile.area_m2 / (r2_m2 + tile.area_m2 / (2.0 * kPi));
      if (!(power > faint2)) continue;
      const double r_m = std::sqrt(r2_m2), fade = std::min(5.0 * (1.0 - r_m / own_.reach_m), 1.0);
      if (fade <= 0.0 || r_m < 1e-3) continue;
      const Eigen::Vector3d to_W = way_W / r_m;
      const double least =
          2.0 * std::pow(faint2 / power, 1.0 / exponent(scene.scene().materials()[tile.material])) - 1.0;
      out.axes.add(to_W - 2.0 * (approach_m / r_m) * tile.normal_W, 1.0 + kConeSlack, least - kConeSlack);
      out.tiles.push_back({i, &tile, to_W, r_m, fade});
    }
    out.waves.fill(waves.directions_W());
    out.waves.find(out.axes, out.pairs);
    keep_paired(waves.size(), out);
  }

  /// No tile beyond it counts. Fills in what materials scatter at most.
  double largest_reach_m(const PlaneWaves& waves, const scene::SceneAt& scene, double faint2, Bright& out) const {
    double most = 0.0;
    out.most_scattered.assign(scene.scene().materials().size(), 0.0);
    for (std::size_t i = 0; i < out.most_scattered.size(); ++i) {
      for (std::size_t k = 0; k < waves.size(); ++k) {
        if (k > 0 && waves.carrier_hz(k) == waves.carrier_hz(k - 1)) continue;
        out.most_scattered[i] =
            std::max(out.most_scattered[i], scattering(scene, static_cast<std::uint16_t>(i), waves.carrier_hz(k)).most);
      }
      most = std::max(most, out.most_scattered[i]);
    }
    return (1.0 + 1e-6) * own_.tile_m * std::sqrt(most / faint2);
  }

  /// Of the tiles those that a wave stands to, and for each wave its own.
  static void keep_paired(std::size_t waves, Bright& out) {
    out.of_wave.resize(std::max(out.of_wave.size(), waves));
    for (auto& of : out.of_wave) of.clear();
    std::size_t kept = 0;
    std::uint32_t last = ~0U;
    for (const AxisAndWave& pair : out.pairs) {
      if (pair.axis != last) {
        last = pair.axis;
        out.tiles[kept++] = out.tiles[pair.axis];
      }
      out.of_wave[pair.wave].push_back(static_cast<std::uint32_t>(kept - 1));
    }
    out.tiles.resize(kept);
  }

  static void look(const Eigen::Vector3d& p_W, PointSight& sight, GnssCounters& counters, Bright& bright) {
    const PointSight::From from = sight.from(p_W);
    for (Seen& one : bright.tiles) one.fade *= from.share(one.id, one.tile->center_W, counters);
  }

  void gather(const Bright& bright, const PlaneWaves& waves, std::size_t k, const scene::SceneAt& scene,
              PointSight& sight, GnssCounters& counters, DelayBins& bins) const {
    const Eigen::Vector3d& s = waves.direction_W(k);
    const PointSight::Towards towards = sight.towards(s);
    const double faint = 0.1 * weakest_;
    for (const std::uint32_t i : bright.of_wave[k]) {
      const Seen& one = bright.tiles[i];
      const FacadeTile& tile = *one.tile;
      const double cosine = tile.normal_W.dot(s);
      if (cosine <= 0.0 || one.fade == 0.0) continue;
      const double excess_m = one.r_m * (1.0 - one.to_W.dot(s));
      // The mirror's direction is 2 (n.s) n - s; the tile scatters towards -to.
      const double cos_psi = one.to_W.dot(s) - 2.0 * cosine * tile.normal_W.dot(one.to_W);
      const Scattering& wall = scattering(scene, tile.material, waves.carrier_hz(k));
      const double power = wall.share * wall.table.at(cosine) * tile.area_m2 * cosine * wall.lobe.at(cos_psi) /
                           (wall.integral_sr(cosine) * (one.r_m * one.r_m + tile.area_m2 / (2.0 * kPi)));
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

  /// Of the scene, made when it is first met; a sensor serves one.
  const FacadeTiles& tiles_of(const scene::Scene& scene) const {
    const std::scoped_lock lock(mutex_);
    if (scene_ != &scene) {
      tiles_ = std::make_unique<FacadeTiles>(scene, own_.tile_m);
      scatterings_.clear();
      scene_ = &scene;
    }
    return *tiles_;
  }

  int exponent(const scene::Material& material) const {
    return own_.lobe > 0 ? static_cast<int>(own_.lobe) : material.scatter_lobe;
  }

  /// At the carrier, rounded to 50 MHz.
  const Scattering& scattering(const scene::SceneAt& scene, std::uint16_t material, double carrier_hz) const {
    const std::scoped_lock lock(mutex_);
    const std::pair key(material, std::lround(carrier_hz / 50e6));
    auto at = scatterings_.find(key);
    if (at == scatterings_.end()) {
      const scene::Material& m = scene.scene().materials()[material];
      at =
          scatterings_.try_emplace(key, m, scattered_share().of(m), exponent(m), 50e6 * static_cast<double>(key.second))
              .first;
    }
    return at->second;
  }

  DirectiveParameters own_;
  double weakest_;
  mutable SightPool sights_;
  mutable std::mutex mutex_;
  mutable const scene::Scene* scene_ = nullptr;
  mutable std::unique_ptr<FacadeTiles> tiles_;
  mutable std::map<std::pair<std::uint16_t, long>, Scattering> scatterings_;
};

}  // namespace

void directive_scatter_parameters(ModelParameters& section) {
  section.add<DirectiveParameters>();
}

std::unique_ptr<ScatterModel> make_directive_scatter(const ModelParameters& own, const PathParameters& p) {
  return std::make_unique<DirectiveScatter>(own.get<DirectiveParameters>(), p);
}

}  // namespace canyon::gnss
