#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "canyon/core/process/progress.h"
#include "canyon/core/result.h"
#include "canyon/core/time.h"

namespace canyon {

/// A text file of numbers line by line, with what its errors need.
class LineReader {
 public:
  LineReader(const std::string& path, std::string text) : path_(path), text_(std::move(text)) {}

  /// The next line that is neither empty nor a comment (#), without its end.
  bool next(std::string_view& line) {
    while (position_ < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', position_), text_.size());
      line = std::string_view(text_).substr(position_, end - position_);
      position_ = end + 1;
      ++number_;
      if (number_ % 4096 == 0) throw_if_cancelled();
      while (!line.empty() && (line.back() == '\r' || line.back() == ' ' || line.back() == '\t')) line.remove_suffix(1);
      if (!line.empty() && line.front() != '#') return true;
    }
    return false;
  }

  int number() const { return number_; }  ///< of the line that next() gave last

  Error error(std::string what, std::string expected) const {
    Error e;
    e.file = path_;
    e.line = number_;
    e.what = std::move(what);
    e.expected = std::move(expected);
    return e;
  }
  Error empty_file(const std::string& what_it_lacks) const {
    Error e;
    e.file = path_;
    e.what = "holds no " + what_it_lacks;
    e.expected = "at least one line of numbers";
    return e;
  }

 private:
  std::string path_;
  std::string text_;
  std::size_t position_ = 0;
  int number_ = 0;
};

/// The fields of a line. `join_separators`: several in a row count as one (columns apart by blanks).
std::vector<std::string_view> split(std::string_view line, std::string_view separators, bool join_separators);
/// The same into `fields`, whose room is used again: what a reader of a million lines takes.
void split(std::string_view line, std::string_view separators, bool join_separators,
           std::vector<std::string_view>& fields);

/// Without blanks and tabs at both ends.
std::string_view trimmed(std::string_view field);

Result<double> parse_number(const LineReader& in, std::string_view field);

/// Seconds as nanoseconds. Plain decimals are read digit by digit: as a double, GPS seconds of today would lose 0.1 us.
Result<std::int64_t> parse_seconds(const LineReader& in, std::string_view field);

/// A coordinate in metres, at most 1e9 m (two and a half times the distance of the Moon) from where it is counted: what
/// is farther is no place of a vehicle, and its squares would leave the range of numbers.
Result<double> parse_coordinate(const LineReader& in, std::string_view field);

/// A speed component in m/s, below that of light.
Result<double> parse_speed(const LineReader& in, std::string_view field);

/// The instant of a GPS week (0 to 14000) and nanoseconds from its start, if it can be represented.
Result<GpsTime> gps_instant(const LineReader& in, int week, std::int64_t sow_ns);

/// That `t` is later than `last` and that the time since `first` can be represented (292 years).
Status check_time_order(const LineReader& in, GpsTime first, GpsTime last, GpsTime t, const char* expected);

}  // namespace canyon
