#include "canyon/gnss/sensor/simulation/drive.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/earth/earth.h"
#include "canyon/core/fix_status.h"
#include "canyon/core/math/median.h"
#include "canyon/core/process/progress.h"
#include "canyon/gnss/antenna_height.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {

std::int64_t Drive::epochs() const {
  return static_cast<std::int64_t>(std::floor(duration_s * rate_hz + 1e-9)) + 1;
}

void DriveTotals::add(const GnssOutput& output) {
  ++epochs;
  for (const GnssObservationTruth& s : output.truth.satellites) {
    if (!s.tracked) continue;
    ++tracked;
    nlos += s.line_of_sight ? 0 : 1;
  }
  if (output.fix.status == FixStatus::kNone) return;
  ++fixes;
  square_m2 += (output.fix.p_A_E - output.truth.p_A_E).squaredNorm();
  const Geodetic place = geodetic_from_ecef(output.truth.p_A_E);
  const Eigen::Vector3d error = rotation_E_from_enu(place).transpose() * (output.fix.p_A_E - output.truth.p_A_E);
  horizontal_m.push_back(error.head<2>().norm());
  reported.add(output.fix, output.truth.p_A_E);
  if (std::isfinite(output.fix.dop.gdop)) gdop.push_back(output.fix.dop.gdop);
}

double DriveTotals::satellites_mean() const {
  return epochs > 0 ? static_cast<double>(tracked) / static_cast<double>(epochs) : kNaN;
}

double DriveTotals::nlos_share() const {
  return tracked > 0 ? static_cast<double>(nlos) / static_cast<double>(tracked) : kNaN;
}

double DriveTotals::rms_m() const {
  return fixes > 0 ? std::sqrt(square_m2 / static_cast<double>(fixes)) : kNaN;
}

double DriveTotals::gdop_median() const {
  return median(gdop);
}

double DriveTotals::horizontal_percentile_m(double share) const {
  if (horizontal_m.empty()) return kNaN;
  std::vector<double> sorted = horizontal_m;
  std::sort(sorted.begin(), sorted.end());
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto i = static_cast<std::size_t>(at);
  const std::size_t next = std::min(i + 1, sorted.size() - 1);
  return sorted[i] + (at - static_cast<double>(i)) * (sorted[next] - sorted[i]);
}

double depth_below_ground_m(const scene::Scene& scene, const Eigen::Vector3d& p_W) {
  const auto ground = scene.ground(p_W.x(), p_W.y());
  return ground ? std::max(0.0, ground->height_m - p_W.z()) : 0.0;
}

Result<DriveTotals> simulate_drive(const Drive& drive, GnssSensor& sensor, const scene::Scene& scene,
                                   const std::function<void(const GnssOutput&)>& take) {
  const LocalFrame& frame = scene.frame();
  const scene::SceneAt scene_at(scene);
  DriveTotals totals;
  for (std::int64_t k = 0; k < drive.epochs(); ++k) {
    throw_if_cancelled();
    const GpsTime t = tick(drive.start, k, drive.rate_hz);
    const auto state = drive.path.at(t);
    if (!state) break;  // the last tick may round to a nanosecond past the end
    // Between places the way is a smooth curve, which may lead where they do not.
    CANYON_TRY_STATUS(check_antenna_height(state->p_E, {drive.path_name, 0, t.iso()}));
    const Eigen::Vector3d p_A_W = frame.to_W(state->p_E);
    const double depth_m = depth_below_ground_m(scene, p_A_W);
    totals.below_ground += depth_m > 0.0 ? 1 : 0;
    totals.deepest_m = std::max(totals.deepest_m, depth_m);
    const GnssOutput output = sensor.measure(k, t, p_A_W, frame.R_EW().transpose() * state->v_E, scene_at);
    totals.add(output);
    take(output);
  }
  return totals;
}

}  // namespace canyon::gnss
