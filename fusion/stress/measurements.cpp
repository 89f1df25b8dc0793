// Each row of measurements: what it is told where the filter is right, and its derivative.
#include <functional>
#include <vector>

#include <Eigen/Cholesky>

#include "canyon/core/earth/standard_atmosphere.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/stress_rows.h"
#include "canyon/fusion/measurements/measurement.h"
#include "canyon/fusion/states/receiver_clock.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/stress/subjects.h"

namespace canyon::fusion {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Worst;

const LocalFrame kFrame(Geodetic{32.35 * kDegree, -90.88 * kDegree, 60.0});
const Vector3d kImu(0.3, -0.1, 0.9), kAntenna(-0.4, 0.2, 1.7), kWheel(0.1, 0.8, -0.2);
const GpsTime kNow = GpsTime::from_week_sow(1590, 396000.0);
/// What the unit puts out: a bend, braked, over a bump.
const Vector3d kRate(0.05, -0.08, 0.4), kForce(-1.2, 2.1, 10.4);
constexpr double kRadius_m = 6.4e6;

ImuNoise noise_of_all() {
  ImuNoise n;
  n.gyro = {.turn_on_bias_sigma = 1e-3, .in_run_bias_sigma = 1e-4, .scale_sigma = 1e-3, .misalignment_sigma_rad = 1e-3};
  n.accel = {
      .turn_on_bias_sigma = 1e-2, .in_run_bias_sigma = 1e-3, .scale_sigma = 1e-3, .misalignment_sigma_rad = 1e-3};
  return n;
}

/// A state with every block in some size, on a bend, and what a measurement sees of it. Or without any beside motion.
class Stage {
 public:
  explicit Stage(bool all_blocks = true)
      : state_(all_blocks ? model_names(state_blocks()) : std::vector<std::string>{"receiver_clock", "clone"},
               FilterConfig().own, {.noise = noise_of_all()}) {
    NavState nav;
    nav.t = kNow;
    nav.R_EU = Eigen::Quaterniond(kFrame.R_EW()) * rotation_from({.yaw_rad = 0.7, .pitch_rad = 0.05, .roll_rad = -0.1});
    nav.p_EU_E = kFrame.to_E({30.0, -20.0, 2.0});
    nav.v_EU_E = nav.R_EU * Vector3d(9.0, 0.3, -0.2);
    state_.start(nav);
    state_.take_clone();
    state_.nav.R_EU = state_.nav.R_EU * rotation_from({.yaw_rad = 0.2, .pitch_rad = -0.02, .roll_rad = 0.03});
    state_.nav.p_EU_E += state_.nav.R_EU * Vector3d(4.0, 0.7, 0.1);
    Eigen::VectorXd values = Eigen::VectorXd::Zero(state_.padded_size());
    if (all_blocks)
      for (int i = ErrorIndex::kMoving; i < state_.size(); ++i) values[i] = 1e-3 * std::sin(2.0 * i);
    state_.inject(values);
  }
  ErrorState& state() { return state_; }

  /// Part `part` of the message; without one what comes of the motion itself.
  std::optional<Measurement> measure(MeasurementModel& model, const AidingMessage* message, int part) {
    const Calibration& imu = state_.step_calibration(Eigen::VectorXd::Ones(state_.padded_size()));
    const Increments in = imu.apply(0.01, 0.01 * kRate, 0.01 * kForce);
    state_.feeds(in);
    w_U_ = in.dtheta_U / in.dt_s - state_.nav.R_EU.conjugate() * earth_rate_E();
    f_U_ = in.dv_U / in.dt_s;
    const FilterView view{.state = state_,
                          .frame = kFrame,
                          .lever_U_B = kImu,
                          .lever_A_B = kAntenna,
                          .imu = imu,
                          .w_EU_U = w_U_,
                          .f_U = f_U_};
    if (message != nullptr) {
      if (model.parts(view, *message) <= part) return std::nullopt;
      return model.received(view, *message, part);
    }
    model.start();
    std::optional<Measurement> made;
    for (int k = 0; k < 1000 && !made; ++k) made = model.stepped(view, in);
    return made;
  }
  const Vector3d& w_U() const { return w_U_; }
  const Vector3d& f_U() const { return f_U_; }

 private:
  ErrorState state_;
  Vector3d w_U_, f_U_;
};

Matrix6d some_covariance() {
  return (Vector6d() << 1e-4, 2e-4, 3e-4, 0.01, 0.02, 0.03).finished().asDiagonal();
}

GnssObservation some_satellite() {
  GnssObservation o;
  o.sv = {GnssSystem::kGalileo, 3};
  o.p_E = kFrame.to_E({8e6, 6e6, 2e7});
  o.v_E = kFrame.R_EW() * Vector3d(2000.0, -1500.0, 700.0);
  o.sigma_m = 2.0;
  o.cn0_dbhz = 40.0;
  return o;
}

/// Of each row a message that is off by some metres, degrees and pascals.
AidingMessage some_message(const std::string& row) {
  if (row == "position" || row == "velocity") {
    GnssFix fix;
    fix.t = kNow + 0.03;
    fix.status = FixStatus::kSingle;
    fix.p_A_E = kFrame.to_E({31.0, -19.0, 4.0});
    fix.v_A_E = kFrame.R_EW() * Vector3d(5.0, 7.0, 0.1);
    fix.covariance_E = 4.0 * Eigen::Matrix3d::Identity();
    fix.velocity_covariance_E = 0.01 * Eigen::Matrix3d::Identity();
    return fix;
  }
  if (row == "odometer") return OdometerSample{.t = kNow, .dt_s = 0.2, .ticks = 88, .speed_m_s = 8.8};
  if (row == "heading") return HeadingSample{.t = kNow, .heading_rad = 0.8, .sigma_rad = 0.01};
  if (row == "barometer") return BarometerSample{.t = kNow, .pressure_pa = 100500.0};
  if (row == "magnetometer") return MagnetometerSample{.t = kNow, .field_U_t = {1e-5, 2e-5, -4e-5}};
  if (row == "relative_pose")
    return RelativePose{.source = kNow,
                        .target = kNow,
                        .X_TS = {rotation_from({.yaw_rad = 0.25, .pitch_rad = 0.0, .roll_rad = 0.0}), {4.1, 0.5, 0.3}},
                        .covariance = some_covariance()};
  if (row == "map_pose")
    return PoseInMap{.t = kNow,
                     .X_WB = {rotation_from({.yaw_rad = 0.95, .pitch_rad = 0.0, .roll_rad = 0.0}), {32.0, -17.0, 1.0}},
                     .covariance = some_covariance()};
  GnssObservation o = some_satellite();
  o.pseudorange_m = 2.24e7;
  o.rate_m_s = 100.0;
  return GnssEpoch{.t = kNow + 0.02, .observations = {o}};
}

bool of_motion(const std::string& row) {
  return row == "non_holonomic" || row == "standstill";
}

std::unique_ptr<MeasurementModel> model_of(const std::string& row, Stage& stage) {
  const FilterConfig config = configured(
      "standstill_speed_m_s = 100\nstandstill_rate_deg_s = 100\nodometer_wheel_m = [0.1, 0.8, -0.2]\n"
      "magnetic_declination_deg = 12");
  return model_row(measurement_models(), row).make(config.own, {.state = stage.state(), .noise = noise_of_all()});
}

/// H against central differences of the residual over a step of each state. What the difference leaves out is the
/// third derivative times step^2 / 6: angles are 1e-4 rad, places 10 m of the Earth's radius, velocities linear but for
/// light of 2e7 m (1 m/s over 0.1 s), values of the blocks 1e-3 rad or parts, four of which meet in a product. What it
/// rounds are places of 6e6 m and ranges of 2e7 m, an ulp of 4e-9 m, over the step.
StressFigure derivative(const std::string& row, int part) {
  Stage stage;
  const auto model = model_of(row, stage);
  const AidingMessage message = of_motion(row) ? AidingMessage() : some_message(row);
  const AidingMessage* const given = of_motion(row) ? nullptr : &message;
  const auto at = stage.measure(*model, given, part);
  Worst worst;
  if (!at || at->R.llt().info() != Eigen::Success || at->R != at->R.transpose()) return {stress::kInfinity, 1.0};
  for (int j = 0; j < stage.state().size(); ++j) {
    const double step = j < 3 ? 1e-4 : j < 6 ? 10.0 : j < 9 ? 1.0 : 1e-3;
    const auto residual = [&](double by) {
      Stage moved;
      Eigen::VectorXd e = Eigen::VectorXd::Zero(moved.state().padded_size());
      e[j] = by;
      moved.state().inject(e);
      return moved.measure(*model, given, part)->residual;
    };
    // The estimate moves towards the truth by e, and the residual loses H e.
    const Measurement::Vector numeric = (residual(-step) - residual(step)) / (2.0 * step);
    const double size = std::max(1.0, at->H.col(j).cwiseAbs().maxCoeff<Eigen::PropagateNaN>());
    const double curved = j < 3   ? step * step
                          : j < 6 ? step * step / (kRadius_m * kRadius_m)
                          : j < 9 ? 1e-9
                                  : 0.1 * step * step;
    worst.look((numeric - at->H.col(j)).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(), curved * size + 4e-9 / step);
  }
  return worst.figure();
}

/// Without blocks, at a known place, attitude and velocity: the message that these make leaves nothing, and the noise
/// is the one stated. Places and ranges round by an ulp of 2e7 m, four times; angles and speeds by 32 eps of 10.
StressFigure nothing_left() {
  Stage stage(false);
  const NavState& nav = stage.state().nav;
  const Pose X_WU = kFrame.X_EW().inverse() * Pose{nav.R_EU, nav.p_EU_E};
  const Pose X_WB{X_WU.R, X_WU * -kImu};
  Worst worst;
  const auto left = [&](const std::string& row, const AidingMessage* message, int part, double bound,
                        const Measurement::Square& R, double expected = 0.0) {
    const auto model = model_of(row, stage);
    const auto m = stage.measure(*model, message, part);
    if (!m) return worst.look(stress::kInfinity, 1.0);
    worst.look((m->residual.array() - expected).abs().maxCoeff<Eigen::PropagateNaN>(), bound);
    worst.look((m->R - R).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(),
               8.0 * kEpsilon * R.cwiseAbs().maxCoeff<Eigen::PropagateNaN>());
  };
  const auto square = [](double x) { return Measurement::Square::Constant(1, 1, x); };
  const double ulp_m = 4.0 * 4e-9, ulp = 320.0 * kEpsilon;
  stage.measure(*model_of("standstill", stage), nullptr, 0);  // so that the turn is known
  const Vector3d arm_U = kAntenna - kImu, turning = stage.w_U();

  GnssFix fix;
  fix.t = kNow;
  fix.status = FixStatus::kSingle;
  fix.p_A_E = nav.p_EU_E + nav.R_EU * arm_U;
  fix.v_A_E = nav.v_EU_E + nav.R_EU * turning.cross(arm_U);
  fix.covariance_E = Vector3d(1.0, 2.0, 3.0).asDiagonal();
  AidingMessage message = fix;
  left("position", &message, 0, ulp_m, fix.covariance_E);

  const Vector3d ahead_W = X_WB.R * Vector3d::UnitX();
  message = HeadingSample{.t = kNow, .heading_rad = std::atan2(ahead_W.x(), ahead_W.y()), .sigma_rad = 0.01};
  left("heading", &message, 0, ulp, square(1e-4));

  const double height_m = geodetic_from_ecef(nav.p_EU_E).h_m;
  message = BarometerSample{.t = kNow, .pressure_pa = standard_pressure_pa(height_m)};
  left("barometer", &message, 0, ulp_m, square(0.25));

  const double east = 12.0 * kDegree, down = 60.0 * kDegree;
  const Vector3d field_W(50e-6 * std::cos(down) * std::sin(east), 50e-6 * std::cos(down) * std::cos(east),
                         -50e-6 * std::sin(down));
  message = MagnetometerSample{.t = kNow, .field_U_t = X_WU.R.conjugate() * field_W};
  left("magnetometer", &message, 0, 10.0 * ulp, Measurement::Square::Identity(3, 3));

  message = PoseInMap{.t = kNow, .X_WB = X_WB, .covariance = some_covariance()};
  left("map_pose", &message, 0, ulp_m, some_covariance());

  const auto& clone = *stage.state().clone();
  const Pose then = Pose{clone.R_EU, clone.p_EU_E} * Pose{Eigen::Quaterniond::Identity(), -kImu},
             now = Pose{nav.R_EU, nav.p_EU_E} * Pose{Eigen::Quaterniond::Identity(), -kImu};
  message = RelativePose{.source = kNow, .target = kNow, .X_TS = then.inverse() * now, .covariance = some_covariance()};
  left("relative_pose", &message, 0, ulp_m, some_covariance());

  // The clock is set by the farther one of two: the nearer one's pseudorange is 5 m less than that says.
  GnssEpoch epoch{.t = kNow, .observations = {some_satellite(), some_satellite()}};
  for (int i = 0; i < 2; ++i) {
    GnssObservation& o = epoch.observations[static_cast<std::size_t>(i)];
    o.p_E += i * Vector3d(1e7, -2e7, 3e6);
    const Vector3d to_E = o.p_E - fix.p_A_E;
    o.clock_m = i == 0 ? -40.0 : 10.0;
    o.correction_m = i == 0 ? -23.0 : 3.0;
    o.pseudorange_m = to_E.norm() + 1000.0 + 5.0 * i - o.clock_m + o.correction_m;
    o.rate_m_s = to_E.normalized().dot(o.v_E - fix.v_A_E) + 2.0;
  }
  message = epoch;
  left("ranges", &message, 0, ulp_m, square(4.0), -5.0);
  left("ranges", &message, 1, 500.0 * ulp, square(0.2 * 0.2), 2.0);
  left("ranges", &message, 2, ulp_m, square(4.0));

  // A mean over 0.5 s is that of its middle, a quarter of a second's acceleration before.
  const Vector3d v_U = nav.R_EU.conjugate() * nav.v_EU_E, earth_U = nav.R_EU.conjugate() * earth_rate_E(),
                 a_U = stage.f_U() + nav.R_EU.conjugate() * gravity_E(nav.p_EU_E) - 2.0 * earth_U.cross(v_U) -
                       turning.cross(v_U);
  const double wheel_m_s = (v_U + turning.cross(kWheel - kImu)).x(), edges_m_s = 0.02 / 0.5 / std::sqrt(6.0);
  message = OdometerSample{.t = kNow, .dt_s = 0.5, .ticks = 1, .speed_m_s = wheel_m_s};
  left("odometer", &message, 0, ulp, square(edges_m_s * edges_m_s + std::pow(0.003 * wheel_m_s, 2)), 0.25 * a_U.x());
  return worst.figure();
}

/// What is not a number, of another instant, or of no place is no measurement of that row; a figure counts what is one.
StressFigure no_measurement() {
  Stage stage;
  int made = 0;
  const auto count = [&](const std::string& row, const AidingMessage& message, int part = 0) {
    made += stage.measure(*model_of(row, stage), &message, part).has_value() ? 1 : 0;
  };
  const double nan = std::nan("");
  for (const auto& row : measurement_models())
    for (const auto& other : measurement_models()) {
      const std::string a = row.name, b = other.name;
      const bool of_fix = (a == "position" || a == "velocity") && (b == "position" || b == "velocity");
      if (!of_motion(b) && a != b && !of_fix) count(a, some_message(b));
    }
  for (const double pa : {nan, stress::kInfinity, 0.0, -1.0, 2e5}) count("barometer", BarometerSample{kNow, pa});
  for (const double rad : {nan, stress::kInfinity}) {
    count("heading", HeadingSample{kNow, rad, 0.01});
    count("heading", HeadingSample{kNow, 0.8, rad});
    count("magnetometer", MagnetometerSample{kNow, {1e-5, rad, 1e-5}});
  }
  auto relative = std::get<RelativePose>(some_message("relative_pose"));
  relative.target = kNow + 0.01;
  count("relative_pose", relative);
  relative.target = kNow;
  relative.source = kNow + -0.01;
  count("relative_pose", relative);
  relative.source = kNow;
  relative.covariance(2, 2) = nan;
  count("relative_pose", relative);
  auto epoch = std::get<GnssEpoch>(some_message("ranges"));
  for (const int part : {0, 1}) {
    GnssEpoch bad = epoch;
    bad.observations[0].p_E.y() = nan;
    count("ranges", bad, part);
    bad = epoch;
    (part == 0 ? bad.observations[0].pseudorange_m : bad.observations[0].rate_m_s) = nan;
    count("ranges", bad, part);
  }
  return {1.0 * made, 0.0};
}

}  // namespace

std::vector<StressCase> measurement_cases() {
  const StressMechanism differences{
      StressGroup::kGeometry, "the derivative of a measurement with every state in some size",
      "a lever arm, a turn or a block that stands in the residual and not in H, or with the other sign",
      "H is the difference of the residual, to the step's third derivative and an ulp of its places over the step",
      "of the bound"};
  const StressMechanism exact{StressGroup::kGeometry, "a measurement of what the state itself says",
                              "a frame, a unit or a sign that a filter learns to live with",
                              "no residual, and the noise as stated: roundings", "of the bound"};
  const StressMechanism none{StressGroup::kData, "a message that is none of a measurement",
                             "not a number, another instant or another row's message corrects the filter",
                             "no measurement is made", "made"};
  StressRows rows;
  for (const auto& row : measurement_models()) {
    const std::string name = row.name;
    rows.of(differences).add("measurement/derivative_of_" + name, [name] { return derivative(name, 0); });
    if (name == "ranges") rows.add("measurement/derivative_of_range_rates", [name] { return derivative(name, 1); });
  }
  rows.of(exact).add("measurement/nothing_is_left_at_the_truth", nothing_left);
  rows.of(none).add("measurement/no_measurement_of_what_is_none", no_measurement);
  return rows.take();
}

}  // namespace canyon::fusion
