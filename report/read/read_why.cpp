#include <algorithm>

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

}  // namespace

Status read_why(std::string_view json, const std::string& file, Results& results) {
  CANYON_TRY(const JsonFile tree, JsonFile::parse(json, file));
  std::optional<Error> error;
  const JsonFields fields(&tree.root(), tree, {}, error);
  for (const auto& [node, path] : fields.list("failures", true)) {
    const JsonFields failure(node, tree, path, error);
    const std::string name = failure.required_text("run");
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
    const auto run =
        std::find_if(results.runs.begin(), results.runs.end(), [&name](const Run& r) { return r.fidelity == name; });
    if (run == results.runs.end())
      failure.fail(failure.find("run"), "run", "no run \"" + name + "\"", "a run of summary.json");
    else
      run->why = std::move(why);
  }
  if (error) return *error;
  return Ok{};
}

}  // namespace canyon::report
