// Paths of a body against differences, and recorded ones against their files.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/files/navigation_file.h"
#include "canyon/core/motion/trajectory.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/inertial/motion/motion.h"
#include "canyon/inertial/stress/subjects.h"
#include "canyon/inertial/true_increments.h"

namespace canyon::inertial {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Worst;

MotionConfig path(const std::string& name) {
  MotionConfig config;
  config.path = name;
  config.heading_deg = 130.0;
  if (name == "straight") config.profile_s = {2.0, 7.0, 12.0}, config.profile_m_s = {0.0, 30.0, 5.0};
  if (name == "figure_eight") config.climb_m = 5.0, config.sway_deg = 20.0;
  if (name == "coning") config.cone_deg = 30.0, config.cone_hz = 0.5;
  if (name == "vibration") {
    config.path = "figure_eight";
    config.vibration.sinusoid = {
        {.frequency_hz = 3.0, .acceleration_m_s2 = {1.0, 2.0, 3.0}, .angle_deg = {4.0, 5.0, 6.0}, .phase_deg = 20.0}};
    config.vibration.psd_hz = {0.5, 2.0};
    config.vibration.psd_g2_per_hz = {0.01, 0.02};
  }
  return config;
}

/// Velocity, acceleration and their like of the attitude against eighth-order differences over h = 2 ms: a rounding of
/// 100 m and 30 m/s over h, three of them; what truncation leaves of 3 Hz is (w h)^8, far below.
StressFigure derivatives(const MotionConfig& config) {
  const auto placed = make_motion(config, 1);
  if (!placed) return {kInfinity, 1.0};
  const auto difference = [&](double t, auto value) -> Vector3d {
    constexpr double h = 2e-3, weight[4] = {4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0};
    Vector3d sum = Vector3d::Zero();
    for (int k = 1; k <= 4; ++k)
      sum += weight[k - 1] * (value(placed->motion->at(t + k * h)) - value(placed->motion->at(t - k * h)));
    return sum / h;
  };
  Worst worst;
  const double bound = 3.0 * 100.0 * kEpsilon / 2e-3;
  for (const double t : {0.77, 3.21, 4.36, 6.6, 11.3}) {
    const KinematicState k = placed->motion->at(t);
    worst.look((difference(t, [](const auto& s) { return s.X_WB.p; }) - k.v_WB_W).norm(), bound);
    worst.look((difference(t, [](const auto& s) { return s.v_WB_W; }) - k.a_WB_W).norm(), bound);
    worst.look((difference(t, [](const auto& s) { return s.w_WB_B; }) - k.alpha_WB_B).norm(), bound);
    const auto turned = [&](const auto& s) { return so3_log(k.X_WB.R.conjugate() * s.X_WB.R); };
    worst.look((difference(t, turned) - k.w_WB_B).norm(), bound);
    worst.look(k.X_WB.R.norm() - 1.0, 8.0 * kEpsilon);
  }
  return worst.figure();
}

/// The lever arm of a body that turns: what the IMU feels is what a body at its own place feels, whose motion is that
/// of the point by rigid motion (placed motion), to roundings of w^2 l; and the Boole sum over nodes is the quadrature
/// but for (w h)^6 of what changes.
StressFigure lever(const MotionConfig& config) {
  PlacedMotion placed = *make_motion(config, 1);
  const Vector3d arm(0.7, -0.4, 1.1);
  PlacedMotion at_arm = placed;
  at_arm.lever_arm_m = arm;
  Worst worst;
  for (const double t : {1.0, 3.3, 9.0}) {
    KinematicState body = placed.motion->at(t), imu = at_arm.imu_at(t);
    const InertialInput by_arm = inertial_input(body, placed.frame, arm),
                        by_itself = inertial_input(imu, placed.frame, Vector3d::Zero());
    worst.look((by_arm.w_IU_U - by_itself.w_IU_U).norm(), 64.0 * kEpsilon * (1.0 + body.w_WB_B.norm()));
    worst.look((by_arm.f_U - by_itself.f_U).norm(), 256.0 * kEpsilon * (10.0 + by_arm.f_U.norm()));
    std::vector<KinematicState> nodes;
    constexpr double kStep = 0.002;
    for (int k = 0; k <= 4; ++k) {
      nodes.push_back(placed.motion->at(t + k * kStep));
      nodes.back().t = placed.start + (t + k * kStep);
    }
    const ImuSample boole = true_increments(nodes, placed.frame, arm),
                    exact = motion_increments(at_arm, t, t + 4 * kStep);
    // 8 / 945 h^7 of the sixth derivative, w up to 2 pi 6 Hz of forces to 1000 m/s^2: 1e-11; stamps are of a
    // nanosecond.
    worst.look((boole.dtheta_U - exact.dtheta_U).norm(), 1e-9 * (body.w_WB_B.norm() + 1e-3) + 2e-12);
    worst.look((boole.dv_U - exact.dv_U).norm(), 1e-9 * (10.0 + by_arm.f_U.norm()));
  }
  return worst.figure();
}

/// A folder that is gone again.
class Folder {
 public:
  Folder() {
    const auto base = std::filesystem::temp_directory_path();
    for (int k = 0; path_.empty(); ++k) {
      const auto candidate = base / ("canyon-stress-" + std::to_string(::getpid()) + "-" + std::to_string(k));
      if (std::filesystem::create_directory(candidate)) path_ = candidate;
    }
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

std::string line_of(const char* format, std::initializer_list<double> values) {
  std::string out;
  for (const double x : values) {
    char text[40];
    std::snprintf(text, sizeof text, format, x);
    out += (out.empty() ? "" : ",") + std::string(text);
  }
  return out + "\n";
}

/// Poses of a figure of eight, written in each format and read again as a motion: it passes them, to the last decimal,
/// and starts when they do; of a reference solution the frame is its first point's.
StressFigure recorded(const std::string& ending) {
  const Folder folder;
  const std::string name = folder.file("poses." + ending);
  const PlacedMotion truth = *make_motion(path("figure_eight"), 1);
  Trajectory poses;
  NavigationFile navigation;
  std::string csv = "gps_week,sow,x_m,y_m,z_m,qw,qx,qy,qz\n", kitti;
  const GpsTime start = ending == "kitti" ? GpsTime{} : GpsTime::from_week_sow(1590, 1000.0);
  const LocalFrame frame =
      ending == "nav" ? LocalFrame(truth.frame.to_geodetic(truth.motion->at(0.0).X_WB.p)) : truth.frame;
  for (int k = 0; k < 60; ++k) {
    const double t_s = 0.5 * k;
    const KinematicState at = truth.motion->at(t_s);
    poses.append({start + t_s, at.X_WB});
    NavigationRecord record{start + t_s, truth.frame.X_EW() * at.X_WB};
    record.v_EU_E = truth.frame.R_EW() * at.v_WB_W;
    navigation.records.push_back(record);
    const auto& [p, R] = std::pair{at.X_WB.p, at.X_WB.R};
    csv += line_of("%.15g", {1590, 1000.0 + t_s, p.x(), p.y(), p.z(), R.w(), R.x(), R.y(), R.z()});
    const Eigen::Matrix4d T = at.X_WB.matrix();
    for (int i = 0; i < 12; ++i) {
      char text[40];
      std::snprintf(text, sizeof text, "%.15g%s", T(i / 4, i % 4), i == 11 ? "\n" : " ");
      kitti += text;
    }
  }
  bool written = true;
  if (ending == "tum") written = write_tum(name, poses).ok();
  if (ending == "nav") written = write_navigation_file(name, navigation).ok();
  if (ending == "csv") std::ofstream(name) << csv;
  if (ending == "kitti") std::ofstream(name) << kitti;
  MotionConfig config = path("figure_eight");
  config.path = "recorded";
  config.file = name;
  config.file_rate_hz = 2.0;
  const auto found = make_motion(config, 1);
  if (!written || !found) return {kInfinity, 1.0};
  Worst worst;
  worst.look(found->start - start, 1e-6);
  worst.look(found->motion->duration_s() - 29.5, 1e-6);
  // Nine decimals of metres and of the quaternion's parts at least, and of degrees so many that they are as good.
  const double place_m = 1e-6, angle = ending == "nav" ? 1e-8 : 1e-7;
  for (int k = 0; k < 60; ++k) {
    const Pose expected = frame.X_EW().inverse() * navigation.records[static_cast<std::size_t>(k)].X_EU;
    const KinematicState at = found->motion->at(std::min(0.5 * k, found->motion->duration_s()));
    worst.look((at.X_WB.p - expected.p).norm(), place_m);
    worst.look(at.X_WB.R.angularDistance(expected.R), angle);
    worst.look((found->frame.to_E(at.X_WB.p) - truth.frame.to_E(truth.motion->at(0.5 * k).X_WB.p)).norm(),
               2.0 * place_m);
  }
  return worst.figure();
}

/// Instants over the ends of weeks that counts of 10, 11 and 13 bits forget, of years and of leap seconds, with the
/// nanoseconds beside them, through a file and back: exact.
StressFigure over_borders(const std::string& ending) {
  const Folder folder;
  const std::string name = folder.file("poses." + ending);
  StressFigure out;
  std::vector<GpsTime> borders;
  for (const int week : {1, 1024, 2048, 8192}) borders.push_back(GpsTime::from_week_sow(week, 0.0));
  for (const int year : {1999, 2000, 2017, 2100}) borders.push_back(GpsTime::from_calendar(year, 1, 1, 0, 0, 0.0));
  for (const GpsTime last :
       {GpsTime::from_calendar(2012, 7, 1, 0, 0, 16.0), GpsTime::from_calendar(2016, 2, 29, 0, 0, 0.0)})
    borders.push_back(last);
  for (const GpsTime border : borders) {
    Trajectory poses;
    NavigationFile navigation;
    std::string csv = "gps_week,sow,x_m,y_m,z_m,qw,qx,qy,qz\n";
    std::vector<GpsTime> times;
    for (const std::int64_t ns : {-1'000'000'000LL, -1LL, 0LL, 1LL, 999'999'999LL}) {
      const GpsTime t{border.ns + ns};
      times.push_back(t);
      poses.append({t, Pose{}});
      navigation.records.push_back({t, {Eigen::Quaterniond::Identity(), ecef_from_geodetic({0.5, 0.5, 0.0})}});
      char text[64];
      std::snprintf(text, sizeof text, "%d,%lld.%09lld,0,0,0,1,0,0,0\n", t.week(),
                    static_cast<long long>(t.sow_ns() / kNsPerSecond),
                    static_cast<long long>(t.sow_ns() % kNsPerSecond));
      csv += text;
    }
    std::vector<GpsTime> found;
    const auto take = [&](const Result<Trajectory>& read) {
      if (read.ok())
        for (const StampedPose& pose : read->poses()) found.push_back(pose.t);
    };
    if (ending == "tum" && write_tum(name, poses).ok()) take(read_tum(name));
    if (ending == "csv") {
      std::ofstream(name) << csv;
      take(read_csv_trajectory(name));
    }
    if (ending == "nav" && write_navigation_file(name, navigation).ok()) {
      if (const auto read = read_navigation_file(name); read.ok())
        for (const NavigationRecord& record : read->records) found.push_back(record.t);
    }
    out.figure += found == times ? 0.0 : 1.0;
  }
  return out;
}

/// Files that cannot be joined to a motion: each is refused, with the line where one is wrong.
StressFigure refused_files() {
  const Folder folder;
  int wrong = 0;
  const auto offered = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder.file(name)) << text;
    MotionConfig config;
    config.path = "recorded";
    config.file = folder.file(name);
    return make_motion(config, 1);
  };
  const std::string head = "gps_week,sow,x_m,y_m,z_m,qw,qx,qy,qz\n", row = ",0,0,0,1,0,0,0\n";
  const auto bad_number = offered("number.csv", head + "1590,1" + row + "1590,two" + row + "1590,3" + row);
  wrong += !bad_number && bad_number.error().line == 3 ? 0 : 1;
  const auto backwards = offered("back.csv", head + "1590,1" + row + "1590,3" + row + "1590,2" + row);
  wrong += !backwards && backwards.error().line == 4 ? 0 : 1;
  const auto two = offered("two.csv", head + "1590,1" + row + "1590,3" + row);
  wrong += two ? 1 : 0;
  const auto other = offered("other.csv", "a,b\n1,2\n");
  wrong += other ? 1 : 0;
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> motion_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "the derivatives of a path",
           "a chain rule without a factor, a rate of another frame",
           "eighth-order differences over 2 ms to their rounding", "of the bound"});
  for (const char* name : {"stationary", "straight", "circle", "figure_eight", "coning", "vibration"})
    rows.add(std::string("imu/derivatives_of_") + name, [name] { return derivatives(path(name)); });
  rows.of({StressGroup::kGeometry, "an IMU on a lever arm", "w x (w x l) of the other hand, rates in the wrong axes",
           "what a body at its own place feels, and Boole's sum of it", "of the bound"});
  for (const char* name : {"circle", "figure_eight", "coning", "vibration"})
    rows.add(std::string("imu/lever_arm_on_") + name, [name] { return lever(path(name)); })
        .loose("the quadrature that it is compared with is good to 1e-12, and of even paths far better");
  rows.of({StressGroup::kData, "a recorded path in each format", "a quaternion's order, a frame that is not the file's",
           "the poses again, to the decimals of the format", "of the bound"});
  for (const char* ending : {"tum", "kitti", "csv", "nav"})
    rows.add(std::string("imu/recorded_") + ending, [ending] { return recorded(ending); });
  rows.of({StressGroup::kLong, "a recorded path over the ends of weeks, years and leap seconds",
           "a week's last nanosecond that is rounded up to 604800 s, or seconds since 1980 through a double",
           "the same nanoseconds: exact", "files"});
  for (const char* ending : {"tum", "csv", "nav"})
    rows.add(std::string("imu/borders_in_") + ending, [ending] { return over_borders(ending); });
  rows.of({StressGroup::kData, "a recorded path that is none", "the complaint of another reader, about another line",
           "refused, with the line that is wrong", "let through"});
  rows.add("imu/recorded_wrong", refused_files);
  return rows.take();
}

}  // namespace canyon::inertial
