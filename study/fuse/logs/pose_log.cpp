#include "canyon/core/earth/earth.h"
#include "canyon/core/earth/local_frame.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/tables/state_table.h"
#include "canyon/core/units.h"
#include "canyon/study/fuse/logs/aiding_logs.h"

namespace canyon::study {
namespace {

bool says_how_good(const Eigen::Vector3d& sigma) {
  return sigma.allFinite() && sigma.minCoeff() > 0.0;
}

}  // namespace

PoseInMap pose_in_frame(const StampedMapPose& pose, const LocalFrame& frame) {
  return {.t = pose.t, .X_WB = frame.X_EW().inverse() * pose.X_EB, .covariance = pose.covariance};
}

Result<PoseLog> read_pose_log(const std::string& path, const FusePosesConfig& config) {
  CANYON_TRY(const StateTable table, read_state_table(path, config.columns));
  const auto& o = config.origin_deg_deg_m;
  if (table.local && o.empty())
    return Error{path, table.rows.front().line, "", "is in local coordinates",
                 "poses.origin_deg_deg_m in --config, or lat_deg,lon_deg,h_m"};
  const LocalFrame map = table.local ? LocalFrame({o[0] * kDegree, o[1] * kDegree, o[2]}) : LocalFrame();
  const Eigen::Matrix3d R_EM = table.local ? map.R_EW() : Eigen::Matrix3d::Identity().eval();
  PoseLog out;
  out.has_week = table.has_week;
  out.passed_over = table.passed_over;
  for (const StateRow& row : table.rows) {
    if (!row.solved) continue;
    if (!row.R)
      return Error{path, row.line, "", "a pose without an attitude",
                   "columns roll_deg,pitch_deg,yaw_deg, or qw,qx,qy,qz"};
    StampedMapPose pose{.t = row.t, .X_EB = {}, .covariance = Matrix6d::Zero()};
    pose.X_EB.p = table.local ? map.to_E(row.p) : row.p;
    pose.X_EB.R = (Eigen::Quaterniond(R_EM) * *row.R).normalized();
    const Eigen::Matrix3d R_EB = pose.X_EB.R.toRotationMatrix();
    Eigen::Matrix3d place_E = R_EM * row.p_covariance * R_EM.transpose();
    if (!place_E.allFinite() || place_E.llt().info() != Eigen::Success) {
      const Eigen::Matrix3d R = rotation_E_from_enu(geodetic_from_ecef(pose.X_EB.p));
      place_E = R * config.sigma_enu_m.cwiseAbs2().asDiagonal() * R.transpose();
      if (!says_how_good(config.sigma_enu_m))
        return Error{path, row.line, "", "a place without a sigma, or with one of 0",
                     "columns sd_n,sd_e,sd_u, or poses.sigma_enu_m in --config"};
    }
    const Eigen::Vector3d turned =
        says_how_good(row.attitude_sigma_rad) ? row.attitude_sigma_rad : (config.attitude_sigma_deg * kDegree).eval();
    if (!says_how_good(turned))
      return Error{path, row.line, "", "an attitude without a sigma, or with one of 0",
                   "columns sd_roll_deg,sd_pitch_deg,sd_yaw_deg, or poses.attitude_sigma_deg in --config"};
    pose.covariance.topLeftCorner<3, 3>() = turned.cwiseAbs2().asDiagonal();
    pose.covariance.bottomRightCorner<3, 3>() = R_EB.transpose() * place_E * R_EB;
    out.poses.push_back(pose);
  }
  if (out.poses.empty()) return Error{path, 0, "", "holds no pose", "at least one"};
  return out;
}

}  // namespace canyon::study
