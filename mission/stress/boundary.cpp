#include <array>
#include <functional>
#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/mission/boundaries.h"
#include "canyon/mission/stress/subjects.h"

namespace canyon::mission {
namespace {

const GpsTime kStart = GpsTime::from_week_sow(1610, 305000.0);
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

/// A number of a message: how to spoil it, and whether NaN there means that it was not measured.
template <class Message>
struct Field {
  std::function<void(Message&, double)> set;
  bool may_be_missing = false;
};

template <class Message, class Values>
void add_values(std::vector<Field<Message>>& fields, Values values) {
  Message probe{};
  const auto count = values(probe).size();
  for (Eigen::Index i = 0; i < count; ++i)
    fields.push_back({[=](Message& m, double bad) {
      using Scalar = typename std::decay_t<decltype(values(m))>::Scalar;
      values(m).data()[i] = static_cast<Scalar>(bad);
    }});
}
template <class Message>
void add_pose(std::vector<Field<Message>>& fields, Pose Message::*pose) {
  add_values(fields, [=](Message& m) -> Eigen::Vector3d& { return (m.*pose).p; });
  add_values(fields, [=](Message& m) -> Eigen::Vector4d& { return (m.*pose).R.coeffs(); });
}
template <class Message>
void add(std::vector<Field<Message>>& fields, std::function<double&(Message&)> number, bool may_be_missing = false) {
  fields.push_back({[number = std::move(number)](Message& m, double bad) { number(m) = bad; }, may_be_missing});
}

/// 1 where something passes, or is refused in another's name.
int passes(const Status& looked, const std::string& producer) {
  return !looked.ok() && looked.error().str().find(": " + producer + " gave ") != std::string::npos ? 0 : 1;
}

/// How many spoilt messages pass, or are laid to another's door than their producer's, and how many good ones do not
/// pass: field by field, not a number and infinite.
template <class Message>
StressFigure field_by_field(const char* producer, const Message& good, const std::vector<Field<Message>>& fields) {
  const Boundaries boundaries(kStart);
  int wrong = boundaries.check(good).ok() ? 0 : 1;
  for (const Field<Message>& field : fields)
    for (const double bad : {kNothing, stress::kInfinity, -stress::kInfinity}) {
      Message spoilt = good;
      field.set(spoilt, bad);
      const bool allowed = field.may_be_missing && std::isnan(bad);
      const Status looked = boundaries.check(spoilt);
      wrong += allowed ? (looked.ok() ? 0 : 1) : passes(looked, producer);
    }
  return {1.0 * wrong, 0.0};
}

StressFigure motion() {
  using M = KinematicState;
  std::vector<Field<M>> fields;
  add_pose(fields, &M::X_WB);
  for (auto vector : {&M::v_WB_W, &M::a_WB_W, &M::w_WB_B, &M::alpha_WB_B})
    add_values(fields, [=](M& m) -> Eigen::Vector3d& { return m.*vector; });
  M good;
  good.t = kStart + 1.0;
  return field_by_field("the vehicle", good, fields);
}

StressFigure imu() {
  using M = ImuSample;
  std::vector<Field<M>> fields;
  for (auto vector : {&M::dtheta_U, &M::dv_U}) add_values(fields, [=](M& m) -> Eigen::Vector3d& { return m.*vector; });
  add<M>(fields, [](M& m) -> double& { return m.dt_s; });
  M good;
  good.t = kStart + 1.0;
  good.dt_s = 0.01;
  return field_by_field("the IMU", good, fields);
}

gnss::GnssOutput good_gnss() {
  gnss::GnssOutput out;
  out.fix.t = kStart + 1.0;
  out.fix.status = FixStatus::kSingle;
  out.fix.p_A_E = {4e6, 1e5, 5e6};
  out.fix.covariance_E = Eigen::Matrix3d::Identity();
  out.fix.v_A_E.setZero();
  out.fix.velocity_covariance_E = Eigen::Matrix3d::Identity();
  GnssObservation o;
  o.used = true;
  o.pseudorange_m = 2e7;
  o.p_E = {2e7, 1e7, 0.0};
  o.v_E.setZero();
  out.epoch.observations = {o};
  out.truth.satellites.emplace_back();
  return out;
}

StressFigure gnss_fix() {
  using M = gnss::GnssOutput;
  std::vector<Field<M>> fields;
  for (auto vector : {&GnssFix::p_A_E, &GnssFix::v_A_E})
    add_values(fields, [=](M& m) -> Eigen::Vector3d& { return m.fix.*vector; });
  for (auto matrix : {&GnssFix::covariance_E, &GnssFix::velocity_covariance_E})
    add_values(fields, [=](M& m) -> Eigen::Matrix3d& { return m.fix.*matrix; });
  add<M>(
      fields, [](M& m) -> double& { return m.fix.clock_m; }, true);
  return field_by_field("the GNSS receiver", good_gnss(), fields);
}

StressFigure gnss_observation() {
  using M = gnss::GnssOutput;
  using O = GnssObservation;
  std::vector<Field<M>> fields;
  for (auto vector : {&O::p_E, &O::v_E})
    add_values(fields, [=](M& m) -> Eigen::Vector3d& { return m.epoch.observations[0].*vector; });
  for (auto number : {&O::pseudorange_m, &O::clock_m, &O::correction_m})
    add<M>(fields, [=](M& m) -> double& { return m.epoch.observations[0].*number; });
  for (auto number : {&O::doppler_hz, &O::carrier_phase_cycles, &O::cn0_dbhz, &O::sigma_m})
    add<M>(
        fields, [=](M& m) -> double& { return m.epoch.observations[0].*number; }, true);
  using S = GnssSecondSignal;
  for (auto number : {&S::pseudorange_m, &S::doppler_hz, &S::carrier_phase_cycles, &S::cn0_dbhz})
    add<M>(
        fields, [=](M& m) -> double& { return m.epoch.observations[0].second.*number; }, true);
  return field_by_field("the GNSS receiver", good_gnss(), fields);
}

StressFigure gnss_truth() {
  using M = gnss::GnssOutput;
  using T = GnssObservationTruth;
  std::vector<Field<M>> fields;
  for (auto vector : {&GnssTruth::p_A_E, &GnssTruth::v_A_E})
    add_values(fields, [=](M& m) -> Eigen::Vector3d& { return m.truth.*vector; });
  for (auto number : {&GnssTruth::receiver_clock_m, &GnssTruth::receiver_clock_rate_m_s})
    add<M>(fields, [=](M& m) -> double& { return m.truth.*number; });
  for (auto number : {&T::elevation_rad, &T::azimuth_rad, &T::range_m, &T::range_rate_m_s})
    add<M>(fields, [=](M& m) -> double& { return m.truth.satellites[0].*number; });
  // An error that a plan leaves out is not made.
  for (auto number : {&T::multipath_m, &T::ionosphere_m, &T::troposphere_m, &T::ephemeris_m, &T::noise_m, &T::base_m,
                      &T::phase_centre_m, &T::ionosphere_delay_m, &T::troposphere_delay_m, &T::carrier_multipath_m,
                      &T::range_rate_multipath_m_s, &T::ambiguity_cycles})
    add<M>(
        fields, [=](M& m) -> double& { return m.truth.satellites[0].*number; }, true);
  return field_by_field("the GNSS receiver", good_gnss(), fields);
}

StressFigure lidar_scan() {
  using M = lidar::LidarOutput;
  std::vector<Field<M>> fields;
  for (auto number : {&LidarPoint::x, &LidarPoint::y, &LidarPoint::z, &LidarPoint::intensity, &LidarPoint::time_s})
    fields.push_back({[=](M& m, double bad) { m.scan.points[1].*number = static_cast<float>(bad); }});
  for (auto number : {&LidarPointTruth::range_m, &LidarPointTruth::cos_incidence})
    fields.push_back({[=](M& m, double bad) { m.truth[1].*number = static_cast<float>(bad); }});
  add<M>(fields, [](M& m) -> double& { return m.scan.period_s; });
  M good;
  good.scan.t = kStart + 1.0;
  good.scan.period_s = 0.1;
  good.scan.points.resize(3);
  good.truth.resize(3);
  return field_by_field("the LIDAR", good, fields);
}

StressFigure estimate() {
  using M = NavEstimate;
  std::vector<Field<M>> fields;
  add_pose(fields, &M::X_WB);
  for (auto vector : {&M::v_WB_W, &M::gyro_bias_U, &M::accel_bias_U})
    add_values(fields, [=](M& m) -> Eigen::Vector3d& { return m.*vector; });
  add_values(fields, [](M& m) -> Matrix6d& { return m.pose_covariance; });
  add_values(fields, [](M& m) -> Eigen::Matrix3d& { return m.velocity_covariance_W; });
  M good;
  good.t = kStart + 1.0;
  return field_by_field("the filter", good, fields);
}

StressFigure keyframe() {
  using M = Keyframe;
  std::vector<Field<M>> fields;
  add_pose(fields, &M::X_WL_prior);
  add_pose(fields, &M::X_WL_registered);
  add<M>(
      fields, [](M& m) -> double& { return m.rms_m; }, true);
  M good;
  good.t = kStart + 1.0;
  return field_by_field("the registration", good, fields);
}

StressFigure recorded_rows() {
  std::vector<Field<NavRow>> nav;
  add_pose(nav, &NavRow::X_WB_true);
  add<NavRow>(nav, [](NavRow& m) -> double& { return m.true_speed_m_s; });
  add<NavRow>(nav, [](NavRow& m) -> double& { return m.command.speed_m_s; });
  add<NavRow>(nav, [](NavRow& m) -> double& { return m.command.curvature_1_m; });
  add_values(nav, [](NavRow& m) -> Eigen::Vector3d& { return m.estimate.X_WB.p; });
  NavRow nav_row;
  nav_row.t = kStart;
  std::vector<Field<GnssRow>> gnss;
  add_values(gnss, [](GnssRow& m) -> Eigen::Vector3d& { return m.p_A_W_true; });
  GnssRow gnss_row;
  gnss_row.fix.t = kStart;
  std::vector<Field<KeyframeRow>> keyframes;
  for (auto pose : {&KeyframeRow::X_WL_true, &KeyframeRow::X_WL_prior, &KeyframeRow::X_WL_registered})
    add_pose(keyframes, pose);
  add<KeyframeRow>(
      keyframes, [](KeyframeRow& m) -> double& { return m.rms_m; }, true);
  KeyframeRow keyframe_row;
  keyframe_row.t = kStart;
  double wrong = field_by_field("the recorder", nav_row, nav).figure +
                 field_by_field("the recorder", gnss_row, gnss).figure +
                 field_by_field("the recorder", keyframe_row, keyframes).figure;
  const Boundaries boundaries(kStart);
  for (const double bad : {kNothing, stress::kInfinity, -stress::kInfinity}) {
    wrong += passes(boundaries.check_end(bad, 1.0), "the recorder");
    wrong += passes(boundaries.check_end(1.0, bad), "the recorder");
    wrong += is_finite(DriveCommand{bad, 0.0}) || is_finite(DriveCommand{0.0, bad}) ? 1 : 0;
    for (int i = 0; i < 4; ++i) {
      lidar::MapCloud map(std::vector<lidar::MapPoint>(3));
      (i < 3 ? map[1].p_W[i] : map[1].intensity) = static_cast<float>(bad);
      wrong += passes(boundaries.check(map, 1.0), "the recorder");
    }
  }
  return {wrong, 0.0};
}

/// What is finite and yet larger than it can be on Earth: a place, a speed, a force, a rate, a return of a LIDAR.
StressFigure too_large() {
  const Boundaries boundaries(kStart);
  int passed = 0;
  for (const double size : {1e13, 1e150, 1.7e308}) {
    KinematicState motion;
    motion.X_WB.p.y() = size;
    passed += passes(boundaries.check(motion), "the vehicle");
    motion = {};
    motion.v_WB_W.x() = -size;
    passed += passes(boundaries.check(motion), "the vehicle");
    ImuSample sample;
    sample.dt_s = 0.01;
    sample.dv_U.z() = size;
    passed += passes(boundaries.check(sample), "the IMU");
    sample = {};
    sample.dt_s = size;
    passed += passes(boundaries.check(sample), "the IMU");
    NavEstimate estimate;
    estimate.X_WB.p.x() = -size;
    passed += passes(boundaries.check(estimate), "the filter");
    auto gnss = good_gnss();
    gnss.fix.p_A_E.x() = size;
    passed += passes(boundaries.check(gnss), "the GNSS receiver");
    lidar::LidarOutput scan;
    scan.scan.points.resize(1);
    scan.scan.points[0].x = 3e38F;
    passed += passes(boundaries.check(scan), "the LIDAR");
  }
  return {1.0 * passed, 0.0};
}

}  // namespace

std::vector<StressCase> boundary_cases() {
  const StressMechanism finite{
      StressGroup::kData, "a number that is none, on its way from part to part",
      "one NaN passes vehicle, IMU, filter and LIDAR until a library ends the process (2026-11-22)",
      "not a number and both infinities in each number of the message in turn: refused, but for NaN "
      "where it means that "
      "nothing was measured",
      "messages"};
  const StressMechanism large{StressGroup::kData, "a finite number that is too large",
                              "its square is infinite in the next part",
                              "beyond what there is on Earth it is refused where it comes from", "let through"};
  StressRows rows;
  rows.of(finite).add("boundary/motion_of_the_vehicle", motion);
  rows.of(finite).add("boundary/imu_sample", imu);
  rows.of(finite).add("boundary/gnss_fix", gnss_fix);
  rows.of(finite).add("boundary/gnss_observation", gnss_observation);
  rows.of(finite).add("boundary/gnss_truth", gnss_truth);
  rows.of(finite).add("boundary/lidar_scan", lidar_scan);
  rows.of(finite).add("boundary/estimate", estimate);
  rows.of(finite).add("boundary/keyframe", keyframe);
  rows.of(finite).add("boundary/recorded_rows_and_commands", recorded_rows);
  rows.of(large).add("boundary/too_large", too_large);
  return rows.take();
}

}  // namespace canyon::mission
