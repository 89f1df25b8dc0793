#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

namespace canyon::mission {

/// Builds a CSV text row by row, whole or piece by piece. Numbers have a fixed number of decimals and no locale;
/// undefined (not finite) values are empty.
class CsvWriter {
 public:
  explicit CsvWriter(std::string_view header) : text_(header) { text_ += '\n'; }

  CsvWriter& number(double value, int decimals) {
    separate();
    if (!std::isfinite(value)) return *this;
    char buffer[64];  // of anything a run measures; what is longer has a power of ten
    auto end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, decimals);
    if (end.ec != std::errc()) end = std::to_chars(buffer, buffer + sizeof buffer, value);
    text_.append(buffer, end.ptr);
    return *this;
  }
  /// As few digits as give the same bits when they are read.
  CsvWriter& exact(double value) {
    separate();
    if (!std::isfinite(value)) return *this;
    char buffer[32];
    text_.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
    return *this;
  }
  template <class... Values>
  CsvWriter& numbers(int decimals, Values... values) {
    (number(values, decimals), ...);
    return *this;
  }
  CsvWriter& integer(std::int64_t value) {
    separate();
    text_ += std::to_string(value);
    return *this;
  }
  /// Words that need no quoting: commas become semicolons, quotes apostrophes, line breaks blanks.
  CsvWriter& word(std::string_view value) {
    separate();
    for (const char c : value) text_ += c == ',' ? ';' : c == '"' ? '\'' : c == '\n' ? ' ' : c;
    return *this;
  }
  void end_row() {
    text_ += '\n';
    row_started_ = false;
  }
  const std::string& text() const { return text_; }
  void clear() { text_.clear(); }  ///< what was written has been taken

 private:
  void separate() {
    if (row_started_) text_ += ',';
    row_started_ = true;
  }
  std::string text_;
  bool row_started_ = false;
};

}  // namespace canyon::mission
