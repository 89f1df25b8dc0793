#include "canyon/report/format.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "canyon/core/check.h"

namespace canyon::report {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD
constexpr std::string_view kMinus = "\xE2\x88\x92";        // U+2212
constexpr std::string_view kDash = "\xE2\x80\x93";         // U+2013
constexpr std::string_view kThinSpace = "\xE2\x80\xAF";    // U+202F, no-break
constexpr std::string_view kNoBreakSpace = "\xC2\xA0";     // U+00A0

/// Length of the well-formed UTF-8 sequence at text[i]; 0 if there is none.
std::size_t utf8_length(std::string_view text, std::size_t i) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned char lead = byte(i);
  if (lead < 0x80) return 1;
  std::size_t length = 0;
  std::uint32_t code = 0;
  std::uint32_t smallest = 0;
  if ((lead & 0xE0) == 0xC0) {
    length = 2, code = lead & 0x1Fu, smallest = 0x80;
  } else if ((lead & 0xF0) == 0xE0) {
    length = 3, code = lead & 0x0Fu, smallest = 0x800;
  } else if ((lead & 0xF8) == 0xF0) {
    length = 4, code = lead & 0x07u, smallest = 0x10000;
  } else {
    return 0;
  }
  if (i + length > text.size()) return 0;
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(i + k) & 0xC0) != 0x80) return 0;
    code = (code << 6) | (byte(i + k) & 0x3Fu);
  }
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  return code < smallest || code > 0x10FFFF || surrogate ? 0 : length;
}

std::string plain_fixed(double value, int decimals) {
  std::array<char, 400> buffer;
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, decimals);
  CANYON_CHECK(end.ec == std::errc{}, "value = ", value, ", decimals = ", decimals);
  return {buffer.data(), end.ptr};
}

/// Thousands apart, in numbers of five digits and more.
std::string grouped(const std::string& digits) {
  const std::size_t whole = std::min(digits.find('.'), digits.size());
  if (whole < 5) return digits;
  std::string out;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && i < whole && (whole - i) % 3 == 0) out += kThinSpace;
    out += digits[i];
  }
  return out;
}

}  // namespace

std::string escape_html(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text, i);
    const char c = text[i];
    if (length == 0 || (length == 1 && (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) && c != '\n' && c != '\t')) {
      out += kReplacement;
      ++i;
      continue;
    }
    if (length > 1) {
      out += text.substr(i, length);
    } else if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '"') {
      out += "&quot;";
    } else if (c == '\'') {
      out += "&#39;";
    } else {
      out += c;
    }
    i += length;
  }
  return out;
}

std::string show_number(double value, int significant) {
  CANYON_CHECK(significant >= 1, "significant = ", significant);
  if (!std::isfinite(value)) return std::string(kDash);
  if (value == 0) return "0";
  const double size = std::abs(value);
  const std::string sign = value < 0 ? std::string(kMinus) : std::string();
  // The exponent after rounding: 9.996 with three digits is 10.0, not 10.00.
  std::array<char, 64> buffer;
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), size, std::chars_format::scientific, significant - 1);
  const std::string_view scientific(buffer.data(), static_cast<std::size_t>(end.ptr - buffer.data()));
  const std::size_t e = scientific.find('e');
  int exponent = 0;
  const char* first = scientific.data() + e + 1 + (scientific[e + 1] == '+' ? 1 : 0);
  std::from_chars(first, scientific.data() + scientific.size(), exponent);
  if (exponent >= 9 || exponent < -4) {
    return sign + std::string(scientific.substr(0, e)) + "e" + (exponent < 0 ? std::string(kMinus) : std::string()) +
           std::to_string(std::abs(exponent));
  }
  const int decimals = std::max(0, significant - 1 - exponent);
  return sign + grouped(plain_fixed(size, decimals));
}

std::string show_quantity(double value, std::string_view unit, int significant) {
  const std::string number = show_number(value, significant);
  if (!std::isfinite(value) || unit.empty()) return number;
  if (unit == "\xC2\xB0") return number + std::string(unit);
  return number + std::string(kNoBreakSpace) + std::string(unit);
}

std::string show_share(double share) {
  if (!std::isfinite(share)) return std::string(kDash);
  const double percent = 100 * share;
  const bool whole = percent == 0 || std::abs(percent) >= 99.95;
  std::string text = plain_fixed(std::abs(percent), whole ? 0 : std::abs(percent) < 0.095 ? 2 : 1);
  return (percent < 0 ? std::string(kMinus) : std::string()) + text + std::string(kNoBreakSpace) + "%";
}

std::string show_count(double value) {
  if (!std::isfinite(value)) return std::string(kDash);
  return (value < 0 ? std::string(kMinus) : std::string()) + grouped(plain_fixed(std::abs(value), 0));
}

std::string fixed(double value, int decimals) {
  CANYON_CHECK(std::isfinite(value), "value = ", value);
  std::string text = plain_fixed(value, decimals);
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

std::string count_of(double n, std::string_view one, std::string_view many) {
  return show_count(n) + std::string(kNoBreakSpace) + std::string(n == 1 ? one : many);
}

}  // namespace canyon::report
