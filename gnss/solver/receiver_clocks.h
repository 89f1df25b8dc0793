#pragma once

#include <span>
#include <vector>

#include "canyon/gnss/solver/position_solver.h"

namespace canyon::gnss {

/// The system whose receiver clock applies to a range. QZSS and SBAS keep GPS time and share its clock: their few
/// satellites would be of no use with one of their own. Every other system has its own, because its time, and the delay
/// of its signals in the receiver, differ from those of GPS by up to hundreds of nanoseconds.
GnssSystem clock_system(GnssSystem system);

/// The receiver clocks that a set of ranges needs, in the order of GnssSystem.
class ReceiverClocks {
 public:
  ReceiverClocks() = default;
  explicit ReceiverClocks(std::span<const RangeMeasurement> ranges);
  explicit ReceiverClocks(std::span<const GnssSystem> systems);

  const std::vector<GnssSystem>& systems() const { return systems_; }
  std::size_t size() const { return systems_.size(); }
  /// Position of a system's clock among the unknowns; the system must be one of the set.
  std::size_t index(GnssSystem system) const;

 private:
  void add(GnssSystem system);
  std::vector<GnssSystem> systems_;
};

}  // namespace canyon::gnss
