#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "canyon/lidar/beam/aim.h"
#include "canyon/lidar/beam/beam_table.h"

namespace canyon::lidar {

/// When each laser fires in each scan, and where it then points, in L.
///
/// The head spins clockwise seen from above, as Velodyne's and Ouster's do, at a constant rate, and starts and ends its
/// revolution looking backwards (-x of L), so that the seam between two scans lies behind.
///
/// With a number of steps per revolution, cycle c of a scan starts at period * (c + 1 - steps) / steps - last firing
/// time after the scan's stamp, so that the last firing is at the stamp exactly. With 0 steps the lasers run free at
/// the shortest cycle of their table, whatever the head does, as the real ones do: cycle m since the first scan began
/// starts at m * cycle; a scan holds those whose last firing lies in it, and the azimuth is the head's at that time.
class FiringPattern {
 public:
  /// `steps` 0 needs a table with a cycle.
  FiringPattern(BeamTable table, double rate_hz, std::size_t steps);

  /// The firings of one scan.
  struct Sweep {
    double start_s = 0.0;  ///< of its first cycle, after the scan's stamp
    std::size_t cycles = 0;
    std::uint64_t first_cycle = 0;  ///< since the first scan began: numbers the random draws
    double turn_rad = 0.0;          ///< azimuth of the head at start_s, clockwise from -x of L
    double since_first_s = 0.0;     ///< from the beginning of the first scan to start_s
    std::vector<HeadBeam> beams;    ///< of a spinning head, by laser
  };
  Sweep sweep(std::int64_t index) const;

  const BeamTable& table() const { return table_; }
  std::size_t lasers() const { return table_.beams.size(); }
  double step_s() const { return step_s_; }
  /// Lasers by firing time; equal times: by number.
  const std::vector<std::size_t>& firing_order() const { return firing_order_; }
  /// How long before `stamp - period` the first firing of a scan may be.
  double overlap_s() const { return free_running_ ? step_s_ : 0.0; }

  /// Shots of one laser in sixteen cycles from `cycle` on; those beyond the sweep are whatever follows.
  void aim(const Sweep& sweep, std::size_t laser, std::size_t cycle, AimPacket& out) const;
  /// The same of many packets, placed at once (place_shots()).
  void fire(const Sweep& sweep, std::size_t laser, std::size_t cycle, std::span<const PlacementPacket> placements,
            float late_s, float max_m, scene::RayPacket* out) const;

 private:
  std::vector<HeadBeam> beams(double turn_rad) const;
  void aim_rosette(const Sweep& sweep, std::size_t laser, std::size_t cycle, AimPacket& out) const;

  BeamTable table_;
  double period_s_ = 0.0, step_s_ = 0.0;
  std::size_t steps_ = 0;
  bool free_running_ = false;
  std::vector<std::size_t> firing_order_;
  std::vector<float> cosine_, sine_;  ///< of the head's azimuth by step, from 0
};

}  // namespace canyon::lidar
