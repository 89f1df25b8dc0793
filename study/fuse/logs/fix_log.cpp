#include "canyon/study/fuse/logs/fix_log.h"

#include "canyon/core/earth/earth.h"
#include "canyon/gnss/single_point/recorded_data.h"

namespace canyon::study {
namespace {

Eigen::Matrix3d diagonal_E(const Eigen::Vector3d& p_E, const Eigen::Vector3d& sigma_enu) {
  const Eigen::Matrix3d R = rotation_E_from_enu(geodetic_from_ecef(p_E));
  return R * sigma_enu.cwiseAbs2().asDiagonal() * R.transpose();
}

bool positive_definite(const Eigen::Matrix3d& covariance) {
  return covariance.allFinite() && covariance.llt().info() == Eigen::Success;
}

FixStatus status_of(const StateRow& row) {
  const bool carrier_or_differential = row.quality >= 1 && row.quality <= 4;
  return carrier_or_differential ? FixStatus::kDifferential : FixStatus::kSingle;
}

Result<GnssFix> fix_of(const StateRow& row, const std::string& path, const FuseGnssConfig& config) {
  GnssFix fix;
  fix.t = row.t;
  fix.status = status_of(row);
  fix.p_A_E = row.p;
  fix.covariance_E = row.p_covariance;
  if (!positive_definite(fix.covariance_E) && config.sigma_enu_m.minCoeff() > 0.0)
    fix.covariance_E = diagonal_E(row.p, config.sigma_enu_m);
  if (!positive_definite(fix.covariance_E))
    return Error{path, row.line, "", "a fix without a sigma, or with one of 0",
                 "columns sd_n,sd_e,sd_u, or gnss.sigma_enu_m in --config"};
  fix.v_A_E = row.v;
  fix.velocity_covariance_E = row.v_covariance;
  if (row.v.allFinite() && !positive_definite(row.v_covariance))
    fix.velocity_covariance_E = config.velocity_sigma_enu_m_s.minCoeff() > 0.0
                                    ? diagonal_E(row.p, config.velocity_sigma_enu_m_s)
                                    : Eigen::Matrix3d::Constant(kNaN).eval();
  return fix;
}

Result<FixLog> solve(const std::string& path, const std::vector<std::string>& navigation,
                     const FuseGnssConfig& config) {
  gnss::SinglePointConfig options;
  if (!config.solve.empty()) {
    CANYON_TRY(options, gnss::read_single_point_config(config.solve));
  }
  gnss::RecordedFiles files;
  files.observations = path;
  files.navigation = navigation;
  CANYON_TRY(const auto data, gnss::read_recorded_data(files, options));
  CANYON_TRY(const auto solved, gnss::solve_observations(data.observations, data.inputs(), options));
  FixLog out;
  out.has_week = true;
  out.warnings = data.warnings;
  for (const auto* lines : {&data.observations.warnings, &solved.warnings})
    out.warnings.insert(out.warnings.end(), lines->begin(), lines->end());
  for (const auto& epoch : solved.epochs) {
    if (!epoch.epoch.observations.empty() && (out.ranges.empty() || epoch.epoch.t > out.ranges.back().t))
      out.ranges.push_back(epoch.epoch);
    if (epoch.fix.status == FixStatus::kNone)
      out.without_solution.add(0, epoch.epoch.t.sow_s(), kNaN);
    else if (!out.fixes.empty() && epoch.fix.t <= out.fixes.back().t)
      out.passed_over.reversed.add(0, epoch.fix.t.sow_s(), out.fixes.back().t.sow_s());
    else
      out.fixes.push_back(epoch.fix);
  }
  for (const GnssFix& fix : out.fixes) out.came.push_back(fix.t);
  return out;
}

}  // namespace

Result<FixLog> read_fix_log(const std::string& path, const std::vector<std::string>& navigation,
                            const FuseGnssConfig& config, double late_s) {
  if (!navigation.empty()) return solve(path, navigation, config);
  CANYON_TRY(const StateTable table, read_state_table(path, config.columns, late_s));
  if (table.local)
    return Error{path, table.rows.front().line, "", "places nearer to the Earth's centre than 1000 km",
                 "lat_deg,lon_deg,h_m, or x_m,y_m,z_m in the Earth-fixed frame"};
  FixLog out;
  out.has_week = table.has_week;
  out.passed_over = table.passed_over;
  for (const StateRow& row : table.rows) {
    if (!row.offered) {
      out.withheld.add(row.line, table.stated_s(row.t), kNaN);
    } else if (!row.solved) {
      out.without_solution.add(row.line, table.stated_s(row.t), kNaN);
    } else {
      CANYON_TRY(GnssFix fix, fix_of(row, path, config));
      out.fixes.push_back(std::move(fix));
      out.came.push_back(row.came);
    }
  }
  if (out.fixes.empty()) return Error{path, 0, "", "holds no fix", "at least one"};
  return out;
}

}  // namespace canyon::study
