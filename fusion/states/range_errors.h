#pragma once

#include "canyon/core/config/config.h"

namespace canyon::fusion {

/// What lasts of the errors of pseudoranges, as reflections make it: its size by C/N0, what it is on average, and over
/// what time and way it changes. The block `range_errors` has a state for each of so many satellites, the measurement
/// `ranges` says which.
///
/// Defaults: of a plain receiver with a patch antenna (half a chip, 4 MHz) in streets of the built-in kind of city,
/// ways off two walls and around two edges (docs/fusion.md has the figures); the correlation time is that in which an
/// orbit turns the line of sight (0.5 degrees a minute) by enough to change an echo's way by a wavelength.
struct RangeErrorsParameters {
  std::int64_t range_error_slots = 24;
  double range_error_sigma_m = 2.0;
  double range_error_decade_db = 14.0;
  double range_error_most_m = 25.0;
  double range_error_mean = 1.0;
  double range_error_tau_s = 60.0;
  double range_error_way_m = 50.0;

  /// 1-sigma of a satellite received at this C/N0.
  double sigma_m(double cn0_dbhz) const { return range_error_sigma_m * growth(cn0_dbhz); }
  /// That over the one at 45 dB-Hz. Rates err in the same proportion: what changes an echo's way is in them.
  double growth(double cn0_dbhz) const;
  /// What is to be expected of it: echoes are late.
  double mean_m(double cn0_dbhz) const;
};
void visit(FieldVisitor& f, RangeErrorsParameters& p);

/// The C/N0 above which it makes no difference any more.
inline constexpr double kClearCn0Dbhz = 45.0;

}  // namespace canyon::fusion
