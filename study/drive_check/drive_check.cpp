#include "canyon/study/drive_check/drive_check.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/fix_status.h"
#include "canyon/core/math/median.h"
#include "canyon/gnss/paths/clutter/street_number.h"
#include "canyon/study/drive_check/drive_resampling.h"
#include "canyon/study/drive_check/simulated_log.h"

namespace canyon::study {
namespace {

constexpr int kResampledDrives = 200;

/// Horizontal bounds of what stands around.
struct Bounds {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e300), high = Eigen::Vector2d::Constant(-1e300);

  explicit Bounds(const scene::Scene& scene) {
    for (const scene::Building& building : scene.buildings())
      for (const Eigen::Vector2d& corner : building.footprint_W) {
        low = low.cwiseMin(corner);
        high = high.cwiseMax(corner);
      }
    if (!scene.buildings().empty()) return;
    low = scene.extent().min.head<2>();
    high = scene.extent().max.head<2>();
  }
  bool hold(const Eigen::Vector3d& p_W) const {
    return (p_W.head<2>().array() >= low.array()).all() && (p_W.head<2>().array() <= high.array()).all();
  }
};

Result<std::vector<GpsTime>> epochs_with_reference(const DriveCheckInputs& inputs, const DriveStretch& stretch) {
  const gnss::ObservationFile& log = inputs.data.observations;
  std::vector<GpsTime> out;
  int inside = 0;
  const Bounds city(inputs.scene);
  for (const gnss::ObservationEpoch& epoch : log.epochs) {
    const auto at = stretch.truth.at(epoch.t);
    if (!at || !stretch.holds(epoch.t)) continue;
    out.push_back(epoch.t);
    inside += city.hold(inputs.scene.frame().to_W(at->p_E)) ? 1 : 0;
  }
  if (out.empty())
    return Error{log.name, 0, "", "has no epoch at a time of " + inputs.reference_name, "a reference of the same time"};
  if (inside < static_cast<int>(out.size()))
    return Error{inputs.scene_name, 0, "",
                 "covers " + std::to_string(inside) + " of " + std::to_string(out.size()) + " epochs of the drive",
                 "a city around all of it, or --from-sow and --to-sow of the stretch that it covers"};
  return out;
}

DriveFix compare(const GnssFix& fix, const Eigen::Vector3d& truth_E) {
  if (fix.status == FixStatus::kNone) return {};
  const Eigen::Matrix3d R_E_enu = rotation_E_from_enu(geodetic_from_ecef(truth_E));
  const Eigen::Vector2d error = (R_E_enu.transpose() * (fix.p_A_E - truth_E)).head<2>();
  const Eigen::Matrix2d covariance = (R_E_enu.transpose() * fix.covariance_E * R_E_enu).topLeftCorner<2, 2>();
  return {.horizontal_m = error.norm(), .normalised2 = error.dot(covariance.ldlt().solve(error))};
}

/// The fix of each instant of the reference: of the epoch that is at most half an interval away.
std::vector<DriveFix> fixes_at_reference(const std::vector<gnss::SinglePointEpoch>& solved, double half_interval_s,
                                         const std::vector<StampedPlace>& reference, const DriveStretch& stretch) {
  std::vector<DriveFix> out;
  std::size_t next = 0;
  for (const StampedPlace& place : reference) {
    if (!stretch.holds(place.t)) continue;
    while (next < solved.size() && solved[next].fix.t - place.t < -half_interval_s) ++next;
    DriveFix fix;
    if (next < solved.size() && solved[next].fix.t - place.t <= half_interval_s)
      if (const auto at = stretch.truth.at(solved[next].fix.t)) fix = compare(solved[next].fix, at->p_E);
    fix.t = place.t;
    out.push_back(fix);
  }
  return out;
}

/// Of the reference, s, halved.
double half_interval_s(const std::vector<StampedPlace>& reference) {
  std::vector<double> intervals_s;
  for (std::size_t i = 1; i < reference.size(); ++i) intervals_s.push_back(reference[i].t - reference[i - 1].t);
  return 0.5 * (intervals_s.empty() ? 1.0 : median(intervals_s)) + 1e-6;
}

Result<DriveSide> side_of(const gnss::ObservationFile& log, const gnss::SinglePointInputs& sky,
                          const DriveCheckInputs& inputs, const DriveStretch& stretch,
                          std::vector<std::string>& warnings) {
  DriveSide out;
  out.epochs = drive_signals(log, sky.constellation, sky.navigation, inputs.solver, stretch);
  CANYON_TRY(const auto solved, gnss::solve_observations(log, sky, inputs.solver));
  warnings.insert(warnings.end(), solved.warnings.begin(), solved.warnings.end());
  out.fixes = fixes_at_reference(solved.epochs, half_interval_s(inputs.reference), inputs.reference, stretch);
  out.figures = drive_figures(out.epochs, out.fixes);
  return out;
}

/// The draw of that number: its seed, and what stands in its street.
Result<DriveSide> simulated_side(const DriveCheckInputs& inputs, int draw, const PlacePath& truth,
                                 const std::vector<GpsTime>& epochs, const DriveStretch& stretch,
                                 std::vector<std::string>& warnings) {
  DriveCheckInputs own = inputs;
  own.seed += static_cast<std::uint64_t>(draw);
  gnss::move_to_street(own.receiver.propagation.clutter.own, draw);
  CANYON_TRY(const SimulatedLog simulated, simulated_log(own, truth, epochs, warnings));
  return side_of(simulated.observations, {*simulated.source.constellation, inputs.data.navigation}, inputs, stretch,
                 warnings);
}

}  // namespace

Result<DriveCheck> check_drive(const DriveCheckInputs& inputs) {
  const PlacePath truth(inputs.reference);
  const DriveStretch stretch{truth, inputs.scene, inputs.from_sow, inputs.to_sow};
  CANYON_TRY(const auto epochs, epochs_with_reference(inputs, stretch));
  DriveCheck out;
  CANYON_TRY(out.measured, side_of(inputs.data.observations, inputs.data.inputs(), inputs, stretch, out.warnings));
  out.measured.spread = resampled_figures(out.measured.epochs, out.measured.fixes, kResampledDrives, inputs.seed);
  std::vector<std::vector<DriveEpoch>> draws;
  for (int k = 0; k < inputs.draws; ++k) {
    std::vector<std::string> own;
    CANYON_TRY(DriveSide side, simulated_side(inputs, k, truth, epochs, stretch, own));
    if (k == 0) out.warnings.insert(out.warnings.begin(), own.begin(), own.end());
    if (inputs.draws > 1) {
      draws.push_back(side.epochs);
      out.simulated.spread.push_back(side.figures);
    }
    if (k > 0) continue;
    side.spread = std::move(out.simulated.spread);
    out.simulated = std::move(side);
  }
  if (inputs.draws > 1) out.score = drive_score(out.measured.epochs, draws, inputs.seed);
  return out;
}

}  // namespace canyon::study
