#include "canyon/study/reproduce/reproduction.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "canyon/core/output/json.h"
#include "canyon/core/output/printed.h"

namespace canyon::study {
namespace {

Json json_of(const Ours& ours) {
  return {{"form", ours.form},
          {"value", or_null(ours.value)},
          {"low", or_null(ours.range.low)},
          {"high", or_null(ours.range.high)},
          {"n", ours.n}};
}

Json json_of(const PaperRow& row) {
  Json ours = Json::array();
  for (const Ours& one : row.ours) ours.push_back(json_of(one));
  const Ours* best = nearest(row);
  return {{"what", row.what},
          {"unit", row.unit},
          {"paper", or_null(row.paper)},
          {"real", or_null(row.real)},
          {"ours", ours},
          {"nearest", best != nullptr ? Json(best->form) : Json(nullptr)},
          {"ratio", or_null(best != nullptr ? best->value / row.paper : kNaN)}};
}

/// Six digits: they are drawn, not computed with.
Json numbers(const std::vector<double>& values) {
  Json out = Json::array();
  for (const double v : values) out.push_back(or_null(std::isfinite(v) ? std::stod(printed("%.6g", v)) : v));
  return out;
}

Json json_of(const PaperCurve& curve) {
  return {{"panel", curve.panel},           {"unit", curve.unit},     {"name", curve.name},    {"points", curve.points},
          {"from_above", curve.from_above}, {"labels", curve.labels}, {"x", numbers(curve.x)}, {"y", numbers(curve.y)}};
}

Json json_of(const PaperPart& part) {
  Json rows = Json::array(), curves = Json::array();
  for (const PaperRow& row : part.rows) rows.push_back(json_of(row));
  for (const PaperCurve& curve : part.curves) curves.push_back(json_of(curve));
  return {{"name", part.name},
          {"title", part.title},
          {"paper_says", part.paper_says},
          {"made", part.made},
          {"difference", part.difference},
          {"x_label", part.x_label},
          {"rows", rows},
          {"curves", curves}};
}

std::string shown(double value) {
  return std::isfinite(value) ? printed("%.3g", value) : "-";
}

/// "  (0.9 to 1.8, n = 20)"; of a single value nothing.
std::string shown_spread(const Ours& one) {
  std::string out;
  if (one.range.defined()) out = shown(one.range.low) + " to " + shown(one.range.high);
  if (one.n > 1) out += (out.empty() ? "n = " : ", n = ") + std::to_string(one.n);
  return out.empty() ? out : "  (" + out + ")";
}

std::string table_of(const PaperRow& row) {
  std::string out = printed("  %-46s", (row.what + (row.unit.empty() ? "" : ", " + row.unit)).c_str());
  if (std::isfinite(row.paper)) out += printed(" paper %9s", shown(row.paper).c_str());
  if (std::isfinite(row.real)) out += printed("  its real sensor %9s", shown(row.real).c_str());
  out += "\n";
  for (const Ours& one : row.ours) {
    out += printed("    %-44s       %9s", one.form.c_str(), shown(one.value).c_str()) + shown_spread(one) + "\n";
  }
  return out;
}

}  // namespace

const Ours* nearest(const PaperRow& row) {
  const Ours* best = nullptr;
  if (!std::isfinite(row.paper) || row.paper <= 0.0) return nullptr;
  const auto off = [&](const Ours& one) { return std::abs(std::log(one.value / row.paper)); };
  for (const Ours& one : row.ours)
    if (one.value > 0.0 && (best == nullptr || off(one) < off(*best))) best = &one;
  return best;
}

nlohmann::ordered_json reproduction_json(const Reproduction& reproduction) {
  Json parts = Json::array();
  for (const PaperPart& part : reproduction.parts) parts.push_back(json_of(part));
  return {{"paper", "Durst & Goodin 2012"}, {"ephemeris", reproduction.ephemeris}, {"start", reproduction.start},
          {"draws", reproduction.draws},    {"missions", reproduction.missions},   {"parts", parts}};
}

std::string reproduction_csv(const Reproduction& reproduction) {
  const auto number = [](double v) { return std::isfinite(v) ? printed("%.9g", v) : std::string(); };
  std::string out = "part,what,unit,paper,real,form,value,low,high,n\n";
  for (const PaperPart& part : reproduction.parts)
    for (const PaperRow& row : part.rows)
      for (const Ours& one : row.ours)
        out += part.name + ",\"" + row.what + "\"," + row.unit + "," + number(row.paper) + "," + number(row.real) +
               ",\"" + one.form + "\"," + number(one.value) + "," + number(one.range.low) + "," +
               number(one.range.high) + "," + std::to_string(one.n) + "\n";
  return out;
}

std::string reproduction_table(const Reproduction& reproduction) {
  std::string out = "Durst & Goodin 2012 beside Canyon; satellites: " + reproduction.ephemeris + ", from " +
                    reproduction.start + " GPS time\n";
  for (const PaperPart& part : reproduction.parts) {
    out += "\n" + part.title + "\n";
    for (const PaperRow& row : part.rows) out += table_of(row);
    for (const std::string& line : part.difference) out += "  " + line + "\n";
  }
  return out;
}

}  // namespace canyon::study
