#include "canyon/gnss/single_point/position_statistics.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/earth/earth.h"
#include "canyon/core/process/progress.h"

namespace canyon::gnss {
namespace {

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return kNaN;
  std::sort(values.begin(), values.end());
  const double at = share * static_cast<double>(values.size() - 1);
  const auto i = static_cast<std::size_t>(at);
  const std::size_t next = std::min(i + 1, values.size() - 1);
  return values[i] + (at - static_cast<double>(i)) * (values[next] - values[i]);
}

}  // namespace

PositionStatistics position_statistics(const std::vector<GnssFix>& fixes, const Truth& truth) {
  PositionStatistics out;
  std::vector<Eigen::Vector3d> errors;
  Eigen::Vector3d velocity_square = Eigen::Vector3d::Zero();
  int velocities = 0;
  for (const GnssFix& fix : fixes) {
    throw_if_cancelled();
    ++out.epochs;
    if (fix.status == FixStatus::kNone) continue;
    ++out.solved;
    const auto place = truth(fix.t);
    if (!place) continue;
    const Eigen::Matrix3d R_enu_E = rotation_E_from_enu(geodetic_from_ecef(place->p_E)).transpose();
    errors.push_back(R_enu_E * (fix.p_A_E - place->p_E));
    out.reported.add(errors.back(), R_enu_E * fix.covariance_E * R_enu_E.transpose());
    if (place->v_E && fix.v_A_E.allFinite()) {
      velocity_square += (R_enu_E * (fix.v_A_E - *place->v_E)).cwiseAbs2();
      ++velocities;
    }
  }
  out.compared = static_cast<int>(errors.size());
  if (errors.empty()) return out;

  const double n = static_cast<double>(errors.size());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), square = Eigen::Vector3d::Zero();
  std::vector<double> horizontal, vertical;
  for (const auto& e : errors) {
    sum += e;
    square += e.cwiseAbs2();
    horizontal.push_back(std::hypot(e.x(), e.y()));
    vertical.push_back(std::abs(e.z()));
  }
  out.mean_enu_m = sum / n;
  Eigen::Vector3d about_mean = Eigen::Vector3d::Zero();
  for (const auto& e : errors) about_mean += (e - out.mean_enu_m).cwiseAbs2();
  out.std_enu_m = (about_mean / n).cwiseSqrt();
  out.rms_3d_m = std::sqrt(square.sum() / n);
  out.h50_m = percentile(horizontal, 0.50);
  out.h95_m = percentile(horizontal, 0.95);
  out.v95_m = percentile(vertical, 0.95);
  if (velocities > 0) out.velocity_rms_enu_m_s = (velocity_square / velocities).cwiseSqrt();
  return out;
}

}  // namespace canyon::gnss
