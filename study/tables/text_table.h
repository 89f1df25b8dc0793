#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "canyon/study/results/figures.h"

namespace canyon::study {

/// Columns of words and numbers for a terminal, aligned right, under headings.
class TextTable {
 public:
  /// `last`: title of the column that only some lines have.
  explicit TextTable(std::vector<std::string> columns, std::string last = "")
      : columns_(std::move(columns)), last_(std::move(last)) {}

  void heading(const std::string& text) { lines_.push_back({text, {}, ""}); }
  void line(const std::string& label, std::vector<std::string> cells, std::string last = "") {
    lines_.push_back({label, std::move(cells), std::move(last)});
  }
  std::string str() const;

 private:
  struct Line {
    std::string label;
    std::vector<std::string> cells;  ///< none: a heading
    std::string last;
  };
  std::vector<std::string> columns_;
  std::string last_;
  std::vector<Line> lines_;
};

/// "-" where it is undefined.
std::string fixed(double value, int decimals);

/// "0.146", "0.146 [0.141, 0.152]", "27 of 590", ">= 5".
std::string figure_text(const Figure& figure, const Estimate& found, double total = kNaN);

/// A line per figure under its group's heading: `of(figure, k)` stands in column k, with `totals` the figure that it is
/// a part of beside it. With two columns and more the last one has the ratio of the second to the first, unless a value
/// is at its cap.
void add_figures(TextTable& table, std::span<const Figure* const> chosen, std::size_t columns,
                 const std::function<Estimate(const Figure&, std::size_t)>& of, bool totals);

}  // namespace canyon::study
