#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "canyon/core/result.h"
#include "canyon/core/time.h"

namespace canyon::gnss {

/// A navigation record as its lines stand in the file: the one with satellite and epoch, and those that follow.
struct RecordLines {
  std::vector<std::string_view> lines;
  int first_line = 0;  ///< its number in the file
  std::string file;
  bool version2 = false;  ///< RINEX 2: the numbers start one column earlier

  std::size_t clock_column() const { return version2 ? 22 : 23; }
  std::size_t orbit_column() const { return version2 ? 3 : 4; }
};

/// Takes numbers out of a record and remembers the first thing that is wrong.
class RecordFields {
 public:
  static constexpr std::size_t kWidth = 19;  // of every number after the epoch

  RecordFields(const RecordLines& record, std::string who) : record_(record), who_(std::move(who)) {}

  /// Number `index` (0..2) of the first line, after the epoch.
  double clock(std::size_t index, const char* name);
  /// Number `index` (0..3) of line 1, 2, ...; blank is an error if required, else 0.
  double orbit(std::size_t line, std::size_t index, const char* name, bool required = true);
  /// The same; nullopt where it is blank, or where the record has no such line.
  std::optional<double> known(std::size_t line, std::size_t index, const char* name);
  /// The epoch of the first line, counted as if it were GPS time.
  GpsTime epoch();

  void require(bool condition, std::size_t line, const std::string& what, const std::string& expected);
  bool ok() const { return ok_; }
  const Error& error() const { return error_; }

 private:
  double number(std::size_t line, std::size_t column, const char* name, bool required);
  void fail(std::size_t line, const std::string& what, const std::string& expected);

  const RecordLines& record_;
  std::string who_;
  bool ok_ = true;
  Error error_;
};

/// The satellite number in columns 1-2 of a record's first line (0-1 in RINEX 2); nullopt unless 1 to 63.
std::optional<int> satellite_number(const RecordLines& record);

/// Epoch at the start of a line: `yyyy mm dd hh mm ss` from column 4, or RINEX 2's `yy mm dd hh mm ss.s` from column 3
/// (80-99 = 19xx, else 20xx); counted as if it were GPS time.
std::optional<GpsTime> epoch_of_line(std::string_view line, bool version2);

/// The instant with that second of week nearest to `near`, both in one time scale. Week numbers of the files are not
/// trusted: writers roll them over at 1024, and differ on which week a number before midnight belongs to.
GpsTime nearest_with_sow(double sow_s, GpsTime near);

}  // namespace canyon::gnss
