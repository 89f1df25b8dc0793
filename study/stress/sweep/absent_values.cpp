#include "canyon/study/stress/sweep/absent_values.h"

namespace canyon::study {
namespace {

constexpr const char *kFix = "fix_x_m,fix_y_m,fix_z_m,sigma_e_m,sigma_n_m,sigma_u_m,error_e_m,error_n_m,error_u_m",
                     *kDops = "gdop,pdop,hdop,vdop", *kCounts = "satellites,above_mask,tracked,nlos,reflected",
                     *kPosition = "x_m,y_m,z_m,xx_m2,xy_m2,xz_m2,yy_m2,yz_m2,zz_m2",
                     *kVelocity = "vx_m_s,vy_m_s,vz_m_s,vxx_m2_s2,vxy_m2_s2,vxz_m2_s2,vyy_m2_s2,vyz_m2_s2,vzz_m2_s2",
                     *kFixFigures = "gdop_median,gdop_max,pdop_median,satellites_mean,nlos_share,multipath_share",
                     *kRegistered =
                         "registered_error_m,registered_error_up_m,error_roll_deg,error_pitch_deg,error_yaw_deg,"
                         "sigma_e_m,sigma_n_m,sigma_u_m,sigma_roll_deg,sigma_pitch_deg,sigma_yaw_deg,nees,covariance",
                     *kAlignment =
                         "align_error_roll_deg,align_error_pitch_deg,align_error_yaw_deg,align_error_x_m,"
                         "align_error_y_m,align_error_z_m,align_sigma_roll_deg,align_sigma_pitch_deg,"
                         "align_sigma_yaw_deg,align_sigma_x_m,align_sigma_y_m,align_sigma_z_m,align_nees,"
                         "align_covariance",
                     *kNotConverged =
                         "not_registered,not_converged,too_few_points,degenerate,diverged,ambiguous,"
                         "too_little_overlap,beyond_prior",
                     *kPriorMap = "map_error_prior_rms_m,map_error_p95_prior_m,map_capped_prior_share",
                     *kErrors =
                         "position_error_rms_m,position_error_p95_m,position_error_max_m,"
                         "position_error_e_rms_m,position_error_e_p95_m,position_error_e_max_m,"
                         "position_error_n_rms_m,position_error_n_p95_m,position_error_n_max_m,"
                         "position_error_up_rms_m,position_error_up_p95_m,position_error_up_max_m,"
                         "attitude_error_roll_rms_deg,attitude_error_pitch_rms_deg,attitude_error_yaw_rms_deg",
                     *kMap = "map_error_rms_m,map_error_p95_m,map_capped_share";

constexpr MayBeAbsent kRows[] = {
    {"gnss", kFix, "status", "none", "no fix"},
    {"gnss", kDops, "status", "none", "no fix"},
    {"gnss", kDops, "satellites", "1,2,3,4,5,6",
     "too few for a place and a clock of each system: a fix that the receiver's own filter bridges"},
    {"gnss", kDops, "satellites", "", "a GNSS model that makes fixes without satellites"},
    {"gnss", kCounts, "satellites", "", "the same"},
    {"gnss", "multipath_max_m", "satellites", "", "the same"},
    {"gnss", "nis", "accepted", "0", "the filter was given no fix, or had to refuse it before it could weigh it"},
    {"gnss", "nis", "reason", "filter restarted", "the fix took the place of a position that was not known"},
    {"gnss", "reason", "", "", "a fix, which needs none"},
    {"satellites", "cn0_dbhz", "tracked", "0", "not measured"},
    {"satellites", "cn0_dbhz", "noise_m", "0", "a GNSS model that counts satellites, and knows of no signals"},
    {"keyframes", kRegistered, "status", "not_registered", "`[registration] method = \"none\"`"},
    {"keyframes", "step_error_m,step_error_deg,step_nees", "status", "not_registered",
     "no keyframe before it to be registered to"},
    {"keyframes", kAlignment, "status", kNotConverged, "the alignment gave no pose"},
    {"keyframes", "map_status", "", "", "there is no `[registration] prior_map`"},
    {"keyframes", "overlap,open_directions", "", "", "the own methods alone tell them, of what they matched"},
    {"keyframes", "open_vectors", "open_directions", "0", "none is open"},
    {"keyframes", "open_vectors", "open_directions", "", "the own methods alone tell them"},
    {"keyframes", "rms_m", "overlap", "", "PCL's own methods do not tell it"},
    {"keyframes", "rms_m", "iterations", "0", "nothing was matched"},
    {"keyframes", "rms_m", "status", "too_little_overlap", "less was matched than determines a pose"},
    {"keyframes", "rms_m", "status", "degenerate", "what was matched determines none"},
    {"fixes", kPosition, "status", "none", "no fix"},
    {"fixes", kVelocity, "", "", "the receiver gives no velocity"},
    {"manifest.json", "commit", "", "", "the program was built of a source without its history"},
    {"summary.json", "building", "", "", "a waypoint without a building"},
    {"summary.json", "two_by_two", "", "", "not four runs"},
    {"summary.json", "failure", "outcome", "success", "none"},
    {"summary.json", kErrors, "position_error_max_m", "", "a run too short for a row in epochs/RUN_nav.csv"},
    {"summary.json", "lag_one,white", "", "", "fewer than four innovations or fixes"},
    {"summary.json", "halved_after_s", "", "", "the state is not observed"},
    {"summary.json", "fixes", "fixes_lost", "=fixes_due", "no fix"},
    {"summary.json", "dop_jumps", "", "", "a GNSS model that makes fixes without satellites, or no epoch was due"},
    {"summary.json", kFixFigures, "dop_jumps", "", "the same"},
    {"summary.json", kFixFigures, "fixes_lost", "=fixes_due", "no fix"},
    {"summary.json", "facade_px_per_m_min,facade_range_max_m,facade_obliquity_max_deg,facade_least_seen_share", "", "",
     "no facade was looked at"},
    {"summary.json", "facade_range_m,facade_obliquity_deg,facade_px_per_m", "", "", "the same"},
    {"summary.json", "closest_m,believed_at_m", "", "",
     "a waypoint that no epoch was near to, or that is not believed reached"},
    {"summary.json", "phantoms_per_km,needless_lane_departures_per_km,missed_obstacles_per_km", "distance_m", "0",
     "no way was driven"},
    {"summary.json", "hit_in_scans_s,hit_last_range_m,hit_last_seen_s", "", "",
     "nothing was hit, or no scan showed it"},
    {"summary.json", "fix_error_rms_m", "fixes_lost", "=fixes_due", "no fix"},
    {"summary.json",
     "keyframes_registered,keyframes_converged,registration_error_rms_m,map_points_capped,"
     "map_points_level,map_error_up_rms_m",
     "keyframes_registered", "", "`[registration] method = \"none\"`"},
    {"summary.json", kMap, "keyframes_registered", "", "the same"},
    {"summary.json", "registration_error_rms_m", "keyframes_registered", "0", "one keyframe, which defines the map"},
    {"summary.json", "registration_error_prior_rms_m", "keyframes", "0", "no keyframe"},
    {"summary.json", kPriorMap, "map_points", "0", "no point in the map"},
    {"summary.json", kMap, "map_points", "0", "no point in the map"},
    {"summary.json", "map_error_up_prior_rms_m", "map_points_level_prior", "0",
     "no point next to level ground or a roof"},
    {"summary.json", "map_error_up_rms_m", "map_points_level", "0", "the same"},
};

}  // namespace

std::span<const MayBeAbsent> may_be_absent() {
  return kRows;
}

}  // namespace canyon::study
