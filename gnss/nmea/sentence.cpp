#include "canyon/gnss/nmea/sentence.h"

#include <cstdio>

namespace canyon::gnss {
namespace {

unsigned checksum(std::string_view body) {
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  return sum;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

}  // namespace

std::string nmea_sentence(std::string_view body) {
  char tail[8];
  std::snprintf(tail, sizeof tail, "*%02X\r\n", checksum(body));
  return "$" + std::string(body) + tail;
}

std::optional<std::vector<std::string_view>> nmea_fields(std::string_view line) {
  while (!line.empty() && (line.back() == '\r' || line.back() == '\n' || line.back() == ' ')) line.remove_suffix(1);
  if (line.size() < 5 || line.front() != '$' || line[line.size() - 3] != '*') return std::nullopt;
  const int high = hex_digit(line[line.size() - 2]), low = hex_digit(line[line.size() - 1]);
  const std::string_view body = line.substr(1, line.size() - 4);
  if (high < 0 || low < 0 || checksum(body) != static_cast<unsigned>(16 * high + low)) return std::nullopt;
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0;;) {
    const std::size_t comma = body.find(',', begin);
    fields.push_back(body.substr(begin, comma - begin));
    if (comma == std::string_view::npos) return fields;
    begin = comma + 1;
  }
}

}  // namespace canyon::gnss
