#pragma once

#include <optional>
#include <string>
#include <vector>

#include "canyon/core/result.h"
#include "canyon/core/time.h"

namespace canyon::study {

/// Windows in which fixes are withheld, to see how the filter carries on alone.
struct OutagePlan {
  double length_s = 0.0;
  double every_s = 0.0;  ///< from one beginning to the next; longer than length_s
  double first_s = 0.0;  ///< seconds after the log's beginning; beyond the log's length, seconds of its GPS week
};
/// "LENGTH,EVERY,FIRST", all positive, FIRST also 0.
Result<OutagePlan> parse_outage_plan(const std::string& text, const std::string& option);

/// One window (begin, end]: fixes of that time are withheld, and the errors at truth instants of it count. A fix at
/// `begin` is the last one, so that an outage of 30 s ends 30 s after the last fix.
struct OutageWindow {
  GpsTime begin, end;
  double horizontal_max_m = 0.0, vertical_max_m = 0.0;
  std::size_t instants = 0;  ///< of truth in it
};

class Outages {
 public:
  Outages() = default;
  /// The windows that fit wholly between the two instants.
  Outages(const OutagePlan& plan, GpsTime begin, GpsTime end);

  bool withholds(GpsTime t) const { return window_at(t) != nullptr; }
  /// An error there, estimate minus truth.
  void add(GpsTime t, double horizontal_m, double vertical_m);
  const std::vector<OutageWindow>& windows() const { return windows_; }

 private:
  const OutageWindow* window_at(GpsTime t) const;
  std::vector<OutageWindow> windows_;
};

/// Over the windows with truth in them; NaN without one.
struct OutageScore {
  std::size_t count = 0;
  double horizontal_rms_of_max_m, vertical_rms_of_max_m, horizontal_mean_of_max_m, vertical_mean_of_max_m;
};
OutageScore outage_score(const std::vector<OutageWindow>& windows);

}  // namespace canyon::study
