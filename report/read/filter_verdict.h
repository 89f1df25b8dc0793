#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "canyon/report/read/json_fields.h"

namespace canyon::report {

/// A mean of squares that is 1 of a right filter, as its root: how many times larger than claimed something is.
struct ConsistencyRow {
  std::string group = {};  ///< "errors", "innovations", "fixes"
  std::string name = {}, unit = {};
  double factor = std::nan(""), low = std::nan(""), high = std::nan("");  ///< of a right filter's, between
  double rms = std::nan(""), claimed = std::nan("");                      ///< of errors and fixes
  double count = std::nan(""), refused = std::nan("");                    ///< of innovations
  double correlation_s = std::nan("");
};

/// How well a state was observed: its 1-sigma over what it would be by prediction alone.
struct ObservedState {
  std::string block, name;
  double share = std::nan(""), halved_after_s = std::nan("");
  std::vector<double> shares = {};  ///< at FilterVerdict::looked_s
};

/// What is said of a run's filter (`verdict` and `evidence` of summary.json); empty where a directory has none.
struct FilterVerdict {
  std::vector<std::string> lines;  ///< the worst first; "consistent" where there is no fault
  std::vector<ConsistencyRow> rows;
  std::vector<ObservedState> states;
  std::vector<double> looked_s;  ///< since the filter was first looked at
  double tests = std::nan("");
};

/// `owner` holds the two keys.
FilterVerdict read_filter_verdict(const JsonFields& owner);

}  // namespace canyon::report
