// What stands where a mission file says nothing: every key of every section, as docs/mission.md has it.
#include <map>
#include <string>

#include "canyon/core/config/config.h"
#include "canyon/core/stress_rows.h"
#include "canyon/mission/config/mission_config.h"
#include "canyon/mission/stress/runs/subjects.h"

namespace canyon::mission {
namespace {

/// Section by section, "key=default;". A default that is changed on purpose is changed here too.
constexpr const char* kDefaults = R"(
[scene]
file=""; more_files=[]; terrain=""; crs=""; heights="auto"; undulation_m=-1000; center_deg=[]; radius_m=0;
ground_cell_m=5; margin_m=60; height_property=""; ground_property=""; storeys_property=""; storey_m=3;
default_height_m=9; up_axis="auto"; wall_material="concrete"; roof_material="roofing"; ground_material="asphalt";
materials=[]; streets="auto"; seed=2012; lat_deg=32.35; lon_deg=-90.88; extent_m=1000; base_height_m=60;
slope_percent=3; hill_height_m=6; terrain_cell_m=2; block_m=90; street_width_m=12; kerb_height_m=0; empty=false; absorbing=false;
max_triangles=20000000; moving=0 items; moving[].name=""; moving[].shape="car"; moving[].path_m=[];
moving[].speed_m_s=8; moving[].start_s=0;
[time]
start="2010-11-17T13:00:00"; limit_s=0;
[vehicle]
preset=""; model="kinematic_bicycle"; sideslip_deg_per_m_s2=0; tyres="fiala"; front_cornering_per_deg=0.18;
rear_cornering_per_deg=0.2; tyre_friction=0.9; gravity_centre_share=0.5; gravity_centre_height_m=0.6;
yaw_inertia_ratio=1; slip_track_ratio=1.5; slip_centre_share=0.5; side_acceleration_m_s2=3;
max_turn_rate_deg_s=120; steering="rate_limit"; steering_lag_s=0.1; drive="direct"; drive_lag_s=0.3;
max_jerk_m_s3=10; start_m=[0, 0]; start_heading_deg=0; wheelbase_m=1.8; track_m=1.3; length_m=2.6; width_m=1.5;
height_m=1.6; ground_clearance_m=0.2; max_speed_m_s=6; max_reverse_m_s=1.5; max_acceleration_m_s2=1.5;
max_deceleration_m_s2=3; max_steering_deg=32; max_steering_rate_deg_s=45; suspension_hz=1.6;
suspension_damping=0.6; roughness="B";
[gnss]
model="pseudorange"; isotropic_min_m=0.3; isotropic_max_m=0.5; isotropic_sigma_m=0.23; white_sigma_m=1;
white_sigma_up_m=2; count_noise_max_m=10; count_noise_min_m=2; receiver=""; rate_hz=2; mask_deg=10;
lever_arm_m=[-0.3, 0, 1.2]; mode="dgps"; ionosphere_correction="half"; baseline_km=5;
ionosphere_gradient_mm_per_km=2; troposphere_gradient_mm_per_km=1; base_error_scale=1; base_place_m=[-3000, 4000, 20];
base_receiver="survey_multi"; base_rate_hz=1; base_latency_s=1; base_age_s=30; ionosphere="single_layer";
vtec_tecu=12; ionex_file=""; troposphere="saastamoinen_niell"; pressure_hpa=1022; temperature_c=12.8;
relative_humidity=0.8; weather_height_m=0; ephemeris_error="gauss_markov"; ephemeris_sigma_m=1;
ephemeris_tau_s=3600; sp3_files=[]; antex_file=""; receiver_clock="tcxo"; paths="specular1"; launched_rays=20000;
diffraction="none"; scatter="none"; scatter_coefficient=-1; scatter_lobe=0; scatter_tile_m=8; scatter_reach_m=150;
clutter="none"; clutter_environment="suburban"; clutter_shaded_scale=1; clutter_echo_db=0;
clutter_moving_share=0.2; clutter_coherence_s=2; clutter_cell_m=8; clutter_reach_m=80; clutter_street=0;
ground_reflection=false; reflection_borders=false; surface_roughness_m=0; multipath_rule="paper_first_return"; cutoff_ns=150;
foliage_db_per_m=0.25; foliage_max_db=28; cn0_zenith_dbhz=45; antenna="sine"; antenna_horizon_loss_db=7;
lhcp_rejection_db=10; antenna_phase_centre=false; modulation="auto"; second_frequency="L2";
correlator="early_late"; discriminator="power"; correlator_spacing_chips=0.5; front_end_mhz=0; code_loop_hz=0.13;
carrier_loop_hz=15; integration_ms=20; thermal_noise_scale=1; multipath_scale=1; hidden_signals="as_received";
tracking_threshold_dbhz=25; reacquisition_margin_db=3; reacquisition_s=1; cn0_averaging_s=0; cn0_resolution_db=0;
solver="least_squares"; weighting="elevation"; raim="none"; raim_false_alarm=0.001; solver_sigma_m=0.5;
max_gdop=100; estimator="least_squares"; estimator_acceleration_m_s2=2; smoothing_s=0;
reported_covariance="geometry"; error_correlation_s=10; light_variance_m2=10; light_variance_m2_hz=22500;
heavy_variance_m2=500; heavy_variance_m2_hz=1e+06; fewest_satellites=0; accuracy_limit_m=0; systems="G";
nav_file=""; nav_files=[]; almanac_file="";
[imu]
sensor="high_grade_mems"; gyroscope=""; errors="datasheet"; leave_out=[]; rate_hz=100; lever_arm_m=[0, 0, 0.4];
mounting_error_deg=0; temperature_times_s=[]; temperatures_c=[]; vibration_m_s2=[0, 0, 0];
[odometer]
rate_hz=50; wheel_m=[0, 0.8, 0]; metres_per_tick=0.02; scale_percent=0.5; slip_percent=0.2; slip_tau_s=5;
slip_percent_per_m_s2=0.5;
[barometer]
rate_hz=10; undulation_m=-1000; turn_on_bias_pa=50; drift_pa=100; drift_tau_s=7200; noise_pa_per_sqrt_hz=0.4;
lag_s=0.1; resolution_pa=0;
[magnetometer]
rate_hz=20; declination_deg=0; inclination_deg=60; strength_ut=50; hard_iron_ut=3; soft_iron_percent=2;
noise_ut_per_sqrt_hz=0.05; resolution_ut=0;
[lidar]
beams="vlp16"; model="single_ray"; divergence_mrad=[3, 1.5]; see_through="nothing"; detector="ideal";
threshold_snr=6; saturation=1000; saturation_walk_m=0; rate_hz=10; azimuth_steps=1800; mount_m=[0.3, 0, 1.8];
mount_yaw_pitch_roll_deg=[0, 0, 0]; returns="strongest"; min_range_m=0.9; max_range_m=100; range_quantum_m=0.002;
range_bias_m=0; range_noise_m=0.02; angle_noise_deg=0; latency_s=0; crosstalk=0; ego_min_m=[0, 0, 0];
ego_max_m=[0, 0, 0]; wavelength_nm=905; pulse_m=0.75; range_at_10_percent_m=50; full_overlap_m=5;
reflection="lambertian"; weather.rain_mm_h=0; weather.rain_law="marshall_palmer"; weather.fog_visibility_m=0;
weather.fog_law="kruse"; weather.snow_mm_h=0; weather.snow_law="wet"; weather.dust_visibility_m=0;
weather.false_returns=true; deskew="prediction"; blinded=false;
[fusion]
imu=""; initial_attitude_sigma_deg_roll_pitch=0.1; initial_attitude_sigma_deg_heading=1;
initial_position_sigma_m=0.5; initial_velocity_sigma_m_s=0.05; integrator="two_sample"; estimator="joseph";
filter="naive"; states=[]; measurements=[]; acceptance="as_filter"; map_aiding=false; imu_gain_tau_s=0;
mounting_sigma_deg=1; mounting_walk_deg_per_sqrt_hr=0.1; antenna_lever_sigma_m=0.1; time_offset_sigma_s=0.05;
wheel_scale_sigma_percent=1; fix_error_sigma_m=0.3; fix_error_scale=1.5; fix_error_power=1.5; fix_error_tau_s=20;
fix_error_way_m=1e+09; velocity_error_scale=0.5; velocity_error_up_scale=6; velocity_error_tau_s=2;
clock_sigma_m=100; clock_rate_sigma_m_s=300; clock_walk_m_per_sqrt_s=0.1; clock_rate_walk_m_s_per_sqrt_s=0.1;
system_time_sigma_m=100; range_error_slots=24; range_error_sigma_m=2; range_error_decade_db=14;
range_error_most_m=25; range_error_mean=1; range_error_tau_s=60; range_error_way_m=50; barometer_bias_sigma_m=50;
barometer_bias_tau_s=7200; hard_iron_sigma_ut=5; fix_covariance="as_reported"; fix_sigma_scale=2; fix_sigma_m=3;
fix_sigma_floor_m=0; fix_velocity_scale=1; fix_velocity_floor_m_s=0.05; non_holonomic_rate_hz=10;
non_holonomic_sigma_m_s=0.1; non_holonomic_sideslip=0.02; standstill_window_s=0.5; standstill_force_m_s2=0.05;
standstill_rate_deg_s=0.5; standstill_speed_m_s=0.5; standstill_sigma_m_s=0.02; odometer_wheel_m=[0, 0.8, 0];
odometer_interval_s=0.2; odometer_tick_m=0.02; odometer_slip_percent=0.3; heading_sigma_floor_deg=0.05;
barometer_sigma_m=0.5; magnetic_declination_deg=0; magnetic_inclination_deg=60; magnetic_strength_ut=50;
magnetometer_sigma_ut=1; relative_pose_scale=1; map_pose_scale=1; range_sigma_scale=1; range_rate_sigma_m_s=0.2;
gate_sigma=0; gate_recovery_s=10; huber_sigma=1.345; lost_after_s=8; lost_after_m=20; lost_sigma=5;
student_t_dof=4; adaptive_tau_s=10; fuzzy_tau_s=10; fuzzy_large=5;
[registration]
method="gicp"; leaf_m=0.5; max_correspondence_m=1; max_iterations=20; kernel="geman_mcclure"; kernel_width_m=0.5;
start_correspondence_m=4; covariance="calibrated"; point_sigma_m=0.02; range_bias_m=0.01; least_overlap=0.2;
submap_keyframes=10; keyframe_distance_m=2; keyframe_angle_deg=10; alignment_floor_m=0.02;
alignment_floor_deg=0.05; motion_floor_m_s=0.5; motion_floor_deg_s=0.1; prior_correlation_s=10;
prior_map=""; prior_map_sigma_m=0.05; prior_map_sigma_deg=0.05; prior_map_correlation_m=50;
[autonomy]
model="reference"; perception.model="ground_grid"; perception.cell_m=0.2; perception.half_size_m=30;
perception.obstacle_step_m=0.3; perception.clear_height_m=2.2; perception.max_slope=0.12; perception.min_hits=2;
perception.persistence_scans=2; perception.memory_s=2; perception.hidden_m=1; lane.model="seen_street";
lane.sigma_m=1; lane.narrowest_m=5; lane.widest_m=25; lane.window_m=20; lane.slew_m_s=0.5; lane.doubt_s=3;
lane.kerb_sigma_m=0.15; lane.kerb_memory_m=20;
planner.model="offsets"; planner.horizon_m=22; planner.max_offset_m=3.5; planner.clearance_m=0.3;
planner.comfort_clearance_m=0.8; planner.blocked_cost_1_m=4; planner.closeness_cost_1_m2=1;
planner.offset_cost_1_m=0.6; planner.change_share=0.5; planner.turning_cost_m=5; tracker.model="pure_pursuit";
tracker.lookahead_s=0.8; tracker.lookahead_min_m=2.5; tracker.lookahead_max_m=5; tracker.decay_s=1;
tracker.softening_m_s=1; speed.model="stopping_distance"; speed.reaction_s=0.3; speed.stop_margin_m=0.5;
speed.assumed_seen_m=8; recovery.model="back_up"; recovery.wait_s=2; recovery.way_m=6; recovery.speed_m_s=1;
self_check.model="none"; self_check.false_alarm=1e-04; self_check.window_s=20; self_check.course_share=0.01;
self_check.doubt_sigma_m=5; self_check.lost_after_s=12; self_check.speed_m_s=2; memory_by="estimate"; max_offset_m=3.5; clearance_m=1;
grid.cell_m=0.25; grid.half_size_m=25; grid.memory_s=6; grid.obstacle_step_m=0.4; grid.max_obstacle_height_m=2.2;
grid.min_depth_m=-2.5; grid.min_hits=3; choice.horizon_m=18; choice.stop_margin_m=3; choice.comfort_clearance_m=2;
choice.blocked_cost_1_m=4; choice.closeness_cost_1_m2=1; choice.offset_cost_1_m=0.6; choice.change_cost_1_m=0.8;
map="prior"; rate_hz=100; cruise_m_s=5; lateral_m_s2=1.2; braking_m_s2=1.2; corner_radius_m=6.5; hold_s=6;
blind_after_s=0.5; call_limit_s=10; waypoint=0 items; waypoint[].name=""; waypoint[].p_m=required;
waypoint[].observe="";
[success]
waypoint_radius_m=3; stop_s=5; stopped_speed_m_s=0.1; facade_share=0.5; camera_height_m=1.5; limit_factor=1.5;
stuck_after_s=90; camera_px_per_rad=1000; collision="box"; near_miss_m=0.3; phantom_free_m=5;
[run]
name="mission"; seed=1; initial_attitude_error_deg=[0.1, 0.1, 1]; map_leaf_m=0.25; map_range_m=40;
epoch_rate_hz=10; record_tape=true; record_filter_input=false; record_covariance=false; truth_as_height=false; truth_as_pose=false;
truth_as_guess=false; estimate_up_offset_m=0; told_step_m=0; told_step_every_s=20; told_drift_m_s=0;
told_heading_deg=0; withhold_fixes_after_s=-1; withhold_scans_after_s=-1;
)";

/// Keys whose default is another one, or that are no more.
StressFigure unlike_documented() {
  MissionConfig config;
  std::map<std::string, std::string> found;
  for (const FieldDoc& field : documented_fields("", [&](FieldVisitor& f) { visit(f, config); }))
    found[field.key] = field.default_value;
  StressFigure out;
  std::string section, rest = kDefaults;
  int looked_at = 0;
  for (std::size_t at = 0; at < rest.size();) {
    if (rest[at] == '\n' || rest[at] == ' ') {
      ++at;
    } else if (rest[at] == '[') {
      const std::size_t end = rest.find(']', at);
      section = rest.substr(at + 1, end - at - 1);
      at = end + 1;
    } else {
      const std::size_t equals = rest.find('=', at), end = rest.find(';', at);
      const auto key = found.find(section + "." + rest.substr(at, equals - at));
      out.figure += key != found.end() && key->second == rest.substr(equals + 1, end - equals - 1) ? 0.0 : 1.0;
      ++looked_at;
      at = end + 1;
    }
  }
  out.figure += looked_at > 400 ? 0.0 : 1.0;
  return out;
}

}  // namespace

std::vector<StressCase> default_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "settings of a mission that nobody gives",
           "a default of another size, or of a neighbouring key", "as the documentation lists them: exact", "keys"});
  rows.add("defaults/of_a_mission_file", unlike_documented);
  return rows.take();
}

}  // namespace canyon::mission
