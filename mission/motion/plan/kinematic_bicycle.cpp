#include "canyon/mission/motion/plan/kinematic_bicycle.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/units.h"
#include "canyon/mission/motion/plan/plan_path.h"
#include "canyon/mission/motion/plan/speed_control.h"
#include "canyon/mission/motion/side_slip.h"
#include "canyon/mission/motion/vehicle_config.h"

namespace canyon::mission {
namespace {

/// The rear axle rolls where it points, but for the slip of linear tyres where the configuration has it (SideSlip).
/// Over a step acceleration and curvature are linear in time.
class KinematicBicycle final : public PlanModel {
 public:
  KinematicBicycle(const KinematicBicycleParameters& own, const VehicleConfig& config)
      : wheelbase_m_(config.wheelbase_m),
        speed_(config),
        steering_(config),
        slip_(own.sideslip_deg_per_m_s2 * kDegree) {
    state_.p_W = config.start_m;
    state_.yaw_rad = yaw_rad_ = yaw_from_heading(config.start_heading_deg * kDegree);
  }

  void advance(const DriveCommand& command, double dt_s) override {
    const double sign = speed_.direction(command);
    Step step{.yaw_0 = yaw_rad_, .curvature_0 = curvature_1_m_, .along = speed_.planned(command, dt_s)};
    const double steering = std::atan(curvature_1_m_ * wheelbase_m_);
    const double next_steering = steering_.after(steering, command, dt_s);
    step.curvature_rate = (std::tan(next_steering) / wheelbase_m_ - curvature_1_m_) / dt_s;
    step.sideways = slip_.yields() ? slip_.advance(step.drive(dt_s / 3.0), step.drive(dt_s), dt_s) : slip_.now();

    state_.p_W += displacement(
        dt_s, [&](double tau) { return step.yaw(tau); }, [&](double tau) { return step.along.speed(tau); },
        [&](double tau) { return step.sideways.velocity(tau); });
    state_.distance_m += sign * step.along.distance(dt_s);
    state_.yaw_rad = step.yaw(dt_s);
    yaw_rad_ = wrap_pi(state_.yaw_rad);
    curvature_1_m_ = step.curvature(dt_s);
    if (speed_.end(step.along, sign, dt_s)) slip_.stop();
    const double v = speed_.speed_m_s(), acceleration = speed_.acceleration_m_s2();
    state_.forward_m_s = v;
    state_.forward_change_m_s2 = acceleration;
    state_.across_m_s = slip_.now().velocity(0.0);
    state_.across_change_m_s2 = slip_.now().acceleration(0.0);
    state_.turn_rad_s = v * curvature_1_m_;
    state_.turn_change_rad_s2 = acceleration * curvature_1_m_ + v * step.curvature_rate;
  }
  const PlanState& state() const override { return state_; }
  bool slips() const override { return slip_.yields(); }

 private:
  struct Step {
    double yaw_0 = 0.0, curvature_0 = 0.0, curvature_rate = 0.0;
    SpeedControl::Step along;
    SideSlip::Motion sideways{};

    double curvature(double tau) const { return curvature_0 + curvature_rate * tau; }
    double yaw(double tau) const {
      const double c1 = along.speed_0 * curvature_0,
                   c2 = along.acceleration_0 * curvature_0 + along.speed_0 * curvature_rate,
                   c3 = 0.5 * along.jerk * curvature_0 + along.acceleration_0 * curvature_rate,
                   c4 = 0.5 * along.jerk * curvature_rate;
      return yaw_0 + tau * (c1 + tau * (c2 / 2.0 + tau * (c3 / 3.0 + tau * c4 / 4.0)));
    }
    SideSlip::Drive drive(double tau) const {
      const double forward = std::max(along.speed(tau), 0.0);
      return {forward, forward * forward * curvature(tau)};
    }
  };

  double wheelbase_m_;
  SpeedControl speed_;
  SteeringControl steering_;
  SideSlip slip_;
  double yaw_rad_ = 0.0, curvature_1_m_ = 0.0;  ///< where the coming step begins
  PlanState state_;
};

}  // namespace

void visit(FieldVisitor& f, KinematicBicycleParameters& c) {
  f.number("sideslip_deg_per_m_s2", c.sideslip_deg_per_m_s2, {0, 2},
           "kinematic_bicycle: slip angle of the rear axle per lateral acceleration, about 0.5 for a car's tyres; 0 = "
           "it rolls where it points");
}

void kinematic_bicycle_parameters(ModelParameters& section) {
  section.add<KinematicBicycleParameters>();
}

std::unique_ptr<PlanModel> make_kinematic_bicycle(const ModelParameters& own, const VehicleConfig& config) {
  return std::make_unique<KinematicBicycle>(own.get<KinematicBicycleParameters>(), config);
}

}  // namespace canyon::mission
