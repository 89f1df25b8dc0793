#include "canyon/study/fuse/inputs.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/output/printed.h"
#include "canyon/core/tables/state_table.h"
#include "canyon/core/units.h"
#include "canyon/gnss/antenna_height.h"
#include "canyon/study/dead_reckoning/reference.h"
#include "canyon/study/fuse/logs/fix_log.h"

namespace canyon::study {
namespace {

constexpr double kImuGapFactor = 1.5;
constexpr std::int64_t kWeek_ns = 604'800 * kNsPerSecond;

/// Times of so many weeks are counted from the GPS epoch, and not within a week.
constexpr int kWeeksOfAnEpoch = 100;
bool counts_from_epoch(GpsTime t) {
  return t.ns >= kWeeksOfAnEpoch * kWeek_ns;
}

void shift(GpsTime& t, int weeks, double offset_s) {
  t.ns += weeks * kWeek_ns + static_cast<std::int64_t>(std::llround(offset_s * 1e9));
}

Result<FuseTruth> truth_from(const std::string& path, const StateTable& table, const FuseConfig& config) {
  FuseTruth out;
  out.path = path;
  out.of = config.truth.of;
  const auto& o = config.truth.origin_deg_deg_m;
  if (table.local && o.empty())
    return Error{path, table.rows.front().line, "", "is in local coordinates",
                 "truth.origin_deg_deg_m in --config, or lat_deg,lon_deg,h_m"};
  const LocalFrame frame = table.local ? LocalFrame({o[0] * kDegree, o[1] * kDegree, o[2]}) : LocalFrame();
  const Eigen::Matrix3d R = table.local ? frame.R_EW() : Eigen::Matrix3d::Identity().eval();
  out.has_attitude = out.has_velocity = true;
  for (const StateRow& row : table.rows) {
    if (!row.solved) continue;
    fusion::NavState s;
    s.t = row.t;
    s.p_EU_E = table.local ? frame.to_E(row.p) : row.p;
    s.v_EU_E = R * row.v;
    if (row.R) s.R_EU = (Eigen::Quaterniond(R) * *row.R).normalized();
    out.has_attitude &= row.R.has_value();
    out.has_velocity &= row.v.allFinite();
    out.states.push_back(s);
  }
  if (out.states.empty()) return Error{path, 0, "", "holds no reference", "at least one line"};
  return out;
}

/// Turns the samples from the log's axes to those of B.
void turn(ImuRecording& imu, const FuseImuConfig& config) {
  const Eigen::Vector3d a = config.turn_deg * kDegree;
  const Eigen::Matrix3d to_vehicle =
      rotation_from({.yaw_rad = a.z(), .pitch_rad = a.y(), .roll_rad = a.x()}).toRotationMatrix().transpose();
  const Eigen::Vector3d sign =
      config.axes == LogAxes::kForwardRightDown && !imu.kf_gins ? Eigen::Vector3d(1, -1, -1) : Eigen::Vector3d(1, 1, 1);
  const Eigen::Matrix3d R = sign.asDiagonal() * to_vehicle;
  for (ImuSample& sample : imu.samples) {
    sample.dtheta_U = R * sample.dtheta_U;
    sample.dv_U = R * sample.dv_U;
  }
}

class Diagnosing {
 public:
  Diagnosing(FuseInputs& inputs, const Warn& warn) : inputs_(inputs), warn_(warn) {}
  /// `what` of the first of them.
  void add(const std::string& path, const std::string& key, const Occurrences& where, const std::string& what) {
    if (where.count == 0) return;
    inputs_.diagnoses[key] += where.count;
    const std::string place = where.line > 0 ? path + ":" + std::to_string(where.line) : path;
    warn_(place + ": " + what + " (" + std::to_string(where.count) + " in all)");
  }

 private:
  FuseInputs& inputs_;
  const Warn& warn_;
};

void diagnose(Diagnosing& tell, const std::string& path, const char* of, const PassedOver& over) {
  const std::string key(of);
  const Occurrences &no_number = over.not_finite, &twice = over.duplicates, &back = over.reversed;
  const bool begins = std::isnan(no_number.after_s);
  tell.add(
      path, key + "_not_finite", no_number,
      (begins ? "no finite numbers at the beginning" : printed("no finite numbers after %.3f s", no_number.after_s)) +
          ", passed over");
  tell.add(path, key + "_duplicates", twice, printed("%.3f s once more, passed over", twice.t_s));
  tell.add(path, key + "_reversed", back,
           printed("back in time from %.3f s to %.3f s, one of them passed over", back.after_s, back.t_s));
}

void diagnose(Diagnosing& tell, const ImuRecording& imu) {
  diagnose(tell, imu.path, "imu", imu.passed_over);
  const Occurrences& gap = imu.gaps;
  tell.add(imu.path, "imu_gaps", gap,
           printed("gap of %.4g s after %.3f s", gap.t_s - gap.after_s - imu.interval_s, gap.after_s));
}

/// Poses are told the filter in its own frame, and a map that lies elsewhere would carry it there.
Status check_map_frame(const FuseInputs& in) {
  constexpr double kMost_m = 1000.0;
  std::vector<double> off_m;
  for (const StampedMapPose& pose : in.poses) {
    const auto after = std::lower_bound(in.fixes.begin(), in.fixes.end(), pose.t,
                                        [](const GnssFix& fix, GpsTime t) { return fix.t < t; });
    if (after != in.fixes.end() && after->t - pose.t <= 1.0) off_m.push_back((after->p_A_E - pose.X_EB.p).norm());
  }
  if (off_m.empty()) return Ok{};
  const auto middle = off_m.begin() + static_cast<std::ptrdiff_t>(off_m.size() / 2);
  std::nth_element(off_m.begin(), middle, off_m.end());
  if (*middle < kMost_m) return Ok{};
  return Error{in.poses_path, 0, "", printed("lie %.3g km from the fixes of the same time", 1e-3 * *middle),
               "the frame of " + in.gnss_path + " (degrees or metres, their order, poses.origin_deg_deg_m)"};
}

Status check_overlap(const FuseInputs& in, const std::string& path, GpsTime first, GpsTime last) {
  if (first < in.end() && in.begin() < last) return Ok{};
  const bool one_week = first.week() == in.begin().week();
  const auto in_words = [&](GpsTime a, GpsTime b) {
    return of_week(a, b) + (one_week ? "" : " " + std::to_string(a.week()));
  };
  return Error{path, 0, "", "covers " + in_words(first, last),
               "times from " + in_words(in.begin(), in.end()) + ", as in " + in.imu.path};
}

/// The reference at the times of the fixes: 1 km, and 30 sigma, is no error of a receiver in the middle of a drive.
Status check_same_frame(const FuseInputs& in) {
  constexpr double kMost_m = 1000.0, kMostSigma = 30.0;
  std::vector<double> off;
  for (const GnssFix& fix : in.fixes) {
    const auto after = std::lower_bound(in.truth.states.begin(), in.truth.states.end(), fix.t,
                                        [](const fusion::NavState& s, GpsTime t) { return s.t < t; });
    if (after == in.truth.states.end() || after->t - fix.t > 1.0) continue;
    const double sigma = std::sqrt(fix.covariance_E.trace());
    off.push_back((after->p_EU_E - fix.p_A_E).norm() / std::max(kMost_m, kMostSigma * sigma));
  }
  if (off.empty()) return Ok{};
  std::nth_element(off.begin(), off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2), off.end());
  if (off[off.size() / 2] < 1.0) return Ok{};
  return Error{in.truth.path, 0, "",
               printed("lies %.3g km from the fixes of the same time", 1e-3 * kMost_m * off[off.size() / 2]),
               "the frame of " + in.gnss_path + " (degrees or metres, their order, truth.origin_deg_deg_m)"};
}

Status check_attitude(const FuseInputs& in, const FuseConfig& config) {
  if (in.truth.states.empty() || !in.truth.has_attitude) return Ok{};
  const auto first = std::find_if(in.truth.states.begin(), in.truth.states.end(),
                                  [&](const fusion::NavState& s) { return s.t >= in.begin(); });
  if (first == in.truth.states.end()) return Ok{};
  const bool frd = config.imu.axes == LogAxes::kForwardRightDown;
  return check_axes(
      in.imu, *first,
      frd ? "imu.axes = \"flu\", or another imu.turn_deg" : "imu.axes = \"frd\", or another imu.turn_deg");
}

/// What no unit does, and no filter is linear about: half a turn within a sample, a thousand g.
Status check_magnitudes(const FuseInputs& in) {
  constexpr double kMostForce_m_s2 = 1e4;
  for (const ImuSample& sample : in.imu.samples) {
    if (!(sample.dtheta_U.norm() < kPi))
      return Error{in.imu.path, 0, "",
                   printed("%.3g rad within the sample at %.3f s", sample.dtheta_U.norm(), sample.t.sow_s()),
                   "less than half a turn; are unit and columns right?"};
    if (!(sample.dv_U.norm() < kMostForce_m_s2 * sample.dt_s))
      return Error{
          in.imu.path, 0, "",
          printed("a specific force of %.3g m/s^2 at %.3f s", sample.dv_U.norm() / sample.dt_s, sample.t.sow_s()),
          "less than 1e4; are unit and columns right?"};
  }
  for (const GnssFix& fix : in.fixes) CANYON_TRY_STATUS(gnss::check_antenna_height(fix.p_A_E, {.file = in.gnss_path}));
  return Ok{};
}

}  // namespace

Status check_fuse_inputs(const FuseInputs& in, const FuseConfig& config) {
  CANYON_TRY_STATUS(check_magnitudes(in));
  CANYON_TRY_STATUS(check_overlap(in, in.gnss_path, in.fixes.front().t, in.fixes.back().t));
  if (!in.odometer.empty())
    CANYON_TRY_STATUS(check_overlap(in, in.odometer_path, in.odometer.front().t, in.odometer.back().t));
  if (!in.heading.empty())
    CANYON_TRY_STATUS(check_overlap(in, in.heading_path, in.heading.front().t, in.heading.back().t));
  if (!in.poses.empty()) CANYON_TRY_STATUS(check_overlap(in, in.poses_path, in.poses.front().t, in.poses.back().t));
  if (!in.truth.states.empty())
    CANYON_TRY_STATUS(check_overlap(in, in.truth.path, in.truth.states.front().t, in.truth.states.back().t));
  CANYON_TRY_STATUS(check_fuse_filter(in, config));
  CANYON_TRY_STATUS(check_same_frame(in));
  CANYON_TRY_STATUS(check_map_frame(in));
  return check_attitude(in, config);
}

Result<FuseInputs> read_fuse_inputs(const FuseFiles& files, const FuseConfig& config, const Warn& warn) {
  FuseInputs out;
  Diagnosing tell(out, warn);
  CANYON_TRY(FixLog fixes, read_fix_log(files.gnss, files.navigation, config.gnss, config.timeline.wait_s));
  for (const std::string& line : fixes.warnings) warn(line);
  out.gnss_path = files.gnss;
  StateTable truth;
  if (!files.truth.empty()) {
    CANYON_TRY(truth, read_state_table(files.truth, config.truth.columns));
  }
  OdometerLog odometer;
  if (!files.odometer.empty()) {
    CANYON_TRY(odometer, read_odometer_log(files.odometer, config.odometer));
    out.odometer_path = files.odometer;
  }
  HeadingLog heading;
  if (!files.heading.empty()) {
    CANYON_TRY(heading, read_heading_log(files.heading, config.heading));
    out.heading_path = files.heading;
  }
  PoseLog poses;
  if (!files.poses.empty()) {
    CANYON_TRY(poses, read_pose_log(files.poses, config.poses));
    out.poses_path = files.poses;
  }
  const GpsTime first_fix = fixes.fixes.front().t, first_truth = truth.rows.empty() ? GpsTime{} : truth.rows.front().t;
  const bool week_of_fixes = fixes.has_week || counts_from_epoch(first_fix);
  const bool week_of_truth = truth.has_week || counts_from_epoch(first_truth);
  const int week = week_of_fixes ? first_fix.week() : week_of_truth ? first_truth.week() : 0;
  const auto missing = [&](bool has_week) { return has_week ? 0 : week; };
  for (GnssFix& fix : fixes.fixes) shift(fix.t, missing(week_of_fixes), config.gnss.clock_offset_s);
  for (GpsTime& came : fixes.came) shift(came, missing(week_of_fixes), config.gnss.clock_offset_s);
  for (GnssEpoch& epoch : fixes.ranges) shift(epoch.t, missing(week_of_fixes), config.gnss.clock_offset_s);
  for (StateRow& row : truth.rows) shift(row.t, missing(week_of_truth), 0.0);
  for (OdometerSample& sample : odometer.samples) shift(sample.t, missing(odometer.has_week), 0.0);
  const bool week_of_poses = !poses.poses.empty() && (poses.has_week || counts_from_epoch(poses.poses.front().t));
  for (HeadingSample& sample : heading.samples) shift(sample.t, missing(heading.has_week), 0.0);
  for (StampedMapPose& pose : poses.poses) shift(pose.t, missing(week_of_poses), 0.0);
  out.fixes = std::move(fixes.fixes);
  out.fixes_came = std::move(fixes.came);
  for (GnssEpoch& epoch : fixes.ranges) out.ranges.push_back({epoch.t, std::move(epoch)});
  out.odometer = std::move(odometer.samples);
  out.heading = std::move(heading.samples);
  out.poses = std::move(poses.poses);
  if (!files.truth.empty()) {
    CANYON_TRY(out.truth, truth_from(files.truth, truth, config));
  }
  CANYON_TRY(out.imu, read_imu_recording(files.imu,
                                         {.columns = config.imu.columns,
                                          .gap_factor = kImuGapFactor,
                                          .mend = true,
                                          .instantaneous = config.imu.instantaneous},
                                         warn));
  turn(out.imu, config.imu);
  const bool week_of_imu = counts_from_epoch(out.imu.samples.front().t);
  for (ImuSample& sample : out.imu.samples) shift(sample.t, missing(week_of_imu), config.imu.clock_offset_s);

  diagnose(tell, out.imu);
  diagnose(tell, files.gnss, "fixes", fixes.passed_over);
  tell.add(files.gnss, "fixes_without_solution", fixes.without_solution,
           printed("no solution at %.3f s", fixes.without_solution.t_s));
  tell.add(files.gnss, "fixes_marked_withheld", fixes.withheld,
           printed("fix at %.3f s marked as withheld, not used", fixes.withheld.t_s));
  diagnose(tell, files.odometer, "odometer", odometer.passed_over);
  diagnose(tell, files.heading, "heading", heading.passed_over);
  diagnose(tell, files.poses, "poses", poses.passed_over);
  diagnose(tell, files.truth, "truth", truth.passed_over);
  CANYON_TRY_STATUS(check_fuse_inputs(out, config));
  return out;
}

}  // namespace canyon::study
