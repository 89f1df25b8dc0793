#pragma once

#include <string>
#include <utility>
#include <vector>

#include "canyon/core/result.h"
#include "canyon/inertial/imu_log.h"

namespace canyon::inertial {

/// Where the log's samples stand in the file, for messages.
struct Places {
  std::string path;
  std::vector<int> lines;

  Error error(std::size_t sample, std::string what, std::string expected) const {
    return {path, lines[sample], "", std::move(what), std::move(expected)};
  }
};

/// How the units are judged: what speaks against them is an Error where they are guessed, a doubt where they are named.
struct Judge {
  const Places& places;
  bool named_units;  ///< the header, or --columns, has names with units
  double interval_s;
};

/// Intervals that samples can have; times as seconds that are instants.
Status check_times(const ImuLog& log, double interval_s, const Places& places);
/// Beyond 1e12 rad/s and m/s^2 numbers are no measurements of anything, and their squares leave the range of numbers.
Status check_range(const ImuLog& log, const Places& places);
/// Magnitudes that betray the unit. Each triad by itself: a file may hold rates of one and increments of the other.
Status check_magnitudes(ImuLog& log, const Judge& judge);
/// No channel of more than ten samples never changes, or stays at its extreme value.
Status check_live(const ImuLog& log, const Places& places);

}  // namespace canyon::inertial
