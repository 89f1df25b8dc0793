// What a configuration of this floor asks for where it says nothing, key by key.
#include <string>
#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/core/stress_unsaid.h"
#include "canyon/lidar/lidar_config.h"
#include "canyon/lidar/registration/engine/engine_registration.h"
#include "canyon/lidar/registration/registration.h"
#include "canyon/lidar/stress/subjects.h"

namespace canyon::lidar {
namespace {

using stress::said_nothing;

/// The keys of each part with their values. A figure counts the parts that differ.
StressFigure unsaid_settings() {
  int wrong = 0;
  wrong += said_nothing<LidarConfig>(
               R"({"beams":"vlp16","model":"single_ray","divergence_mrad":[3.0,1.5],"see_through":"nothing",)"
               R"("detector":"ideal","threshold_snr":6.0,"saturation":1000.0,"saturation_walk_m":0.0,)"
               R"("rate_hz":10.0,"azimuth_steps":1800,"mount_m":[0.3,0.0,1.8],"mount_yaw_pitch_roll_deg":[0.0,0.0,)"
               R"(0.0],"returns":"strongest","min_range_m":0.9,"max_range_m":100.0,"range_quantum_m":0.002,)"
               R"("range_bias_m":0.0,"range_noise_m":0.02,"angle_noise_deg":0.0,"latency_s":0.0,"crosstalk":0.0,)"
               R"("ego_min_m":[0.0,0.0,0.0],"ego_max_m":[0.0,0.0,0.0],"wavelength_nm":905.0,"pulse_m":0.75,)"
               R"("range_at_10_percent_m":50.0,"full_overlap_m":5.0,"reflection":"lambertian",)"
               R"("brightness":"uniform","windows":"none",)"
               R"("weather":{"rain_mm_h":0.0,"rain_law":"marshall_palmer","fog_visibility_m":0.0,)"
               R"("fog_law":"kruse","snow_mm_h":0.0,"snow_law":"wet","dust_visibility_m":0.0,)"
               R"("false_returns":true},"deskew":"prediction","blinded":false})")
               ? 0
               : 1;
  wrong += said_nothing<MatchingParameters>(R"({"leaf_m":0.5,"max_correspondence_m":1.0,"max_iterations":20})") ? 0 : 1;
  wrong += said_nothing<EngineParameters>(
               R"({"kernel":"geman_mcclure","kernel_width_m":0.5,"start_correspondence_m":4.0,)"
               R"("covariance":"calibrated","point_sigma_m":0.02,"range_bias_m":0.01,"least_overlap":0.2})")
               ? 0
               : 1;
  wrong += said_nothing<RegistrationConfig>(
               R"({"method":"gicp","leaf_m":0.5,"max_correspondence_m":1.0,"max_iterations":20,)"
               R"("kernel":"geman_mcclure","kernel_width_m":0.5,"start_correspondence_m":4.0,)"
               R"("covariance":"calibrated","point_sigma_m":0.02,"range_bias_m":0.01,"least_overlap":0.2,)"
               R"("submap_keyframes":10,"keyframe_distance_m":2.0,"keyframe_angle_deg":10.0,)"
               R"("alignment_floor_m":0.02,"alignment_floor_deg":0.05,"motion_floor_m_s":0.5,)"
               R"("motion_floor_deg_s":0.1,"prior_correlation_s":10.0,"prior_map":"","prior_map_sigma_m":0.05,)"
               R"("prior_map_sigma_deg":0.05,"prior_map_correlation_m":50.0})")
               ? 0
               : 1;
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> unsaid_setting_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "settings of which nothing is said",
           "a default that has changed, by which every run has",
           "the values as they are documented, written out: exact", "parts"});
  rows.add("unsaid_settings/lidar", unsaid_settings);
  return rows.take();
}

}  // namespace canyon::lidar
