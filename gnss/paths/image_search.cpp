#include "canyon/gnss/paths/image_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "canyon/gnss/paths/beam.h"
#include "canyon/gnss/paths/bounce.h"
#include "canyon/gnss/paths/diffraction/knife_edge.h"
#include "canyon/gnss/paths/diffraction/leg_shadow.h"
#include "canyon/gnss/paths/diffraction/mirror_borders.h"
#include "canyon/gnss/paths/rows/facet_rows.h"
#include "canyon/gnss/paths/rows/near_waves.h"
#include "canyon/gnss/paths/skyline.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {
namespace {

// A leg starts and ends this far in front of a mirror, beyond what its corners deviate from its plane, so that the
// mirror does not block its own reflection in single precision.
constexpr double kClearance_m = 2e-3;

/// Memory that a search uses, kept from epoch to epoch.
struct Workspace {
  NearWaves waves;
  WaveAxes axes;
  std::vector<AxisAndWave> pairs;
  FacetRows rows;
  std::vector<std::uint32_t> first, near;
  std::vector<std::uint32_t> alone, sorted;  ///< facets that mirror beside their borders, by themselves
  std::vector<std::uint32_t> last;           ///< facets at the end of sequences that are looked at together
  std::array<std::vector<std::uint32_t>, SignalPath::kMaxReflections> met;
};

/// One epoch's search, depth first over sequences of facets f1, f2, ... in order from the antenna. Image k is the
/// antenna mirrored at f1 ... fk; the way over them to satellite s is the straight line from image k towards s, folded.
class ImageSearch {
 public:
  ImageSearch(int order, const PathParameters& p, double largest_nu, const Eigen::Vector3d& p_A_W,
              const PlaneWaves& waves, const scene::SceneAt& scene, std::span<SignalPaths> out, GnssCounters& counters,
              Workspace& work)
      : order_(order),
        p_(p),
        antenna_W_(p_A_W),
        waves_(waves),
        scene_(scene),
        facets_(scene.scene().facets().facets()),
        work_(work),
        out_(out),
        counters_(counters),
        weakest_(std::pow(10.0, p.weakest_db / 20.0)),
        weakest_nlos_(std::pow(10.0, p.weakest_nlos_db / 20.0)),
        reach_per_area_(p.finite_facets ? 1.0 / (waves.shortest_wavelength_m() * std::min(weakest_, weakest_nlos_))
                                        : std::numeric_limits<double>::infinity()),
        bend_m_(largest_detour_m(largest_nu, waves.longest_wavelength_m())) {}

  void run() {
    work_.alone.clear();
    work_.waves.fill(waves_.directions_W());
    choose_facets();
    for (const std::uint32_t id : work_.first) {
      sequence_[0] = id;
      extend(1, antenna_W_, order_);
    }
    for (const std::uint32_t id : work_.alone) {
      sequence_[0] = id;
      extend(1, antenna_W_, 1);
    }
  }

 private:
  void choose_facets() {
    const scene::FacetIndex& index = scene_.scene().facets();
    std::vector<std::uint32_t>& ids = work_.rows.ids;
    if (p_.exhaustive) {
      ids.resize(facets_.size());
      for (std::uint32_t i = 0; i < facets_.size(); ++i) ids[i] = i;
    } else {
      double lowest = 1.0;
      for (const Eigen::Vector3d& s : waves_.directions_W()) lowest = std::min(lowest, s.z());
      lowest = std::asin(std::clamp(lowest, 0.0, 1.0));
      index.mirrors(antenna_W_, lowest, reach_per_area_, p_.leaning_reach_m, ids);
      if (order_ > 1 || bend_m_ > 0.0) add_near(index, ids);
      if (bend_m_ > 0.0) add_alone(index, lowest);
    }
    const auto absorbs = [&](std::uint32_t i) { return scene_.scene().materials()[facets_[i].material].rf_absorbing; };
    std::erase_if(ids, absorbs);
    if (order_ > 1) work_.rows.fill(facets_);

    std::vector<std::uint32_t>& first = work_.first;
    std::vector<std::uint32_t>& alone = work_.alone;
    std::erase_if(alone, [&](std::uint32_t i) { return absorbs(i) || !in_reach(facets_[i], antenna_W_); });
    first.clear();
    for (const std::uint32_t i : ids)
      if (in_reach(facets_[i], antenna_W_)) first.push_back(i);
    if (p_.exhaustive) return;
    const Skyline skyline(antenna_W_, facets_, ids);
    for (std::vector<std::uint32_t>* of : {&first, &alone})
      std::erase_if(*of, [&](std::uint32_t i) { return skyline.hides(facets_[i]); });
  }

  /// Walls lower than the lowest satellite, which mirror it beside their borders.
  void add_alone(const scene::FacetIndex& index, double lowest_rad) {
    index.mirrors(antenna_W_, lowest_rad, reach_per_area_, p_.leaning_reach_m, work_.alone, bend_m_);
    work_.sorted = work_.rows.ids;
    std::sort(work_.sorted.begin(), work_.sorted.end());
    std::erase_if(work_.alone,
                  [&](std::uint32_t i) { return std::binary_search(work_.sorted.begin(), work_.sorted.end(), i); });
  }

  void add_near(const scene::FacetIndex& index, std::vector<std::uint32_t>& ids) {
    std::vector<std::uint32_t>& near = work_.near;
    index.near(antenna_W_, p_.combine_all_m, near);
    std::vector<bool> known(near.size(), false);
    for (const std::uint32_t id : ids) {
      const auto at = std::lower_bound(near.begin(), near.end(), id);
      if (at != near.end() && *at == id) known[static_cast<std::size_t>(at - near.begin())] = true;
    }
    for (std::size_t k = 0; k < near.size(); ++k)
      if (!known[k]) ids.push_back(near[k]);
  }

  /// Does the facet face the image, and is it, if small, near enough to reflect enough?
  bool in_reach(const scene::Facet& f, const Eigen::Vector3d& image_W) const {
    const double to_plane_m = f.normal_W.dot(image_W) - f.offset_m;
    if (to_plane_m <= 0.0) return false;
    if (!p_.finite_facets) return true;
    const double distance_m = std::max((f.center_W - image_W).norm() - f.radius_m, 0.0);
    return distance_m * distance_m <= reach_per_area_ * f.area_m2 * to_plane_m;
  }

  /// The sequence has `count` facets, and may have `most`; `before_W` is the image before the last.
  void extend(int count, const Eigen::Vector3d& before_W, int most) {
    const auto k = static_cast<std::size_t>(count);
    const scene::Facet& last = facets_[sequence_[k - 1]];
    const Eigen::Vector3d image_W = mirrored(last, before_W);
    images_W_[k - 1] = image_W;
    work_.last.assign(1, sequence_[k - 1]);
    satellites(count, before_W);
    if (count == most) return;

    std::vector<std::uint32_t>& met = work_.met[k];
    work_.rows.meet(last, Beam(image_W, last, beside_m(last, image_W)), met);
    std::erase_if(met, [&](std::uint32_t id) { return id == sequence_[k - 1] || !in_reach(facets_[id], image_W); });
    if (count + 1 == most) {
      work_.last = met;
      satellites(most, image_W);
      return;
    }
    for (const std::uint32_t id : met) {
      sequence_[k] = id;
      extend(count + 1, image_W, most);
    }
  }

  static Eigen::Vector3d mirrored(const scene::Facet& f, const Eigen::Vector3d& p_W) {
    return p_W - 2.0 * (f.normal_W.dot(p_W) - f.offset_m) * f.normal_W;
  }

  /// Sequences of `count` facets that end with one of `work_.last` each, `before_W` being the image before that: which
  /// satellites may stand where one looks from the image through the last facet?
  void satellites(int count, const Eigen::Vector3d& before_W) {
    const auto k = static_cast<std::size_t>(count);
    counters_.facets_tested += static_cast<std::int64_t>(work_.last.size());
    WaveAxes& axes = work_.axes;
    axes.clear();
    for (const std::uint32_t id : work_.last) {
      const Cone cone = cone_of(facets_[id], mirrored(facets_[id], before_W));
      axes.add(cone.axis_W, 1.0, cone.least);
    }
    work_.waves.find(axes, work_.pairs);
    const Cone before = k > 1 ? cone_of(facets_[sequence_[k - 2]], before_W) : Cone{};
    std::uint32_t at = ~0U;
    Eigen::Vector3d through_W = Eigen::Vector3d::Zero();
    for (const AxisAndWave& pair : work_.pairs) {
      if (pair.axis != at) {
        at = pair.axis;
        sequence_[k - 1] = work_.last[at];
        const scene::Facet& last = facets_[sequence_[k - 1]];
        images_W_[k - 1] = mirrored(last, before_W);
        through_W = before.axis_W - 2.0 * last.normal_W.dot(before.axis_W) * last.normal_W;
      }
      // Most that the last facet mirrors passes the one before it by.
      if (through_W.dot(waves_.direction_W(pair.wave)) >= before.least) try_satellite(count, pair.wave);
    }
  }

  /// The directions from an image in which the ball around a facet may be met; all of them from within the ball.
  struct Cone {
    Eigen::Vector3d axis_W = Eigen::Vector3d::Zero();
    double least = 0.0;
  };
  Cone cone_of(const scene::Facet& f, const Eigen::Vector3d& image_W) const {
    const Eigen::Vector3d to_center_W = f.center_W - image_W;
    const double distance_m = to_center_W.norm(), radius_m = f.radius_m + beside_m(f, image_W);
    if (distance_m <= radius_m) return {};
    const double sine = radius_m / distance_m;
    return {to_center_W / distance_m, std::sqrt(1.0 - sine * sine) - 1e-5};
  }

  /// How far from a facet, across the way, a wave may pass that its borders still send on.
  double beside_m(const scene::Facet& f, const Eigen::Vector3d& image_W) const {
    return bend_m_ > 0.0 ? std::sqrt(2.0 * bend_m_ * ((f.center_W - image_W).norm() + f.radius_m)) : 0.0;
  }

  void try_satellite(int count, std::size_t satellite) {
    const Eigen::Vector3d& s = waves_.direction_W(satellite);
    const auto k = static_cast<std::size_t>(count);
    const double excess_m = (antenna_W_ - images_W_[k - 1]).dot(s);
    const bool visible = out_[satellite].line_of_sight;
    if (visible && excess_m > p_.cutoff_m) return;
    std::array<Eigen::Vector3d, SignalPath::kMaxReflections> points_W;
    std::array<bool, SignalPath::kMaxReflections> held;
    if (!fold(k, s, points_W, held)) return;
    SignalPath path = field(k, satellite, points_W);
    const double least = visible ? weakest_ : weakest_nlos_;
    const double amplitude2 = std::norm(path.copolar) + std::norm(path.crosspolar);
    if (!(amplitude2 > 0.0) || amplitude2 < least * least) return;
    path.excess_m = excess_m;
    if (p_.reflection_borders) {
      fade_at_borders(k, satellite, least, held, points_W, path);
      if (path.copolar == 0.0 && path.crosspolar == 0.0) return;  // what has faded is weaker than `least`
    } else if (!clear_way(nodes_of(k, points_W), k, s)) {
      return;
    }
    add_foliage(nodes_of(k, points_W), k, s, path);
    path.arrival_W = (points_W[0] - antenna_W_).normalized();
    path.reflections = count;
    for (std::size_t j = 0; j < k; ++j) path.facets[j] = sequence_[j];
    out_[satellite].echoes.push_back(path);
    ++counters_.reflected_paths;
  }

  /// The reflection points, from the satellite's end back to the antenna, and does the facet hold each. False if one
  /// lies outside of its facet, or too far outside where borders send on, or a facet would be met from behind.
  bool fold(std::size_t k, const Eigen::Vector3d& s, std::array<Eigen::Vector3d, SignalPath::kMaxReflections>& points_W,
            std::array<bool, SignalPath::kMaxReflections>& held) const {
    std::array<double, SignalPath::kMaxReflections> outside_m;  // how far, in the facets' planes
    Eigen::Vector3d towards_W = s;  // direction of travel away from the antenna, after the reflection at hand
    for (std::size_t j = k; j-- > 0;) {
      const scene::Facet& f = facets_[sequence_[j]];
      const double cos_incidence = f.normal_W.dot(towards_W);
      if (cos_incidence <= 0.0) return false;
      const Eigen::Vector3d& from_W = images_W_[j];
      const double way_m = (f.offset_m - f.normal_W.dot(from_W)) / cos_incidence;
      if (way_m <= 0.0) return false;
      points_W[j] = from_W + way_m * towards_W;
      // Across the way it lies at least cos_incidence times as far outside as in the plane.
      outside_m[j] = beside_m(f, from_W) / cos_incidence;
      const double reach_m = f.radius_m + outside_m[j];
      if ((points_W[j] - f.center_W).squaredNorm() > reach_m * reach_m * (1.0 + 1e-12)) return false;
      if (j + 1 < k && f.normal_W.dot(points_W[j + 1]) <= f.offset_m) return false;
      if (j + 1 < k) {
        const scene::Facet& after = facets_[sequence_[j + 1]];
        if (after.normal_W.dot(points_W[j]) <= after.offset_m) return false;
      }
      towards_W -= 2.0 * cos_incidence * f.normal_W;
    }
    for (std::size_t j = 0; j < k; ++j) {
      const scene::Facet& f = facets_[sequence_[j]];
      held[j] = scene::facet_contains(f, scene_.scene(), points_W[j]);
      if (held[j]) continue;
      if (!p_.reflection_borders) return false;
      if ((nearest_of_border(f, points_W[j]) - points_W[j]).squaredNorm() > outside_m[j] * outside_m[j]) return false;
    }
    return true;
  }

  /// What the facets' sizes and what stands beside the legs leave of the field. It fades out over 3.5 dB above the
  /// weakest that is followed, on the way too: what is too weak after one of them is not raised by the next. A point
  /// that a facet does not hold moves onto its border.
  void fade_at_borders(std::size_t k, std::size_t satellite, double least,
                       const std::array<bool, SignalPath::kMaxReflections>& held,
                       std::array<Eigen::Vector3d, SignalPath::kMaxReflections>& points_W, SignalPath& path) {
    const double full = std::sqrt(std::norm(path.copolar) + std::norm(path.crosspolar));
    std::complex<double> share = 1.0;
    double needed = 0.0, kept = 1.0;  // what of what comes in is too weak, and matters
    const auto passes = [&](const std::complex<double>& part) {
      share *= part;
      const double strength = std::abs(share) * full;
      needed = least / strength;
      kept = std::min(kept, 2.0 * (strength / least - 1.0));
      return kept > 0.0;
    };
    const std::array<MirroredWave, SignalPath::kMaxReflections> mirrored = waves_at(k, satellite, points_W);
    bool followed = passes(1.0) && may_pass(k, held, mirrored, needed);
    for (std::size_t j = k; followed && j-- > 0;) {
      const scene::Facet& f = facets_[sequence_[j]];
      followed = passes(mirrored_share(f, held[j], mirrored[j], kFaintestBorder));
      if (!held[j]) points_W[j] = nearest_of_border(f, points_W[j]);
    }
    const Nodes nodes_W = nodes_of(k, points_W);
    // From the satellite's end, which is blocked most often.
    for (std::size_t j = k + 1; followed && j-- > 0;) {
      MirroredLeg leg{.from_W = nodes_W[j],
                      .towards_W = waves_.direction_W(satellite),
                      .wavelength_m = waves_.wavelength_m(satellite)};
      if (j < k) {
        const Eigen::Vector3d way_W = nodes_W[j + 1] - nodes_W[j];
        leg.length_m = way_W.norm();
        leg.towards_W = way_W / leg.length_m;
        leg.mirrors[1] = &facets_[sequence_[j]];
      }
      if (j > 0) {
        leg.behind_m = (nodes_W[j] - images_W_[j - 1]).norm();
        leg.mirrors[0] = &facets_[sequence_[j - 1]];
      }
      followed = passes(leg_share(leg, std::max(needed, kFaintestBorder), scene_, counters_, needed));
    }
    share *= followed ? kept : 0.0;
    path.copolar *= share;
    path.crosspolar *= share;
  }

  /// The wave as each facet meets it, where it meets the facet's plane.
  std::array<MirroredWave, SignalPath::kMaxReflections> waves_at(
      std::size_t k, std::size_t satellite,
      const std::array<Eigen::Vector3d, SignalPath::kMaxReflections>& points_W) const {
    std::array<MirroredWave, SignalPath::kMaxReflections> out;
    Eigen::Vector3d towards_W = waves_.direction_W(satellite);
    for (std::size_t j = k; j-- > 0;) {
      const scene::Facet& f = facets_[sequence_[j]];
      out[j] = {images_W_[j], towards_W, points_W[j], waves_.wavelength_m(satellite)};
      towards_W -= 2.0 * towards_W.dot(f.normal_W) * f.normal_W;
    }
    return out;
  }

  /// Can the facets together mirror more than `needed`? First those beside whose borders it passes.
  bool may_pass(std::size_t k, const std::array<bool, SignalPath::kMaxReflections>& held,
                const std::array<MirroredWave, SignalPath::kMaxReflections>& mirrored, double needed) const {
    double most = std::pow(kMostMirrored, static_cast<double>(k));
    for (const bool holds : {false, true})
      for (std::size_t j = k; j-- > 0;) {
        if (held[j] != holds) continue;
        most *= most_mirrored(facets_[sequence_[j]], holds, mirrored[j], kFaintestBorder) / kMostMirrored;
        if (most <= needed) return false;
      }
    return true;
  }

  SignalPath field(std::size_t k, std::size_t satellite,
                   const std::array<Eigen::Vector3d, SignalPath::kMaxReflections>& points_W) const {
    std::array<Bounce, SignalPath::kMaxReflections> bounces;  // in the order of propagation
    const double wavelength_m = waves_.wavelength_m(satellite);
    Eigen::Vector3d incoming_W = -waves_.direction_W(satellite);
    for (std::size_t j = k; j-- > 0;) {
      const scene::Facet& f = facets_[sequence_[j]];
      const scene::Material& material = scene_.scene().materials()[f.material];
      Bounce& b = bounces[k - 1 - j];
      b = bounce_off(material, incoming_W, f.normal_W, p_.roughness_m, waves_.carrier_hz(satellite));
      b.factor *= mirror_factor(f.normal_W, p_.scattered_share.of(material));
      if (p_.finite_facets && !p_.reflection_borders) {
        const double cos_incidence = std::clamp(-incoming_W.dot(f.normal_W), 0.0, 1.0);
        const double distance_m = (points_W[j] - images_W_[j]).norm();
        b.factor *= finite_facet_factor(f.area_m2, cos_incidence, wavelength_m, distance_m);
      }
      incoming_W -= 2.0 * incoming_W.dot(f.normal_W) * f.normal_W;
    }
    const CircularField field = reflected_field({bounces.data(), k});
    SignalPath path;
    path.copolar = field.copolar;
    path.crosspolar = field.crosspolar;
    return path;
  }

  /// The antenna and the reflection points, a little before their facets.
  using Nodes = std::array<Eigen::Vector3d, SignalPath::kMaxReflections + 1>;
  Nodes nodes_of(std::size_t k, const std::array<Eigen::Vector3d, SignalPath::kMaxReflections>& points_W) const {
    Nodes nodes_W;
    nodes_W[0] = antenna_W_;
    for (std::size_t j = 0; j < k; ++j) {
      const scene::Facet& f = facets_[sequence_[j]];
      nodes_W[j + 1] = points_W[j] + (kClearance_m + f.flatness_m) * f.normal_W;
    }
    return nodes_W;
  }

  /// Is every leg free?
  bool clear_way(const Nodes& nodes_W, std::size_t k, const Eigen::Vector3d& s) {
    // From the satellite's end, which is blocked most often.
    ++counters_.occlusion_rays;
    if (scene_.blocked_towards(nodes_W[k], s)) return false;
    for (std::size_t j = k; j-- > 0;) {
      const Eigen::Vector3d leg_W = nodes_W[j + 1] - nodes_W[j];
      const double leg_m = leg_W.norm();
      ++counters_.occlusion_rays;
      if (scene_.blocked_towards(nodes_W[j], leg_W / leg_m, leg_m)) return false;
    }
    return true;
  }

  /// What of the way leads through foliage.
  void add_foliage(const Nodes& nodes_W, std::size_t k, const Eigen::Vector3d& s, SignalPath& path) const {
    path.foliage_m = scene_.foliage_m(nodes_W[k], s);
    for (std::size_t j = 0; j < k; ++j) {
      const Eigen::Vector3d leg_W = nodes_W[j + 1] - nodes_W[j];
      const double leg_m = leg_W.norm();
      path.foliage_m += scene_.foliage_m(nodes_W[j], leg_W / leg_m, leg_m);
    }
  }

  int order_;
  const PathParameters& p_;
  Eigen::Vector3d antenna_W_;
  const PlaneWaves& waves_;
  const scene::SceneAt& scene_;
  const std::vector<scene::Facet>& facets_;
  Workspace& work_;
  std::span<SignalPaths> out_;
  GnssCounters& counters_;
  double weakest_, weakest_nlos_, reach_per_area_;
  double bend_m_;  ///< longest detour over a border that sends on; 0 if none does

  std::array<std::uint32_t, SignalPath::kMaxReflections> sequence_;
  std::array<Eigen::Vector3d, SignalPath::kMaxReflections> images_W_;
};

}  // namespace

void find_images(int order, const PathParameters& p, double largest_nu, const Eigen::Vector3d& p_A_W,
                 const PlaneWaves& waves, const scene::SceneAt& scene, std::span<SignalPaths> out,
                 GnssCounters& counters) {
  if (waves.empty()) return;
  thread_local Workspace work;
  ImageSearch(order, p, largest_nu, p_A_W, waves, scene, out, counters, work).run();
}

}  // namespace canyon::gnss
