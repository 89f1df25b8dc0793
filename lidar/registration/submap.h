#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <vector>

#include "canyon/core/motion/rotation.h"
#include "canyon/lidar/registration/registration.h"
#include "canyon/lidar/voxels/voxel_key.h"

namespace canyon::lidar {

/// The last clouds of a way, as targets of a registration: what a newer cloud shows of a voxel of leaf_m takes the
/// place of what older ones had there, once and for all, so that no alignment looks at all points of all clouds again.
/// The voxels lie in a frame O of that way, in which the clouds are placed; farther than 2^20 of them from its origin
/// nothing is thinned. Methods that unite what they are given thin the rest in the frame of the alignment.
class Submap {
 public:
  /// The last `most` >= 1 clouds are kept. With leaf_m = 0 as they are: for methods that take all points of all clouds.
  Submap(double leaf_m, std::size_t most) : leaf_m_(leaf_m), most_(most) {}

  void add(std::shared_ptr<const PreparedCloud> cloud, const Pose& X_OC);
  void clear() { held_.clear(); }

  bool empty() const { return held_.empty(); }
  std::size_t size() const { return held_.size(); }
  /// Where the newest stands; there is one.
  const Pose& last() const { return held_.back().X_OC; }
  /// What is left of each, oldest first, in a frame T. Good until the next call of add().
  std::vector<Registration::Placed> in(const Pose& X_TO) const;

 private:
  struct Held {
    std::shared_ptr<const PreparedCloud> cloud;
    std::shared_ptr<PreparedCloud> own;  ///< `cloud`, as a copy that may be changed; nullptr until something is gone
    Pose X_OC;
    std::vector<VoxelCoordinates> voxels;  ///< of its points
  };
  void leave_out(const class VoxelIndex& taken, Held& held) const;

  double leaf_m_;
  std::size_t most_;
  std::deque<Held> held_;
};

}  // namespace canyon::lidar
