#include "canyon/gnss/solver/fault_exclusion.h"

#include <array>

#include "canyon/core/math/chi_square.h"

namespace canyon::gnss {
namespace {

// Below this part of its variance a residual is rounding: the fit follows that range, and nothing can be said of it.
constexpr double kLeastRedundancy = 1e-6;

std::vector<std::size_t> without(const std::vector<std::size_t>& members, std::size_t position) {
  auto out = members;
  out.erase(out.begin() + static_cast<std::ptrdiff_t>(position));
  return out;
}

/// The threshold that an epoch's test needs, kept by degrees of freedom: it is the root of a series, and a run asks for
/// the same few over and over.
double threshold_of(double false_alarm, int degrees_of_freedom) {
  constexpr int kKept = 64;
  thread_local double kept_for = 0.0;
  thread_local std::array<double, kKept> kept{};
  if (degrees_of_freedom < 0 || degrees_of_freedom >= kKept)
    return chi_square_threshold(false_alarm, degrees_of_freedom);
  if (kept_for != false_alarm) {
    kept.fill(-1.0);
    kept_for = false_alarm;
  }
  double& threshold = kept[static_cast<std::size_t>(degrees_of_freedom)];
  if (threshold < 0.0) threshold = chi_square_threshold(false_alarm, degrees_of_freedom);
  return threshold;
}

RangeSubset exclude_none(const RangeSubset&, const SubsetFitter&) {
  return {};
}

RangeSubset exclude_largest(const RangeSubset& failed, const SubsetFitter& fitter) {
  std::size_t worst = failed.members.size();
  double largest = 0.0;
  for (std::size_t i = 0; i < failed.members.size(); ++i) {
    if (failed.fit.redundancy[i] < kLeastRedundancy) continue;
    const double w2 = failed.fit.weighted[i] * failed.fit.weighted[i] / failed.fit.redundancy[i];
    if (w2 > largest) {
      largest = w2;
      worst = i;
    }
  }
  if (worst == failed.members.size()) return {};
  RangeSubset out{without(failed.members, worst), {}};
  out.fit = fitter.fit(out.members);
  return out;
}

RangeSubset exclude_best_of_all(const RangeSubset& failed, const SubsetFitter& fitter) {
  RangeSubset best;
  for (std::size_t i = 0; i < failed.members.size(); ++i) {
    if (failed.fit.redundancy[i] < kLeastRedundancy) continue;
    RangeSubset candidate{without(failed.members, i), {}};
    candidate.fit = fitter.fit(candidate.members);
    if (!candidate.fit.ok) continue;
    if (best.members.empty() || candidate.fit.statistic < best.fit.statistic) best = std::move(candidate);
  }
  return best;
}

constexpr ModelRow<FaultExclusion> kExclusions[] = {
    {"none", {exclude_none, false}, "no test of the residuals"},
    {"detect", {exclude_none, true}, "chi-square test; an epoch that fails has no fix"},
    {"greedy",
     {exclude_largest, true},
     "chi-square test; the largest standardised residual is excluded until it passes"},
    {"leave_one_out",
     {exclude_best_of_all, true},
     "chi-square test; of all fits without one satellite the best is kept, until it passes"},
};

}  // namespace

ModelTable<FaultExclusion> fault_exclusions() {
  return kExclusions;
}

IntegrityTest exclude_faults(RangeSubset& tested, const SubsetFitter& fitter, const PositionSolverParameters& p) {
  const FaultExclusion& model = model_row(fault_exclusions(), p.fault_exclusion).make;
  IntegrityTest test;
  const auto passes = [&](const RangeFit& fit) {
    test.statistic = fit.statistic;
    test.degrees_of_freedom = fit.degrees_of_freedom;
    test.threshold = threshold_of(p.false_alarm, fit.degrees_of_freedom);
    return test.statistic <= test.threshold;
  };

  if (!model.tests || tested.fit.degrees_of_freedom < 1) return test;
  if (passes(tested.fit)) {
    test.status = IntegrityTest::Status::kPassed;
    return test;
  }
  const IntegrityTest of_all = test;
  RangeSubset now = tested;
  for (int k = 0; k < p.max_exclusions; ++k) {
    now = model.next(now, fitter);
    if (now.members.empty() || !now.fit.ok || now.fit.degrees_of_freedom < 1) break;
    if (passes(now.fit)) {
      test.status = IntegrityTest::Status::kRepaired;
      tested = std::move(now);
      return test;
    }
  }
  test = of_all;
  test.status = IntegrityTest::Status::kFailed;
  return test;
}

}  // namespace canyon::gnss
