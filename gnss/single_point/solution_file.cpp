#include "canyon/gnss/single_point/solution_file.h"

#include <cmath>
#include <cstdio>

#include "canyon/core/earth/earth.h"
#include "canyon/core/fix_status.h"
#include "canyon/core/process/progress.h"

namespace canyon::gnss {
namespace {

std::string field(double value, int decimals) {
  if (!std::isfinite(value)) return "";
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

/// Six digits, wherever the point is.
std::string significant(double value) {
  if (!std::isfinite(value)) return "";
  char text[64];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string quoted(const std::string& text) {
  return text.find(',') == std::string::npos ? text : "\"" + text + "\"";
}

}  // namespace

std::string solution_csv(const SinglePointResult& result) {
  std::string out =
      "gps_week,sow,x_m,y_m,z_m,status,satellites,gdop,pdop,hdop,vdop,tdop,excluded,sigma_e_m,sigma_n_m,sigma_u_m,"
      "clock_m,vx_m_s,vy_m_s,vz_m_s,xx_m2,xy_m2,xz_m2,yy_m2,yz_m2,zz_m2,vxx_m2_s2,vxy_m2_s2,vxz_m2_s2,vyy_m2_s2,"
      "vyz_m2_s2,vzz_m2_s2,reason\n";
  for (const auto& e : result.epochs) {
    throw_if_cancelled();
    const GnssFix& fix = e.fix;
    const bool solved = fix.status != FixStatus::kNone;
    Eigen::Vector3d sigma_enu = Eigen::Vector3d::Constant(kNaN);
    if (solved) {
      const Eigen::Matrix3d R = rotation_E_from_enu(geodetic_from_ecef(fix.p_A_E));
      sigma_enu = (R.transpose() * fix.covariance_E * R).diagonal().cwiseSqrt();
    }
    out += std::to_string(fix.t.week()) + "," + field(fix.t.sow_s(), 7);
    for (int i = 0; i < 3; ++i) out += "," + field(fix.p_A_E[i], 4);
    out += std::string(",") + fix_status_name(fix.status) + "," + std::to_string(fix.satellites);
    for (const double dop : {fix.dop.gdop, fix.dop.pdop, fix.dop.hdop, fix.dop.vdop, fix.dop.tdop})
      out += "," + field(dop, 3);
    out += "," + std::to_string(e.excluded);
    for (int i = 0; i < 3; ++i) out += "," + field(sigma_enu[i], 3);
    out += "," + field(fix.clock_m, 4);
    for (int i = 0; i < 3; ++i) out += "," + field(fix.v_A_E[i], 4);
    for (const Eigen::Matrix3d* covariance : {&fix.covariance_E, &fix.velocity_covariance_E})
      for (int i = 0; i < 3; ++i)
        for (int j = i; j < 3; ++j) out += "," + (solved ? significant((*covariance)(i, j)) : "");
    out += "," + quoted(fix.reason) + "\n";
  }
  return out;
}

}  // namespace canyon::gnss
