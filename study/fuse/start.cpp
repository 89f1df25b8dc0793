#include <algorithm>
#include <cmath>

#include "canyon/core/units.h"
#include "canyon/fusion/alignment/alignment.h"
#include "canyon/fusion/dead_reckoning.h"
#include "canyon/fusion/reference_track.h"
#include "canyon/study/fuse/run.h"

namespace canyon::study {
namespace {

/// Of a reference without velocities, by differences between the states around.
Eigen::Vector3d difference_velocity(const std::vector<fusion::NavState>& states, GpsTime t) {
  std::size_t i = 0;
  while (i + 2 < states.size() && states[i + 1].t <= t) ++i;
  return (states[i + 1].p_EU_E - states[i].p_EU_E) / (states[i + 1].t - states[i].t);
}

Eigen::Vector3d rate_at(const std::vector<ImuSample>& samples, GpsTime t) {
  const auto after = std::lower_bound(samples.begin(), samples.end(), t,
                                      [](const ImuSample& sample, GpsTime at) { return sample.t < at; });
  const ImuSample& sample = after == samples.end() ? samples.back() : *after;
  return sample.dtheta_U / sample.dt_s;
}

Result<fusion::Aligned> from_truth(const FuseInputs& in, const FuseConfig& config) {
  const FuseTruth& truth = in.truth;
  if (truth.states.empty())
    return at_key(config, "start.from", "\"truth\" without one", "--truth FILE, or an alignment such as \"in_motion\"");
  if (!truth.has_attitude)
    return at_key(config, "start.from", "\"truth\", but " + truth.path + " has no attitudes",
                  "columns roll_deg,pitch_deg,yaw_deg or qw,qx,qy,qz, or an alignment such as \"in_motion\"");
  const auto state = fusion::first_common_state(truth.states, in.imu.samples);
  if (!state) return Error{truth.path, 0, "", "has no instant in common with " + in.imu.path, "one"};
  fusion::Aligned out;
  out.nav = *state;
  if (!out.nav.v_EU_E.allFinite()) {
    if (truth.states.size() < 2)
      return Error{truth.path, 0, "", "one state without velocity", "a velocity, or two states"};
    out.nav.v_EU_E = difference_velocity(truth.states, state->t);
  }
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();  // from the IMU to the reference's point
  if (truth.of == TruthPoint::kAntenna) arm = config.gnss.lever_m - config.imu.lever_m;
  if (truth.of == TruthPoint::kBody) arm = -config.imu.lever_m;
  out.nav.p_EU_E -= out.nav.R_EU * arm;
  out.nav.v_EU_E -= out.nav.R_EU * rate_at(in.imu.samples, out.nav.t).cross(arm);
  return out;
}

Result<fusion::Aligned> aligned(const FuseInputs& in, const FuseConfig& config, const std::string& from) {
  if (from == "truth") return from_truth(in, config);
  CANYON_TRY(const ImuNoise noise, fuse_noise(config));
  const auto& row = model_row(fusion::alignments(), from);
  auto out = row.make(config.start.own, {.imu = in.imu.samples,
                                         .fixes = in.fixes,
                                         .noise = noise,
                                         .lever_U_B = config.imu.lever_m,
                                         .lever_A_B = config.gnss.lever_m});
  if (out) return out;
  Error error = at_key(config, out.error().key, out.error().what, out.error().expected);
  if (error.file.empty()) error.file = in.gnss_path;
  return error;
}

/// From this 1-sigma on a heading is not known: no filter is linear about it.
constexpr double kUnknownHeading_rad = 60.0 * kDegree;
constexpr int kHeadings = 8;

/// When the fixes have told the headings apart: they are far from the first of them, and some time has passed since.
GpsTime told_apart(const FuseInputs& in, GpsTime start) {
  constexpr double kFar_m = 20.0, kFarSigmas = 10.0, kAfter_s = 30.0;
  const GnssFix* first = nullptr;
  for (const GnssFix& fix : in.fixes) {
    if (fix.t <= start) continue;
    if (first == nullptr) first = &fix;
    const double sigma = std::sqrt(fix.covariance_E.trace());
    if ((fix.p_A_E - first->p_A_E).norm() > kFar_m + kFarSigmas * sigma) return std::min(fix.t + kAfter_s, in.end());
  }
  return start;
}

/// A sum of Gaussians (Alspach & Sorenson 1972): headings all around, each a filter of its own; the one whose
/// innovations are the smallest, once the fixes have moved, is where navigation starts. Where they never move, nothing
/// is changed.
Status search_heading(const FuseInputs& in, FusePlan& plan) {
  const GpsTime until = told_apart(in, plan.start);
  if (until <= plan.start) return Ok{};
  FuseInputs part = in;
  part.truth = {};
  std::erase_if(part.imu.samples, [&](const ImuSample& sample) { return sample.t > until; });
  FusePlan trial = plan;
  trial.filter.initial_attitude_sigma_deg_heading = 1.5 * 180.0 / kHeadings;
  trial.outages.reset();
  trial.realign = nullptr;
  trial.rate_hz = 0.0;
  const std::vector<std::string> measured = fusion::filter_parts(plan.filter).measurements;
  const std::string_view by = std::ranges::find(measured, "position") != measured.end() ? "position" : "ranges";
  double least = 0.0;
  Eigen::Quaterniond best = plan.X_WB.R;
  for (int i = 0; i < kHeadings; ++i) {
    const Eigen::AngleAxisd turn(2.0 * kPi * i / kHeadings, Eigen::Vector3d::UnitZ());
    trial.X_WB.R = (Eigen::Quaterniond(turn) * plan.X_WB.R).normalized();
    CANYON_TRY(const Fused run, fuse(part, trial));
    // In metres: one that has lost its way takes its own innovations for likely. Of satellites one by one what is
    // measured of each is a pseudorange.
    double sum = 0.0;
    for (const fusion::UpdateReport& update : run.updates)
      if (std::string_view(update.measurement) == by) sum += update.innovation.squaredNorm();
    if (i > 0 && !(sum < least)) continue;
    least = sum;
    best = trial.X_WB.R;
  }
  plan.filter.initial_attitude_sigma_deg_heading = trial.filter.initial_attitude_sigma_deg_heading;
  plan.X_WB.R = best;
  return Ok{};
}

/// A unit that levels itself says how it stands, not how the vehicle does: of that it knows no more than of its
/// mounting, where that is estimated. The course is the vehicle's own.
double tilt_of_body(double tilt_of_unit_rad, const FusePlan& plan) {
  const fusion::ErrorState state(fusion::filter_parts(plan.filter).states, plan.filter.own, {.noise = plan.noise});
  for (const fusion::ErrorState::Member& member : state.members())
    if (member.offset == state.mounting()) return std::hypot(tilt_of_unit_rad, std::sqrt(member.block->variance(0)));
  return tilt_of_unit_rad;
}

}  // namespace

Status settle_heading(const FuseInputs& inputs, FusePlan& plan) {
  if (plan.filter.initial_attitude_sigma_deg_heading * kDegree < kUnknownHeading_rad) return Ok{};
  return search_heading(inputs, plan);
}

Result<FusePlan> plan_fuse(const FuseInputs& in, const FuseConfig& config, const std::optional<OutagePlan>& outages) {
  FusePlan plan;
  plan.start_from = config.start.from;
  if (plan.start_from == "auto") plan.start_from = in.truth.has_attitude ? "truth" : "in_motion";
  CANYON_TRY(const fusion::Aligned start, aligned(in, config, plan.start_from));
  plan.filter = config.fusion;
  const auto set = [](double sigma, double unit, double least, double& key) {
    if (std::isfinite(sigma)) key = std::max(sigma / unit, least);
  };
  set(start.heading_rad, kDegree, 1e-6, plan.filter.initial_attitude_sigma_deg_heading);
  set(start.position_m, 1.0, 1e-6, plan.filter.initial_position_sigma_m);
  set(start.velocity_m_s, 1.0, 1e-6, plan.filter.initial_velocity_sigma_m_s);
  CANYON_TRY(plan.noise, fuse_noise(config));
  set(tilt_of_body(start.tilt_rad, plan), kDegree, 1e-6, plan.filter.initial_attitude_sigma_deg_roll_pitch);
  plan.lever_U_B = config.imu.lever_m;
  plan.lever_A_B = config.gnss.lever_m;
  plan.frame = LocalFrame(geodetic_from_ecef(start.nav.p_EU_E));
  const Eigen::Matrix3d R_WE = plan.frame.R_EW().transpose();
  plan.start = start.nav.t;
  plan.X_WB.R = (Eigen::Quaterniond(R_WE) * start.nav.R_EU).normalized();
  plan.X_WB.p = plan.frame.to_W(start.nav.p_EU_E) - plan.X_WB.R * config.imu.lever_m;
  plan.v_WB_W = R_WE * start.nav.v_EU_E;
  plan.interval_s = in.imu.interval_s;
  plan.bridge_s = config.imu.bridge_s;
  plan.timeline = config.timeline;
  plan.skip_s = config.score.skip_s;
  plan.rate_hz = config.output.rate_hz;
  plan.outages = outages;
  plan.realign = &config;
  CANYON_TRY_STATUS(settle_heading(in, plan));
  return plan;
}

}  // namespace canyon::study
