#include "canyon/gnss/paths/diffraction/leg_shadow.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/gnss/paths/diffraction/edge_air.h"
#include "canyon/gnss/paths/diffraction/knife_edge.h"
#include "canyon/gnss/paths/diffraction/screen_edge.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/surfaces/edge.h"

namespace canyon::gnss {
namespace {

constexpr double kInPlane_m = 0.05;
constexpr double kSame_m = 0.01;

/// In the mirror's plane, or behind it, where nothing hides what goes on before it.
bool is_not_before(const scene::Edge& edge, const scene::Facet* mirror) {
  if (mirror == nullptr) return false;
  const auto before_m = [&](const Eigen::Vector3d& p_W) { return mirror->normal_W.dot(p_W) - mirror->offset_m; };
  return before_m(edge.a_W) < kInPlane_m && before_m(edge.b_W) < kInPlane_m;
}

/// An edge that the leg passes, or several that overlap on one line.
struct Passed {
  const scene::Edge* edge;
  Eigen::Vector3d a_W, b_W;
  ScreenEdge screen;
  Eigen::Vector3d point_W, along_W;  ///< where the way over it is shortest; unit
  Eigen::Vector3d across_W;          ///< unit, across edge and leg, away from what throws the shadow
  double lit_m;                      ///< how far along it the leg lies from the shadow's border; in the shadow below 0

  Passed(const scene::Edge& e, const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W, const ScreenEdge& s,
         const MirroredLeg& leg)
      : edge(&e), a_W(from_W), b_W(to_W), screen(s), along_W((to_W - from_W).normalized()) {
    point_W = a_W + s.at_m() * along_W;
    across_W = along_W.cross(leg.towards_W).normalized();
    if (across_W.dot(e.outward_W) < 0.0) across_W = -across_W;
    lit_m = across_W.dot(leg.from_W - a_W);
  }
  double length_m() const { return (b_W - a_W).norm(); }
};

/// From where to where along the one both reach together, if they lie over one another on one line and look the same
/// way: houses that share an edge have it twice. One that goes on where another ends is another, and so is one that
/// looks the other way: what sheets side by side make where they meet cancels out.
std::optional<std::pair<double, double>> reach_together_m(const Passed& one, const Passed& other) {
  if (std::abs(other.along_W.dot(one.along_W)) < 0.999 || other.across_W.dot(one.across_W) < 0.0) return std::nullopt;
  const Eigen::Vector3d a_W = other.a_W - one.a_W, b_W = other.b_W - one.a_W;
  if (a_W.cross(one.along_W).norm() > kSame_m || b_W.cross(one.along_W).norm() > kSame_m) return std::nullopt;
  const auto [first_m, last_m] = std::minmax({a_W.dot(one.along_W), b_W.dot(one.along_W)});
  if (std::min(last_m, one.length_m()) - std::max(first_m, 0.0) <= kSame_m) return std::nullopt;
  return std::pair{std::min(first_m, 0.0), std::max(last_m, one.length_m())};
}

/// Is the edge seen from both ends of the leg? What throws the shadow does not hide its own edge from within it: it is
/// asked for from the shadow's border, beside the end.
bool is_seen(const Passed& passed, const MirroredLeg& leg, const scene::SceneAt& scene, GnssCounters& counters) {
  const Eigen::Vector3d at_W = passed.point_W + kOffEdge_m * passed.edge->outward_W;
  const Eigen::Vector3d aside_W = std::max(kOffEdge_m - passed.lit_m, 0.0) * passed.across_W;
  const auto sees = [&](const Eigen::Vector3d& end_W, const scene::Facet* mirror) {
    Eigen::Vector3d way_W = end_W + aside_W - at_W;
    if (mirror != nullptr) {
      // Beside the end the mirror's plane may be nearer.
      const double in_front_m = mirror->normal_W.dot(end_W) - mirror->offset_m;
      const double here_m = mirror->normal_W.dot(at_W) - mirror->offset_m,
                   there_m = here_m + mirror->normal_W.dot(way_W);
      if (here_m <= in_front_m) return true;
      if (there_m < in_front_m) way_W *= (here_m - in_front_m) / (here_m - there_m);
    }
    const double way_m = way_W.norm();
    ++counters.occlusion_rays;
    return !(way_m > 0.0) || !scene.blocked_towards(at_W, way_W / way_m, way_m);
  };
  if (!sees(leg.from_W, leg.mirrors[0])) return false;
  if (std::isfinite(leg.length_m)) return sees(leg.from_W + leg.length_m * leg.towards_W, leg.mirrors[1]);
  ++counters.occlusion_rays;
  return !scene.blocked_towards(at_W, leg.towards_W);
}

bool is_clear(const MirroredLeg& leg, const scene::SceneAt& scene, GnssCounters& counters) {
  ++counters.occlusion_rays;
  return std::isfinite(leg.length_m) ? !scene.blocked_towards(leg.from_W, leg.towards_W, leg.length_m)
                                     : !scene.blocked_towards(leg.from_W, leg.towards_W);
}

/// May the share be more than `needed`, which is what comes straight and what edges make at most, whether seen or not?
bool may_exceed(double needed, double straight, std::span<const Passed> passed) {
  double most = straight;
  for (const Passed& one : passed) most += one.screen.most();
  if (most > needed) return true;
  // Two that are one may make more.
  for (std::size_t i = 0; i < passed.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (reach_together_m(passed[j], passed[i])) return true;
  return false;
}

}  // namespace

std::complex<double> leg_share(const MirroredLeg& leg, double least, const scene::SceneAt& scene,
                               GnssCounters& counters, double needed) {
  std::complex<double> share = is_clear(leg, scene, counters) ? 1.0 : 0.0;
  const double weakest = ScreenEdge::followed(least);
  const double detour_m = largest_detour_m(kFarEdgeField / weakest, leg.wavelength_m);
  const scene::EdgeIndex& index = scene.scene().edges();
  thread_local std::vector<std::uint32_t> near;
  index.along({.from_W = leg.from_W, .towards_W = leg.towards_W, .length_m = leg.length_m, .behind_m = leg.behind_m},
              detour_m, near);
  const Eigen::Vector3d image_W = leg.from_W - leg.behind_m * leg.towards_W;
  thread_local std::vector<Passed> all, before;
  all.clear();
  for (const std::uint32_t i : near) {
    const scene::Edge& edge = index.edges()[i];
    // An edge throws a shadow where the wave meets one of its faces alone.
    if (edge.normal_1_W.dot(leg.towards_W) * edge.normal_2_W.dot(leg.towards_W) >= 0.0) continue;
    if (is_not_before(edge, leg.mirrors[0]) || is_not_before(edge, leg.mirrors[1])) continue;
    const ScreenEdge screen(edge.a_W, edge.b_W, image_W, leg.towards_W, leg.wavelength_m);
    if (screen.is_faded(weakest)) continue;
    Passed passed(edge, edge.a_W, edge.b_W, screen, leg);
    const double ahead_m = (passed.point_W - leg.from_W).dot(leg.towards_W);
    if (ahead_m > 0.0 && ahead_m < leg.length_m) all.push_back(passed);
  }
  if (!may_exceed(needed, share.real(), all)) return 0.0;
  before.clear();
  for (Passed& passed : all) {
    auto twin = before.begin();
    std::optional<std::pair<double, double>> both_m;
    while (twin != before.end() && !(both_m = reach_together_m(*twin, passed))) ++twin;
    if (both_m) {
      const auto [first_m, last_m] = *both_m;
      if (last_m - first_m <= twin->length_m() + kSame_m) continue;
      if (last_m - first_m > passed.length_m() + kSame_m) {
        const Eigen::Vector3d a_W = twin->a_W + first_m * twin->along_W, b_W = twin->a_W + last_m * twin->along_W;
        passed = Passed(*passed.edge, a_W, b_W, {a_W, b_W, image_W, leg.towards_W, leg.wavelength_m}, leg);
      }
    }
    if (!is_seen(passed, leg, scene, counters) || !ends_in_air(*passed.edge, passed.point_W, scene)) continue;
    if (both_m)
      *twin = passed;
    else
      before.push_back(passed);
  }
  for (const Passed& passed : before) {
    const std::complex<double> made = passed.screen.field(weakest);
    share += passed.lit_m >= 0.0 ? -made : made;
  }
  return share;
}

}  // namespace canyon::gnss
