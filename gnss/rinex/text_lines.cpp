#include "canyon/gnss/rinex/text_lines.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "canyon/core/process/progress.h"

namespace canyon::gnss {
namespace {

std::string_view first_line(std::string_view text) {
  std::string_view line = text.substr(0, std::min(text.find('\n'), text.size()));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

}  // namespace

bool TextLines::next() {
  if (rest_.empty()) return false;
  line_ = first_line(rest_);
  const std::size_t end = rest_.find('\n');
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  ++number_;
  // Every reader of ours comes by here.
  if (number_ % 4096 == 0) throw_if_cancelled();
  return true;
}

std::string_view TextLines::peek() const {
  return first_line(rest_);
}

std::string_view columns(std::string_view line, std::size_t first, std::size_t width) {
  if (first >= line.size()) return {};
  std::string_view field = line.substr(first, width);
  const std::size_t begin = field.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return field.substr(begin, field.find_last_not_of(" \t") - begin + 1);
}

std::optional<double> fortran_number(std::string_view text) {
  std::array<char, 40> buffer{};
  if (text.starts_with('+')) text.remove_prefix(1);
  if (text.empty() || text.size() >= buffer.size()) return std::nullopt;
  std::transform(text.begin(), text.end(), buffer.begin(), [](char c) { return c == 'D' || c == 'd' ? 'e' : c; });
  const char* end = buffer.data() + text.size();
  double value = 0.0;
  const auto [stop, error] = std::from_chars(buffer.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<int> whole_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  int value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || stop != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string printable(std::string_view text) {
  std::string out(text);
  std::replace_if(
      out.begin(), out.end(), [](unsigned char c) { return c < 0x20 || c > 0x7e; }, '?');
  return out;
}

}  // namespace canyon::gnss
