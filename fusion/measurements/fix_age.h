#pragma once

#include "canyon/fusion/measurements/measurement.h"

namespace canyon::fusion {

/// How long after the last IMU sample what a receiver says holds, s: by its stamp, and by what the block time_offset
/// says of stamps.
class FixAge {
 public:
  explicit FixAge(const ErrorState& state) : offset_(state.offset("time_offset")) {}

  double of(const FilterView& filter, GpsTime stamp) const {
    const double by_stamp = stamp - filter.state.nav.t;
    return offset_ < 0 ? by_stamp : by_stamp + filter.state.values(offset_, 1)[0];
  }
  /// Where what is measured changes at this rate.
  template <class Rate>
  void set_column(Measurement::Rows& H, const Rate& rate) const {
    if (offset_ >= 0) H.col(offset_) = rate;
  }
  bool estimated() const { return offset_ >= 0; }

 private:
  int offset_;
};

}  // namespace canyon::fusion
