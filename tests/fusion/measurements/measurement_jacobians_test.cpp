// What every measurement says of the errors is the derivative of its residual.
#include <cmath>
#include <functional>
#include <ostream>

#include <gtest/gtest.h>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/units.h"
#include "canyon/fusion/filter_config.h"
#include "canyon/fusion/measurements/measurement.h"

namespace canyon::fusion {
namespace {

const LocalFrame kJacobianFrame(Geodetic{32.35 * kDegree, -90.88 * kDegree, 60.0});
const Eigen::Vector3d kJacobianImu(0.3, -0.1, 0.9), kJacobianAntenna(-0.4, 0.2, 1.7);
const GpsTime kNow = GpsTime::from_week_sow(1590, 396000.0);
/// What the unit puts out: a bend, braked, over a bump.
const Eigen::Vector3d kRate(0.05, -0.08, 0.4), kForce(-1.2, 2.1, 10.4);

ImuNoise noise() {
  ImuNoise n;
  n.gyro = {.turn_on_bias_sigma = 1e-3, .in_run_bias_sigma = 1e-4, .scale_sigma = 1e-3, .misalignment_sigma_rad = 1e-3};
  n.accel = {
      .turn_on_bias_sigma = 1e-2, .in_run_bias_sigma = 1e-3, .scale_sigma = 1e-3, .misalignment_sigma_rad = 1e-3};
  return n;
}

/// A filter with every state block in some state, and what a measurement sees of it, all of it a function of the state.
class Stage {
 public:
  Stage() : state_(model_names(state_blocks()), FilterConfig().own, {.noise = noise()}) {
    NavState nav;
    nav.t = kNow;
    nav.R_EU = Eigen::Quaterniond(kJacobianFrame.R_EW()) *
               rotation_from({.yaw_rad = 0.7, .pitch_rad = 0.05, .roll_rad = -0.1});
    nav.p_EU_E = kJacobianFrame.to_E({30.0, -20.0, 2.0});
    nav.v_EU_E = nav.R_EU * Eigen::Vector3d(9.0, 0.3, -0.2);
    state_.start(nav);
    state_.take_clone();
    // What has been driven since.
    state_.nav.R_EU = state_.nav.R_EU * rotation_from({.yaw_rad = 0.2, .pitch_rad = -0.02, .roll_rad = 0.03});
    state_.nav.p_EU_E += state_.nav.R_EU * Eigen::Vector3d(4.0, 0.7, 0.1);
    Eigen::VectorXd values = Eigen::VectorXd::Zero(size());
    for (int i = ErrorIndex::kMoving; i < state_.size(); ++i) values[i] = 1e-3 * std::sin(2.0 * i);
    state_.inject(values);
  }
  int size() const { return state_.padded_size(); }
  const ErrorState& state() const { return state_; }
  void move(const Eigen::VectorXd& error) { state_.inject(error); }

  std::optional<Measurement> measure(MeasurementModel& model, const std::function<AidingMessage()>& message, int part) {
    const Calibration& imu = state_.step_calibration(Eigen::VectorXd::Ones(size()));
    const Increments in = imu.apply(0.01, 0.01 * kRate, 0.01 * kForce);
    state_.feeds(in);
    const Eigen::Vector3d w = in.dtheta_U / in.dt_s - state_.nav.R_EU.conjugate() * earth_rate_E(),
                          f = in.dv_U / in.dt_s;
    const FilterView view{.state = state_,
                          .frame = kJacobianFrame,
                          .lever_U_B = kJacobianImu,
                          .lever_A_B = kJacobianAntenna,
                          .imu = imu,
                          .w_EU_U = w,
                          .f_U = f};
    if (message) {
      const AidingMessage m = message();
      EXPECT_GT(model.parts(view, m), part);
      return model.received(view, m, part);
    }
    model.start();
    std::optional<Measurement> made;
    for (int k = 0; k < 1000 && !made; ++k) made = model.stepped(view, in);
    return made;
  }

 private:
  ErrorState state_;
};

AidingMessage fix() {
  GnssFix fix;
  fix.t = kNow + 0.03;
  fix.status = FixStatus::kSingle;
  fix.p_A_E = kJacobianFrame.to_E({31.0, -19.0, 4.0});
  fix.v_A_E = kJacobianFrame.R_EW() * Eigen::Vector3d(5.0, 7.0, 0.1);
  fix.covariance_E = 4.0 * Eigen::Matrix3d::Identity();
  fix.velocity_covariance_E = 0.01 * Eigen::Matrix3d::Identity();
  return fix;
}

Matrix6d some_covariance() {
  return (Vector6d() << 1e-4, 2e-4, 3e-4, 0.01, 0.02, 0.03).finished().asDiagonal();
}

/// Whose residual is some degrees and decimetres.
AidingMessage relative_pose() {
  RelativePose m{.source = kNow, .target = kNow, .X_TS = {}, .covariance = some_covariance()};
  m.X_TS = {rotation_from({.yaw_rad = 0.25, .pitch_rad = 0.0, .roll_rad = 0.0}), {4.1, 0.5, 0.3}};
  return m;
}

AidingMessage map_pose() {
  return PoseInMap{.t = kNow,
                   .X_WB = {rotation_from({.yaw_rad = 0.95, .pitch_rad = 0.0, .roll_rad = 0.0}), {32.0, -17.0, 1.0}},
                   .covariance = some_covariance()};
}

AidingMessage heading() {
  return HeadingSample{.t = kNow, .heading_rad = 0.8, .sigma_rad = 0.01};
}

AidingMessage pressure() {
  return BarometerSample{.t = kNow, .pressure_pa = 100500.0};
}

AidingMessage field() {
  return MagnetometerSample{.t = kNow, .field_U_t = {1e-5, 2e-5, -4e-5}};
}

AidingMessage epoch() {
  GnssObservation o;
  o.sv = {GnssSystem::kGalileo, 3};
  o.p_E = kJacobianFrame.to_E({8e6, 6e6, 2e7});
  o.v_E = kJacobianFrame.R_EW() * Eigen::Vector3d(2000.0, -1500.0, 700.0);
  o.pseudorange_m = 2.24e7;
  o.sigma_m = 2.0;
  o.cn0_dbhz = 37.0;
  o.rate_m_s = 100.0;
  return GnssEpoch{.t = kNow + 0.02, .observations = {o}};
}

AidingMessage ticks() {
  return OdometerSample{.t = kNow, .dt_s = 0.2, .ticks = 88, .speed_m_s = 8.8};
}

struct Case {
  const char* model;
  std::function<AidingMessage()> message;
  const char* keys;
  int part = 0;
  const char* further = "";  ///< of a row's second case
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.model << " " << c.part;
}

class Jacobian : public ::testing::TestWithParam<Case> {};

TEST_P(Jacobian, IsTheDerivativeOfTheResidual) {
  const Case& c = GetParam();
  FilterConfig config;
  const auto node = ConfigNode::parse(c.keys, "test");
  ASSERT_TRUE(read_config(&*node, "fusion", config).ok());
  const ImuNoise unit = noise();
  Stage stage;
  const auto model = model_row(measurement_models(), c.model).make(config.own, {.state = stage.state(), .noise = unit});
  const auto at = stage.measure(*model, c.message, c.part);
  ASSERT_TRUE(at.has_value());
  EXPECT_EQ(at->R.llt().info(), Eigen::Success);
  for (int j = 0; j < stage.state().size(); ++j) {
    // Central differences: steps large against rounding (positions are 6e6 m: 1e-9 m), small against curvature.
    const double step = j < 3 ? 1e-4 : j < 6 ? 10.0 : j < 9 ? 1.0 : 1e-3;
    const auto residual = [&](double by) {
      Stage moved;
      Eigen::VectorXd e = Eigen::VectorXd::Zero(moved.size());
      e[j] = by;
      moved.move(e);
      return moved.measure(*model, c.message, c.part)->residual;
    };
    // The estimate moves towards the truth by e, and the residual loses H e.
    const Measurement::Vector numeric = (residual(-step) - residual(step)) / (2.0 * step);
    const double rounding = 4e-9 / step;
    EXPECT_LT((numeric - at->H.col(j)).cwiseAbs().maxCoeff(),
              1e-7 * std::max(1.0, at->H.col(j).cwiseAbs().maxCoeff()) + rounding)
        << "state " << j << ": " << numeric.transpose() << " against " << at->H.col(j).transpose();
  }
}

const std::vector<Case> kCases = {
    {"position", fix, ""},
    {"position", fix, "fix_error_scale = 0", 0, "OfErrorsOfOneSize"},
    {"velocity", fix, ""},
    {"non_holonomic", nullptr, ""},
    {"standstill", nullptr, "standstill_speed_m_s = 100\nstandstill_rate_deg_s = 100"},
    {"odometer", ticks, ""},
    {"heading", heading, ""},
    {"barometer", pressure, ""},
    {"magnetometer", field, ""},
    {"relative_pose", relative_pose, ""},
    {"map_pose", map_pose, ""},
    {"ranges", epoch, ""},
    {"ranges", epoch, "", 1},
};

INSTANTIATE_TEST_SUITE_P(Rows, Jacobian, ::testing::ValuesIn(kCases), [](const auto& row) {
  return row.param.model + (row.param.part == 0 ? std::string() : std::to_string(row.param.part)) + row.param.further;
});

TEST(Jacobian, ThereIsACaseForEveryRow) {
  std::vector<std::string> names;
  for (const Case& c : kCases)
    if (c.part == 0 && *c.further == '\0') names.emplace_back(c.model);
  EXPECT_EQ(names, model_names(measurement_models()));
}

}  // namespace
}  // namespace canyon::fusion
