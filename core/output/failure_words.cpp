#include "canyon/core/output/failure_words.h"

#include <algorithm>

#include "canyon/core/output/printed.h"

namespace canyon {
namespace {

constexpr std::string_view kHit = "hit ";

struct OutcomeWords {
  std::string_view outcome, words;
};
constexpr OutcomeWords kOutcomeWords[] = {{"success", "completed the mission"},
                                          {"collision", "hit an obstacle"},
                                          {"timeout", "ran out of time"},
                                          {"stopped", "was stopped by the time limit it was given"},
                                          {"missed_waypoint", "missed a waypoint"},
                                          {"no_line_of_sight", "did not see its building of interest"},
                                          {"stuck", "got stuck"},
                                          {"left_scene", "left the scene"},
                                          {"lost", "no longer knew where it was"},
                                          {"autonomy_fault", "was ended by a fault of its autonomy's own"}};

/// Things by the words that the scorer begins their names with.
struct ThingWords {
  std::string_view begins, words;
  bool says_more;  ///< the words alone say all that `begins` does, so the name may do without
};
constexpr ThingWords kThingWords[] = {{"other vehicle ", "another vehicle", true},
                                      {"vehicle ", "a parked car", false},
                                      {"building ", "a building", false},
                                      {"tree ", "a tree", false},
                                      {"wall ", "a wall", false},
                                      {"pole ", "a pole", false},
                                      {"person ", "a person", false},
                                      {"terrain", "the ground", false}};

std::string quantity(double value, std::string_view space, const char* unit) {
  constexpr double kTwoDigits = 9.95;  // from here on, a decimal would be the third
  return printed(value < kTwoDigits ? "%.1f" : "%.0f", value) + std::string(space) + unit;
}

}  // namespace

std::string outcome_words(std::string_view outcome) {
  for (const auto& [name, words] : kOutcomeWords)
    if (name == outcome) return std::string(words);
  std::string label(outcome);
  std::replace(label.begin(), label.end(), '_', ' ');
  return "ended with \"" + label + "\"";
}

bool tells_what_was_hit(const ToldFailure& failure) {
  return failure.kind == "collision" && failure.detail.rfind(kHit, 0) == 0;
}

std::string failure_words(const ToldFailure& failure) {
  if (!tells_what_was_hit(failure)) return outcome_words(failure.kind);
  const std::string thing = failure.detail.substr(kHit.size());
  for (const ThingWords& row : kThingWords) {
    if (thing.rfind(row.begins, 0) != 0) continue;
    const std::string name = row.says_more ? thing.substr(row.begins.size()) : thing;
    return "hit " + std::string(row.words) + " (" + name + ")";
  }
  return "hit \"" + thing + "\"";
}

std::string sighting_words(const ToldFailure& failure, std::string_view space) {
  if (!std::isfinite(failure.in_scans_s)) return {};
  if (!std::isfinite(failure.last_range_m) || !std::isfinite(failure.last_seen_s))
    return ", which no scan of its LIDAR had shown";
  const std::string off = quantity(failure.last_range_m, space, "m") + " off";
  // A sweep takes a tenth of a second: what the last ones showed was in view to the end.
  constexpr double kToTheEnd_s = 0.3;
  if (failure.last_seen_s > kToTheEnd_s)
    return ", last seen by its LIDAR " + off + ", " + quantity(failure.last_seen_s, space, "s") + " before";
  if (failure.in_scans_s <= 0.0) return ", which its LIDAR saw in the last scan only, " + off;
  return ", seen by its LIDAR for the last " + quantity(failure.in_scans_s, space, "s") + ", in the end " + off;
}

std::string failure_line(const ToldFailure& failure) {
  std::string line = failure_words(failure) + sighting_words(failure);
  if (!tells_what_was_hit(failure) && !failure.detail.empty()) line += " (" + failure.detail + ")";
  return line;
}

}  // namespace canyon
