#include "canyon/study/tables/text_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace canyon::study {

namespace {

std::string padded(const std::string& text, std::size_t width, bool left) {
  const std::string blanks(text.size() < width ? width - text.size() : 0, ' ');
  return left ? text + blanks : blanks + text;
}

/// Second over first; values at their cap are not known beyond it, and a ratio of them means nothing.
std::string ratio_text(const Figure& figure, double first, double second) {
  const bool known = first < figure.cap && second < figure.cap;
  const double ratio = known ? second / first : kNaN;
  return fixed(ratio, ratio < 10 ? 2 : 1);
}

}  // namespace

std::string TextTable::str() const {
  std::size_t label_width = 0;
  std::vector<std::size_t> widths;
  for (const std::string& column : columns_) widths.push_back(column.size());
  for (const Line& line : lines_) {
    if (!line.cells.empty()) label_width = std::max(label_width, line.label.size() + 2);
    for (std::size_t i = 0; i < line.cells.size(); ++i) widths[i] = std::max(widths[i], line.cells[i].size());
  }
  std::string out = padded("", label_width, true);
  for (std::size_t i = 0; i < columns_.size(); ++i) out += "  " + padded(columns_[i], widths[i], false);
  out += (last_.empty() ? "" : "  " + last_) + "\n";
  for (const Line& line : lines_) {
    if (line.cells.empty()) {
      out += line.label + "\n";
      continue;
    }
    std::string row = padded("  " + line.label, label_width, true);
    for (std::size_t i = 0; i < line.cells.size(); ++i) row += "  " + padded(line.cells[i], widths[i], false);
    if (!line.last.empty()) row += "  " + padded(line.last, last_.size(), false);
    out += row + "\n";
  }
  return out;
}

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "-";
  char text[48];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

std::string figure_text(const Figure& figure, const Estimate& found, double total) {
  const double scale = figure.kind == Figure::Kind::kShare ? 100.0 : 1.0;
  if (found.value >= figure.cap) return ">= " + fixed(figure.cap, 0);
  // A median of an even number of counts may lie between two.
  const int decimals =
      figure.kind == Figure::Kind::kCount && found.value != std::floor(found.value) ? 1 : figure.decimals;
  std::string text = fixed(scale * found.value, decimals);
  if (std::isfinite(found.value) && std::isfinite(total)) text += " of " + fixed(total, 0);
  if (found.interval.defined())
    text +=
        " [" + fixed(scale * found.interval.low, decimals) + ", " + fixed(scale * found.interval.high, decimals) + "]";
  return text;
}

void add_figures(TextTable& table, std::span<const Figure* const> chosen, std::size_t columns,
                 const std::function<Estimate(const Figure&, std::size_t)>& of, bool totals) {
  std::string group;
  for (const Figure* figure : chosen) {
    if (group != figure->group) table.heading(group = figure->group);
    const Figure* total = totals && figure->total != nullptr ? find_figure(figure->total) : nullptr;
    std::vector<std::string> cells;
    for (std::size_t k = 0; k < columns; ++k)
      cells.push_back(figure_text(*figure, of(*figure, k), total != nullptr ? of(*total, k).value : kNaN));
    const std::string unit = *figure->unit != '\0' ? std::string(", ") + figure->unit : "";
    table.line(figure->label + unit, std::move(cells),
               columns > 1 ? ratio_text(*figure, of(*figure, 0).value, of(*figure, 1).value) : "");
  }
}

}  // namespace canyon::study
