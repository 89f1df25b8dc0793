#include "canyon/mission/motion/vehicle.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/mission/boundaries.h"
#include "canyon/mission/motion/plan/kinematic_bicycle.h"
#include "canyon/mission/motion/side_slip.h"
#include "canyon/mission/motion/sprung_mass.h"
#include "canyon/mission/stress/subjects.h"
#include "canyon/scene/flat_ground.h"
#include "canyon/scene/mesh_builder.h"

namespace canyon::mission {
namespace {

using stress::kEpsilon;

const GpsTime kSetOff = GpsTime::from_week_sow(1610, 305000.0);

/// Amplitudes of the 24 waves of a road of class E together: each is the root of twice the variance of its band, whose
/// ends have the same ratio from 0.05 to 1.4 cycles/m (ISO 8608: 4096e-6 m^3 at 0.1 cycles/m, falling with n^2).
double amplitude_m(int i) {
  const double low = 0.05 * std::pow(28.0, i / 24.0), high = 0.05 * std::pow(28.0, (i + 1) / 24.0);
  return std::sqrt(2.0 * 4096e-6 * 0.01 * (1.0 / low - 1.0 / high));
}
double roughest_m() {
  double sum = 0.0;
  for (int i = 0; i < 24; ++i) sum += amplitude_m(i);
  return sum;
}
/// The root of the variance of all of them.
double road_sigma_m() {
  double sum = 0.0;
  for (int i = 0; i < 24; ++i) sum += 0.5 * std::pow(amplitude_m(i), 2);
  return std::sqrt(sum);
}

/// The gain from road to body of x'' = w^2 (u - x) + 2 zeta w (u' - x'), at r times its own frequency, and the largest.
double gain(double zeta, double r) {
  const double spring = 1.0 - r * r, damper = 2.0 * zeta * r;
  return std::sqrt((1.0 + damper * damper) / (spring * spring + damper * damper));
}
double largest_gain(double zeta) {
  double most = 1.0;
  for (double r = 0.01; r < 10.0; r *= 1.001) most = worse(most, gain(zeta, r));
  return most;
}

/// A road of waves of 1 mm at the body's own frequency, in steps of 1 ms: after 20 s, when what rang at the start is
/// e^(-zeta w 20 s) or less, the body swings by the gain times 1 mm. A road that stands for h
/// is sinc(w h / 2) of the wave; that, and the largest sample of a swing, are (w h)^2 / 24 and / 8 of it.
StressFigure resonance(double hz, double damping) {
  const double w = 2.0 * kPi * hz, h = 1e-3, start_s = 20.0 / std::min(1.0, hz);
  SprungMass mass(w, damping, 0.0);
  double swing_m = 0.0;
  for (int k = 0; k * h < start_s + 2.0 / hz; ++k) {
    const SprungMass::State& s = mass.advance(1e-3 * std::sin(w * h * k), h);
    if (k * h >= start_s) swing_m = worse(swing_m, std::abs(s.x));
  }
  return {std::abs(swing_m / (1e-3 * gain(damping, 1.0)) - 1.0), w * h * w * h + std::exp(-damping * w * start_s)};
}

/// Half a minute round a circle at 30 m/s on the roughest road: the body stays within what resonance can make of all
/// waves at once (twice, as it also rings from the start), and every state passes the run's own gate. And it moves: at
/// least half of what the longest wave alone makes of it, met head-on or slower.
StressFigure roughest_road(double hz, double damping) {
  VehicleConfig config;
  config.suspension_hz = hz;
  config.suspension_damping = damping;
  config.roughness = "E";
  config.max_speed_m_s = 30.0;
  Vehicle vehicle(config, scene::flat_ground(), 3, kSetOff);
  const Boundaries boundaries(kSetOff);
  const double level_m = scene::flat_ground().ground(0.0, 0.0)->height_m;
  stress::Worst worst;
  double lowest_m = stress::kInfinity, highest_m = -stress::kInfinity;
  for (int k = 0; k < 3000; ++k) {
    const KinematicState& s = vehicle.advance({30.0, 1.0 / 60.0});
    lowest_m = std::min(lowest_m, s.X_WB.p.z());
    highest_m = worse(highest_m, s.X_WB.p.z());
    worst.look(s.X_WB.p.z() - level_m, 2.0 * largest_gain(damping) * roughest_m());
    worst.look(boundaries.check(s).ok() && vehicle.on_terrain() ? 0.0 : stress::kInfinity, 1.0);
  }
  const double longest_hz = 30.0 * 0.05 * std::pow(28.0, 1.0 / 24.0);
  worst.look(0.5 * amplitude_m(0) * gain(damping, longest_hz / hz), 0.5 * (highest_m - lowest_m));
  return worst.figure();
}

/// Waves of 8 m along x, 5 mm high, in facets of 1/8 m, 300 m of them. Either level across, so that the axles' heights
/// differ, or turned: as high on the left track as it is low on the right.
constexpr double kWaveLength_m = 8.0, kWave_m = 0.005, kFacet_m = 0.125;
scene::Scene waves(double half_track_m, bool turned) {
  scene::SceneParts parts;
  parts.name = "waves";
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("ground", scene::ObjectKind::kTerrain);
  const auto asphalt = mesh.material("asphalt");
  const double across_m[] = {-4.0, -half_track_m, half_track_m, 4.0}, sides[] = {-1.0, -1.0, 1.0, 1.0};
  const auto at = [&](double x, int c) {
    const double z = kWave_m * std::sin(2.0 * kPi * x / kWaveLength_m);
    return Eigen::Vector3d(x, across_m[c], turned ? sides[c] * z : z);
  };
  for (double x = -8.0; x < 300.0; x += kFacet_m)
    for (int c = 0; c < 3; ++c)
      mesh.quad(at(x, c), at(x + kFacet_m, c), at(x + kFacet_m, c + 1), at(x, c + 1), asphalt);
  return scene::Scene(std::move(parts));
}

/// Driven straight over waves that come at r times the body's own frequency, it pitches by the gain times the slope
/// between its axles, 2 A sin(k b / 2) / b, and rolls by the gain times that between its tracks, 2 A / t, as both axles
/// feel it, cos(k b / 2); nothing else turns it. After five seconds at speed what the start left is
/// e^(-zeta w 5 s). A road that goes evenly over a step of h takes (w' h)^2 / 12 from a wave of w', and the largest
/// sample of a swing (w' h)^2 / 8; so do facets, (k d)^2 / 8; a slope s is its tangent to s^2 / 3; and tracks lie on
/// the facets' edges to single precision.
StressFigure gain_of_turns(double hz, double r, bool turned) {
  VehicleConfig config;
  config.roughness = "none";
  config.suspension_hz = hz;
  config.suspension_damping = 0.3;
  config.max_speed_m_s = 30.0;
  config.max_acceleration_m_s2 = 10.0;
  config.start_heading_deg = 90.0;
  const scene::Scene ground = waves(0.5 * config.track_m, turned);
  Vehicle vehicle(config, ground, 3, kSetOff);
  const double met_hz = r * hz, speed_m_s = kWaveLength_m * met_hz, k = 2.0 * kPi / kWaveLength_m;
  const double settled_s = 5.0 + speed_m_s / config.max_acceleration_m_s2;
  double pitch_rad = 0.0, roll_rad = 0.0;
  for (int n = 0; n * 0.01 < settled_s + 2.0 / met_hz; ++n) {
    const KinematicState& s = vehicle.advance({speed_m_s, 0.0});
    if (n * 0.01 < settled_s) continue;
    const Eigen::Matrix3d R = s.X_WB.R.toRotationMatrix();
    pitch_rad = worse(pitch_rad, std::abs(std::asin(R(2, 0))));
    roll_rad = worse(roll_rad, std::abs(std::atan2(R(2, 1), R(2, 2))));
  }
  const double b = config.wheelbase_m, w_h = 2.0 * kPi * met_hz * 0.01;
  const double pitches = 2.0 * kWave_m * std::sin(0.5 * k * b) / b,
               rolls = 2.0 * kWave_m * std::cos(0.5 * k * b) / config.track_m;
  const double expected = gain(config.suspension_damping, r) * (turned ? rolls : pitches);
  const double bound = (1.0 / 12.0 + 1.0 / 8.0) * w_h * w_h +
                       std::exp(-config.suspension_damping * 2.0 * kPi * hz * 5.0) +
                       std::pow(k * kFacet_m, 2) / 8.0 / std::sin(0.5 * k * b) + std::pow(2.0 * kWave_m / b, 2) / 3.0 +
                       8.0 * stress::kHalfUlp * 300.0 / kFacet_m;
  stress::Worst worst;
  worst.look((turned ? roll_rad : pitch_rad) / expected - 1.0, bound);
  worst.look(turned ? pitch_rad : roll_rad, bound * expected);
  worst.look(vehicle.on_terrain() ? 0.0 : stress::kInfinity, 1.0);
  return worst.figure();
}

/// Commands of any size, from one end to the other at every step: the limits of speed, acceleration, steering and its
/// rate hold, to four roundings.
StressFigure wild_commands() {
  VehicleConfig config;
  config.roughness = "none";
  Vehicle vehicle(config, scene::flat_ground(), 3, kSetOff);
  stress::Worst worst;
  const double most_curvature = std::tan(config.max_steering_deg * kDegree) / config.wheelbase_m;
  const double rate = config.max_steering_rate_deg_s * kDegree * 0.01;
  double steering = 0.0;
  const double slack = 1.0 + 4.0 * kEpsilon * 1e3;
  for (int k = 0; k < 4000; ++k) {
    const double size = std::pow(10.0, (k * 7) % 309), sign = k % 2 == 0 ? 1.0 : -1.0;
    const double asked = k % 500 < 300 ? 1.0 : -1.0;
    const KinematicState& s = vehicle.advance({asked * size, sign * size});
    const double speed = vehicle.speed_m_s();
    worst.look(speed, (speed < 0.0 ? config.max_reverse_m_s : config.max_speed_m_s) * slack);
    // In reverse what speeds it up points backwards.
    const double way = speed != 0.0 ? std::copysign(1.0, speed) : asked;
    const double along = way * s.a_WB_W.head<2>().dot((s.X_WB.R * Eigen::Vector3d::UnitX()).head<2>());
    worst.look(along, (along > 0.0 ? config.max_acceleration_m_s2 : config.max_deceleration_m_s2) * slack + 1e-9);
    if (std::abs(speed) < 0.5) {
      steering = 0.0;
      continue;
    }
    const double curvature = s.w_WB_B.z() / speed;
    worst.look(curvature, most_curvature * slack + 1e-6);  // pitch and roll of the flat road are below 1e-4
    const double now = std::atan(curvature * config.wheelbase_m);
    if (k > 0 && steering != 0.0) worst.look(now - steering, rate + 1e-6);
    steering = now;
  }
  return worst.figure();
}

StressFigure refused_commands() {
  int passed = 0;
  Vehicle vehicle({}, scene::flat_ground(), 3, kSetOff);
  const Eigen::Vector3d before = vehicle.state().X_WB.p;
  for (const double bad : {std::nan(""), stress::kInfinity, -stress::kInfinity}) {
    passed += stress::not_refused([&] { vehicle.advance({bad, 0.0}); });
    passed += stress::not_refused([&] { vehicle.advance({1.0, bad}); });
  }
  passed += vehicle.state().X_WB.p == before && vehicle.state().t == kSetOff ? 0 : 1;
  return {1.0 * passed, 0.0};
}

/// The law of the tyres, v = -k s (v' + s w), with the v' that comes out, at speeds that go evenly from rest to 30 m/s
/// and back while the wheel is turned to and fro. Ten roundings of the largest term, k s s w at its limit or v itself;
/// those of v' are of v / h, and count k s times.
StressFigure slip_law(double compliance_rad_s2_m) {
  SideSlip slip(compliance_rad_s2_m);
  constexpr double h = 0.01;
  const auto drive = [](double t_s) {
    const double speed = std::abs(std::remainder(t_s, 60.0));
    return SideSlip::Drive{speed, speed * speed * 0.01 * std::sin(0.7 * t_s)};
  };
  const double most_turning = SideSlip::kLargestSlip / compliance_rad_s2_m;
  stress::Worst worst;
  double most_m_s = 0.0;
  for (int k = 0; k < 12000; ++k) {
    const SideSlip::Drive end = drive((k + 1) * h);
    const SideSlip::Motion step = slip.advance(drive((k + 1.0 / 3.0) * h), end, h), now = slip.now();
    const double T = compliance_rad_s2_m * end.speed_m_s;
    const double turning = std::clamp(end.turning_m_s2, -most_turning, most_turning);
    const double size = std::abs(step.v_0) + std::abs(now.v_0) + T * std::abs(turning);
    worst.look(now.v_0 + T * (now.a_0 + turning), 10.0 * kEpsilon * size * (1.0 + T / h) + 1e-300);
    most_m_s = worse(most_m_s, std::abs(now.v_0));
  }
  // It does slip: by half of what the steepest turn at 20 m/s would make of it in the end, if T is short.
  worst.look(0.5 * std::min(compliance_rad_s2_m * 20.0 * 4.0, SideSlip::kLargestSlip * 10.0), most_m_s);
  return worst.figure();
}

/// Commands from one end to the other on the softest tyres: the run's own gate lets every state pass, and nothing slips
/// by more than kLargestSlip of the greatest speed.
StressFigure wildest_slip() {
  VehicleConfig config;
  config.roughness = "none";
  config.model.own.get<KinematicBicycleParameters>().sideslip_deg_per_m_s2 = 2.0;
  config.max_speed_m_s = 30.0;
  config.max_acceleration_m_s2 = config.max_deceleration_m_s2 = 10.0;
  config.max_steering_deg = 60.0;
  config.max_steering_rate_deg_s = 360.0;
  Vehicle vehicle(config, scene::flat_ground(), 3, kSetOff);
  const Boundaries boundaries(kSetOff);
  stress::Worst worst;
  double most_m_s = 0.0;
  for (int k = 0; k < 4000; ++k) {
    const KinematicState& s = vehicle.advance({k % 500 < 300 ? 1e300 : 0.0, k / 20 % 2 == 0 ? 1e300 : -1e300});
    const double square = s.v_WB_W.head<2>().squaredNorm() - std::pow(vehicle.speed_m_s(), 2);
    const double across = std::sqrt(square < 0.0 ? 0.0 : square);  // no number stays none
    most_m_s = worse(most_m_s, across);
    // The root of a difference of squares of 30 m/s: 2e-7 m/s.
    worst.look(across, SideSlip::kLargestSlip * config.max_speed_m_s + 1e-6);
    worst.look(boundaries.check(s).ok() ? 0.0 : stress::kInfinity, 1.0);
  }
  worst.look(0.5, most_m_s);  // it does slip
  return worst.figure();
}

/// Class E at 1e5 m from W's origin: within the waves' amplitudes, and between two places 1 mm apart no steeper than
/// all of them at once; their phases of up to 9e5 rad know themselves to an epsilon.
StressFigure far_roughness() {
  const RoadRoughness road("E", 5);
  stress::Worst worst;
  const double most_m = roughest_m(), steepest = 2.0 * kPi * 1.4 * most_m;
  double highest_m = 0.0;
  for (double x = -1e5; x <= 1e5; x += 777.7) {
    const Eigen::Vector2d p(x, 1e5 - 0.3 * x), beside = p + Eigen::Vector2d(1e-3, 0.0);
    worst.look(road.height_m(p), most_m);
    highest_m = worse(highest_m, std::abs(road.height_m(p)));
    worst.look(road.height_m(beside) - road.height_m(p), steepest * (1e-3 + 8.0 * kEpsilon * 2e5));
  }
  worst.look(road_sigma_m(), highest_m);  // of 258 places; a road that is flat there has none
  worst.look(RoadRoughness("none", 5).height_m({1e5, -1e5}), 1e-300);
  return worst.figure();
}

}  // namespace

std::vector<StressCase> vehicle_cases() {
  const StressMechanism rough{
      StressGroup::kStiff, "a resonance that the road feeds",
      "an explicit step feeds it beyond all bounds; one that damps lets no resonance be",
      "within the waves' amplitudes times the largest gain, and every state passes the run's gate", "of the bound"};
  const StressMechanism commands{StressGroup::kData, "commands beyond every limit",
                                 "a limit of the square, or a tangent at 90 degrees of steering",
                                 "speed, acceleration, steering and its rate stay within the vehicle's own limits",
                                 "of the bound"};
  const StressMechanism broken{StressGroup::kData, "a command that is not finite",
                               "it is clamped to a limit, and no number to none",
                               "is refused before anything has moved", "let through"};
  const StressMechanism far{StressGroup::kGeometry, "a wave's phase far from the origin",
                            "a phase in single precision, or waves that grow with it",
                            "within the amplitudes, no steeper than all waves at once", "of the bound"};
  StressRows rows;
  for (const double hz : {0.3, 5.0})
    for (const double damping : {0.05, 2.0})
      rows.of(rough).add("vehicle/roughest_road_" + stress::text(hz) + "_hz_damping_" + stress::text(damping),
                         [=] { return roughest_road(hz, damping); });
  const StressMechanism swings{
      StressGroup::kStiff, "a body at its own frequency", "a scheme that damps what it should let swing",
      "the gain sqrt(1 + 4 zeta^2) / (2 zeta), to the road's step times w and what still rings", ""};
  for (const double hz : {0.3, 5.0})
    for (const double damping : {0.05, 2.0})
      rows.of(swings).add("vehicle/resonance_" + stress::text(hz) + "_hz_damping_" + stress::text(damping),
                          [=] { return resonance(hz, damping); });
  const StressMechanism turns{StressGroup::kStiff, "a body that pitches and rolls over waves",
                              "a frequency of heave's that pitch or roll does not have, an axle or a track for another",
                              "the gain of a sprung mass times the slope between axles or tracks, to steps and facets",
                              "of the bound"};
  for (const double hz : {1.0, 3.0})
    for (const double r : {0.5, 1.0}) {
      const std::string name = "_over_waves_at_" + stress::text(r) + "_of_" + stress::text(hz) + "_hz";
      rows.of(turns).add("vehicle/pitch" + name, [=] { return gain_of_turns(hz, r, false); });
      rows.of(turns).add("vehicle/roll" + name, [=] { return gain_of_turns(hz, r, true); });
    }
  rows.of(commands).add("vehicle/commands_to_1e308", wild_commands);
  const StressMechanism slips{StressGroup::kStiff, "a slip that fades in far less or more than a step",
                              "an explicit step rings where k s << h, and at rest k s is 0 and divides; beside them "
                              "the velocity's derivative is "
                              "another one's than the force's",
                              "the tyres' law with the velocity's own derivative: ten roundings of its terms",
                              "of the bound"};
  for (const double k : {1e-12, 1e-6, 2.0 * kDegree})
    rows.of(slips).add("vehicle/slip_of_" + stress::text(k) + "_rad_s2_m", [=] { return slip_law(k); });
  const StressMechanism skids{
      StressGroup::kData, "steering from lock to lock at any speed, on soft tyres",
      "a slip that grows with the square of speed: kilometres a second sideways",
      "no more than the largest slip times the greatest speed, and every state passes the run's gate", "of the bound"};
  rows.of(skids).add("vehicle/slip_from_lock_to_lock", wildest_slip);
  rows.of(broken).add("vehicle/commands_not_finite", refused_commands);
  rows.of(far).add("vehicle/roughness_100_km_off", far_roughness);
  return rows.take();
}

}  // namespace canyon::mission
