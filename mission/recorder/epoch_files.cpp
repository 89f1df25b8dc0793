#include "canyon/mission/recorder/epoch_files.h"

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Cholesky>

#include "canyon/core/config/text.h"
#include "canyon/core/files/files.h"
#include "canyon/core/fix_status.h"
#include "canyon/core/units.h"
#include "canyon/mission/recorder/csv_writer.h"
#include "canyon/mission/recorder/estimate_error.h"

namespace canyon::mission {

namespace {

const char* word(std::optional<lidar::RegistrationStatus> status) {
  if (!status) return "not_registered";
  return row_of(lidar::registration_statuses(), *status).name;
}

void time_columns(CsvWriter& csv, GpsTime t, GpsTime start) {
  csv.number(t - start, 3);
  csv.integer(t.week());
  csv.number(t.sow_s(), 3);
}

/// Why there is no fix, or the filter did not use it as it uses others.
std::string_view reason(const GnssRow& row) {
  if (row.withheld) return "withheld";
  const bool restarted = row.update.accepted && row.update.dimension == 0;
  return restarted ? "filter restarted" : std::string_view(row.fix.reason);
}

}  // namespace

const char* const kNavColumns =
    "t_s,gps_week,sow,true_x_m,true_y_m,true_z_m,true_yaw_deg,true_pitch_deg,true_roll_deg,true_speed_m_s,est_x_m,"
    "est_y_m,est_z_m,"
    "est_yaw_deg,est_pitch_deg,est_roll_deg,est_speed_m_s,sigma_e_m,sigma_n_m,sigma_u_m,sigma_yaw_deg,error_e_m,"
    "error_n_m,"
    "error_u_m,error_roll_deg,error_pitch_deg,error_yaw_deg,command_speed_m_s,command_curvature_1_m,waypoint,state";

void write(CsvWriter& csv, const NavRow& row, const RowPlace& run) {
  time_columns(csv, row.t, run.start);
  const YawPitchRoll truth = yaw_pitch_roll(row.X_WB_true.R), estimate = yaw_pitch_roll(row.estimate.X_WB.R);
  const Eigen::Matrix3d R = row.estimate.X_WB.R.toRotationMatrix();
  const Eigen::Matrix3d position_W = R * row.estimate.pose_covariance.bottomRightCorner<3, 3>() * R.transpose();
  const Eigen::Matrix3d attitude_W = R * row.estimate.pose_covariance.topLeftCorner<3, 3>() * R.transpose();
  const EstimateError error = estimate_error(row);
  const auto& p = row.X_WB_true.p;
  const auto& q = row.estimate.X_WB.p;
  csv.numbers(4, p.x(), p.y(), p.z(), truth.yaw_rad / kDegree, truth.pitch_rad / kDegree, truth.roll_rad / kDegree,
              row.true_speed_m_s, q.x(), q.y(), q.z(), estimate.yaw_rad / kDegree, estimate.pitch_rad / kDegree,
              estimate.roll_rad / kDegree, row.estimate.v_WB_W.head<2>().norm(), std::sqrt(position_W(0, 0)),
              std::sqrt(position_W(1, 1)), std::sqrt(position_W(2, 2)), std::sqrt(attitude_W(2, 2)) / kDegree,
              error.position_W_m.x(), error.position_W_m.y(), error.position_W_m.z(), error.attitude_deg.x(),
              error.attitude_deg.y(), error.attitude_deg.z(), row.command.speed_m_s, row.command.curvature_1_m);
  csv.integer(row.waypoint).word(name(row.state)).end_row();
}

const char* const kNavCovarianceColumns =
    "t_s,p_0_0,p_0_1,p_0_2,p_0_3,p_0_4,p_0_5,p_0_6,p_0_7,p_0_8,p_1_1,p_1_2,p_1_3,p_1_4,p_1_5,p_1_6,p_1_7,"
    "p_1_8,p_2_2,p_2_3,p_2_4,p_2_5,p_2_6,p_2_7,p_2_8,p_3_3,p_3_4,p_3_5,p_3_6,p_3_7,p_3_8,p_4_4,p_4_5,"
    "p_4_6,p_4_7,p_4_8,p_5_5,p_5_6,p_5_7,p_5_8,p_6_6,p_6_7,p_6_8,p_7_7,p_7_8,p_8_8";

void write_covariance(CsvWriter& csv, const NavRow& row, const RowPlace& run) {
  const Eigen::Matrix3d R = row.estimate.X_WB.R.toRotationMatrix();
  Eigen::Matrix<double, 9, 9> J = Eigen::Matrix<double, 9, 9>::Zero();  // of [turned; moved, both in B; velocity in W]
  J.block<3, 3>(0, 3) = R;
  J.block<3, 3>(3, 6).setIdentity();
  J.block<3, 3>(6, 0) = R;
  const Eigen::Matrix<double, 9, 9> P = J * *row.covariance * J.transpose();
  csv.number(row.t - run.start, 3);
  for (int i = 0; i < 9; ++i)
    for (int j = i; j < 9; ++j) csv.exact(0.5 * (P(i, j) + P(j, i)));
  csv.end_row();
}

const char* const kGnssColumns =
    "t_s,gps_week,sow,status,satellites,above_mask,tracked,nlos,reflected,gdop,pdop,hdop,vdop,fix_x_m,fix_y_m,fix_z_"
    "m,sigma_e_m,"
    "sigma_n_m,sigma_u_m,true_x_m,true_y_m,true_z_m,error_e_m,error_n_m,error_u_m,multipath_max_m,accepted,nis,"
    "reason";

void write(CsvWriter& csv, const GnssRow& row, const RowPlace& run) {
  const Eigen::Matrix3d R_WE = run.frame.R_EW().transpose();
  const bool has_satellites = row.has_satellites;
  time_columns(csv, row.fix.t, run.start);
  int tracked = 0, nlos = 0, reflected = 0;
  double multipath = has_satellites ? 0.0 : kNaN;
  for (const auto& satellite : row.truth.satellites) {
    if (!satellite.tracked) continue;
    ++tracked;
    nlos += satellite.line_of_sight ? 0 : 1;
    reflected += satellite.line_of_sight && satellite.reflections > 0 ? 1 : 0;
    if (std::abs(satellite.multipath_m) > std::abs(multipath)) multipath = satellite.multipath_m;
  }
  csv.word(fix_status_name(row.fix.status));
  for (const int count : {row.fix.satellites, static_cast<int>(row.truth.satellites.size()), tracked, nlos, reflected})
    csv.number(has_satellites ? count : kNaN, 0);
  csv.numbers(3, row.fix.dop.gdop, row.fix.dop.pdop, row.fix.dop.hdop, row.fix.dop.vdop);
  const bool fixed = row.fix.status != FixStatus::kNone;
  const Eigen::Vector3d p = fixed ? run.frame.to_W(row.fix.p_A_E) : Eigen::Vector3d::Constant(kNaN);
  const Eigen::Matrix3d covariance = R_WE * row.fix.covariance_E * R_WE.transpose();
  const Eigen::Vector3d& truth = row.p_A_W_true;
  csv.numbers(4, p.x(), p.y(), p.z(), std::sqrt(covariance(0, 0)), std::sqrt(covariance(1, 1)),
              std::sqrt(covariance(2, 2)), truth.x(), truth.y(), truth.z(), p.x() - truth.x(), p.y() - truth.y(),
              p.z() - truth.z(), multipath);
  csv.integer(row.update.accepted ? 1 : 0).number(row.update.dimension > 0 ? row.update.nis : kNaN, 4);
  csv.word(reason(row)).end_row();
}

const char* const kSatelliteColumns =
    "t_s,satellite,elevation_deg,azimuth_deg,line_of_sight,tracked,reflections,cn0_dbhz,multipath_m,ionosphere_m,"
    "troposphere_m,"
    "ephemeris_m,noise_m,base_m,carrier_multipath_m,range_rate_multipath_m_s";

void write_satellites(CsvWriter& csv, const GnssRow& row, const RowPlace& run) {
  for (std::size_t i = 0; i < row.truth.satellites.size(); ++i) {
    const GnssObservationTruth& s = row.truth.satellites[i];
    csv.number(row.fix.t - run.start, 3).word(s.sv.str());
    csv.numbers(2, s.elevation_rad / kDegree, s.azimuth_rad / kDegree);
    csv.integer(s.line_of_sight ? 1 : 0).integer(s.tracked ? 1 : 0).integer(s.reflections).number(row.cn0_dbhz[i], 2);
    csv.numbers(4, s.multipath_m, s.ionosphere_m, s.troposphere_m, s.ephemeris_m, s.noise_m, s.base_m,
                s.carrier_multipath_m, s.range_rate_multipath_m_s);
    csv.end_row();
  }
}

const char* const kKeyframeColumns =
    "t_s,points,true_x_m,true_y_m,true_z_m,prior_error_m,prior_error_up_m,registered_error_m,registered_error_up_m,"
    "status,"
    "iterations,rms_m,error_roll_deg,error_pitch_deg,error_yaw_deg,sigma_e_m,sigma_n_m,sigma_u_m,sigma_roll_deg,"
    "sigma_pitch_deg,sigma_yaw_deg,nees,step_error_m,step_error_deg,step_nees,overlap,open_directions,map_status,"
    "align_error_roll_deg,align_error_pitch_deg,align_error_yaw_deg,align_error_x_m,align_error_y_m,align_error_z_m,"
    "align_sigma_roll_deg,align_sigma_pitch_deg,align_sigma_yaw_deg,align_sigma_x_m,align_sigma_y_m,align_sigma_z_m,"
    "align_nees,align_covariance,covariance,open_vectors";

namespace {

/// Of a pose's error, 6 degrees of freedom; NaN where the covariance is none.
double nees(const Pose& X, const Pose& X_true, const Matrix6d& covariance) {
  const Vector6d xi = (X.inverse() * X_true).log();
  return xi.dot(covariance.ldlt().solve(xi));
}

/// The upper triangle row by row, in one field, with as many digits as give the same bits; empty where there is none.
std::string upper_triangle(const Matrix6d& covariance) {
  std::string text;
  if (!covariance.allFinite()) return text;
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j)
      text += (text.empty() ? "" : " ") + number_text(0.5 * (covariance(i, j) + covariance(j, i)));
  return text;
}

/// Six numbers each, in one field.
std::string open_vectors(const std::vector<Vector6d>& directions) {
  std::string text;
  for (const Vector6d& v : directions) {
    if (!text.empty()) text += ';';
    for (int i = 0; i < 6; ++i) text += (i > 0 ? " " : "") + number_text(v[i]);
  }
  return text;
}

/// Of the alignment alone, about and along L's axes.
void alignment_columns(CsvWriter& csv, const KeyframeRow& row) {
  const RelativePose alone = row.alone.value_or(RelativePose{});
  const Pose off = row.X_LL_true.inverse() * alone.X_TS;
  const double known = row.alone ? 1.0 : kNaN;
  const Vector6d sigma = alone.covariance.diagonal().cwiseSqrt();
  const Eigen::Vector3d turned_deg = known * so3_log(off.R) / kDegree, moved_m = known * off.p,
                        sigma_deg = sigma.head<3>() / kDegree, sigma_m = sigma.tail<3>();
  for (const Eigen::Vector3d* of : {&turned_deg, &moved_m, &sigma_deg, &sigma_m})
    for (const double value : *of) csv.number(value, 4);
  csv.number(nees(alone.X_TS, row.X_LL_true, alone.covariance), 3).word(upper_triangle(alone.covariance));
}

}  // namespace

void write(CsvWriter& csv, const KeyframeRow& row, const RowPlace& run) {
  const Eigen::Vector3d& p = row.X_WL_true.p;
  const Eigen::Vector3d prior = row.X_WL_prior.p - p, registered = row.X_WL_registered.p - p;
  csv.number(row.t - run.start, 3).integer(static_cast<std::int64_t>(row.points));
  const double known = run.registers ? 1.0 : kNaN;
  csv.numbers(4, p.x(), p.y(), p.z(), prior.norm(), prior.z(), known * registered.norm(), known * registered.z());
  csv.word(word(row.status)).integer(row.iterations).number(row.rms_m, 4);
  const Eigen::Vector3d turned_deg = known * so3_log(row.X_WL_true.R.conjugate() * row.X_WL_registered.R) / kDegree;
  const Eigen::Matrix3d R = row.X_WL_registered.R.toRotationMatrix();
  const Eigen::Vector3d position = (R * row.covariance.bottomRightCorner<3, 3>() * R.transpose()).diagonal(),
                        attitude = row.covariance.diagonal().head<3>();
  const Eigen::Vector3d sigma_m = known * position.cwiseSqrt(), sigma_deg = known * attitude.cwiseSqrt() / kDegree;
  for (const Eigen::Vector3d* of : {&turned_deg, &sigma_m, &sigma_deg})
    for (const double value : *of) csv.number(value, 4);
  csv.number(known * nees(row.X_WL_registered, row.X_WL_true, row.covariance), 3);
  const Pose step = row.placed ? row.placed->X_TS.inverse() * row.X_LL_true : Pose{};
  const double placed = row.placed ? 1.0 : kNaN;
  csv.number(placed * step.p.norm(), 4).number(placed * so3_log(step.R).norm() / kDegree, 4);
  csv.number(row.placed ? nees(row.placed->X_TS, row.X_LL_true, row.placed->covariance) : kNaN, 3);
  csv.number(row.overlap, 4).number(row.open ? static_cast<double>(row.open->size()) : kNaN, 0);
  csv.word(row.map_status ? word(row.map_status) : "");
  alignment_columns(csv, row);
  csv.word(run.registers ? upper_triangle(row.covariance) : "").word(row.open ? open_vectors(*row.open) : "");
  csv.end_row();
}

const char* const kImuColumns = "t_ns,dt_s,gx_rad,gy_rad,gz_rad,ax_m_s,ay_m_s,az_m_s,lost";

void write(CsvWriter& csv, const ImuSample& sample, const RowPlace& run) {
  csv.integer(sample.t.ns - run.start.ns).exact(sample.dt_s);
  for (const Eigen::Vector3d* triad : {&sample.dtheta_U, &sample.dv_U})
    for (const double value : *triad) csv.exact(value);
  csv.integer(sample.lost ? 1 : 0).end_row();
}

const char* const kOdometerColumns = "t_ns,dt_s,ticks,speed_m_s,true_distance_m,true_slip,true_scale_error";

void write(CsvWriter& csv, const inertial::Odometer::Reading& reading, const RowPlace& run) {
  const OdometerSample& sample = reading.message;
  csv.integer(sample.t.ns - run.start.ns).exact(sample.dt_s).integer(sample.ticks).exact(sample.speed_m_s);
  csv.exact(reading.truth.distance_m).exact(reading.truth.slip).exact(reading.truth.scale_error).end_row();
}

const char* const kBarometerColumns = "t_ns,pressure_pa,true_pressure_pa,true_drift_pa";

void write(CsvWriter& csv, const inertial::Barometer::Reading& reading, const RowPlace& run) {
  csv.integer(reading.message.t.ns - run.start.ns).exact(reading.message.pressure_pa);
  csv.exact(reading.truth.pressure_pa).exact(reading.truth.drift_pa).end_row();
}

const char* const kMagnetometerColumns = "t_ns,x_t,y_t,z_t,true_x_t,true_y_t,true_z_t";

void write(CsvWriter& csv, const inertial::Magnetometer::Reading& reading, const RowPlace& run) {
  csv.integer(reading.message.t.ns - run.start.ns);
  for (const Eigen::Vector3d* field : {&reading.message.field_U_t, &reading.truth.field_U_t})
    for (const double value : *field) csv.exact(value);
  csv.end_row();
}

const char* const kFixColumns =
    "t_ns,offered,status,x_m,y_m,z_m,xx_m2,xy_m2,xz_m2,yy_m2,yz_m2,zz_m2,vx_m_s,vy_m_s,vz_m_s,vxx_m2_s2,vxy_m2_s2,"
    "vxz_m2_s2,vyy_m2_s2,vyz_m2_s2,vzz_m2_s2";

void write_fix(CsvWriter& csv, const GnssRow& row, const RowPlace& run) {
  const GnssFix& fix = row.fix;
  csv.integer(fix.t.ns - run.start.ns).integer(row.withheld ? 0 : 1).word(fix_status_name(fix.status));
  const auto add = [&csv](const Eigen::Vector3d& mean, const Eigen::Matrix3d& covariance) {
    for (const double value : mean) csv.exact(value);
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) csv.exact(0.5 * (covariance(i, j) + covariance(j, i)));
  };
  add(fix.p_A_E, fix.covariance_E);
  add(fix.v_A_E, fix.velocity_covariance_E);
  csv.end_row();
}

const char* const kRangeColumns =
    "t_ns,offered,received_ns,satellite,corrected_m,rate_m_s,sigma_m,cn0_dbhz,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s";

void write_ranges(CsvWriter& csv, const GnssRow& row, const RowPlace& run) {
  for (const GnssObservation& o : row.epoch.observations) {
    csv.integer(row.fix.t.ns - run.start.ns).integer(row.withheld ? 0 : 1).integer(row.epoch.t.ns - run.start.ns);
    csv.word(o.sv.str());
    csv.exact(o.corrected_m()).exact(o.rate_m_s).exact(o.sigma_m).exact(o.cn0_dbhz);
    for (const Eigen::Vector3d* of_satellite : {&o.p_E, &o.v_E})
      for (const double value : *of_satellite) csv.exact(value);
    csv.end_row();
  }
}

}  // namespace canyon::mission
