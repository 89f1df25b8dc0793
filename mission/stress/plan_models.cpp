// Vehicles in the plane, step by step, against the equations that they state, integrated by another method.
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/mission/motion/plan/dynamic_bicycle.h"
#include "canyon/mission/motion/plan/skid_steer.h"
#include "canyon/mission/motion/road_roughness.h"
#include "canyon/mission/motion/vehicle_config.h"
#include "canyon/mission/scoring/sightings.h"
#include "canyon/mission/stress/subjects.h"
#include "canyon/mission/told_errors.h"

namespace canyon::mission {
namespace {

using Eigen::Vector2d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Looks;

double held(double x, double low, double high) {
  return x < low ? low : x > high ? high : x;
}

/// What a drive asks for: up to speed, through bends of both hands, braking in one, to a stop, and backwards.
DriveCommand asked(double t_s, double fastest) {
  if (t_s < 3.0) return {fastest, 0.0};
  if (t_s < 5.0) return {fastest, 0.03};
  if (t_s < 7.0) return {0.6 * fastest, -0.05};
  if (t_s < 8.0) return {0.3 * fastest, 0.3};
  if (t_s < 11.0) return {0.0, 0.3};
  if (t_s < 13.0) return {-1.0, -0.2};
  return {0.0, 0.0};
}

VehicleConfig vehicle_of(const std::string& model, const std::string& actuators) {
  VehicleConfig config;
  config.model.name = model;
  config.wheelbase_m = 2.5;
  config.track_m = 1.4;
  config.max_speed_m_s = 14.0;
  config.max_acceleration_m_s2 = 4.0;
  config.max_deceleration_m_s2 = 5.0;
  config.max_steering_rate_deg_s = 70.0;
  config.start_m = {3.0, -8.0};
  config.start_heading_deg = 70.0;
  if (actuators == "first_order") config.steering.name = config.drive.name = actuators;
  return config;
}

/// State of the equations: place, yaw, sideways velocity of what the model has there, yaw rate.
using State5 = std::array<double, 5>;
using Slope5 = std::function<State5(double tau, const State5&)>;
State5 plus(const State5& a, double h, const State5& b) {
  State5 out = a;
  for (std::size_t i = 0; i < 5; ++i) out[i] += h * b[i];
  return out;
}
/// Runge and Kutta's fourth order.
State5 integrated(State5 y, const Slope5& f, double dt_s, int pieces) {
  const double h = dt_s / pieces;
  for (int k = 0; k < pieces; ++k) {
    const double t = k * h;
    const State5 a = f(t, y), b = f(t + 0.5 * h, plus(y, 0.5 * h, a)), c = f(t + 0.5 * h, plus(y, 0.5 * h, b)),
                 d = f(t + h, plus(y, h, c));
    for (std::size_t i = 0; i < 5; ++i) y[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
  }
  return y;
}

/// The brush model, Pacejka's eq. 3.11 as he prints it; and the linear one.
double tyre_share(const std::string& law, double slip, double cornering, double friction) {
  const double size = std::abs(slip);
  double share = cornering * std::atan(size);
  if (law == "fiala") {
    const double c = cornering, m = friction;
    share = size < 3.0 * m / c
                ? c * size - c * c * size * size / (3.0 * m) + c * c * c * size * size * size / (27.0 * m * m)
                : m;
  }
  return -std::copysign(share < friction ? share : friction, slip);
}

/// The law of the speed, and what the actuators do within a step; then the model's own equations for the rest, both
/// from their documentation. Kinematics by Gauss and by Runge-Kutta agree to 2e-10 m; the dynamic model's own method is
/// of third order, 1e-4 of a turn at steps of 10 ms (as its tests measure) and so 2e-6 at 2.5 ms, over 14 s and 60 m.
StressFigure follows_equations(const std::string& model, const std::string& actuators, const std::string& law,
                               double dt_s) {
  VehicleConfig config = vehicle_of(model, actuators);
  const bool dynamic = model == "dynamic_bicycle", skid = model == "skid_steer";
  DynamicBicycleParameters car;
  SkidSteerParameters sides;
  if (dynamic) {
    car.tyres.name = law;
    car.front_cornering_per_deg = 0.17;
    car.gravity_centre_share = 0.42;
    car.gravity_centre_height_m = 0.7;
    car.yaw_inertia_ratio = 0.85;
    config.model.own.get<DynamicBicycleParameters>() = car;
  }
  if (skid) {
    sides.slip_track_ratio = 1.7;
    sides.slip_centre_share = 0.4;
    config.model.own.get<SkidSteerParameters>() = sides;
  }
  const auto made = model_row(plan_models(), model).make(config.model.own, config);
  const double L = config.wheelbase_m, lock = 32.0 * kPi / 180.0, fastest = dynamic ? 12.0 : 8.0;
  const double steering_lag_s = actuators == "first_order" ? 0.1 : 0.0, drive_lag_s = steering_lag_s > 0.0 ? 0.3 : 0.0;
  const double b = dynamic ? car.gravity_centre_share * L : 0.0, a = L - b;
  double v = 0.0, acceleration = 0.0, steering = 0.0, distance = 0.0, turn = 0.0;
  State5 y{config.start_m.x(), config.start_m.y(), 20.0 * kPi / 180.0, 0.0, 0.0};
  Looks looks;
  for (int k = 0; k * dt_s < 14.0; ++k) {
    const DriveCommand command = asked(k * dt_s, fastest);
    // Along: a tenth of a second, or four lags, to make a difference up; the acceleration changes evenly.
    const double way = v != 0.0 ? (v > 0.0 ? 1.0 : -1.0) : command.speed_m_s < 0.0 ? -1.0 : 1.0;
    const double target = held(way * command.speed_m_s, 0.0, way > 0.0 ? 14.0 : 1.5);
    const double within = 4.0 * drive_lag_s > 0.1 ? 4.0 * drive_lag_s : 0.1;
    const double wanted = way * held((target - way * v) / within, -5.0, 4.0);
    const double next = drive_lag_s > 0.0 ? first_order_after(acceleration, wanted, dt_s, drive_lag_s, 10.0) : wanted;
    double a0 = acceleration, jerk = (next - a0) / dt_s;
    if (target == 0.0 && way * (v + (a0 + 0.5 * jerk * dt_s) * dt_s) < 1e-3) a0 = -v / dt_s, jerk = 0.0;
    const auto speed = [&](double tau) { return v + a0 * tau + 0.5 * jerk * tau * tau; };
    const double angle = held(std::atan(command.curvature_1_m * L), -lock, lock);
    const double rate = 70.0 * kPi / 180.0;
    const double turned = steering_lag_s > 0.0 ? first_order_after(steering, angle, dt_s, steering_lag_s, rate)
                                               : steering + held(angle - steering, -rate * dt_s, rate * dt_s);
    const auto wheels = [&](double tau) { return steering + (turned - steering) * tau / dt_s; };
    const double curvature0 = std::tan(steering) / L, curvature1 = std::tan(turned) / L;
    const double most_curvature = std::tan(lock) / L, half = 0.5 * 1.7 * 1.4;
    const double turn_wanted = held(speed(dt_s) * held(command.curvature_1_m, -most_curvature, most_curvature),
                                    -120.0 * kPi / 180.0, 120.0 * kPi / 180.0);
    const double turn_next = turn + held(turn_wanted - turn, -3.0 / half * dt_s, 3.0 / half * dt_s);
    const auto slope = [&](double tau, const State5& s) {
      const double u = speed(tau), c = std::cos(s[2]), n = std::sin(s[2]);
      double across = 0.0, w = 0.0;
      State5 out{};
      if (dynamic) {
        w = s[4], across = s[3] - b * w;
        const double d = wheels(tau), shift = 0.7 / L * (a0 + jerk * tau), g = 9.80665;
        const double front = g * b / L - shift > 0.0 ? g * b / L - shift : 0.0,
                     rear = g * a / L + shift > 0.0 ? g * a / L + shift : 0.0;
        const double at_front = s[3] + a * w, along_wheel = u * std::cos(d) + at_front * std::sin(d);
        const double fast_f = std::abs(along_wheel) > 1e-3 ? std::abs(along_wheel) : 1e-3,
                     fast_r = std::abs(u) > 1e-3 ? std::abs(u) : 1e-3;
        const double ff =
            front * tyre_share(law, (at_front * std::cos(d) - u * std::sin(d)) / fast_f, 0.17 * 180.0 / kPi, 0.9);
        const double fr = rear * tyre_share(law, across / fast_r, 0.2 * 180.0 / kPi, 0.9);
        out[3] = ff * std::cos(d) + fr - u * w;
        out[4] = (a * ff * std::cos(d) - b * fr) / (0.85 * a * b);
      } else if (skid) {
        w = turn + (turn_next - turn) * tau / dt_s;
        across = -0.4 * L * w;
      } else {
        w = u * (curvature0 + (curvature1 - curvature0) * tau / dt_s);
      }
      out[0] = u * c - across * n;
      out[1] = u * n + across * c;
      out[2] = w;
      return out;
    };
    const bool moves = v != 0.0 || speed(dt_s) != 0.0;
    // Tyres at a crawl are stiff: their slip fades within C g dt / u; there the two are compared before it alone.
    const bool crawls = dynamic && std::abs(speed(dt_s)) < 0.5 && k * dt_s > 3.0;
    if (crawls) break;
    const int pieces = !dynamic ? 4 : std::abs(v) < 0.5 ? 4000 : 40;
    if (moves) y = integrated(y, slope, dt_s, pieces);
    distance += way * (v * dt_s + a0 * dt_s * dt_s / 2.0 + jerk * dt_s * dt_s * dt_s / 6.0);
    const bool stops = way * speed(dt_s) <= 0.0;
    const double v_next = stops ? 0.0 : speed(dt_s), a_next = stops ? 0.0 : a0 + jerk * dt_s;
    v = v_next, acceleration = a_next, steering = turned, turn = stops ? 0.0 : turn_next;
    if (stops) y[3] = y[4] = 0.0;
    made->advance(command, dt_s);
    const PlanState& s = made->state();
    const double scale = dynamic ? 1.0 : 2e-7;
    looks.near((s.p_W - Vector2d(y[0], y[1])).norm(), 0.0, 1e-3 * scale);
    looks.near(std::remainder(s.yaw_rad - y[2], 2.0 * kPi), 0.0, 2e-5 * scale);
    looks.near(s.forward_m_s, v, 1e-13);
    looks.near(s.forward_change_m_s2, acceleration, 1e-11);
    looks.near(s.distance_m, distance, 1e-11);
    const double w = dynamic ? y[4] : skid ? turn : v * curvature1;
    looks.near(s.turn_rad_s, w, 1e-5 * scale);
    looks.near(s.across_m_s, dynamic ? y[3] - b * w : skid ? -0.4 * L * turn : 0.0, 3e-5 * scale);
  }
  return looks.figure();
}

/// An actuator's answer by its own equation in 20000 steps, each exact to first order: 1e-4 of what it goes; and
/// both tyres' laws and slopes by differences.
StressFigure actuators_and_tyres() {
  Looks looks;
  const RandomStream draws(2, "stress.actuators");
  for (std::uint64_t k = 0; k < 60; ++k) {
    const double now = draws.uniform(-2, 2, 0, k), wanted = draws.uniform(-2, 2, 1, k),
                 dt_s = draws.uniform(0.01, 1, 2, k), lag_s = k % 5 == 0 ? 0.0 : draws.uniform(0.02, 0.5, 3, k),
                 most = draws.uniform(0.5, 9, 4, k);
    double y = now;
    constexpr int kSteps = 20000;
    const double h = dt_s / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      const double free = lag_s > 0.0 ? (wanted - y) / lag_s : std::copysign(kInfinity, wanted - y);
      const double step = h * held(free, -most, most);
      y = std::abs(step) > std::abs(wanted - y) ? wanted : y + step;
    }
    looks.near(first_order_after(now, wanted, dt_s, lag_s, most), y, 1e-3 * (1e-3 + std::abs(wanted - now)));
  }
  for (const char* law : {"linear", "fiala"})
    for (double slip = -0.6; slip <= 0.6; slip += 0.0137)
      for (const double friction : {0.3, 0.9}) {
        const auto at = [&](double s) { return model_row(tyre_laws(), law).make(s, 11.0, friction); };
        looks.near(at(slip).share, tyre_share(law, slip, 11.0, friction), 1e-14);
        // Differences: h^2 of the third derivative, C^3 / mu^2, and rounding over h; not over the kink.
        if (std::abs(std::abs(at(slip).share) - friction) < 1e-4 && at(slip).slope != 0.0) continue;
        const double h = 1e-6;
        if (std::abs(at(slip + h).slope - at(slip - h).slope) > 0.1) continue;
        looks.near(at(slip).slope, (at(slip + h).share - at(slip - h).share) / (2.0 * h), 1e-6);
      }
  return looks.figure();
}

/// Mean squares of height and slope over a plane of 10 km, of 24 waves in bands of one ratio from 0.05 to 1.4 per metre
/// under 16e-6 4^k (0.1 / n)^2: each mean square is known to 5 sqrt(2 / N) of it, N = 40000.
StressFigure road_spectrum(const std::string& grade, int k) {
  const RoadRoughness road(grade, 4);
  const RandomStream draws(9, "stress.road");
  double height2 = 0.0, slope2 = 0.0;
  constexpr int kN = 40000;
  for (std::uint64_t i = 0; i < kN; ++i) {
    const Vector2d p(draws.uniform(-5e3, 5e3, 0, i), draws.uniform(-5e3, 5e3, 1, i));
    const double h = 1e-3;
    height2 += road.height_m(p) * road.height_m(p) / kN;
    for (const Vector2d& d : {Vector2d(h, 0.0), Vector2d(0.0, h)}) {
      const double slope = (road.height_m(p + d) - road.height_m(p - d)) / (2.0 * h);
      slope2 += slope * slope / kN;
    }
  }
  const double density = 16e-6 * std::pow(4.0, k);
  double expected_slope2 = 0.0;
  for (int i = 0; i < 24; ++i) {
    const double low = 0.05 * std::pow(28.0, i / 24.0), high = 0.05 * std::pow(28.0, (i + 1) / 24.0);
    // k^2 = (2 pi)^2 low high of the band's variance density 0.01 (1 / low - 1 / high).
    expected_slope2 += 4.0 * kPi * kPi * density * 0.01 * (high - low);
  }
  Looks looks;
  const double share = 5.0 * std::sqrt(2.0 / kN);
  looks.near(height2 / (density * 0.01 * (20.0 - 1.0 / 1.4)), 1.0, share);
  looks.near(slope2 / expected_slope2, 1.0, share);
  return looks.figure();
}

/// What scans showed of a thing, by hand; and errors told to an autonomy, by their sizes.
StressFigure sightings_and_told() {
  Looks looks;
  const GpsTime start = GpsTime::from_week_sow(1600, 100.0);
  Sightings seen;
  const auto scan = [&](double t_s, std::vector<std::pair<std::uint32_t, float>> returns) {
    std::vector<LidarPointTruth> truth(returns.size());
    for (std::size_t i = 0; i < returns.size(); ++i)
      truth[i].object = returns[i].first, truth[i].range_m = returns[i].second;
    seen.scan(start + t_s, truth);
  };
  looks.right(!seen.of(2, start));
  scan(0.0, {{2, 9.0f}, {1, 4.0f}, {2, 7.0f}, {2, 8.0f}});
  scan(0.4, {{2, 6.0f}});
  scan(0.8, {{2, 5.0f}, {2, 5.5f}});
  const auto a = seen.of(2, start + 1.0), b = seen.of(1, start + 1.0);
  if (!a || !b || seen.of(0, start)) return {kInfinity, 1.0};
  looks.near(a->range_m, 5.0, 1e-12), looks.near(a->stood_s, 0.8, 1e-15), looks.near(a->ago_s, 0.2, 1e-15);
  looks.near(b->range_m, 4.0, 1e-12), looks.near(b->stood_s, 0.0, 1e-15), looks.near(b->ago_s, 1.0, 1e-15);
  scan(1.4, {{2, 3.0f}});
  looks.near(seen.of(2, start + 1.5)->stood_s, 0.0, 1e-15);
  scan(1.8, {{2, 2.0f}});
  looks.near(seen.of(2, start + 2.0)->stood_s, 0.4, 1e-15);

  ToldErrors errors;
  errors.step_m = 3.0, errors.step_every_s = 7.0, errors.heading_deg = 2.0;
  const ToldErrorDraws steps(errors, 5, start);
  ToldErrors drifting;
  drifting.drift_m_s = 0.04;
  const ToldErrorDraws drift(drifting, 5, start);
  Eigen::Vector3d last = Eigen::Vector3d::Zero();
  for (int k = 0; k < 60; ++k) {
    NavEstimate e;
    e.t = start + 0.97 * k;
    e.X_WB.p = {10.0, -4.0, 2.0};
    e.X_WB.R = rotation_from({.yaw_rad = 1.0, .pitch_rad = 0.02, .roll_rad = 0.01});
    NavEstimate other = e, plain = e;
    steps.lay_over(e), drift.lay_over(other);
    const Eigen::Vector3d moved = e.X_WB.p - plain.X_WB.p;
    looks.near(moved.norm(), 0.97 * k < 7.0 ? 0.0 : 3.0, 2e-13);
    looks.near(moved.z(), 0.0, 1e-12);
    const bool anew = std::floor(0.97 * k / 7.0) != std::floor(0.97 * (k - 1) / 7.0);
    looks.right(k == 0 || (anew ? (moved - last).norm() > 1e-3 : (moved - last).norm() < 1e-12));
    last = moved;
    // A heading too large by 2 degrees is a yaw too small.
    looks.near(yaw_pitch_roll(e.X_WB.R).yaw_rad, 1.0 - 2.0 * kPi / 180.0, 1e-12);
    looks.near((other.X_WB.p - plain.X_WB.p).norm(), 0.04 * 0.97 * k, 1e-10);
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> plan_model_cases() {
  StressRows rows;
  rows.of(
      {.group = StressGroup::kStiff,
       .mechanism = "a vehicle's way under commands that change, by its equations",
       .why = "a load shifted to the other axle, a limit of the other unit, a slip of the other sign: all still "
              "drive",
       .expected = "place, yaw and rates by Runge and Kutta of what the models state, 1e-5 of a turn where tyres slip",
       .unit = "of the bound"});
  for (const char* actuators : {"rate_limit", "first_order"}) {
    const std::string with = std::string("_by_") + actuators;
    for (const char* model : {"kinematic_bicycle", "skid_steer"})
      rows.add(std::string("plan_models/") + model + with,
               [=] { return follows_equations(model, actuators, "fiala", 0.01); });
    for (const char* law : {"linear", "fiala"})
      rows.add(std::string("plan_models/dynamic_bicycle_") + law + with,
               [=] { return follows_equations("dynamic_bicycle", actuators, law, 0.0025); });
  }
  rows.of({.group = StressGroup::kStiff,
           .mechanism = "answers of actuators, tyres and roads",
           .why = "a limit that ends too late, a slope that is not that of the force, a spectrum of another reference",
           .expected = "equations in small steps, differences, mean squares of the spectrum to five deviations",
           .unit = "of the bound"});
  rows.add("plan_models/actuators_and_tyres", actuators_and_tyres);
  for (const auto& [grade, k] : {std::pair("A", 0), std::pair("C", 2), std::pair("E", 4)})
    rows.add(std::string("plan_models/road_of_class_") + grade,
             [g = std::string(grade), k = k] { return road_spectrum(g, k); });
  rows.of({.group = StressGroup::kData,
           .mechanism = "what scans had shown, and what an autonomy is told wrongly",
           .why = "a gap that is none, the farthest return of a scan, an error of the other hand",
           .expected = "by hand: rounding of instants",
           .unit = "of the bound"});
  rows.add("plan_models/sightings_and_told_errors", sightings_and_told);
  return rows.take();
}

}  // namespace canyon::mission
