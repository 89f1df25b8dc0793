#pragma once

#include <memory>
#include <optional>
#include <span>

#include "gnss/model_table.h"
#include "gnss/receiver/link_budget.h"

namespace canyon::gnss {

/// What the receiver makes of one satellite's signals.
struct Reception {
  bool tracked = false;
  double error_m = 0.0;  ///< code delay beyond the direct way's
  double cn0_dbhz = 0.0;
};

/// How direct and reflected signals together become a range.
class MultipathRule {
 public:
  virtual ~MultipathRule() = default;
  /// `direct_cn0_dbhz`: of the direct signal; nullopt if it is blocked. Reflections by growing excess.
  virtual Reception receive(std::optional<double> direct_cn0_dbhz,
                            std::span<const ReceivedReflection> reflections) const = 0;
};

struct MultipathParameters {
  double cutoff_m = 45.0;  ///< paper_first_return
  double threshold_dbhz = 25.0;
  double spacing_chips = 0.5;  ///< correlator
};

using MakeMultipathRule = std::unique_ptr<MultipathRule>(const MultipathParameters&);
std::span<const ModelRow<MakeMultipathRule>> multipath_rules();

std::unique_ptr<MultipathRule> make_paper_first_return(const MultipathParameters& p);
std::unique_ptr<MultipathRule> make_correlator(const MultipathParameters& p);

/// NLOS-only reception, shared by the rules: the strongest reflection is tracked if it reaches the threshold, its range
/// too long by its excess; otherwise nothing is.
Reception strongest_reflection(std::span<const ReceivedReflection> reflections, double threshold_dbhz);

}  // namespace canyon::gnss
