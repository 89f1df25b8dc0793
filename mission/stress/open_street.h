#pragma once

/// What whole missions of the cases drive.
namespace canyon::mission {

/// Up a street of the built-in city whose houses are left out, and round a corner of it.
inline constexpr const char* kOpenStreet = R"(
base = "vicksburg"
[run]
name = "open"
[scene]
empty = true
slope_percent = 0
hill_height_m = 0
terrain_cell_m = 10
[vehicle]
start_m = [213.9, 60.0]
start_heading_deg = 0.0
roughness = "none"
[imu]
errors = "none"
mounting_error_deg = 0
[gnss]
model = "truth_plus_white"
white_sigma_m = 0.01
white_sigma_up_m = 0.01
rate_hz = 5
[lidar]
azimuth_steps = 180
range_noise_m = 0
[fusion]
initial_position_sigma_m = 0.01
initial_velocity_sigma_m_s = 0.01
initial_attitude_sigma_deg_roll_pitch = 0.01
initial_attitude_sigma_deg_heading = 0.01
[registration]
method = "none"
[autonomy]
[[autonomy.waypoint]]
name = "crossing"
p_m = [213.9, 109.9]
)";

}  // namespace canyon::mission
