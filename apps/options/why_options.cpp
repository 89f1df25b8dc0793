#include "canyon/apps/options/why_options.h"

#include <cstdio>

#include <nlohmann/json.hpp>

namespace canyon::apps {

namespace {

constexpr std::int64_t kWhyDraws = 12;

}  // namespace

void declare_why_options(Arguments& arguments, WhyOptions& options) {
  arguments.flag("--why", options.why,
                 "for each run that fails, with --seeds of every seed: its chain of events, and replays without each "
                 "source of error, beside replays with other noise alone: which source's removal rescues the mission; "
                 "with --seeds also how many failures come from what");
  arguments.option("--why-draws", options.draws, "replays with and without each source; without it 12")
      .within(std::int64_t{10}, std::int64_t{study::kMostDraws});
  arguments
      .option(
          "--why-seeds", options.seeds,
          "explain of each run so many seeds that fail, the first ones: each takes 8 or 9 times --why-draws drives, or "
          "17 times; without it all")
      .within(std::int64_t{1}, std::int64_t{100'000});
}

Status check_why(const WhyOptions& why, const WhyBeside& beside) {
  if (why.draws && !why.why)
    return Error{.file = "--why-draws", .what = "is for replays", .expected = "--why beside it"};
  if (why.seeds && !why.why)
    return Error{.file = "--why-seeds", .what = "is for replays", .expected = "--why beside it"};
  if (why.seeds && !beside.several_seeds)
    return Error{.file = "--why-seeds", .what = "is for failures of several seeds", .expected = "--seeds beside it"};
  if (why.why && beside.open_loop)
    return Error{.file = "--why", .what = "an open loop has no outcome", .expected = "no --open-loop beside it"};
  if (why.why && beside.plan)
    return Error{.file = "--why", .what = "replays leave nothing out by a plan", .expected = "no --plan beside it"};
  return Ok{};
}

Result<WhyAnswer> explain(const WhyOptions& why, bool several_seeds, const study::Comparison& comparison,
                          const study::Results& results, bool show_progress) {
  WhyAnswer answer{.asked = why.why, .several_seeds = several_seeds, .explanations = {}, .tally = {}};
  if (!why.why) return answer;
  const int draws = static_cast<int>(why.draws.value_or(kWhyDraws));
  CANYON_TRY(answer.explanations, study::explain_failures(comparison, results, draws, show_progress, why.seeds));
  if (several_seeds) answer.tally = study::cause_tally(results, answer.explanations);
  return answer;
}

Json why_answer_json(const WhyAnswer& answer) {
  Json out = study::why_json(answer.explanations);
  if (answer.several_seeds) out["tally"] = study::cause_tally_json(answer.tally);
  return out;
}

void print_why(const WhyAnswer& answer) {
  if (answer.asked && answer.explanations.empty()) std::printf("No run failed, so there is nothing to explain.\n\n");
  for (const study::Explanation& explanation : answer.explanations) {
    const std::string seed = answer.several_seeds ? " with seed " + std::to_string(explanation.seed) : "";
    std::printf("Why %s failed%s: %s.\n", explanation.run.c_str(), seed.c_str(), study::verdict(explanation).c_str());
    for (const std::string& line : study::chain(explanation)) std::printf("  %s\n", line.c_str());
    for (const study::RemovalOutcome& outcome : explanation.outcomes)
      std::printf("  without %-20s %2d of %d%s\n", outcome.removal->name, outcome.successes, explanation.draws,
                  outcome.rescues ? "  rescues it" : "");
    std::printf("\n");
  }
  if (!answer.tally.empty()) std::printf("%s\n", study::cause_tally_table(answer.tally).c_str());
}

}  // namespace canyon::apps
