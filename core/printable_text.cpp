#include "canyon/core/printable_text.h"

#include <algorithm>
#include <cstddef>

namespace canyon {
namespace {

/// Bytes of the UTF-8 character at the beginning of `text`; 0 if there is none (RFC 3629: no overlong forms, no
/// surrogates, nothing beyond U+10FFFF) or if it is a control character.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned first = byte(0);
  if (first < 0x20 || first == 0x7f) return 0;
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xc0u) != 0x80u) return 0;
  const unsigned second = byte(1);
  if ((first == 0xe0 && second < 0xa0) || (first == 0xed && second >= 0xa0)) return 0;
  if ((first == 0xf0 && second < 0x90) || (first == 0xf4 && second >= 0x90)) return 0;
  if (first == 0xc2 && second < 0xa0) return 0;  // control characters of Latin-1
  return length;
}

constexpr bool continues(char c) {
  return (static_cast<unsigned char>(c) & 0xc0u) == 0x80u;
}

/// `text` with its middle left out if it is longer than `most`; never inside a character.
std::string shortened(std::string_view text, std::size_t most, std::size_t head, std::size_t tail) {
  if (text.size() <= most) return std::string(text);
  std::size_t end = head, begin = text.size() - tail;
  while (end > 0 && continues(text[end])) --end;
  while (begin < text.size() && continues(text[begin])) ++begin;
  return std::string(text.substr(0, end)) + "..." + std::string(text.substr(begin));
}

}  // namespace

std::string escaped_text(std::string_view text) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string out;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    if (length > 0) {
      out += text.substr(0, length);
    } else {
      const auto c = static_cast<unsigned char>(text[0]);
      out += {'\\', 'x', kDigits[c >> 4], kDigits[c & 15u]};
    }
    text.remove_prefix(length > 0 ? length : 1);
  }
  return out;
}

std::string printable_text(std::string_view text) {
  // What is left out anyway need not be escaped: a quoted line may have megabytes.
  const std::string all = escaped_text(text.size() <= 4000 ? std::string(text) : shortened(text, 4000, 2000, 1500));
  std::string words;
  for (std::size_t at = 0; at < all.size();) {
    const std::size_t blank = std::min(all.find(' ', at), all.size());
    words += shortened(std::string_view(all).substr(at, blank - at), 120, 60, 40);
    if (blank < all.size()) words += ' ';
    at = blank + 1;
  }
  return shortened(words, 1000, 700, 250);
}

}  // namespace canyon
