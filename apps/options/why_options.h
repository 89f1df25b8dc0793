#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "canyon/apps/line/arguments.h"
#include "canyon/core/output/json.h"
#include "canyon/core/result.h"
#include "canyon/study/causes/tally.h"

namespace canyon::apps {

/// Whether failed runs are explained by replays (study/causes/causes.h).
struct WhyOptions {
  bool why = false;
  std::optional<std::int64_t> draws;  ///< replays of each kind; none: 12
  std::optional<std::int64_t> seeds;  ///< of each run so many seeds that fail, the first ones; none: all
};
void declare_why_options(Arguments& arguments, WhyOptions& options);

/// What else is asked for.
struct WhyBeside {
  bool open_loop = false, plan = false, several_seeds = false;
};
/// What is asked for without what it needs, or beside what has no failures to explain.
Status check_why(const WhyOptions& why, const WhyBeside& beside);

/// What came of it; empty where it was not asked for.
struct WhyAnswer {
  bool asked = false, several_seeds = false;
  std::vector<study::Explanation> explanations;
  std::vector<study::CauseTally> tally;  ///< with several seeds
};
Result<WhyAnswer> explain(const WhyOptions& why, bool several_seeds, const study::Comparison& comparison,
                          const study::Results& results, bool show_progress);

/// why.json.
Json why_answer_json(const WhyAnswer& answer);
void print_why(const WhyAnswer& answer);

}  // namespace canyon::apps
