#pragma once

#include <vector>

#include "canyon/scene/city/city.h"

namespace canyon::scene::city {

enum class Zone : std::uint8_t { kTall, kMiddle, kLow, kOpen };

/// Picks by zone.
constexpr double by_zone(Zone zone, double tall, double middle, double low, double open) {
  return zone == Zone::kTall ? tall : zone == Zone::kMiddle ? middle : zone == Zone::kLow ? low : open;
}

struct Rectangle {
  double x0, y0, x1, y1;
  double width() const { return x1 - x0; }
  double depth() const { return y1 - y0; }
  Eigen::Vector2d center() const { return {0.5 * (x0 + x1), 0.5 * (y0 + y1)}; }
  Rectangle inset(double by_m) const { return {x0 + by_m, y0 + by_m, x1 - by_m, y1 - by_m}; }
};

/// A block between streets.
struct Block {
  Rectangle kerb;  ///< bounded by the kerbs
  Zone zone;
};

/// Streets and blocks: a grid with blocks of varied size, a few streets left out, and zones around a tall quarter.
struct Plan {
  std::vector<Block> blocks;  ///< row by row from the south-west
  StreetGraph streets;
  Rectangle quarter;  ///< the tall quarter

  /// Zone of the block at or nearest to a point.
  Zone zone_near(const Eigen::Vector2d& p) const;
};

inline constexpr double kSidewalk_m = 3.0;

Plan make_plan(const CityConfig& config);

}  // namespace canyon::scene::city
