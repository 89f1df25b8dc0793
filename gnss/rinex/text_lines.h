#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace canyon::gnss {

/// Walks through the lines of a text, counting from 1; line ends \n and \r\n.
class TextLines {
 public:
  explicit TextLines(std::string_view text) : rest_(text) {}

  /// Moves to the next line; false at the end.
  bool next();
  /// The line after this one, without moving; empty at the end.
  std::string_view peek() const;
  bool at_end() const { return rest_.empty(); }

  std::string_view line() const { return line_; }
  int number() const { return number_; }

 private:
  std::string_view rest_, line_;
  int number_ = 0;
};

/// Columns [first, first + width) of a line, blanks trimmed; shorter or empty where the line ends before.
std::string_view columns(std::string_view line, std::size_t first, std::size_t width);

/// A Fortran number: 0.1234D-05, 1.5E+3, -.5, 12; nullopt unless the whole text is one finite number.
std::optional<double> fortran_number(std::string_view text);
std::optional<int> whole_number(std::string_view text);

/// The text with every byte that is not printable ASCII shown as `?`; for error messages about arbitrary bytes.
std::string printable(std::string_view text);

}  // namespace canyon::gnss
