// Vehicles in the plane against closed forms.
#include <cmath>

#include <gtest/gtest.h>
#include <unsupported/Eigen/MatrixFunctions>

#include "canyon/core/units.h"
#include "canyon/mission/motion/plan/dynamic_bicycle.h"
#include "canyon/mission/motion/plan/skid_steer.h"
#include "canyon/mission/motion/vehicle_config.h"

namespace canyon::mission {
namespace {

constexpr double kStep_s = 0.01, kG_m_s2 = 9.80665;

VehicleConfig car(const std::string& model) {
  VehicleConfig config;
  config.model.name = model;
  config.wheelbase_m = 2.5;
  config.max_speed_m_s = 30.0;
  config.max_acceleration_m_s2 = 5.0;
  config.max_steering_rate_deg_s = 360.0;
  return config;
}

DynamicBicycleParameters& tyres_of(VehicleConfig& config) {
  return config.model.own.get<DynamicBicycleParameters>();
}

std::unique_ptr<PlanModel> made(const VehicleConfig& config) {
  return model_row(plan_models(), config.model.name).make(config.model.own, config);
}

/// Until the speed is made up (0.1 s) and nothing fades any more.
void drive(PlanModel& model, const DriveCommand& command, double seconds, double step_s = kStep_s) {
  for (int k = 0; k < std::lround(seconds / step_s); ++k) model.advance(command, step_s);
}

double kinematic_turn(const VehicleConfig& config, double speed_m_s, double curvature_1_m) {
  return speed_m_s * std::tan(std::atan(curvature_1_m * config.wheelbase_m)) / config.wheelbase_m;
}

// Steady turns: L / R = d - K u^2 R^-1 with K = 1 / (g C_f) - 1 / (g C_r) (Gillespie 1992, eq. 6-15), so that the yaw
// rate is u d / (L + K u^2). Small angles: the tyres' angles are below 0.02 rad, their squares 4e-4 of it.
TEST(DynamicBicycle, HasTheUndersteerGradientOfItsTyres) {
  for (const auto& [front, rear] : {std::pair{0.15, 0.2}, {0.2, 0.2}, {0.2, 0.17}})
    for (const char* law : {"linear", "fiala"}) {
      VehicleConfig config = car("dynamic_bicycle");
      auto& own = tyres_of(config);
      own.tyres.name = law;
      own.front_cornering_per_deg = front;
      own.rear_cornering_per_deg = rear;
      own.tyre_friction = 100.0;  // far from sliding: a brush is as linear as its slip is small against it
      const double K = (1.0 / front - 1.0 / rear) * kDegree / kG_m_s2;
      for (const double speed : {5.0, 15.0, 25.0}) {
        const double curvature = 0.25 / (speed * speed);  // some 0.25 m/s^2
        const auto model = made(config);
        drive(*model, {speed, curvature}, 20.0);
        const double expected = speed * curvature * config.wheelbase_m / (config.wheelbase_m + K * speed * speed);
        EXPECT_NEAR(model->state().turn_rad_s / expected, 1.0, 5e-4) << law << " " << front << " at " << speed;
      }
    }
}

/// Sideways velocity and yaw rate of a linear bicycle at constant speed: x' = A x + B d.
struct Linear {
  Eigen::Matrix2d A;
  Eigen::Vector2d B;
  Linear(const DynamicBicycleParameters& own, double L, double u) {
    const double b = own.gravity_centre_share * L, a = L - b, k2 = own.yaw_inertia_ratio * a * b;
    const double cf = own.front_cornering_per_deg / kDegree * kG_m_s2 * b / L,
                 cr = own.rear_cornering_per_deg / kDegree * kG_m_s2 * a / L;
    A << -(cf + cr) / u, -(a * cf - b * cr) / u - u, -(a * cf - b * cr) / (k2 * u),
        -(a * a * cf + b * b * cr) / (k2 * u);
    B << cf, a * cf / k2;
  }
};

/// The largest error of the yaw rate after a step of the steering angle, once the wheels have turned: against the
/// exponential of the matrix, from the state at 0.1 s on.
double worst_of_step(double step_s) {
  VehicleConfig config = car("dynamic_bicycle");
  auto& own = tyres_of(config);
  own.tyres.name = "linear";
  own.gravity_centre_share = 0.55;
  own.yaw_inertia_ratio = 0.9;
  constexpr double kSpeed_m_s = 15.0, kCurvature_1_m = 1e-4;
  const auto model = made(config);
  drive(*model, {kSpeed_m_s, 0.0}, 20.0, step_s);
  drive(*model, {kSpeed_m_s, kCurvature_1_m}, 0.1, step_s);
  const Linear linear(own, config.wheelbase_m, kSpeed_m_s);
  const double steering = std::atan(kCurvature_1_m * config.wheelbase_m);
  const Eigen::Vector2d steady = -linear.A.inverse() * linear.B * steering;
  const double b = own.gravity_centre_share * config.wheelbase_m;
  const auto state = [&] {
    return Eigen::Vector2d(model->state().across_m_s + b * model->state().turn_rad_s, model->state().turn_rad_s);
  };
  const Eigen::Vector2d from = state() - steady;
  double worst = 0.0;
  for (int k = 1; k <= std::lround(1.0 / step_s); ++k) {
    model->advance({kSpeed_m_s, kCurvature_1_m}, step_s);
    const Eigen::Matrix2d fading = (linear.A * (k * step_s)).exp();
    worst = std::max(worst, std::abs((state() - steady - fading * from).y() / steady.y()));
  }
  return worst;
}

// How its yaw rate answers: the eigenvalues of the linear bicycle, 8.6 and 10.4 1/s there. Radau's method of third
// order: a half of the step has an eighth of the error, and at the master step that is below 1e-5 of the turn.
TEST(DynamicBicycle, AnswersWithTheTimeConstantsOfTheLinearBicycle) {
  const double whole = worst_of_step(0.02), half = worst_of_step(0.01);
  EXPECT_LT(half, 1e-4);
  EXPECT_NEAR(whole / half, 8.0, 1.5);
}

// At 2 cm/s the wheels roll where they point, at full lock too: what is left is K u^2 / L and smaller.
TEST(DynamicBicycle, IsTheKinematicBicycleAtLowSpeed) {
  for (const char* law : {"linear", "fiala"}) {
    VehicleConfig config = car("dynamic_bicycle");
    tyres_of(config).tyres.name = law;
    const auto model = made(config);
    for (int k = 0; k < 100; ++k) model->advance({0.0, 1.0}, kStep_s);  // turns its wheels at rest
    constexpr double kSpeed_m_s = 0.02;
    for (const double way : {1.0, -1.0}) {
      drive(*model, {way * kSpeed_m_s, 0.2}, 5.0);
      const PlanState& s = model->state();
      EXPECT_NEAR(s.turn_rad_s / kinematic_turn(config, way * kSpeed_m_s, 0.2), 1.0, 1e-5) << law;
      EXPECT_NEAR(s.across_m_s, 0.0, 1e-5 * kSpeed_m_s) << law;
    }
  }
}

// What friction holds: at 20 m/s and full lock neither axle gives more, and the turn is near that.
TEST(DynamicBicycle, TyresHoldNoMoreThanTheirFriction) {
  for (const char* law : {"linear", "fiala"}) {
    VehicleConfig config = car("dynamic_bicycle");
    auto& own = tyres_of(config);
    own.tyres.name = law;
    own.tyre_friction = 0.7;
    own.gravity_centre_height_m = 0.0;
    const auto model = made(config);
    drive(*model, {20.0, 0.0}, 10.0);
    double most = 0.0;
    for (int k = 0; k < 300; ++k) {
      model->advance({20.0, 0.15}, kStep_s);
      const PlanState& s = model->state();
      const double b = own.gravity_centre_share * config.wheelbase_m;
      const double at_centre = s.across_change_m_s2 + b * s.turn_change_rad_s2 + s.forward_m_s * s.turn_rad_s;
      ASSERT_LT(std::abs(at_centre), 0.7 * kG_m_s2 * (1.0 + 1e-6)) << law << " step " << k;
      most = std::max(most, std::abs(at_centre));
    }
    EXPECT_GT(most, 0.6 * kG_m_s2) << law;
  }
}

TEST(Tyres, FialaIsTheBrushsCubic) {
  constexpr double kCornering = 11.0, kFriction = 0.9;
  for (double slip = -0.5; slip <= 0.5; slip += 0.013) {
    const TyreForce force = fiala_tyre(slip, kCornering, kFriction);
    const double s = std::abs(slip), c = kCornering, m = kFriction;
    // Pacejka 2012, eq. 3.11, written out; 3.13 beyond.
    const double cubic =
        s < 3.0 * m / c ? c * s - c * c * s * s / (3.0 * m) + c * c * c * s * s * s / (27.0 * m * m) : m;
    EXPECT_NEAR(force.share, -std::copysign(cubic, slip), 1e-14);
    for (TyreLaw* law : {linear_tyre, fiala_tyre}) {
      constexpr double h = 1e-6;  // differences: h^2 of the third derivative, and rounding of 1e-16 / h
      const double slope = (law(slip + h, c, m).share - law(slip - h, c, m).share) / (2.0 * h);
      if (std::abs(std::abs(law(slip, c, m).share) - m) > 1e-4) {
        EXPECT_NEAR(law(slip, c, m).slope, slope, 1e-4);
      }
    }
  }
}

// Mandow et al. 2007: what lies at x ahead and y left of B stands still in the plane; wheels' speeds of both sides
// differ by the turn times the distance of the centres.
TEST(SkidSteer, TurnsAboutItsInstantaneousCentre) {
  VehicleConfig config = car("skid_steer");
  auto& own = config.model.own.get<SkidSteerParameters>();
  own.slip_track_ratio = 1.8;
  own.slip_centre_share = 0.4;
  const auto model = made(config);
  constexpr double kSpeed_m_s = 2.0, kCurvature_1_m = 0.2;
  drive(*model, {kSpeed_m_s, kCurvature_1_m}, 10.0);
  const PlanState& s = model->state();
  EXPECT_NEAR(s.turn_rad_s, kSpeed_m_s * kCurvature_1_m, 1e-12);
  const double x = 0.4 * config.wheelbase_m, y = 1.0 / kCurvature_1_m;
  EXPECT_NEAR(s.forward_m_s - s.turn_rad_s * y, 0.0, 1e-12);
  EXPECT_NEAR(s.across_m_s + s.turn_rad_s * x, 0.0, 1e-12);
  // And in the plane that point stays where it is.
  const auto centre = [&] {
    const Eigen::Vector2d forward(std::cos(s.yaw_rad), std::sin(s.yaw_rad)), left(-forward.y(), forward.x());
    return Eigen::Vector2d(s.p_W + x * forward + y * left);
  };
  const Eigen::Vector2d before = centre();
  for (int k = 0; k < 500; ++k) {
    model->advance({kSpeed_m_s, kCurvature_1_m}, kStep_s);
    ASSERT_LT((centre() - before).norm(), 1e-10);
  }
}

// The side's acceleration bounds the turn: w' <= a / (half the distance of the centres).
TEST(SkidSteer, ItsSidesLimitHowFastItBeginsToTurn) {
  VehicleConfig config = car("skid_steer");
  auto& own = config.model.own.get<SkidSteerParameters>();
  own.side_acceleration_m_s2 = 0.5;
  const auto model = made(config);
  drive(*model, {2.0, 0.0}, 10.0);
  const double most = 0.5 / (0.5 * own.slip_track_ratio * config.track_m);
  double last = 0.0;
  for (int k = 0; k < 50; ++k) {
    model->advance({2.0, 0.2}, kStep_s);
    EXPECT_NEAR(model->state().turn_rad_s - last, k * most * kStep_s < 0.4 - most * kStep_s ? most * kStep_s : 0.0,
                most * kStep_s);
    EXPECT_LE(model->state().turn_rad_s - last, most * kStep_s * (1.0 + 1e-12));
    last = model->state().turn_rad_s;
  }
}

/// A minute of turns either way, halts and starts.
DriveCommand meandering(int k) {
  return {k % 1500 < 1200 ? 6.0 : 0.0, 0.12 * std::sin(0.007 * k) + (k % 700 < 300 ? 0.06 : 0.0)};
}

// Places are integrals of velocities (p_1 - p_0 = h/2 (v_0 + v_1) + h^2/12 (a_0 - a_1), off by h^5/720 of the
// velocity's fourth derivative), and yaw that of the yaw rate, of every model, but for the last step of a halt, which
// is cut off.
TEST(PlanModels, VelocitiesAreDerivativesOfPlaces) {
  for (const auto& row : plan_models()) {
    VehicleConfig config = car(row.name);
    config.max_steering_rate_deg_s = 45.0;
    config.steering.name = config.drive.name = "first_order";
    const auto model = made(config);
    PlanState a = model->state();
    double most_across = 0.0, most_change = 0.0;
    std::vector<double> off_yaw;
    const auto velocity = [](const PlanState& s) {
      const double c = std::cos(s.yaw_rad), n = std::sin(s.yaw_rad);
      return Eigen::Vector2d(s.forward_m_s * c - s.across_m_s * n, s.forward_m_s * n + s.across_m_s * c);
    };
    const auto acceleration = [](const PlanState& s) {
      const double c = std::cos(s.yaw_rad), n = std::sin(s.yaw_rad);
      const double along = s.forward_change_m_s2 - s.across_m_s * s.turn_rad_s,
                   across = s.across_change_m_s2 + s.forward_m_s * s.turn_rad_s;
      return Eigen::Vector2d(along * c - across * n, along * n + across * c);
    };
    for (int k = 1; k <= 6000; ++k) {
      model->advance(meandering(k), kStep_s);
      const PlanState& b = model->state();
      most_across = std::max(most_across, std::abs(b.across_m_s));
      if (std::abs(b.forward_m_s) > 0.05) {
        const double h = kStep_s;
        const Eigen::Vector2d off =
            b.p_W - a.p_W - 0.5 * h * (velocity(a) + velocity(b)) - h * h / 12.0 * (acceleration(a) - acceleration(b));
        // What begins at a node, as a limit on the sides' speeds, the state before does not know of yet.
        const double begins_m_s2 =
            row.name == std::string("skid_steer") ? std::abs(a.across_change_m_s2 - b.across_change_m_s2) : 0.0;
        ASSERT_LT(off.norm(), 2e-8 + h * h / 12.0 * 1.01 * begins_m_s2) << row.name << " step " << k;
        off_yaw.push_back(std::remainder(b.yaw_rad - a.yaw_rad - 0.5 * h * (a.turn_rad_s + b.turn_rad_s), 2.0 * kPi));
      }
      most_change = std::max(most_change, std::abs(b.turn_change_rad_s2));
      a = b;
    }
    // A rate of third degree: h^2 / 12 of what its derivative changes by within a step, at most twice its largest.
    for (const double off : off_yaw) ASSERT_LE(std::abs(off), kStep_s * kStep_s / 6.0 * most_change) << row.name;
    if (model->slips()) {
      EXPECT_GT(most_across, 0.01) << row.name;
    }
  }
}

}  // namespace
}  // namespace canyon::mission
