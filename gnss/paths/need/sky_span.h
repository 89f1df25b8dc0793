#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/messages.h"
#include "canyon/gnss/paths/need/ball.h"
#include "canyon/gnss/satellites/constellation.h"

namespace canyon::gnss {

/// Where satellites may stand over a span of time, seen from anywhere in a ball: unit directions in W every
/// kSkyStep_s of every satellite that comes above the mask, and how far one may be from the nearest of them.
struct SkySpan {
  struct Direction {
    SatelliteId sv;
    Eigen::Vector3d s_W;
  };
  std::vector<Direction> directions;
  double spread_rad = 0.0;  ///< no satellite of the span stands farther from all `directions` of it
  double lowest_rad = 0.0;  ///< no satellite that is received stands lower above W's horizontal

  /// A direction in which a ray that leaves from somewhere in `from` may pass through `at`, by its index; none: no
  /// satellite of the span is seen through `at`. Errs on the side of "may": a ray from a point of one ball through a
  /// point of the other is turned from the line of their centers, of length D, by asin((r1 + r2) / D) at most.
  std::optional<std::size_t> through(const Ball& from, const Ball& at) const { return through(from, at, 0); }
  /// The same of the directions from index `first` on.
  std::optional<std::size_t> through(const Ball& from, const Ball& at, std::size_t first) const;
};

inline constexpr double kSkyStep_s = 30.0;

/// Satellites above `mask_rad` between start and end, from anywhere in `place` (at most 100 km wide). The spread is the
/// largest step of any satellite, plus the parallax over the place.
SkySpan sky_span(const Constellation& constellation, const LocalFrame& frame, GpsTime start, GpsTime end,
                 const Ball& place, double mask_rad);

}  // namespace canyon::gnss
