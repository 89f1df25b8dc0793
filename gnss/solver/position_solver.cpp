#include "canyon/gnss/solver/position_solver.h"

#include <algorithm>
#include <cstdio>
#include <numeric>

#include "canyon/core/check.h"
#include "canyon/gnss/solver/fault_exclusion.h"
#include "canyon/gnss/solver/gauss_newton.h"
#include "canyon/gnss/solver/receiver_clocks.h"

namespace canyon::gnss {
namespace {

std::string inconsistent_reason(const IntegrityTest& test) {
  char text[160];
  std::snprintf(text, sizeof text, "ranges are inconsistent: chi-square %.4g of %d degrees of freedom exceeds %.4g",
                test.statistic, test.degrees_of_freedom, test.threshold);
  return text;
}

/// Fits subsets of one epoch's ranges.
class EpochFitter final : public SubsetFitter {
 public:
  EpochFitter(std::span<const RangeMeasurement> ranges, const Eigen::Vector3d& guess_E, bool clocks, double max_gdop)
      : ranges_(ranges), guess_E_(guess_E), clocks_(clocks), max_gdop_(max_gdop) {}

  RangeFit fit(const std::vector<std::size_t>& members) const override {
    return fit_ranges(subset(members), guess_E_, clocks_, max_gdop_);
  }
  std::vector<RangeMeasurement> subset(const std::vector<std::size_t>& members) const {
    std::vector<RangeMeasurement> out;
    for (const std::size_t i : members) out.push_back(ranges_[i]);
    return out;
  }

 private:
  std::span<const RangeMeasurement> ranges_;
  Eigen::Vector3d guess_E_;
  bool clocks_;
  double max_gdop_;
};

/// Ranges that were excluded have residuals too, where their system's clock is known.
std::vector<double> residuals_of_all(std::span<const RangeMeasurement> ranges, const PositionSolution& solution,
                                     double shared, bool clocks) {
  std::vector<double> out;
  for (const auto& r : ranges) {
    const double clock_m = clocks ? solution.system_clock_m[static_cast<std::size_t>(r.system)] : 0.0;
    out.push_back(r.range_m - line_of_sight(r.p_E, solution.p_E).range_m - clock_m - shared * r.shared_m);
  }
  return out;
}

PositionSolution solve_ranges(std::span<const RangeMeasurement> ranges, const Eigen::Vector3d& guess_E, bool clocks,
                              const PositionSolverParameters& p) {
  RangeSubset subset;
  subset.members.resize(ranges.size());
  std::iota(subset.members.begin(), subset.members.end(), std::size_t{0});
  const EpochFitter fitter(ranges, guess_E, clocks, p.max_gdop);
  subset.fit = fitter.fit(subset.members);

  PositionSolution out;
  out.dop = subset.fit.dop;
  out.iterations = subset.fit.iterations;
  out.reason = subset.fit.reason;
  if (!subset.fit.ok) return out;
  out.integrity = exclude_faults(subset, fitter, p);
  if (out.integrity.status == IntegrityTest::Status::kFailed) {
    out.reason = inconsistent_reason(out.integrity);
    return out;
  }

  const RangeFit& fit = subset.fit;
  out.ok = true;
  out.p_E = fit.p_E;
  out.covariance_E = fit.covariance_E;
  out.range_gain = fit.range_gain;
  out.dop = fit.dop;
  if (clocks) {
    const ReceiverClocks order(fitter.subset(subset.members));
    for (const GnssSystem s : {GnssSystem::kGps, GnssSystem::kGlonass, GnssSystem::kGalileo, GnssSystem::kBeidou,
                               GnssSystem::kQzss, GnssSystem::kSbas})
      if (const auto& known = order.systems(); std::find(known.begin(), known.end(), clock_system(s)) != known.end())
        out.system_clock_m[static_cast<std::size_t>(s)] = fit.clock_m[order.index(s)];
    out.clock_m = fit.clock_m.front();
  }
  out.used.assign(ranges.size(), false);
  for (const std::size_t i : subset.members) out.used[i] = true;
  out.residuals_m = residuals_of_all(ranges, out, fit.shared, clocks);
  return out;
}

class LeastSquares final : public PositionSolver {
 public:
  explicit LeastSquares(const PositionSolverParameters& p) : p_(p) {}
  PositionSolution solve(std::span<const RangeMeasurement> ranges, const Eigen::Vector3d& guess_E) const override {
    return solve_ranges(ranges, guess_E, true, p_);
  }
  bool solves_clock() const override { return true; }

 private:
  PositionSolverParameters p_;
};

class Trilateration final : public PositionSolver {
 public:
  explicit Trilateration(const PositionSolverParameters& p) : p_(p) {}
  PositionSolution solve(std::span<const RangeMeasurement> ranges, const Eigen::Vector3d& guess_E) const override {
    return solve_ranges(ranges, guess_E, false, p_);
  }
  bool solves_clock() const override { return false; }

 private:
  PositionSolverParameters p_;
};

constexpr ModelRow<MakePositionSolver> kSolvers[] = {
    {"least_squares", without_keys<make_least_squares>,
     "iterated weighted least squares for position and receiver clocks"},
    {"trilateration", without_keys<make_trilateration>, "the paper's: ranges only, no receiver clock"},
};

}  // namespace

ModelTable<MakePositionSolver> position_solvers() {
  return kSolvers;
}

std::unique_ptr<PositionSolver> make_least_squares(const PositionSolverParameters& p) {
  return std::make_unique<LeastSquares>(p);
}
std::unique_ptr<PositionSolver> make_trilateration(const PositionSolverParameters& p) {
  return std::make_unique<Trilateration>(p);
}

}  // namespace canyon::gnss
