#include "canyon/mission/config/waypoint_reach.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include "canyon/core/process/progress.h"
#include "canyon/core/truth.h"
#include "canyon/core/units.h"
#include "canyon/mission/collision/body_at_rest.h"
#include "canyon/mission/collision/collision.h"
#include "canyon/scene/city/site.h"

namespace canyon::mission {
namespace {

constexpr double kAlongRoute_m = 0.5;
constexpr int kHeadings = 48;
constexpr double kPlacesShare = 0.1;  // between places, of the body's shorter side
constexpr double kMostSmaller = 0.4;  // of that side: neighbouring places are never on two sides of a wall

Eigen::Vector2d unit(double yaw_rad) {
  return {std::cos(yaw_rad), std::sin(yaw_rad)};
}

double shorter_m(const VehicleConfig& body) {
  return std::min(body.length_m, body.width_m);
}

/// By how much the body is smaller on each side: half a diagonal between places, and what its corners go sideways
/// within half a step of the heading.
double smaller_by_m(const VehicleConfig& body, double step_m) {
  const double turning_m = 0.5 * std::hypot(body.length_m, body.width_m) * std::sin(kPi / kHeadings);
  return step_m / std::sqrt(2.0) + turning_m;
}

/// A square of places around one in its middle.
struct Places {
  int half;
  int side() const { return 2 * half + 1; }
  std::size_t count() const { return static_cast<std::size_t>(side()) * static_cast<std::size_t>(side()); }
  bool contain(int i, int j) const { return std::max(std::abs(i), std::abs(j)) <= half; }
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(i + half) * static_cast<std::size_t>(side()) + static_cast<std::size_t>(j + half);
  }
};

}  // namespace

WaypointReach::WaypointReach(const VehicleConfig& vehicle, double radius_m, const scene::SceneAt& scene,
                             std::int64_t most_checks)
    : vehicle_(vehicle),
      smaller_(vehicle),
      radius_m_(radius_m),
      step_m_(kPlacesShare * shorter_m(vehicle)),
      near_m_(radius_m + step_m_ / std::sqrt(2.0) + vehicle.wheelbase_m * std::sin(kPi / (2 * kHeadings))),
      most_checks_(most_checks),
      scene_(scene) {
  const double by_m = smaller_by_m(vehicle, step_m_);
  is_judged_ = by_m <= kMostSmaller * shorter_m(vehicle);
  smaller_.length_m -= 2.0 * by_m;
  smaller_.width_m -= 2.0 * by_m;
}

bool WaypointReach::is_free(const VehicleConfig& body, const Eigen::Vector2d& rear_axle_W, double yaw_rad,
                            std::optional<std::uint32_t>* met) const {
  const auto X_WB = body_at_rest(body, scene_.scene(), rear_axle_W, yaw_rad);
  if (!X_WB) return false;
  KinematicState state;
  state.X_WB = *X_WB;
  // One that is made anew: it looks again only where the body has moved.
  const auto touched = make_line_check(ModelParameters{}, body, scene_)->touched(state);
  if (met != nullptr) *met = touched;
  return !touched;
}

std::optional<std::uint32_t> WaypointReach::met_before(const Path& route, double s_m) const {
  std::optional<std::uint32_t> met;
  for (double s = s_m; s >= std::max(0.0, s_m - radius_m_ - kAround_m) && !met; s -= kAlongRoute_m) {
    const Eigen::Vector2d along = route.direction(s);
    is_free(vehicle_, route.at(s), std::atan2(along.y(), along.x()), &met);
  }
  return met;
}

WaypointReach::Stand WaypointReach::stand(const Eigen::Vector2d& middle_W, const Eigen::Vector2d& place_W,
                                          std::int64_t& checks) const {
  const double before_axle_m = 0.5 * smaller_.wheelbase_m;
  const bool may_be_near = (middle_W - place_W).norm() <= near_m_ + before_axle_m;
  Stand best = Stand::kNowhere;
  for (int k = 0; k < kHeadings; ++k) {
    const double yaw_rad = 2.0 * kPi * k / kHeadings;
    const Eigen::Vector2d rear_axle = middle_W - before_axle_m * unit(yaw_rad);
    ++checks;
    if (!is_free(smaller_, rear_axle, yaw_rad)) continue;
    if ((rear_axle - place_W).norm() <= near_m_) return Stand::kNear;
    best = Stand::kFree;
    if (!may_be_near) break;
  }
  return best;
}

WaypointReach::Way WaypointReach::way_to(const Eigen::Vector2d& place_W) const {
  Way way;
  if (!is_judged_) return way;
  const Places places{static_cast<int>(std::ceil((radius_m_ + kAround_m) / step_m_))};
  std::vector<bool> known(places.count(), false);
  // Way left, place: the nearest is looked at first, so that a way that there is takes few looks.
  using Open = std::pair<double, std::pair<int, int>>;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
  const auto middle = [&](int i, int j) { return Eigen::Vector2d(place_W + step_m_ * Eigen::Vector2d(i, j)); };
  const auto add = [&](int i, int j) {
    if (!places.contain(i, j) || known[places.index(i, j)]) return;
    known[places.index(i, j)] = true;
    open.push({(middle(i, j) - place_W).norm(), {i, j}});
  };

  for (int k = -places.half; k <= places.half; ++k)
    for (const int edge : {-places.half, places.half}) {
      add(k, edge);
      add(edge, k);
    }
  const Eigen::Vector2d start_W =
      vehicle_.start_m + 0.5 * vehicle_.wheelbase_m * unit(yaw_from_heading(vehicle_.start_heading_deg * kDegree));
  const Eigen::Vector2d start = (start_W - place_W) / step_m_;
  if (start.cwiseAbs().maxCoeff() <= places.half)
    add(static_cast<int>(std::lround(start.x())), static_cast<int>(std::lround(start.y())));

  while (!open.empty()) {
    throw_if_cancelled();
    if (way.checks >= most_checks_) return way;
    const auto [i, j] = open.top().second;
    open.pop();
    // Nothing comes from inside a building.
    const bool on_edge = std::max(std::abs(i), std::abs(j)) == places.half;
    if (on_edge && scene::building_at(scene_.scene().buildings(), middle(i, j)) != nullptr) continue;
    const Stand found = stand(middle(i, j), place_W, way.checks);
    if (found == Stand::kNear) return way;
    if (found == Stand::kNowhere) continue;
    for (int di = -1; di <= 1; ++di)
      for (int dj = -1; dj <= 1; ++dj) add(i + di, j + dj);
  }
  way.may_be = false;
  return way;
}

}  // namespace canyon::mission
