#include "canyon/study/loops/closed_map.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "canyon/core/math/chi_square.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/lidar/voxels/voxel_map.h"
#include "canyon/mission/run.h"

namespace canyon::study {
namespace {

/// Keeps what a graph of the keyframes is made of.
class KeyframeKeeper final : public mission::Recorder {
 public:
  explicit KeyframeKeeper(const lidar::Registration& registration) : registration_(registration) {}

  Status keyframe(const mission::KeyframeRow& row) override {
    rows.push_back(row);
    return Ok{};
  }
  Status keyframe_input(const mission::KeyframeInput& input) override {
    std::vector<Eigen::Vector3f>& points = points_L.emplace_back();
    points.reserve(input.deskewed.points.size());
    for (const LidarPoint& p : input.deskewed.points) points.emplace_back(p.x, p.y, p.z);
    clouds.push_back(registration_.prepare(points));
    return Ok{};
  }

  std::vector<mission::KeyframeRow> rows;
  std::vector<std::vector<Eigen::Vector3f>> points_L;
  std::vector<std::shared_ptr<const lidar::PreparedCloud>> clouds;

 private:
  const lidar::Registration& registration_;
};

std::vector<lidar::MappedCloud> mapped(const KeyframeKeeper& kept) {
  std::vector<lidar::MappedCloud> out;
  for (std::size_t k = 0; k < kept.rows.size(); ++k)
    out.push_back({kept.clouds[k], kept.rows[k].X_WL_registered, kept.rows[k].covariance});
  return out;
}

fusion::PoseGraph chain_of(const KeyframeKeeper& kept, double prior_correlation_s) {
  fusion::PoseGraph graph;
  for (std::size_t k = 0; k < kept.rows.size(); ++k) {
    const mission::KeyframeRow& row = kept.rows[k];
    graph.X_WS.push_back(row.X_WL_registered);
    double share = 1.0;
    if (k > 0) share = std::max(1.0, prior_correlation_s / std::max(row.t - kept.rows[k - 1].t, 1e-3));
    graph.absolute.push_back({k, row.X_WL_prior, share * row.prior_covariance});
    if (row.placed)
      graph.relative.push_back(
          {.source = k, .target = k - 1, .X_TS = row.placed->X_TS, .covariance = row.placed->covariance});
  }
  return graph;
}

/// Adds those that close; their number in `closures` for each.
std::vector<std::size_t> add_closures(const std::vector<lidar::ClosureTrial>& trials, fusion::PoseGraph& graph) {
  std::vector<std::size_t> added;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const lidar::ClosureTrial& trial = trials[i];
    if (!trial.closes) continue;
    graph.relative.push_back({.source = trial.source,
                              .target = trial.target,
                              .X_TS = trial.X_TS,
                              .covariance = trial.covariance,
                              .switchable = true});
    added.push_back(i);
  }
  return added;
}

JudgedClosure judged(const lidar::ClosureTrial& trial, const std::vector<mission::KeyframeRow>& rows) {
  JudgedClosure out;
  out.trial = trial;
  if (!trial.closes) return out;
  const Pose X_TS_true = rows[trial.target].X_WL_true.inverse() * rows[trial.source].X_WL_true;
  const Pose off = X_TS_true.inverse() * trial.X_TS;
  out.off_m = off.p.norm();
  out.off_deg = so3_log(off.R).norm() / kDegree;
  const Vector6d xi = off.log();
  out.beyond_bound = xi.dot(trial.covariance.ldlt().solve(xi)) > chi_square_threshold(1e-3, 6.0);
  return out;
}

/// Errors of the keyframes so placed, and of the map, a point per voxel as in the run.
PlacedMap judged(const char* name, const mission::MissionConfig& config, const scene::SceneAt& scene,
                 const KeyframeKeeper& kept, const std::vector<Pose>& X_WL) {
  PlacedMap out;
  out.name = name;
  double m2 = 0.0, rad2 = 0.0;
  lidar::VoxelMap map(config.run.map_leaf_m);
  const auto range2_m2 = static_cast<float>(config.run.map_range_m * config.run.map_range_m);
  for (std::size_t k = 0; k < X_WL.size(); ++k) {
    const Pose& truth = kept.rows[k].X_WL_true;
    m2 += (X_WL[k].p - truth.p).squaredNorm();
    rad2 += so3_log(truth.R.conjugate() * X_WL[k].R).squaredNorm();
    for (const Eigen::Vector3f& p_L : kept.points_L[k])
      if (p_L.squaredNorm() <= range2_m2) map.insert({(X_WL[k] * p_L.cast<double>()).cast<float>(), 0.0f});
  }
  const auto n = static_cast<double>(X_WL.size());
  out.keyframe_rms_m = std::sqrt(m2 / n);
  out.keyframe_rms_deg = std::sqrt(rad2 / n) / kDegree;
  out.map = lidar::evaluate_map(std::move(map).take(), scene).quality;
  return out;
}

std::vector<Pose> poses_of(const KeyframeKeeper& kept, Pose mission::KeyframeRow::*which) {
  std::vector<Pose> out;
  for (const mission::KeyframeRow& row : kept.rows) out.push_back(row.*which);
  return out;
}

double way_of(const std::vector<Pose>& X_WL) {
  double way_m = 0.0;
  for (std::size_t k = 1; k < X_WL.size(); ++k) way_m += (X_WL[k].p - X_WL[k - 1].p).norm();
  return way_m;
}

}  // namespace

Result<ClosedMap> make_closed_map(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                                  const Tape* tape, const std::string& fidelity, const lidar::ClosureOptions& options,
                                  bool show_progress) {
  if (!lidar::registers(config.registration))
    return Error{
        .key = "registration.method", .what = "\"none\" gives no map to close", .expected = "a method that registers"};
  CANYON_TRY(const auto registration, lidar::make_registration(config.registration));
  KeyframeKeeper kept(*registration);
  {
    Progress progress(fidelity, tape != nullptr ? tape->duration_s() : mission.time_limit_s, show_progress);
    CANYON_TRY_STATUS(
        mission::run_mission(config, mission, &progress, {.tape = tape, .recorder = &kept, .autonomy = nullptr}));
  }
  if (kept.rows.empty())
    return Error{.what = "the run has no keyframe", .expected = "a scan with returns", .exit_code = 1};
  ClosedMap out;
  out.mission = config.run.name;
  out.fidelity = fidelity;
  out.seed = config.run.seed;
  out.keyframes = kept.rows.size();
  const auto trials = lidar::find_closures(*registration, mapped(kept), options);
  fusion::PoseGraph smoothed = chain_of(kept, config.registration.prior_correlation_s), closed = smoothed;
  const std::vector<std::size_t> added = add_closures(trials, closed);
  for (const lidar::ClosureTrial& trial : trials) out.closures.push_back(judged(trial, kept.rows));
  CANYON_TRY_STATUS(fusion::solve(smoothed, {}));
  CANYON_TRY(out.graph, fusion::solve(closed, {}));
  for (std::size_t i = 0; i < added.size(); ++i)
    out.closures[added[i]].weight = closed.relative[closed.relative.size() - added.size() + i].weight;
  for (std::size_t k = 0; k < closed.X_WS.size(); ++k) out.X_WL_closed.append({kept.rows[k].t, closed.X_WS[k]});
  const auto registered = poses_of(kept, &mission::KeyframeRow::X_WL_registered);
  out.way_m = way_of(registered);
  const scene::SceneAt scene(*mission.scene);
  const auto prior = poses_of(kept, &mission::KeyframeRow::X_WL_prior);
  out.placed = {judged("prior", config, scene, kept, prior), judged("registered", config, scene, kept, registered),
                judged("smoothed", config, scene, kept, smoothed.X_WS),
                judged("closed", config, scene, kept, closed.X_WS)};
  return out;
}

}  // namespace canyon::study
