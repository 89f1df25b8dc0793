#include "canyon/mission/scoring/encounters.h"

#include <algorithm>
#include <cmath>

#include "canyon/mission/collision/body_box.h"

namespace canyon::mission {
namespace {

constexpr double kEvery_m = 0.2, kEvery_s = 0.2;
constexpr double kAhead_m = 0.5;       // between the boxes that are laid along an arc
constexpr double kSlow_m_s = 0.5;      // slower than this nothing is missed
constexpr double kSlowing_m_s = 0.05;  // a command that is less than the speed by this slows down
constexpr double kTimesApart_s = 1.0;

}  // namespace

Encounters::Encounters(const SuccessConfig& config, const VehicleConfig& vehicle, const scene::SceneAt& scene)
    : near_miss_m_(config.near_miss_m),
      phantom_free_m_(config.phantom_free_m),
      vehicle_(vehicle),
      scene_(scene),
      near_(scene) {}

bool Encounters::Times::begins(bool holds, GpsTime t) {
  if (!holds) return false;
  const bool anew = !ever_ || t - last_ > kTimesApart_s;
  ever_ = true;
  last_ = t;
  return anew;
}

bool Encounters::Approaches::is_near_miss() const {
  return std::any_of(things_.begin(), things_.end(), [](const Thing& thing) { return !thing.touched; });
}

void Encounters::Approaches::add(std::uint32_t object, bool touched, GpsTime t) {
  if (!things_.empty() && t - last_ > kTimesApart_s) {
    before_ = near_misses();
    things_.clear();
  }
  last_ = t;
  const auto known =
      std::find_if(things_.begin(), things_.end(), [object](const Thing& thing) { return thing.object == object; });
  if (known == things_.end()) {
    things_.push_back({object, touched});
  } else {
    known->touched = known->touched || touched;
  }
}

bool Encounters::is_thing(const NearTriangle& triangle) const {
  return scene_.object(scene_.surface(triangle.index).object).kind != scene::ObjectKind::kTerrain;
}

/// What is lower than the body, as a pavement is, is no thing to keep clear of. Of objects of known kinds all counts.
bool Encounters::is_driven_over(const NearTriangle& triangle, const OrientedBox& body) const {
  if (scene_.object(scene_.surface(triangle.index).object).kind != scene::ObjectKind::kOther) return false;
  const Eigen::Vector3d up = body.X_WC.R * Eigen::Vector3d::UnitZ();
  const scene::Triangle& t = triangle.corners;
  const double underside_m = up.dot(body.X_WC.p) - body.half_m.z();
  return std::max({up.dot(t.a), up.dot(t.b), up.dot(t.c)}) < underside_m;
}

double Encounters::clearance_m(const Pose& X_WB, GpsTime t) {
  const OrientedBox body = body_box(vehicle_, X_WB);
  double least_m = kFar_m;
  for (const NearTriangle& triangle : near_.near(body.X_WC.p, body.radius_m() + kFar_m)) {
    if (!is_thing(triangle) || is_driven_over(triangle, body)) continue;
    const double clear_m = distance_m(body, triangle.corners);
    least_m = std::min(least_m, clear_m);
    if (clear_m < near_miss_m_) approaches_.add(scene_.surface(triangle.index).object, clear_m <= 0.0, t);
  }
  return least_m;
}

void Encounters::touched(std::uint32_t object, GpsTime t) {
  if (scene_.object(object).kind == scene::ObjectKind::kTerrain) return;
  numbers_.clearance_min_m = 0.0;
  approaches_.add(object, true, t);
  numbers_.near_misses = approaches_.near_misses();
}

bool Encounters::meets(const Pose& X_WB, double curvature_1_m, double way_m) {
  const OrientedBox body = body_box(vehicle_, X_WB);
  std::vector<NearTriangle> things = near_.near(body.X_WC.p, body.radius_m() + way_m);
  std::erase_if(things, [this](const NearTriangle& triangle) { return !is_thing(triangle); });
  for (double s = 0.0; s <= way_m && !things.empty(); s += kAhead_m) {
    const PlanPose there = PlanPose{}.along(curvature_1_m, s);
    const Pose X_BB{Eigen::Quaterniond(Eigen::AngleAxisd(there.yaw_rad, Eigen::Vector3d::UnitZ())),
                    {there.p_m.x(), there.p_m.y(), 0.0}};
    const OrientedBox ahead = body_box(vehicle_, X_WB * X_BB);
    for (const NearTriangle& triangle : things)
      if (touch(ahead, triangle.corners)) return true;
  }
  return false;
}

void Encounters::look(const KinematicState& truth, double speed_m_s, const DriveCommand& command, AutonomyState state) {
  const Eigen::Vector2d p = truth.X_WB.p.head<2>();
  if (looked_ && truth.t - looked_at_ < kEvery_s && (p - looked_from_).norm() < kEvery_m) return;
  looked_ = true;
  looked_at_ = truth.t;
  looked_from_ = p;
  const double clear_m = clearance_m(truth.X_WB, truth.t);
  numbers_.clearance_min_m =
      std::isnan(numbers_.clearance_min_m) ? clear_m : std::min(numbers_.clearance_min_m, clear_m);
  numbers_.near_misses = approaches_.near_misses();

  const bool finds_no_way = state == AutonomyState::kBlocked && command.speed_m_s <= 0.0;
  const bool phantom = finds_no_way && !meets(truth.X_WB, 0.0, phantom_free_m_);
  phantom_now_ = phantom;
  numbers_.phantoms += phantom_.begins(phantom, truth.t) ? 1 : 0;

  const bool goes_on = speed_m_s > kSlow_m_s && command.speed_m_s > speed_m_s - kSlowing_m_s;
  const double stop_m = 0.5 * speed_m_s * speed_m_s / vehicle_.max_deceleration_m_s2;
  const bool misses = goes_on && meets(truth.X_WB, truth.w_WB_B.z() / speed_m_s, stop_m);
  numbers_.missed_obstacles += missed_.begins(misses, truth.t) ? 1 : 0;
}

}  // namespace canyon::mission
