#include "canyon/study/tradeoff/probes/imu_samples.h"

namespace canyon::study {

std::vector<ImuSample> imu_samples(inertial::ImuModel& imu, const TrueMotion& motion, GpsTime start, double rate_hz,
                                   std::int64_t first, std::int64_t last) {
  std::vector<ImuSample> samples;
  samples.reserve(static_cast<std::size_t>(last - first));
  for (std::int64_t k = first + 1; k <= last; ++k)
    samples.push_back(imu.sample(k, motion, tick(start, k - 1, rate_hz), tick(start, k, rate_hz)));
  return samples;
}

std::vector<ImuSample> summed(std::span<const ImuSample> fine, std::size_t count) {
  std::vector<ImuSample> out;
  for (std::size_t i = 0; i + count <= fine.size(); i += count) {
    ImuSample sum = fine[i];
    for (std::size_t j = i + 1; j < i + count; ++j) {
      sum.t = fine[j].t;
      sum.dt_s += fine[j].dt_s;
      sum.dtheta_U += fine[j].dtheta_U;
      sum.dv_U += fine[j].dv_U;
    }
    out.push_back(sum);
  }
  return out;
}

fusion::NavState imu_state(const KinematicState& truth, const LocalFrame& frame, const Eigen::Vector3d& lever_arm_m,
                           const std::optional<Eigen::Quaterniond>& R_BU) {
  fusion::NavState state;
  state.t = truth.t;
  state.R_EU = (Eigen::Quaterniond(frame.R_EW()) * truth.X_WB.R).normalized();
  if (R_BU) state.R_EU = (state.R_EU * *R_BU).normalized();
  state.p_EU_E = frame.to_E(truth.X_WB * lever_arm_m);
  state.v_EU_E = frame.R_EW() * (truth.v_WB_W + truth.X_WB.R * truth.w_WB_B.cross(lever_arm_m));
  return state;
}

}  // namespace canyon::study
