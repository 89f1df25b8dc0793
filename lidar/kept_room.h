#pragma once

#include <limits>

namespace canyon::lidar {

struct LidarConfig;

/// The room that the readers of a scan keep returns of: what lies outside they drop. In B as it stands at the stamp;
/// by how much B may have been turned and moved between a firing and the stamp, as the deskewing believes, is said
/// beside it. A shot is followed only as far as a return from it may lie in there, and not fired at all where nothing
/// stands that near.
struct KeptRoom {
  double low_m = 0.0, high_m = 0.0;  ///< along B's z from its origin
  double reach_m = 0.0;              ///< from B's origin
  double turned_rad = 0.0;           ///< of B's z axis
  double moved_m = 0.0;              ///< of B's origin
  /// But for the ground nothing stands within this distance of B's origin, horizontally. There the ground stays below L
  /// by `above_ground_m` - distance x `ground_rise`, measured along B's z axis. 0: nothing is known.
  double clear_m = 0.0, above_ground_m = 0.0, ground_rise = 0.0;
};

/// Whether a shot's return depends on nothing that lies beyond it: one ray a beam, a detector that judges each
/// echo by itself, clear air, nothing that is looked through, and a head whose firings begin with the revolution. Else
/// a scanner follows every shot to the end, whatever is kept.
bool follows_shots_alone(const LidarConfig& config);

}  // namespace canyon::lidar
