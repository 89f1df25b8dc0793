#pragma once

#include <cmath>
#include <string>
#include <string_view>

/// How a run ended, in words that need no glossary: the same in the terminal, in why.json and on the page.
namespace canyon {

/// A failure as summary.json has it.
struct ToldFailure {
  std::string kind;    ///< "collision", ...; docs/results.md lists them, others are told too
  std::string detail;  ///< of a collision "hit vehicle 350", what kind of thing it is first
  /// What scans had shown of the thing that was hit: for how long, how far off and how long before. 0, NaN, NaN: none
  /// ever showed it; all NaN: nothing was hit, or nobody knows.
  double in_scans_s = std::nan(""), last_range_m = std::nan(""), last_seen_s = std::nan("");
};

/// "completed the mission", "hit an obstacle", ...: what follows on "it". An unknown outcome stands in quotes, with
/// spaces for underscores.
std::string outcome_words(std::string_view outcome);

/// Whether the detail says what was hit, and failure_words() with it.
bool tells_what_was_hit(const ToldFailure& failure);
/// outcome_words(), or where it is known what was hit: "hit a parked car (vehicle 350)".
std::string failure_words(const ToldFailure& failure);
/// What its LIDAR knew of what was hit, to follow on failure_words(): ", seen by its LIDAR for the last 1.4 s, in the
/// end 4.2 m off"; empty where that is not known. `space` stands between number and unit.
std::string sighting_words(const ToldFailure& failure, std::string_view space = " ");

/// Both, on one line; of what nobody has hit with the detail in brackets: "got stuck (stood still for 30.0 s)".
std::string failure_line(const ToldFailure& failure);

}  // namespace canyon
