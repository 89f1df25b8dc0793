#include "canyon/lidar/loops/loop_closures.h"

#include <algorithm>
#include <optional>

#include "canyon/core/motion/adjoint.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/units.h"

namespace canyon::lidar {
namespace {

/// Metres driven up to each keyframe.
std::vector<double> ways(std::span<const MappedCloud> keyframes) {
  std::vector<double> out;
  for (std::size_t k = 0; k < keyframes.size(); ++k)
    out.push_back(k == 0 ? 0.0 : out.back() + (keyframes[k].X_WL.p - keyframes[k - 1].X_WL.p).norm());
  return out;
}

/// The earlier keyframe that is nearest to `source`, if one is near enough and long enough ago.
std::optional<std::size_t> nearest_before(std::span<const MappedCloud> keyframes, const std::vector<double>& way_m,
                                          std::size_t source, const ClosureOptions& options) {
  std::optional<std::size_t> nearest;
  double least_m = options.within_m;
  for (std::size_t k = 0; k < source && way_m[source] - way_m[k] >= options.least_way_m; ++k) {
    const double apart_m = (keyframes[source].X_WL.p - keyframes[k].X_WL.p).norm();
    if (apart_m > least_m) continue;
    least_m = apart_m;
    nearest = k;
  }
  return nearest;
}

void align_closure(const Registration& registration, std::span<const MappedCloud> keyframes,
                   const ClosureOptions& options, ClosureTrial& trial) {
  const MappedCloud &source = keyframes[trial.source], &target = keyframes[trial.target];
  const auto around = static_cast<std::size_t>(options.around);
  const std::size_t first = trial.target - std::min(trial.target, around);
  const std::size_t end = std::min(trial.target + around + 1, trial.source);
  const Pose X_TW = target.X_WL.inverse();
  // Where targets overlap the last one counts: the nearest place is that.
  std::vector<Registration::Placed> placed;
  for (std::size_t k = first; k < end; ++k)
    if (k != trial.target) placed.push_back({keyframes[k].cloud, X_TW * keyframes[k].X_WL});
  placed.push_back({target.cloud, Pose{}});

  PosePrior prior;
  prior.X_TS = X_TW * source.X_WL;
  const Matrix6d to_source = adjoint(prior.X_TS.inverse());
  prior.covariance = source.covariance + to_source * target.covariance * to_source.transpose();
  const RegistrationResult result = registration.align_with_prior(*source.cloud, placed, prior);
  trial.status = result.status;
  trial.overlap = result.overlap;
  trial.open = result.open.size();
  trial.closes =
      result.status == RegistrationStatus::kConverged && trial.open < 6 && !(result.overlap < options.least_overlap);
  if (!trial.closes) return;
  trial.X_TS = result.surfaces ? result.surfaces->X_TS : result.X_TS;
  trial.covariance = result.surfaces ? result.surfaces->covariance : result.covariance;
  const double turn_rad = options.alignment_floor_deg * kDegree;
  trial.covariance.diagonal().head<3>().array() += turn_rad * turn_rad;
  trial.covariance.diagonal().tail<3>().array() += options.alignment_floor_m * options.alignment_floor_m;
}

}  // namespace

std::vector<ClosureTrial> find_closures(const Registration& registration, std::span<const MappedCloud> keyframes,
                                        const ClosureOptions& options) {
  const std::vector<double> way_m = ways(keyframes);
  std::vector<ClosureTrial> trials;
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    if (!trials.empty() && way_m[k] - way_m[trials.back().source] < options.apart_m) continue;
    const auto target = nearest_before(keyframes, way_m, k, options);
    if (target) trials.push_back({.source = k, .target = *target, .X_TS = {}, .covariance = {}});
  }
  parallel_for(trials.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) align_closure(registration, keyframes, options, trials[i]);
  });
  return trials;
}

}  // namespace canyon::lidar
