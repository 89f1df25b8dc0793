#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "canyon/core/model_choice.h"
#include "canyon/core/need.h"

namespace canyon::gnss {

/// Which delays of the ranges are not computed, neither where they act nor where the receiver subtracts them.
struct DelayOmissions {
  bool ionosphere = false;             ///< what the model of the ionosphere gives, wherever one is
  bool ionosphere_difference = false;  ///< what base and rover do not share of it
  bool troposphere = false;            ///< the same two of the neutral atmosphere
  bool troposphere_difference = false;
  bool ephemeris = false;  ///< errors of broadcast orbits and satellite clocks

  bool operator==(const DelayOmissions&) const = default;
  /// What one of the two leaves out.
  DelayOmissions operator|(const DelayOmissions& o) const {
    return {ionosphere || o.ionosphere, ionosphere_difference || o.ionosphere_difference, troposphere || o.troposphere,
            troposphere_difference || o.troposphere_difference, ephemeris || o.ephemeris};
  }
};

/// What a run leaves out of its ranges, and the promise that holds for it.
struct RangeOmissions {
  DelayOmissions delays;
  double bound_m = 0.0;  ///< how far all of it together moves a range at most; 0 = not a bit
  /// Epochs whose sum of |d position / d range| is larger are measured in full, so that no fix moves by more than
  /// bound_m times this.
  double most_gain = std::numeric_limits<double>::infinity();

  bool any() const { return !(delays == DelayOmissions{}); }
  bool operator==(const RangeOmissions&) const = default;
};

/// The names of the effects.
inline constexpr const char* kIonosphere = "ionospheric delay";
inline constexpr const char* kIonosphereDifference = "ionosphere, rover less base";
inline constexpr const char* kTroposphere = "tropospheric delay";
inline constexpr const char* kTroposphereDifference = "troposphere, rover less base";
inline constexpr const char* kEphemeris = "orbit and clock errors";

/// What a mode of operation is asked: which of these delays does it let through?
struct DelayQuestion {
  // The largest that act on a range, by the models that are configured; none: a model does not say. 0: there is none.
  std::optional<double> ionosphere_m, troposphere_m, ephemeris_m;
  double lowest_elevation_rad = 0.0;
  double lat_rad = 0.0;
};

/// A Need for every delay of which the mode can say how far leaving it out moves a range.
using StateDelayNeeds = std::vector<Need>(const ModelParameters& own, const DelayQuestion& question);

}  // namespace canyon::gnss
