#pragma once

#include <memory>

#include "canyon/core/files/tape.h"
#include "canyon/mission/motion/vehicle.h"

namespace canyon::mission {

/// Where the true motion of a run comes from, step by step.
class MotionSource {
 public:
  virtual ~MotionSource() = default;
  /// The next node, at most one master step later. Not to be called once over().
  virtual const TapeNode& advance(const DriveCommand& command) = 0;
  virtual const TapeNode& now() const = 0;
  virtual bool over() const { return false; }       ///< nothing follows
  virtual bool on_terrain() const { return true; }  ///< false once a wheel has left the terrain
};

/// A vehicle that answers to commands. `scene` must outlive it.
std::unique_ptr<MotionSource> make_driven_motion(const VehicleConfig& config, const scene::Scene& scene,
                                                 std::uint64_t seed, GpsTime start);

/// A tape laid at `start`: commands change nothing. `tape` must outlive it.
std::unique_ptr<MotionSource> make_taped_motion(const Tape& tape, GpsTime start);

}  // namespace canyon::mission
