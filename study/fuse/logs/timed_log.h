#pragma once

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "canyon/core/files/line_reader.h"
#include "canyon/core/result.h"
#include "canyon/core/tables/column_names.h"
#include "canyon/core/tables/passed_over.h"
#include "canyon/core/time.h"

namespace canyon::study {

/// What a log of an instant and a few numbers on each line may hold.
struct TimedLogLayout {
  static constexpr int kWeek = 0, kTime = 1;  ///< targets that every layout has; its own come after them
  std::span<const KnownColumn> columns;
  int targets = 0;
  const char* expected;  ///< of the columns, in words
  const char* key;       ///< of the configuration, that names them in place of a header
  std::string columns_given = {};
};

/// Reads one, by the names in its header or in the configuration: text, plain or gzip. A line that is not later than
/// those before it is passed over and counted.
class TimedLog {
 public:
  static Result<TimedLog> open(const std::string& path, TimedLogLayout layout);

  /// Goes to the next line that is later than all before it; false at the end. An Error, with its line, for columns
  /// that are missing (`lacking`, of a layout that has a time), and for text that is no number.
  Result<bool> next();
  /// What the columns lack; null: nothing. Asked once, when they are known.
  const char* (*lacking)(const TimedLog&) = nullptr;

  GpsTime t() const { return t_; }
  double since_s() const { return since_s_; }  ///< the line before; NaN on the first
  bool has(int target) const { return places_[static_cast<std::size_t>(target)].there; }
  /// In SI; NaN without such a column, and where the field is empty or says so.
  Result<double> number(int target) const;
  /// The line has not the numbers that it should have.
  void pass_over() { passed_over_.not_finite.add(in_.number(), std::numeric_limits<double>::quiet_NaN(), latest_s_); }

  bool has_week() const { return has(TimedLogLayout::kWeek); }
  const PassedOver& passed_over() const { return passed_over_; }
  Error error(std::string what, std::string expected) const { return in_.error(std::move(what), std::move(expected)); }
  Error empty_file(const std::string& lacks) const { return in_.empty_file(lacks); }

 private:
  struct Place {
    bool there = false;
    std::size_t field = 0;
    double factor = 1.0;
  };
  TimedLog(const std::string& path, std::string text, TimedLogLayout layout)
      : in_(path, std::move(text)), layout_(std::move(layout)), places_(static_cast<std::size_t>(layout_.targets)) {}
  Status place(const std::string& names);
  Result<GpsTime> instant() const;
  double stated_s(GpsTime t) const { return has_week() ? t.sow_s() : t - GpsTime{}; }

  LineReader in_;
  TimedLogLayout layout_;
  std::vector<Place> places_;
  std::vector<std::string_view> fields_;
  bool first_ = true, placed_ = false, any_ = false;
  GpsTime t_;
  double since_s_ = 0.0, latest_s_ = 0.0;
  PassedOver passed_over_;
};

}  // namespace canyon::study
