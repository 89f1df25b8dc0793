#include "canyon/mission/motion/plan/skid_steer.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/units.h"
#include "canyon/mission/motion/plan/plan_path.h"
#include "canyon/mission/motion/plan/speed_control.h"
#include "canyon/mission/motion/vehicle_config.h"

namespace canyon::mission {
namespace {

/// The wheels of each side turn together. Each side slips about a centre of its own, and these lie still in B (A.
/// Mandow et al., Experimental kinematics for wheeled skid-steer mobile robots, IROS 2007, eqs. 1 to 5): with half
/// their distance y, and x the way of the line between them ahead of B,
///   s = (V_l + V_r) / 2,  w = (V_r - V_l) / 2 y,  sideways velocity of B = -x w.
/// Wheels that did not slip sideways would have y half the track and x = 0. Over a step both sides' speeds are linear
/// in time. The curvature that is asked for is held within the arcs of [vehicle] max_steering_deg, its rate by that of
/// the sides; as commands are a speed and a curvature, it does not turn where it stands.
class SkidSteer final : public PlanModel {
 public:
  SkidSteer(const SkidSteerParameters& own, const VehicleConfig& config)
      : speed_(config),
        most_curvature_1_m_(std::tan(config.max_steering_deg * kDegree) / config.wheelbase_m),
        half_m_(0.5 * own.slip_track_ratio * config.track_m),
        ahead_m_(own.slip_centre_share * config.wheelbase_m),
        most_change_rad_s2_(own.side_acceleration_m_s2 / half_m_),
        most_turn_rad_s_(own.max_turn_rate_deg_s * kDegree) {
    state_.p_W = config.start_m;
    state_.yaw_rad = yaw_rad_ = yaw_from_heading(config.start_heading_deg * kDegree);
  }

  void advance(const DriveCommand& command, double dt_s) override {
    const double sign = speed_.direction(command);
    const SpeedControl::Step along = speed_.planned(command, dt_s);
    const double curvature = std::clamp(command.curvature_1_m, -most_curvature_1_m_, most_curvature_1_m_);
    const double wanted = std::clamp(along.speed(dt_s) * curvature, -most_turn_rad_s_, most_turn_rad_s_);
    const double turn_0 = state_.turn_rad_s;
    const double most = most_change_rad_s2_ * dt_s;
    const double change = std::clamp(wanted - turn_0, -most, most) / dt_s;
    const auto turn = [&](double tau) { return turn_0 + change * tau; };
    const auto yaw = [&](double tau) { return yaw_rad_ + (turn_0 + 0.5 * change * tau) * tau; };
    state_.p_W += displacement(
        dt_s, yaw, [&](double tau) { return along.speed(tau); }, [&](double tau) { return -ahead_m_ * turn(tau); });
    state_.distance_m += sign * along.distance(dt_s);
    state_.yaw_rad = yaw(dt_s);
    yaw_rad_ = wrap_pi(state_.yaw_rad);
    const bool stands = speed_.end(along, sign, dt_s);
    state_.forward_m_s = speed_.speed_m_s();
    state_.forward_change_m_s2 = speed_.acceleration_m_s2();
    state_.turn_rad_s = stands ? 0.0 : turn(dt_s);
    state_.turn_change_rad_s2 = stands ? 0.0 : change;
    state_.across_m_s = -ahead_m_ * state_.turn_rad_s;
    state_.across_change_m_s2 = -ahead_m_ * state_.turn_change_rad_s2;
  }
  const PlanState& state() const override { return state_; }
  bool slips() const override { return true; }

 private:
  SpeedControl speed_;
  double most_curvature_1_m_, half_m_, ahead_m_, most_change_rad_s2_, most_turn_rad_s_;
  double yaw_rad_ = 0.0;
  PlanState state_;
};

}  // namespace

void visit(FieldVisitor& f, SkidSteerParameters& c) {
  f.number("slip_track_ratio", c.slip_track_ratio, {1, 5},
           "skid_steer: distance of the centres about which the sides slip, over the track");
  f.number("slip_centre_share", c.slip_centre_share, {0, 1},
           "skid_steer: how far these lie before the rear axle, of the wheelbase");
  f.number("side_acceleration_m_s2", c.side_acceleration_m_s2, {0.1, 50},
           "skid_steer: limit of what each side gains over the other, halved");
  f.number("max_turn_rate_deg_s", c.max_turn_rate_deg_s, {1, 720}, "skid_steer: limit");
}

void skid_steer_parameters(ModelParameters& section) {
  section.add<SkidSteerParameters>();
}

std::unique_ptr<PlanModel> make_skid_steer(const ModelParameters& own, const VehicleConfig& config) {
  return std::make_unique<SkidSteer>(own.get<SkidSteerParameters>(), config);
}

}  // namespace canyon::mission
