#pragma once

#include <span>
#include <vector>

#include "canyon/core/model_table.h"
#include "canyon/gnss/solver/gauss_newton.h"

namespace canyon::gnss {

/// A set of ranges in which some are suspected to be wrong. Vectors of `fit` run parallel to `members`, which are
/// indices into all ranges.
struct RangeSubset {
  std::vector<std::size_t> members;
  RangeFit fit;
};

/// Fits any subset.
class SubsetFitter {
 public:
  virtual ~SubsetFitter() = default;
  virtual RangeFit fit(const std::vector<std::size_t>& members) const = 0;
};

/// The next subset to try after one that failed the test: one range less. Empty members if none can be told to be
/// wrong.
using ExcludeNext = RangeSubset(const RangeSubset& failed, const SubsetFitter& fitter);

/// Residual-based fault handling (receiver autonomous integrity monitoring). With false alarms of probability
/// p, the weighted sum of squared residuals is compared with the chi-square value that n - unknowns degrees of freedom
/// exceed with probability p (Parkinson & Axelrad 1988). Rows:
///   none         no test
///   detect       an epoch that fails has no fix
///   greedy       the range with the largest standardised residual (Baarda's w) is excluded and the test repeated; in
///                the linearised problem that is the one whose absence lowers the statistic most
///   leave_one_out  every subset of one range less is solved anew, and the one with the smallest statistic kept
/// An exclusion is accepted only where the remaining ranges pass the test with at least one degree of freedom left.
struct FaultExclusion {
  ExcludeNext* next;
  bool tests;  ///< false: no test at all
};
ModelTable<FaultExclusion> fault_exclusions();

/// Tests and, where the model allows, repairs. `tested` starts as the fit of all ranges.
IntegrityTest exclude_faults(RangeSubset& tested, const SubsetFitter& fitter, const PositionSolverParameters& p);

}  // namespace canyon::gnss
