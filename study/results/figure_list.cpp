#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "canyon/core/config/config.h"
#include "canyon/core/output/json.h"
#include "canyon/study/results/figures.h"

namespace canyon::study {

const char* name(Better better) {
  switch (better) {
    case Better::kLower:
      return "lower";
    case Better::kHigher:
      return "higher";
    case Better::kNeither:
      break;
  }
  return "neither";
}

namespace {

const char* name(Figure::Kind kind) {
  switch (kind) {
    case Figure::Kind::kCount:
      return "count";
    case Figure::Kind::kShare:
      return "share";
    case Figure::Kind::kQuantity:
      break;
  }
  return "quantity";
}

/// It only says what others are a part of, and stands beside them.
bool is_total(const Figure& figure) {
  const std::string_view key = figure.key;
  return std::any_of(figures().begin(), figures().end(),
                     [key](const Figure& other) { return other.total != nullptr && other.total == key; });
}

/// By edit distance, else the first that has the longest beginning in common: "map" is near "map_error_rms_m".
std::string nearest_key(const std::string& key) {
  std::vector<std::string> known;
  for (const Figure& figure : figures()) known.emplace_back(figure.key);
  const std::string nearest = nearest_word(key, known);
  if (!nearest.empty()) return nearest;
  const auto common = [&key](const std::string& other) {
    return std::mismatch(key.begin(), key.end(), other.begin(), other.end()).first - key.begin();
  };
  return *std::max_element(known.begin(), known.end(),
                           [&](const auto& a, const auto& b) { return common(a) < common(b); });
}

Json interval_json(const Interval& interval) {
  return {{"low", interval.low}, {"high", interval.high}};
}

}  // namespace

const Figure* find_figure(std::string_view key) {
  for (const Figure& figure : figures())
    if (figure.key == key) return &figure;
  return nullptr;
}

Result<std::vector<const Figure*>> choose_figures(const std::vector<std::string>& keys, const std::string& option) {
  std::vector<const Figure*> chosen;
  for (const std::string& key : keys) {
    const Figure* found = find_figure(key);
    if (found == nullptr) {
      return Error{.file = option,
                   .what = "\"" + key + "\" is no figure",
                   .expected = "one that canyon keys --figures lists; nearest is \"" + nearest_key(key) + "\""};
    }
    chosen.push_back(found);
  }
  if (keys.empty())
    for (const Figure& figure : figures())
      if (!is_total(figure)) chosen.push_back(&figure);
  return chosen;
}

Estimate estimate(const Figure& figure, const RunSummary& run) {
  return {figure.get(run), figure.interval != nullptr ? figure.interval(run) : Interval{}};
}

Json figure_json(const Figure& figure, double value) {
  if (!std::isfinite(value)) return nullptr;
  return figure.kind == Figure::Kind::kCount && value == std::floor(value) ? Json(static_cast<std::int64_t>(value))
                                                                           : Json(value);
}

void write_figures(const RunSummary& run, bool timing, Json& out) {
  Json intervals = Json::object();
  for (const Figure& figure : figures()) {
    if (figure.timing != timing) continue;
    const Estimate found = estimate(figure, run);
    out[figure.key] = figure_json(figure, found.value);
    if (found.interval.defined()) intervals[figure.key] = interval_json(found.interval);
  }
  if (!timing) out["intervals"] = intervals;
}

Json figure_descriptions() {
  Json out = Json::array();
  for (const Figure& figure : figures()) {
    Json row{{"key", figure.key},        {"group", figure.group},     {"label", figure.label},
             {"unit", figure.unit},      {"kind", name(figure.kind)}, {"better", name(figure.better)},
             {"meaning", figure.meaning}};
    if (figure.total != nullptr) row["total"] = figure.total;
    if (std::isfinite(figure.cap)) row["cap"] = figure.cap;
    if (figure.timing) row["under"] = "timing";
    out.push_back(std::move(row));
  }
  return out;
}

std::string figure_reference() {
  std::string out = "| key | what | unit | better |\n|---|---|---|---|\n";
  std::string group;
  for (const Figure& figure : figures()) {
    if (group != figure.group) out += "| | **" + std::string(group = figure.group) + "** | | |\n";
    const std::string meaning = figure.meaning;
    std::string what = figure.label;
    if (figure.total != nullptr) what += ", of `" + std::string(figure.total) + "`";
    if (!meaning.empty()) what += ": " + meaning;
    if (figure.interval != nullptr) what += " (95 % under `intervals`)";
    if (figure.timing) what += " (under `timing`)";
    out += "| `" + std::string(figure.key) + "` | " + what + " | " +
           (figure.kind == Figure::Kind::kShare ? "share of 1" : figure.unit) + " | " +
           (figure.better == Better::kNeither ? "" : name(figure.better)) + " |\n";
  }
  return out;
}

}  // namespace canyon::study
