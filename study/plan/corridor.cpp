#include "canyon/study/plan/corridor.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace canyon::study {

namespace {

constexpr double kStep_m = 1.0;    // between the points whose ground is looked at
constexpr double kMargin_m = 0.5;  // of heights

/// Ground under a piece and beside it.
void set_heights(const mission::Path& route, const scene::Scene& scene, RouteSegment& segment) {
  segment.low_m = std::numeric_limits<double>::infinity();
  segment.high_m = -segment.low_m;
  const int across = static_cast<int>(std::ceil(segment.half_width_m / kStep_m));
  // What lies within half a width of the piece lies so far before or after it too.
  for (double s = segment.start_m - segment.half_width_m; s <= segment.end_m + segment.half_width_m; s += kStep_m) {
    const double on_m = std::clamp(s, 0.0, route.length_m());
    const Eigen::Vector2d u = route.direction(on_m), left(-u.y(), u.x());
    const Eigen::Vector2d middle = route.at(on_m) + (s - on_m) * u;
    for (int k = -across; k <= across; ++k) {
      const Eigen::Vector2d p = middle + segment.half_width_m * k / across * left;
      const auto ground = scene.ground(p.x(), p.y());
      if (!ground) continue;
      segment.low_m = std::min(segment.low_m, ground->height_m - kMargin_m);
      segment.high_m = std::max(segment.high_m, ground->height_m + kMargin_m);
    }
  }
}

}  // namespace

std::vector<RouteSegment> corridor_of(const mission::PreparedMission& mission, double half_width_m) {
  const mission::Path& route = mission.prior.route;
  const int pieces = std::max(1, static_cast<int>(std::ceil(route.length_m() / kPiece_m)));
  const double length_m = route.length_m() / pieces;
  std::vector<RouteSegment> corridor;
  for (int i = 0; i < pieces; ++i) {
    RouteSegment segment;
    segment.start_m = i * length_m;
    segment.end_m = (i + 1) * length_m;
    segment.half_width_m = half_width_m;
    set_heights(route, *mission.scene, segment);
    const int steps = static_cast<int>(std::ceil(length_m / kStep_m));
    for (int k = 0; k <= steps; ++k) {
      const Eigen::Vector2d p = route.at(segment.start_m + length_m * k / steps);
      segment.points_W.emplace_back(p.x(), p.y(), 0.5 * (segment.low_m + segment.high_m));
    }
    if (segment.low_m <= segment.high_m) corridor.push_back(std::move(segment));
  }
  return corridor;
}

}  // namespace canyon::study
