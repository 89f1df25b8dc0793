#include "canyon/mission/motion/plan/dynamic_bicycle.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "canyon/core/units.h"
#include "canyon/mission/motion/plan/plan_path.h"
#include "canyon/mission/motion/plan/speed_control.h"
#include "canyon/mission/motion/plan/tyre.h"
#include "canyon/mission/motion/vehicle_config.h"

namespace canyon::mission {
namespace {

constexpr double kGravity_m_s2 = 9.80665;
constexpr double kSlowest_m_s = 1e-3;  // a tyre slips as if it rolled at least so fast; slower the vehicle stands

/// What both axles do to the sideways velocity v of the centre of gravity and the yaw rate w, per mass:
///   v' + s w = f_f cos d + f_r,  k^2 w' = a f_f cos d - b f_r,
/// with s the speed, d the steering angle, a and b the way from the centre to the front and the rear axle, k the radius
/// of gyration, and f = load x tyre law of the slip of the wheel's own plane. Rajamani, Vehicle Dynamics and Control,
/// 2nd ed. 2012, sections 2.3 and 13; without small angles in the geometry, so that at low speed it is the kinematic
/// bicycle. The drive's own force takes none of the grip; braking shifts load to the front.
class Axles {
 public:
  Axles(const DynamicBicycleParameters& own, double wheelbase_m)
      : law_(model_row(tyre_laws(), own.tyres.name).make),
        a_m_((1.0 - own.gravity_centre_share) * wheelbase_m),
        b_m_(own.gravity_centre_share * wheelbase_m),
        gyration_m2_(own.yaw_inertia_ratio * a_m_ * b_m_),
        lever_(own.gravity_centre_height_m / wheelbase_m),
        front_cornering_(own.front_cornering_per_deg / kDegree),
        rear_cornering_(own.rear_cornering_per_deg / kDegree),
        friction_(own.tyre_friction) {}

  struct At {
    double speed_m_s, acceleration_m_s2, steering_rad;
  };
  struct Change {
    Eigen::Vector2d value;     ///< (v', w')
    Eigen::Matrix2d jacobian;  ///< by (v, w)
  };
  Change change(const Eigen::Vector2d& x, const At& at) const {
    const double front_share = b_m_ / (a_m_ + b_m_), shifted = lever_ * at.acceleration_m_s2;
    const double front_load = std::max(0.0, kGravity_m_s2 * front_share - shifted);
    const double rear_load = std::max(0.0, kGravity_m_s2 * (1.0 - front_share) + shifted);
    const Eigen::RowVector2d to_front(1.0, a_m_), to_rear(1.0, -b_m_);
    const double across_front = to_front.dot(x), across_rear = to_rear.dot(x);
    const double c = std::cos(at.steering_rad), s = std::sin(at.steering_rad);
    const Side front = side(at.speed_m_s * c + across_front * s, across_front * c - at.speed_m_s * s, c, s);
    const Side rear = side(at.speed_m_s, across_rear, 1.0, 0.0);
    const TyreForce in_front = law_(front.slip, front_cornering_, friction_),
                    behind = law_(rear.slip, rear_cornering_, friction_);
    const Eigen::Vector2d of_front(c * front_load, c * front_load * a_m_ / gyration_m2_),
        of_rear(rear_load, -rear_load * b_m_ / gyration_m2_);
    Change out;
    out.value = of_front * in_front.share + of_rear * behind.share;
    out.value.x() -= at.speed_m_s * x.y();
    out.jacobian =
        of_front * (in_front.slope * front.slope * to_front) + of_rear * (behind.slope * rear.slope * to_rear);
    out.jacobian(0, 1) -= at.speed_m_s;
    return out;
  }
  /// What rolls without slip.
  Eigen::Vector2d rolling(const At& at) const {
    const double turn = at.speed_m_s * std::tan(at.steering_rad) / (a_m_ + b_m_);
    return {b_m_ * turn, turn};
  }
  double b_m() const { return b_m_; }

 private:
  /// Slip of a wheel, and its derivative by the axle's sideways velocity.
  struct Side {
    double slip, slope;
  };
  static Side side(double along, double across, double c, double s) {
    const double fast = std::max(std::abs(along), kSlowest_m_s);
    const double fast_slope = std::abs(along) > kSlowest_m_s ? std::copysign(s, along) : 0.0;
    return {across / fast, (c - across / fast * fast_slope) / fast};
  }

  TyreLaw* law_;
  double a_m_, b_m_, gyration_m2_, lever_, front_cornering_, rear_cornering_, friction_;
};

/// One step of Radau's method IIA of third order: damped at any speed, however fast the tyres answer, and exact at the
/// end in what the axles say of the derivative. Newton's method, halved where it does not come nearer; both starts that
/// are near are looked at, of which one is exact at low speed.
class RadauStep {
 public:
  RadauStep(const Axles& axles, const Eigen::Vector2d& x, double dt_s) : axles_(axles), x_(x), dt_s_(dt_s) {}

  /// Derivatives at a third of the step and at its end, in columns.
  Eigen::Matrix2d solve(const Axles::At& at_third, const Axles::At& at_end, const Eigen::Vector2d& change) {
    at_[0] = at_third, at_[1] = at_end;
    Eigen::Matrix2d as_before;
    as_before << change, change;
    Eigen::Matrix2d as_rolling;
    as_rolling << axles_.rolling(at_third) - x_, axles_.rolling(at_end) - x_;
    as_rolling = as_rolling * tableau().transpose().inverse() / dt_s_;
    Eigen::Matrix2d k = size(as_before) < size(as_rolling) ? as_before : as_rolling;
    double best = size(k);
    for (int round = 0; round < kRounds && best > 0.0; ++round) {
      const Eigen::Vector4d towards = newton(k);
      double share = 1.0, next = best;
      Eigen::Matrix2d tried = k;
      for (; share > kLeastShare; share *= 0.5) {
        tried = k + share * Eigen::Map<const Eigen::Matrix2d>(towards.data());
        next = size(tried);
        if (next < best) break;
      }
      if (!(next < best)) break;  // as near as rounding lets it
      k = tried, best = next;
    }
    return k;
  }
  /// The state at a stage.
  Eigen::Vector2d state(const Eigen::Matrix2d& k, int stage) const {
    return x_ + dt_s_ * k * tableau().row(stage).transpose();
  }

 private:
  static constexpr int kRounds = 30;
  static constexpr double kLeastShare = 1e-4;

  static Eigen::Matrix2d tableau() {
    return (Eigen::Matrix2d() << 5.0 / 12.0, -1.0 / 12.0, 3.0 / 4.0, 1.0 / 4.0).finished();
  }
  Eigen::Vector2d missing(const Eigen::Matrix2d& k, int stage) const {
    return axles_.change(state(k, stage), at_[stage]).value - k.col(stage);
  }
  double size(const Eigen::Matrix2d& k) const { return missing(k, 0).norm() + missing(k, 1).norm(); }
  Eigen::Vector4d newton(const Eigen::Matrix2d& k) const {
    Eigen::Matrix4d J = -Eigen::Matrix4d::Identity();
    Eigen::Vector4d right;
    for (int i = 0; i < 2; ++i) {
      const Axles::Change change = axles_.change(state(k, i), at_[i]);
      right.segment<2>(2 * i) = k.col(i) - change.value;
      for (int j = 0; j < 2; ++j) J.block<2, 2>(2 * i, 2 * j) += dt_s_ * tableau()(i, j) * change.jacobian;
    }
    return J.partialPivLu().solve(right);
  }

  const Axles& axles_;
  Eigen::Vector2d x_;
  double dt_s_;
  Axles::At at_[2];
};

/// Acceleration along B is what the speed control says; over a step the steering angle is linear in time, sideways
/// velocity and yaw rate are of third degree.
class DynamicBicycle final : public PlanModel {
 public:
  DynamicBicycle(const DynamicBicycleParameters& own, const VehicleConfig& config)
      : speed_(config), steering_(config), axles_(own, config.wheelbase_m) {
    state_.p_W = config.start_m;
    state_.yaw_rad = yaw_rad_ = yaw_from_heading(config.start_heading_deg * kDegree);
  }

  void advance(const DriveCommand& command, double dt_s) override {
    const double sign = speed_.direction(command);
    const SpeedControl::Step along = speed_.planned(command, dt_s);
    const double steering = steering_.after(steering_rad_, command, dt_s);
    const auto at = [&](double share) {
      return Axles::At{along.speed(share * dt_s), along.acceleration(share * dt_s),
                       steering_rad_ + share * (steering - steering_rad_)};
    };
    Eigen::Vector2d next = Eigen::Vector2d::Zero(), change = Eigen::Vector2d::Zero();
    if (along.speed_0 != 0.0 || along.speed(dt_s) != 0.0) {
      RadauStep step(axles_, x_, dt_s);
      const Eigen::Matrix2d k = step.solve(at(1.0 / 3.0), at(1.0), change_);
      next = step.state(k, 1);
      change = k.col(1);
    }
    const double b = axles_.b_m();
    const CubicStep turn = CubicStep::between(x_.y(), change_.y(), next.y(), change.y(), dt_s);
    const CubicStep across = CubicStep::between(x_.x() - b * x_.y(), change_.x() - b * change_.y(),
                                                next.x() - b * next.y(), change.x() - b * change.y(), dt_s);
    const auto yaw = [&](double tau) { return yaw_rad_ + turn.integral(tau); };
    state_.p_W += displacement(
        dt_s, yaw, [&](double tau) { return along.speed(tau); }, [&](double tau) { return across.value(tau); });
    state_.distance_m += sign * along.distance(dt_s);
    state_.yaw_rad = yaw(dt_s);
    yaw_rad_ = wrap_pi(state_.yaw_rad);
    steering_rad_ = steering;
    const bool stands = speed_.end(along, sign, dt_s);
    x_ = stands ? Eigen::Vector2d::Zero().eval() : next;
    change_ = stands ? Eigen::Vector2d::Zero().eval() : change;
    state_.forward_m_s = speed_.speed_m_s();
    state_.forward_change_m_s2 = speed_.acceleration_m_s2();
    state_.across_m_s = x_.x() - b * x_.y();
    state_.across_change_m_s2 = change_.x() - b * change_.y();
    state_.turn_rad_s = x_.y();
    state_.turn_change_rad_s2 = change_.y();
  }
  const PlanState& state() const override { return state_; }
  bool slips() const override { return true; }

 private:
  SpeedControl speed_;
  SteeringControl steering_;
  Axles axles_;
  double yaw_rad_ = 0.0, steering_rad_ = 0.0;
  Eigen::Vector2d x_ = Eigen::Vector2d::Zero();       ///< of the centre of gravity: sideways velocity, yaw rate
  Eigen::Vector2d change_ = Eigen::Vector2d::Zero();  ///< their derivatives
  PlanState state_;
};

}  // namespace

void visit(FieldVisitor& f, DynamicBicycleParameters& c) {
  visit_choice(f, "tyres", c.tyres, "dynamic_bicycle: side force of its tyres, by their slip");
  f.number("front_cornering_per_deg", c.front_cornering_per_deg, {0.01, 1},
           "dynamic_bicycle: side force per load and slip angle of the front axle");
  f.number("rear_cornering_per_deg", c.rear_cornering_per_deg, {0.01, 1},
           "dynamic_bicycle: of the rear axle; below the front axle's the vehicle oversteers");
  f.number("tyre_friction", c.tyre_friction, {0.05, 2}, "dynamic_bicycle: the most side force per load");
  f.number("gravity_centre_share", c.gravity_centre_share, {0.05, 0.95},
           "dynamic_bicycle: how far the centre of gravity lies before the rear axle, of the wheelbase");
  f.number("gravity_centre_height_m", c.gravity_centre_height_m, {0, 3},
           "dynamic_bicycle: above the ground; by it braking loads the front axle");
  f.number("yaw_inertia_ratio", c.yaw_inertia_ratio, {0.2, 3},
           "dynamic_bicycle: yaw inertia over the mass times the distances of both axles from its centre, about 1 for "
           "cars");
}

void dynamic_bicycle_parameters(ModelParameters& section) {
  section.add<DynamicBicycleParameters>();
}

std::unique_ptr<PlanModel> make_dynamic_bicycle(const ModelParameters& own, const VehicleConfig& config) {
  return std::make_unique<DynamicBicycle>(own.get<DynamicBicycleParameters>(), config);
}

}  // namespace canyon::mission
