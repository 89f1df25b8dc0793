#include "canyon/report/tradeoff/tradeoff_summary.h"

#include <nlohmann/json.hpp>

#include "canyon/core/files/files.h"
#include "canyon/report/format.h"
#include "canyon/report/read/json_fields.h"

namespace canyon::report {
namespace {

/// Reads the elements of a list, each by `read`.
template <class T, class Read>
void read_list(const JsonFields& from, const char* key, std::vector<T>& out, Read read) {
  for (const auto& [node, place] : from.list(key))
    out.push_back(read(JsonFields(node, from.file(), place, from.error())));
}

TradeoffModel read_model(const JsonFields& f) {
  TradeoffModel model{.name = f.required_text("name"),
                      .error = f.number("error"),
                      .error_low = f.number("error_low"),
                      .error_high = f.number("error_high"),
                      .undefined_share = f.share("undefined_share"),
                      .cpu_s = f.number("cpu_s"),
                      .cpu_low_s = f.number("cpu_low_s"),
                      .cpu_high_s = f.number("cpu_high_s"),
                      .work = f.number("work"),
                      .memory_mb = f.number("memory_mb"),
                      .on_front = f.flag("on_front"),
                      .in_use = f.flag("in_use"),
                      .is_reference = f.flag("is_reference"),
                      .resolved = f.flag("resolved"),
                      .tied_with = {}};
  for (const auto& [node, place] : f.list("tied_with"))
    if (node->is_string()) model.tied_with.push_back(node->get<std::string>());
  return model;
}

std::string read_left_out(const JsonFields& f) {
  return f.text("name") + ": " + f.text("reason");
}

TradeoffLadder read_ladder(const JsonFields& f) {
  TradeoffLadder ladder{.part = f.required_text("part"),
                        .key = f.required_text("key"),
                        .of = f.text("of"),
                        .meaning = f.text("meaning"),
                        .unit = f.text("error_unit"),
                        .error_is = f.text("error_is"),
                        .reference = f.text("reference"),
                        .work_unit = f.text("work_unit"),
                        .models = {},
                        .left_out = {},
                        .order_observed = f.number("order_observed"),
                        .order_theory = f.number("order_theory"),
                        .reference_error = f.number("reference_error"),
                        .order_holds = f.flag("order_holds")};
  const JsonFields fit = f.object("time_fit");
  ladder.fixed_s = fit.number("fixed_s");
  ladder.per_work_s = fit.number("per_work_s");
  ladder.worst_ratio = fit.number("worst_ratio");
  read_list(f, "models", ladder.models, read_model);
  read_list(f, "left_out", ladder.left_out, read_left_out);
  return ladder;
}

TradeoffRun read_run(const JsonFields& f) {
  const JsonFields driven = f.object("closed_loop");
  TradeoffRun run{.fidelity = f.required_text("fidelity"),
                  .position_m = f.number("position_error_rms_m"),
                  .map_m = f.number("map_error_rms_m"),
                  .registration_m = f.number("registration_error_rms_m"),
                  .tape_s = f.number("tape_s"),
                  .cpu_s = f.number("cpu_s"),
                  .cpu_low_s = f.number("cpu_low_s"),
                  .cpu_high_s = f.number("cpu_high_s"),
                  .simulated_s = f.number("simulated_s"),
                  .driven = driven.node() != nullptr,
                  .success = driven.number("success"),
                  .seeds = driven.number("n"),
                  .success_low = driven.share("low"),
                  .success_high = driven.share("high"),
                  .mission_cpu_s = driven.number("mission_cpu_s"),
                  .outcomes = {}};
  const JsonFields outcomes = driven.object("outcomes");
  if (outcomes.node() != nullptr)
    for (const auto& [outcome, count] : outcomes.node()->items())
      run.outcomes.push_back(outcome + " " + show_count(outcomes.number(outcome)));
  return run;
}

TradeoffChoice read_choice(const JsonFields& f) {
  TradeoffChoice choice;
  if (f.node() == nullptr) return choice;
  choice = {.asked = true,
            .found = f.flag("found"),
            .figure = f.text("figure"),
            .unit = f.text("unit"),
            .tolerance = f.number("tolerance"),
            .budget_cpu_s = f.number("budget_cpu_s"),
            .error = f.number("error"),
            .cpu_s = f.number("cpu_s"),
            .cpu_reference_s = f.number("cpu_reference_s"),
            .refused = f.number("refused"),
            .settings = {},
            .seeds = f.list("validated_seeds").size()};
  const JsonFields settings = f.object("settings");
  if (settings.node() != nullptr)
    for (const auto& [key, value] : settings.node()->items())
      choice.settings.push_back(key + " = " + settings.text(key));
  return choice;
}

}  // namespace

Result<TradeoffSummary> read_tradeoff(const std::string& path) {
  CANYON_TRY(const std::string text, read_text_file(path));
  CANYON_TRY(const JsonFile file, JsonFile::parse(text, path));
  std::optional<Error> error;
  const JsonFields f(&file.root(), file, "", error);
  TradeoffSummary out{.mission = f.required_text("mission"),
                      .fidelity = f.required_text("fidelity"),
                      .seed = f.digits("seed"),
                      .tape = f.text("tape"),
                      .samples = f.number("samples"),
                      .repetitions = f.number("repetitions"),
                      .threads = f.number("threads"),
                      .ladders = {},
                      .skipped = {},
                      .runs = {},
                      .choice = read_choice(f.object("chosen"))};
  read_list(f, "ladders", out.ladders, read_ladder);
  read_list(f, "skipped", out.skipped, read_left_out);
  read_list(f, "fidelities", out.runs, read_run);
  if (error) return *error;
  return out;
}

}  // namespace canyon::report
