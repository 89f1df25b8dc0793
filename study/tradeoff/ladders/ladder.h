#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "canyon/core/config/config.h"

namespace canyon::study {

/// The parts that ladders belong to, in the order in which they are shown.
const std::vector<std::string>& tradeoff_parts();
inline constexpr const char* kRecordedPart = "recorded";  ///< measured on a recorded drive, if one is given

/// The models of one effect, or the values of one setting, ordered or not: one [[ladder]] of ladders.toml, whose head
/// says what each key means.
struct Ladder {
  std::string part, key, probe, reference, for_each;
  std::vector<std::string> rungs, series, fixed;
  std::vector<double> values;
  std::int64_t samples = 0;  ///< at most so many; 0: as many as asked for
  bool chosen = true;        ///< moved by --tolerance and --budget-cpu
};
void visit(FieldVisitor& f, Ladder& c);

/// A choice of the mission file that is no ladder.
struct NoLadder {
  std::string key, reason;
};
void visit(FieldVisitor& f, NoLadder& c);

struct Ladders {
  std::vector<Ladder> ladder;
  std::vector<NoLadder> no_ladder;
};
void visit(FieldVisitor& f, Ladders& c);

inline constexpr const char* kTruth = "truth";  ///< as a reference: nothing but the probe's own truth

Result<Ladders> parse_ladders(std::string_view toml, const std::string& file_name);
/// Those of ladders.toml.
const Ladders& built_in_ladders();

/// "gnss.paths=none" cut at the sign.
std::pair<std::string, std::string> cut_setting(const std::string& setting);

}  // namespace canyon::study
