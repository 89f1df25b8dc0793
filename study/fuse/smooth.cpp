#include "canyon/study/fuse/smooth.h"

#include <cmath>

#include "canyon/core/config/text.h"
#include "canyon/fusion/reference_track.h"
#include "canyon/fusion/smoothing/smoother.h"

namespace canyon::study {
namespace {

FuseEpoch epoch_of(const fusion::SmoothedState& state, const FusePlan& plan) {
  const Eigen::Matrix3d R_WE = plan.frame.R_EW().transpose();
  Eigen::Matrix<double, 9, 9> J = Eigen::Matrix<double, 9, 9>::Identity();
  J.block<3, 3>(3, 3) = J.block<3, 3>(6, 6) = R_WE;
  return {.nav = state.nav,
          .estimate = fusion::estimate_of(state, plan.frame, plan.lever_U_B),
          .covariance = J * state.covariance * J.transpose()};
}

void compare(const fusion::SmoothedState& state, const FuseInputs& in, const FusePlan& plan, Outages& outages,
             std::vector<FuseError>& errors) {
  const auto truth = fusion::reference_at(in.truth.states, state.nav.t);
  if (!truth) return;
  FuseError error = fuse_error(in.truth, truth_arm(in.truth, plan.lever_U_B, plan.lever_A_B),
                               {state.nav, state.w_EU_U, state.covariance}, *truth);
  error.counts = error.t - plan.start >= plan.skip_s;
  outages.add(error.t, error.position_enu_m.head<2>().norm(), std::abs(error.position_enu_m.z()));
  errors.push_back(error);
}

}  // namespace

Status check_smoother(const std::string& smoother, const fusion::FilterConfig& filter) {
  if (find_model(fusion::smoothers(), smoother) == nullptr)
    return unknown_name("--smoother", smoother, model_names(fusion::smoothers()));
  const std::vector<std::string> missing = fusion::not_smoothed_by(smoother, filter);
  if (missing.empty()) return Ok{};
  return Error{"", 0, "--smoother", "\"" + smoother + "\" cannot take the filter's " + quoted_list(missing),
               "\"rts\", or fusion.measurements without it"};
}

Result<FuseSmoothed> smooth(const std::string& smoother, const ModelParameters& own, const FuseInputs& in,
                            const FusePlan& plan, const Fused& run) {
  CANYON_TRY_STATUS(check_smoother(smoother, plan.filter));
  FuseSmoothed out;
  out.smoother = smoother;
  std::vector<PoseInMap> poses;
  for (const StampedMapPose& pose : in.poses) poses.push_back(pose_in_frame(pose, plan.frame));
  Outages outages = plan.outages ? Outages(*plan.outages, in.begin(), in.end()) : Outages();
  for (const FuseSegment& segment : run.segments) {
    if (segment.steps.empty()) continue;
    if (smoother.ends_with("graph") && !segment.loosened.empty())
      return Error{in.imu.path, 0, "",
                   "samples are missing before " + segment.loosened.front().t.iso() + ", which \"" + smoother +
                       "\" cannot bridge",
                   "--smoother rts, or an imu.bridge_s below the gap"};
    const auto row = model_row(fusion::smoothers(), smoother).make(own);
    auto smoothed = row->smooth({.config = plan.filter,
                                 .noise = plan.noise,
                                 .frame = plan.frame,
                                 .lever_U_B = plan.lever_U_B,
                                 .lever_A_B = plan.lever_A_B,
                                 .start = segment.start,
                                 .X_WB = segment.X_WB,
                                 .v_WB_W = segment.v_WB_W,
                                 .imu = segment.steps,
                                 .fixes = segment.fixes,
                                 .odometer = in.odometer,
                                 .barometer = in.barometer,
                                 .magnetometer = in.magnetometer,
                                 .heading = in.heading,
                                 .poses = poses,
                                 .loosened = segment.loosened});
    if (!smoothed) {
      Error error = smoothed.error();
      if (error.file.empty() && error.key.empty()) error.key = "--smoother";
      return error;
    }
    for (const fusion::SmoothedState& state : smoothed->states) {
      out.epochs.push_back(epoch_of(state, plan));
      compare(state, in, plan, outages, out.errors);
    }
  }
  out.windows = outages.windows();
  return out;
}

}  // namespace canyon::study
