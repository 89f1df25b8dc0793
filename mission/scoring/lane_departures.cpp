#include "canyon/mission/scoring/lane_departures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "canyon/core/units.h"
#include "canyon/mission/collision/body_at_rest.h"
#include "canyon/mission/collision/body_box.h"

namespace canyon::mission {
namespace {

constexpr double kRounding_m = 1e-3;  // of a mesh, whose places are in single precision

}  // namespace

LaneDepartures::LaneDepartures(const VehicleConfig& vehicle, Path lane, const scene::SceneAt& scene)
    : vehicle_(vehicle),
      most_curvature_1_m_(std::tan(vehicle.max_steering_deg * kDegree) / vehicle.wheelbase_m),
      lane_(std::move(lane)),
      scene_(scene),
      near_(scene) {}

/// As whoever follows the route does it: a lane that meets itself is not lost.
double LaneDepartures::project(const Eigen::Vector2d& p_W, double near_s_m) const {
  return lane_.project(p_W, std::max(0.0, near_s_m - 2.0), near_s_m + 5.0);
}

void LaneDepartures::look(const KinematicState& truth, const std::function<Eigen::Vector3d()>& believed_W) {
  if (lane_.empty()) return;
  const Eigen::Vector2d p = truth.X_WB.p.head<2>();
  const double since_m = looked_ ? (p - looked_from_).norm() : 0.0;
  if (looked_ && since_m < kEvery_m) return;
  looked_ = true;
  looked_from_ = p;
  way_m_ += since_m;
  const Eigen::Vector2d believed = believed_W().head<2>(), error = p - believed;
  s_m_ = project(p, s_m_);
  believed_s_m_ = project(believed, believed_s_m_);
  const double off_m = lane_.offset(p, s_m_), believed_off_m = lane_.offset(believed, believed_s_m_);
  const bool between = off_m * believed_off_m <= 0.0;
  const double beside_m = between ? 0.0 : std::min(std::abs(off_m), std::abs(believed_off_m));
  if (!can_follow(s_m_) || !can_follow(believed_s_m_)) needed_to_m_ = std::max(needed_to_m_, way_m_ + kSwing_m);

  if (error.norm() > kMostError_m) {
    kept_m_ = 0.0;
  } else if (beside_m <= kBeside_m) {
    const Eigen::Vector2d forward = (truth.X_WB.R * Eigen::Vector3d::UnitX()).head<2>();
    kept_m_ = lane_.direction(s_m_).dot(forward) >= kAlong ? kept_m_ + since_m : 0.0;
    may_leave_ = may_leave_ || kept_m_ >= kKept_m;
  } else {
    kept_m_ = 0.0;
    if (!may_leave_ || way_m_ < search_from_m_) return;
    search_from_m_ = way_m_ + kSearchEvery_m;
    if (!is_free(error)) {
      needed_to_m_ = way_m_ + kBack_m;
    } else if (way_m_ >= needed_to_m_) {
      ++needless_;
      may_leave_ = false;
    }
  }
}

bool LaneDepartures::is_free(const Eigen::Vector2d& most_moved_m) {
  const double wide_m = vehicle_.width_m + 2.0 * kClear_m;
  const int more = static_cast<int>(std::ceil(most_moved_m.norm() / wide_m));
  if (!is_free_at(Eigen::Vector2d::Zero())) return false;
  for (int k = 1; k <= more; ++k)
    if (!is_free_at(most_moved_m * k / more)) return false;
  return true;
}

/// Whether a triangle is of no known kind and nowhere higher above the ground under its corners than the body begins,
/// as a pavement is. Above the body's own plane it may be higher all the same, where the ground beside the lane rises.
bool LaneDepartures::is_kerb(const NearTriangle& triangle) const {
  if (scene_.object(scene_.surface(triangle.index).object).kind != scene::ObjectKind::kOther) return false;
  for (const Eigen::Vector3d& p : {triangle.corners.a, triangle.corners.b, triangle.corners.c}) {
    const auto ground = scene_.scene().ground(p.x(), p.y());
    if (!ground || p.z() - ground->height_m > vehicle_.ground_clearance_m + kRounding_m) return false;
  }
  return true;
}

bool LaneDepartures::can_follow(double s_m) const {
  constexpr double kPoints_m = 0.25;  // apart, as its own are
  for (double s = s_m; s <= s_m + kTurn_m; s += kPoints_m)
    if (std::abs(lane_.curvature(s)) > most_curvature_1_m_) return false;
  return true;
}

/// After its end a lane goes straight on, where whoever drives there looks, too.
bool LaneDepartures::is_free_at(const Eigen::Vector2d& moved_m) {
  for (double s = s_m_; s <= s_m_ + kAhead_m; s += kBodies_m) {
    const Eigen::Vector2d along = lane_.direction(s);
    const Eigen::Vector2d there = lane_.at(s) + std::max(0.0, s - lane_.length_m()) * along + moved_m;
    const auto X_WB = body_at_rest(vehicle_, scene_.scene(), there, std::atan2(along.y(), along.x()));
    if (!X_WB) return false;
    const OrientedBox body = body_box(vehicle_, *X_WB);
    OrientedBox with_room = body;
    with_room.half_m += Eigen::Vector3d(kClear_m, kClear_m, 0.0);
    for (const NearTriangle& triangle : near_.near(body.X_WC.p, with_room.radius_m())) {
      const scene::ObjectKind kind = scene_.object(scene_.surface(triangle.index).object).kind;
      if (kind == scene::ObjectKind::kTerrain || !touch(with_room, triangle.corners)) continue;
      if (!is_kerb(triangle) || touch(body, triangle.corners)) return false;
    }
  }
  return true;
}

}  // namespace canyon::mission
