#include "canyon/report/read/filter_verdict.h"

#include <cmath>

#include <nlohmann/json.hpp>

namespace canyon::report {
namespace {

ConsistencyRow read_row(const JsonFields& f, const char* group, const char* mean) {
  ConsistencyRow row{.group = group, .name = f.text("name"), .unit = f.text("unit")};
  row.factor = std::sqrt(f.number(mean));
  row.low = std::sqrt(f.number("low"));
  row.high = std::sqrt(f.number("high"));
  row.rms = f.number("rms");
  row.claimed = f.number("claimed");
  row.count = f.number("count");
  row.refused = f.number("refused");
  row.correlation_s = f.number("correlation_s");
  return row;
}

}  // namespace

FilterVerdict read_filter_verdict(const JsonFields& owner) {
  FilterVerdict out;
  for (const auto& [node, path] : owner.list("verdict")) {
    if (!node->is_string()) owner.fail(node, path, describe(*node), "a line of words");
    if (node->is_string()) out.lines.push_back(node->get<std::string>());
  }
  if (!owner.has("evidence")) return out;
  const JsonFields evidence = owner.object("evidence");
  out.tests = evidence.number("tests");
  const auto each = [&](const char* key, const auto& take) {
    for (const auto& [node, path] : evidence.list(key)) take(JsonFields(node, owner.file(), path, owner.error()));
  };
  each("errors", [&](const JsonFields& f) { out.rows.push_back(read_row(f, "errors", "ratio")); });
  each("measurements", [&](const JsonFields& f) { out.rows.push_back(read_row(f, "innovations", "nis")); });
  if (evidence.has("fixes")) {
    const JsonFields f = evidence.object("fixes");
    ConsistencyRow row = read_row(f, "fixes", "ratio");
    row.name = "errors of the fixes";
    row.unit = "m";
    row.rms = f.number("rms_m");
    row.claimed = f.number("claimed_m");
    out.rows.push_back(row);
  }
  each("states", [&](const JsonFields& f) {
    out.states.push_back({f.text("block"), f.text("name"), f.number("share"), f.number("halved_after_s")});
  });
  if (!evidence.has("observability")) return out;
  const JsonFields observability = evidence.object("observability");
  out.looked_s = observability.numbers("t_s", observability.list("t_s").size());
  const JsonFields shares = observability.object("states");
  for (ObservedState& state : out.states) state.shares = shares.numbers(state.name, out.looked_s.size());
  return out;
}

}  // namespace canyon::report
