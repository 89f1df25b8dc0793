// Paths of a body against differences, and logs of units whose errors are known.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/files/navigation_file.h"
#include "canyon/core/motion/trajectory.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/inertial/allan/motion_check.h"
#include "canyon/inertial/calibration/log_fits.h"
#include "canyon/inertial/calibration/resting_positions.h"
#include "canyon/inertial/calibration/triad_calibration.h"
#include "canyon/inertial/mems/sensing_element.h"
#include "canyon/inertial/motion/motion.h"
#include "canyon/inertial/paper_figures.h"
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

const Eigen::Matrix3d kGain = (Eigen::Matrix3d() << 0.01, 0.0, 0.0, 0.004, -0.02, 0.0, -0.003, 0.005, 0.015).finished();
const Vector3d kBias(0.3, -0.2, 0.1);
Vector3d measured(const Vector3d& truth) {
  return truth + kGain * truth + kBias;
}

/// A triad's bias and gains from samples without noise beside the truth: back to 32 roundings, and the
/// correction is the inverse. A force that is a million times smaller than its bias loses as many digits.
StressFigure to_reference(double size) {
  std::vector<Vector3d> truth, samples;
  for (int k = 0; k < 1000; ++k) {
    const double t = 0.01 * k;
    truth.emplace_back(size * Vector3d(std::sin(t), std::cos(0.7 * t), 0.5 * std::sin(1.9 * t)));
    samples.push_back(measured(truth.back()));
  }
  const auto c = fit_to_reference(samples, truth);
  if (!c) return {kInfinity, 1.0};
  Worst worst;
  const double bound = 32.0 * kEpsilon * std::max(1.0, 1.0 / size);
  worst.look((c->bias - kBias).norm(), bound * std::max(1.0, size));
  worst.look((c->gain - kGain).norm(), bound);
  worst.look(c->residual_rms, 16.0 * bound * std::max(1.0, size));
  worst.look((c->corrected(samples[7]) - truth[7]).norm(), 16.0 * bound * std::max(1.0, size));
  double square = 0.0;
  for (std::size_t k = 0; k < truth.size(); ++k) square += (samples[k] - truth[k]).squaredNorm();
  worst.look(c->uncalibrated_rms / std::sqrt(square / 3000.0) - 1.0, 1e-2);
  return worst.figure();
}

std::vector<Vector3d> orientations() {
  std::vector<Vector3d> out;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (const int n = std::abs(x) + std::abs(y) + std::abs(z); n == 1 || n == 2)
          out.push_back(Vector3d(x, y, z).normalized() * kStandardGravity);
  return out;
}

/// An accelerometer's from eighteen positions without noise: the sphere of gravity's size has one centre and one lower
/// triangle, and no residual is left: the last step ends at 256 roundings.
StressFigure to_gravity() {
  std::vector<Vector3d> positions;
  for (const Vector3d& f : orientations()) positions.push_back(measured(f));
  const auto c = fit_to_gravity(positions, 1e-3, kStandardGravity);
  if (!c) return {can_fit_noise() ? kInfinity : 0.0, 1.0};
  Worst worst;
  worst.look((c->bias - kBias).norm(), 256.0 * kEpsilon);
  worst.look((c->gain - kGain).norm(), 256.0 * kEpsilon);
  return worst.figure();
}

/// A log of a unit that lies in turn on each of eighteen sides, five seconds each: every rest is found, its means those
/// of the side to five sigma of 400 samples; what lies between is found as motion, from its first second to its last.
StressFigure turned_log() {
  ImuLog log;
  const RandomStream stream(8, "stress.positions");
  const auto where = orientations();
  std::uint64_t k = 0;
  const auto add = [&](const Vector3d& rate, const Vector3d& force) {
    const Vector3d f = measured(force) + 0.02 * stream.normal3(k, 0),
                   w = rate + Vector3d(0.01, 0.02, -0.01) + 0.002 * stream.normal3(k, 1);
    log.t_s.push_back(0.01 * static_cast<double>(k++));
    for (std::size_t i = 0; i < 3; ++i) {
      log.channels[i].push_back(w[static_cast<Eigen::Index>(i)]);
      log.channels[3 + i].push_back(f[static_cast<Eigen::Index>(i)]);
    }
  };
  for (std::size_t p = 0; p < where.size(); ++p) {
    for (int i = 0; i < 500; ++i) add(Vector3d::Zero(), where[p]);
    if (p + 1 == where.size()) break;
    for (int i = 0; i < 200; ++i) {
      const double share = i / 200.0;
      add({0.3, 0.5, 0.8},
          (1.0 - share) * where[p] + share * where[p + 1] + Vector3d(std::sin(0.3 * i), std::cos(0.2 * i), 0.5));
    }
  }
  Worst worst;
  const auto found = resting_positions(log);
  if (found.size() != where.size()) return {kInfinity, 1.0};
  for (std::size_t p = 0; p < found.size(); ++p) {
    const double from = 700.0 * static_cast<double>(p);
    worst.look((found[p].force - measured(where[p])).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(),
               5.0 * 0.02 / std::sqrt(400.0));
    worst.look((found[p].rate - Vector3d(0.01, 0.02, -0.01)).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(),
               5.0 * 0.002 / std::sqrt(400.0));
    // Half a window to either end is taken off, and one may be lost.
    worst.look(static_cast<double>(found[p].begin) - from - 50.0, 75.0);
    worst.look(static_cast<double>(found[p].end) - from - 450.0, 75.0);
  }
  const MotionFound motion = find_motion(log);
  worst.look(motion.moves() ? 0.0 : kInfinity, 1.0);
  const auto fit = fit_to_positions({log, "made"}, given_gravity(kStandardGravity));
  if (fit && fit->calibration[1]) {
    // 12 parameters of 18 means, each 0.02 / sqrt(400).
    worst.look((fit->calibration[1]->bias - kBias).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(), 6.0 * 1e-3);
    worst.look((fit->calibration[1]->gain - kGain).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(), 6.0 * 1e-3 / 9.8 * 3.0);
  } else {
    worst.look(can_fit_noise() ? kInfinity : 0.0, 1.0);
  }
  return worst.figure();
}

/// A log at rest with a turn of 20 deg/s from 30 to 40 s about one axis and a shake of 3 m/s^2 from 60 to 62 s: both
/// are found, to the second, by the channel that shows them, as what they are; and nothing else is.
StressFigure motion_found() {
  ImuLog log;
  const RandomStream stream(3, "stress.rest");
  for (std::size_t k = 0; k < 10'000; ++k) {
    const double t = 0.01 * static_cast<double>(k);
    log.t_s.push_back(t);
    for (std::size_t i = 0; i < 6; ++i) {
      double x = (i < 3 ? 0.001 : 0.01) * stream.normal(static_cast<std::uint32_t>(i), k) + (i == 5 ? 9.81 : 0.0);
      if (i == 1 && t >= 30.0 && t < 40.0) x += 20.0 * kDegree;
      if (i == 3 && t >= 60.0 && t < 62.0) x += 3.0 * std::sqrt(2.0) * std::sin(2.0 * kPi * 7.0 * t);
      log.channels[i].push_back(x);
    }
  }
  const MotionFound found = find_motion(log);
  if (found.intervals.size() != 2) return {kInfinity, 1.0};
  const MovingInterval &turn = found.intervals[0], &shake = found.intervals[1];
  Worst worst;
  worst.look(turn.channel == 1 && !turn.shakes && shake.channel == 3 && shake.shakes ? 0.0 : kInfinity, 1.0);
  worst.look(turn.from_s - 30.0, 1.0);
  worst.look(turn.to_s - 40.0, 1.0);
  worst.look(shake.from_s - 60.0, 1.0);
  worst.look(shake.to_s - 62.0, 1.0);
  // Of 100 samples, five sigma; and of ten whole windows two more may be half in it.
  worst.look(turn.amount - 20.0 * kDegree, 5.0 * 0.001 / 10.0 + 1e-3);
  worst.look(shake.amount - 3.0, 0.01);
  // Beside the degree that rest allows, four sigmas of a mean of 100.
  worst.look(turn.excess - 20.0 * kDegree / (kDegree + 4.0 * 0.001 / 10.0), 0.2);
  worst.look(found.share - 0.12, 0.011);
  return worst.figure();
}

/// A mean at the middles of a reference of another rate: linear motion is itself at any of them, to roundings; and a
/// gap of the reference has no pairs.
StressFigure pairs() {
  const auto log_of = [](double rate_hz, double from_s, double to_s, double gap_from, double gap_to, double factor) {
    ImuLog log;
    for (double k = std::ceil(from_s * rate_hz); k <= to_s * rate_hz; ++k) {
      const double t = k / rate_hz, middle = t - 0.5 / rate_hz;
      if (t > gap_from && t < gap_to) continue;
      log.t_s.push_back(t);
      for (std::size_t i = 0; i < 6; ++i)
        log.channels[i].push_back(factor * (1.0 + static_cast<double>(i)) * (middle - 3.0));
    }
    return log;
  };
  const ReferencePairs found =
      reference_pairs(log_of(100.0, 0.0, 20.0, 1e9, 0.0, 2.0), log_of(40.0, 2.0, 15.0, 7.0, 9.0, 1.0));
  Worst worst;
  std::size_t in_gap = 0;
  for (std::size_t k = 0; k < found.t_s.size(); ++k) {
    const double t = found.t_s[k];
    in_gap += t > 7.05 && t < 8.95 ? 1 : 0;
    worst.look(t >= 1.95 && t <= 15.05 ? 0.0 : kInfinity, 1.0);
    for (std::size_t triad = 0; triad < 2; ++triad)
      worst.look((found.measured[triad][k] - 2.0 * found.truth[triad][k]).norm(), 64.0 * kEpsilon * 200.0);
  }
  worst.look(in_gap == 0 && found.t_s.size() > 1000 ? 0.0 : kInfinity, 1.0);
  return worst.figure();
}

/// An element without noise worth speaking of, at rest in u: it stays there, its output u times the step, with a filter
/// and without, whichever integrator; a step from nothing comes to it and is forgotten as fast as it says. Stops and
/// clips hold at their values.
StressFigure element_at_rest(int order, const std::string& integrator) {
  ElementFigures figures;
  figures.pick_off = "piezoresistive";
  figures.pick_off_figures.strain_cubic = 0.0;
  figures.pick_off_figures.bridge_ohm = 1e-6;
  figures.mass_kg = 1e3;  // thermal noise: 1e-9 of the input
  figures.quality_factor = 0.7;
  figures.resonance_hz = 5000.0;
  figures.filter_order = order;
  figures.bandwidth_hz = 40.0;
  auto model = accelerometer_model(figures, 300.0);
  if (!model) return {kInfinity, 1.0};
  model->filter_order = order;
  model->bandwidth_hz = 40.0;
  model->pick_off_n = 0.0;
  const double step_s = integrator == "exact" ? 0.01 : 2e-5;  // an explicit one diverges from 9e-5 s on
  Worst worst;
  SensingElement settled(*model, 0.0, integrator, step_s, RandomStream(5, "stress.mems"), 0);
  settled.settle(9.81);
  for (int k = 0; k < 50; ++k) worst.look(settled.advance(k, 9.81) / (9.81 * step_s) - 1.0, 1e-6);
  SensingElement stepped(*model, 0.0, integrator, step_s, RandomStream(5, "stress.mems"), 1);
  const double memory = stepped.memory_per_step();
  worst.look(memory < 1.0 ? 0.0 : kInfinity, 1.0);
  const int steps = static_cast<int>(std::ceil(std::log(1e-9) / std::log(std::max(memory, 1e-300)))) + 2;
  double last = 0.0;
  for (int k = 0; k < steps; ++k) last = stepped.advance(k, 5.0);
  worst.look(last / (5.0 * step_s) - 1.0, 1e-6);
  worst.look(stepped.gain(1e-6) - 1.0, 1e-9);
  // Half the power at the corner, where the mass itself has (40 / 5000)^2 more or less.
  if (order > 0) worst.look(stepped.gain(40.0) / std::sqrt(0.5) - 1.0, 2.0 * std::pow(40.0 / 5000.0, 2));
  return worst.figure();
}

/// The paper's plain integration: angles are the sum of rates, places the sum of mean speeds; the rates' own sum says
/// so, to an epsilon a step.
StressFigure drift() {
  Worst worst;
  for (const PaperFigure& figure : paper_figures()) {
    PaperFigure minute = figure;
    minute.seconds = 60.0;
    const auto found = paper_drift(minute, "paper", 3);
    if (!found || found->t_s.size() != 7500) return {kInfinity, 1.0};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double angle_deg = 0.0, size = 0.0;
      for (std::size_t k = 0; k < 7500; ++k) {
        angle_deg += found->rate_deg_s[axis][k] / 125.0;
        size += std::abs(found->rate_deg_s[axis][k]) / 125.0;
        worst.look(found->angle_deg[axis][k] - angle_deg, (static_cast<double>(k) + 4.0) * kEpsilon * size + 1e-300);
      }
      // Second differences of the place are the mean of two neighbours' speed changes: all of one sign of a bias as
      // large as this over a minute, half a t^2.
      const auto& p = found->position_m[axis];
      const double first = p[3749] / (0.5 * 30.0 * 30.0), whole = p[7499] / (0.5 * 60.0 * 60.0);
      worst.look(std::isfinite(first) && std::isfinite(whole) ? 0.0 : kInfinity, 1.0);
    }
    worst.look(found->t_s.back() - 60.0, 1e-9);
  }
  return worst.figure();
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
  rows.of({StressGroup::kData, "a recorded path that is none", "the complaint of another reader, about another line",
           "refused, with the line that is wrong", "let through"});
  rows.add("imu/recorded_wrong", refused_files);
  rows.of({StressGroup::kData, "a triad's bias and gains, found again",
           "normal equations of a force far below its bias",
           "exact samples to their rounding; positions to the solver's tolerance", "of the bound"});
  for (const double size : {1e-3, 1.0, 1e3})
    rows.add("imu/calibrated_at_" + stress::text(size) + "_m_s2", [size] { return to_reference(size); });
  rows.add("imu/calibrated_by_gravity", to_gravity).add("imu/turned_log", turned_log);
  rows.of({StressGroup::kData, "what moves in a log at rest, and what its reference says",
           "means and scatters of one another's windows; a reference at another rate's stamps",
           "from and to the second, by its channel; linear motion at the middles of samples", "of the bound"});
  rows.add("imu/found_in_a_log", motion_found).add("imu/pairs_with_a_reference", pairs);
  rows.of({StressGroup::kStiff, "a sensing element at rest and after a step",
           "a filter of no order, a step that is not forgotten", "the input, times the step", "of the bound"});
  for (const int order : {0, 1, 2, 4})
    rows.add("imu/element_of_order_" + std::to_string(order), [order] { return element_at_rest(order, "exact"); });
  for (const char* integrator : {"backward_euler", "implicit_midpoint", "rk4"})
    rows.add(std::string("imu/element_by_") + integrator, [integrator] { return element_at_rest(2, integrator); });
  rows.of({StressGroup::kLong, "the paper's plain integration", "a sum of another axis", "angles are sums of rates",
           "of the bound"});
  rows.add("imu/paper_drift", drift);
  return rows.take();
}

}  // namespace canyon::inertial
