// What may stand on the straight way, or so near that the wave bends.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "canyon/core/units.h"
#include "canyon/gnss/paths/diffraction/knife_edge.h"
#include "canyon/gnss/paths/need/path_question.h"
#include "canyon/gnss/signal.h"

namespace canyon::gnss {

namespace {

template <class... Values>
std::string text(const char* format, Values... values) {
  char out[200];
  std::snprintf(out, sizeof out, format, values...);
  return out;
}

Need occlusion_need(const PathQuestion& q) {
  Need need{.effect = kOcclusion, .reason = "something may stand before a satellite"};
  // The ground falls away from W's horizontal, whose raster this is.
  const double horizon_rad = q.heights.horizon_rad(q.segment, q.antenna_above_m, q.antenna_reach_m);
  need.reason = horizon_rad < 0.49 * kPi
                    ? text("the horizon may rise to %.1f deg, the lowest satellite stands at %.1f deg",
                           horizon_rad / kDegree, q.sky.lowest_rad / kDegree)
                    : std::string("something higher than the antenna may stand beside it");
  if (horizon_rad >= q.sky.lowest_rad) return need;
  need.verdict = Verdict::kNotNeeded;
  need.reason = text("nothing stands higher than %.1f deg, no satellite lower than %.1f deg", horizon_rad / kDegree,
                     q.sky.lowest_rad / kDegree);
  return need;
}

Need foliage_need(const PathQuestion& q) {
  Need need{.effect = kFoliage};
  for (const scene::Foliage& crown : q.scene.foliage()) {
    const auto seen = q.sky.through(q.antenna(), {crown.center_W, crown.radii_m.maxCoeff()});
    if (!seen) continue;
    need.reason = text("the crown at x %.0f, y %.0f may stand before %s", crown.center_W.x(), crown.center_W.y(),
                       q.sky.directions[*seen].sv.str().c_str());
    return need;
  }
  need.verdict = Verdict::kNotNeeded;
  need.reason = q.scene.foliage().empty() ? "there are no trees" : "no crown stands before any satellite";
  return need;
}

/// `beside_m(edge's middle from the antenna's, half its length)`: a wave bends there only if its straight way passes
/// that near to the edge.
template <class Beside>
Need edges_need(const PathQuestion& q, const Beside& beside_m) {
  Need need{.effect = kDiffraction};
  const auto& edges = q.scene.edges().edges();
  const Ball antenna = q.antenna();
  for (const scene::Edge& edge : edges) {
    const Eigen::Vector3d middle_W = 0.5 * (edge.a_W + edge.b_W);
    const double half_m = 0.5 * (edge.b_W - edge.a_W).norm();
    const auto seen =
        q.sky.through(antenna, {middle_W, half_m + beside_m((middle_W - antenna.center_W).norm(), half_m)});
    if (!seen) continue;
    need.reason = text("an edge at x %.0f, y %.0f may bend the wave of %s", middle_W.x(), middle_W.y(),
                       q.sky.directions[*seen].sv.str().c_str());
    return need;
  }
  need.verdict = Verdict::kNotNeeded;
  need.reason = edges.empty() ? "there are no edges" : "no edge comes near the way to any satellite";
  return need;
}

}  // namespace

Ball PathQuestion::antenna() const {
  Eigen::Vector3d low = segment.points_W.front(), high = low;
  for (const Eigen::Vector3d& p : segment.points_W) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  low.z() = segment.low_m;
  high.z() = segment.high_m;
  const Eigen::Vector3d half = 0.5 * (high - low);
  const double wide_m = half.head<2>().norm() + segment.half_width_m;
  return {0.5 * (low + high), std::hypot(wide_m, half.z()) + antenna_reach_m};
}

std::vector<Need> specular_needs(int order, const PathQuestion& question) {
  std::vector<Need> needs{occlusion_need(question), foliage_need(question)};
  for (int k = 1; k <= order; ++k) needs.push_back(reflection_need(k, question));
  return needs;
}

std::vector<Need> diffraction_needs(const PathQuestion& q) {
  const double reach_m = largest_detour_m(largest_knife_edge_nu(q.limits.weakest_nlos_db), kLongestWave_m);
  const double antenna_m = q.antenna().radius_m;
  // off^2 = detour x (way + forward) <= 2 detour x way, for the point of the edge at the end of `way`.
  return {edges_need(
      q, [&](double middle_m, double half_m) { return std::sqrt(2.0 * reach_m * (middle_m + half_m + antenna_m)); })};
}

std::vector<Need> wedge_needs(const PathQuestion& q) {
  const double weakest_db = std::min(q.limits.weakest_db, q.limits.weakest_nlos_db) - kOverScreen_db;
  const double reach_m = largest_detour_m(largest_knife_edge_nu(weakest_db), kLongestWave_m);
  const double antenna_m = q.antenna().radius_m;
  // An end of an edge may act where the law of diffraction leads beyond it: as far as the search looks (edges_near.h).
  return {edges_need(q, [&](double middle_m, double half_m) {
    const double near_m = std::max(middle_m - half_m - antenna_m, 0.1);
    return 1.1 * (middle_m + antenna_m) * std::sqrt(2.0 * reach_m / near_m);
  })};
}

}  // namespace canyon::gnss
