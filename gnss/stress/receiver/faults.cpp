// Faulty ranges that are left out of a fit.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/earth/earth.h"
#include "canyon/core/math/chi_square.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress_rows.h"
#include "canyon/gnss/solver/gauss_newton.h"
#include "canyon/gnss/stress/receiver/made_ranges.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using made::kPlace;
using made::some_ranges;

double power2(double x) {
  return x * x;
}

/// Faults left out as each method says, by fits of every subset: the largest standardised residual first, or the one
/// without which the rest fits best, until the chi-square test passes; refused where none helps.
StressFigure faults_left_out() {
  int wrong = 0, repaired = 0, failed = 0;
  const RandomStream draws(33, "stress.epochs");
  const Vector3d at_E = ecef_from_geodetic(kPlace);
  for (std::uint64_t epoch = 0; epoch < 40; ++epoch)
    for (const std::string method : {"none", "detect", "greedy", "leave_one_out"}) {
      auto ranges = some_ranges(epoch, 9 + epoch % 4, epoch % 2 == 0, false);
      for (std::uint64_t i = 0; i < epoch % 4; ++i)
        ranges[(3 * i + epoch) % ranges.size()].range_m += draws.uniform(20.0, 90.0, 3, 8 * epoch + i);
      PositionSolverParameters p;
      p.fault_exclusion = method, p.false_alarm = 1e-3, p.max_exclusions = 2;
      const PositionSolution s = make_least_squares(p)->solve(ranges, at_E);
      std::vector<std::size_t> members(ranges.size());
      for (std::size_t i = 0; i < members.size(); ++i) members[i] = i;
      const auto fit_of = [&](const std::vector<std::size_t>& some) {
        std::vector<RangeMeasurement> subset;
        for (const std::size_t i : some) subset.push_back(ranges[i]);
        return fit_ranges(subset, at_E, true, p.max_gdop);
      };
      const auto without = [](std::vector<std::size_t> some, std::size_t i) {
        some.erase(some.begin() + static_cast<std::ptrdiff_t>(i));
        return some;
      };
      RangeFit fit = fit_of(members);
      const auto passes = [&] { return fit.statistic <= chi_square_threshold(1e-3, fit.degrees_of_freedom); };
      bool good = method == "none" || passes();
      const bool at_once = good;
      for (int round = 0; round < 2 && !good && method != "detect"; ++round) {
        std::size_t out = members.size();
        double best = method == "greedy" ? 0.0 : 1e300;
        for (std::size_t i = 0; i < members.size(); ++i) {
          if (fit.redundancy[i] < 1e-6) continue;
          if (method == "greedy") {
            const double w2 = power2(fit.weighted[i]) / fit.redundancy[i];
            if (w2 > best) best = w2, out = i;
          } else if (const RangeFit one = fit_of(without(members, i)); one.ok && one.statistic < best) {
            best = one.statistic, out = i;
          }
        }
        if (out == members.size()) break;
        members = without(members, out);
        fit = fit_of(members);
        if (!fit.ok || fit.degrees_of_freedom < 1) break;
        good = passes();
      }
      wrong += s.ok == good ? 0 : 1;
      using Status = IntegrityTest::Status;
      const Status expected = method == "none" ? Status::kNotTested
                              : at_once        ? Status::kPassed
                              : good           ? Status::kRepaired
                                               : Status::kFailed;
      wrong += s.integrity.status == expected ? 0 : 1;
      repaired += expected == Status::kRepaired ? 1 : 0, failed += expected == Status::kFailed ? 1 : 0;
      if (!s.ok || !good) continue;
      for (std::size_t i = 0; i < ranges.size(); ++i)
        wrong += s.used[i] == (std::find(members.begin(), members.end(), i) != members.end()) ? 0 : 1;
      wrong += (s.p_E - fit.p_E).norm() < 1e-6 ? 0 : 1;
    }
  wrong += repaired > 15 && failed > 10 ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> fault_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "faults that are left out", "the best for the worst, one exclusion too many",
           "each method by fits of all subsets: exact", "wrong"});
  rows.add("epochs/faults_left_out", faults_left_out);
  return rows.take();
}

}  // namespace canyon::gnss
