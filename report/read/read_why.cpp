#include <nlohmann/json.hpp>

#include "canyon/report/read/read_results.h"

namespace canyon::report {
namespace {

Why::Removal read_removal(const JsonFields& fields) {
  Why::Removal removal;
  removal.name = fields.required_text("removal");
  removal.successes = fields.required_number("success");
  removal.p = fields.number("p");
  removal.difference = {fields.number("low"), fields.number("high")};
  removal.rescues = fields.flag("rescues");
  return removal;
}

Why read_explanation(const JsonFields& failure, const JsonFile& tree, std::optional<Error>& error) {
  Why why;
  why.verdict = failure.required_text("verdict");
  for (const auto& [line, place] : failure.list("chain")) {
    if (line->is_string())
      why.chain.push_back(line->get<std::string>());
    else
      failure.fail(line, "chain", describe(*line), "a string");
  }
  why.draws = failure.required_number("draws");
  why.successes_as_it_was = failure.number("success_as_it_was");
  for (const auto& [removal, place] : failure.list("removals"))
    why.removals.push_back(read_removal(JsonFields(removal, tree, place, error)));
  return why;
}

CauseTally read_tally(const JsonFields& fields, const JsonFile& tree, std::optional<Error>& error) {
  CauseTally tally;
  tally.run = fields.required_text("run");
  tally.failed = fields.required_number("failed");
  tally.explained = fields.required_number("explained");
  if (!(tally.explained > 0.0)) fields.fail(fields.find("explained"), "explained", "nothing explained", "1 or more");
  for (const auto& [node, path] : fields.list("verdicts", true)) {
    const JsonFields count(node, tree, path, error);
    tally.counts.push_back({.words = count.required_text("words"),
                            .note = count.text("note"),
                            .n = count.required_number("n"),
                            .interval = {count.share("low"), count.share("high")}});
  }
  return tally;
}

/// The run of summary.json that an element of why.json names; a null one is a mistake that has been told.
Run* run_named_by(const JsonFields& fields, Results& results) {
  const std::string name = fields.required_text("run");
  for (Run& run : results.runs)
    if (run.fidelity == name) return &run;
  fields.fail(fields.find("run"), "run", "no run \"" + name + "\"", "a run of summary.json");
  return nullptr;
}

}  // namespace

Status read_why(std::string_view json, const std::string& file, Results& results) {
  CANYON_TRY(const JsonFile tree, JsonFile::parse(json, file));
  std::optional<Error> error;
  const JsonFields fields(&tree.root(), tree, {}, error);
  for (const auto& [node, path] : fields.list("failures", true)) {
    const JsonFields failure(node, tree, path, error);
    Run* run = run_named_by(failure, results);
    Why why = read_explanation(failure, tree, error);
    const std::string seed = failure.digits("seed");
    if (run == nullptr) continue;
    if (seed.empty() || seed == results.mission.seed)
      run->why = std::move(why);
    else
      results.further_why.push_back({run->fidelity, seed, std::move(why)});
  }
  for (const auto& [node, path] : fields.list("tally")) {
    const JsonFields of_run(node, tree, path, error);
    CauseTally tally = read_tally(of_run, tree, error);
    if (run_named_by(of_run, results) != nullptr) results.cause_tally.push_back(std::move(tally));
  }
  if (error) return *error;
  return Ok{};
}

}  // namespace canyon::report
