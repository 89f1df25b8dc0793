#include <cmath>
#include <initializer_list>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/math/median.h"
#include "canyon/core/math/singular_values.h"
#include "canyon/core/stress/subjects.h"
#include "canyon/core/stress_rows.h"

namespace canyon {
namespace {

StressFigure medians() {
  constexpr double kMost = std::numeric_limits<double>::max(), kLeast = std::numeric_limits<double>::denorm_min();
  int wrong = 0;
  wrong += median({kMost, kMost}) == kMost ? 0 : 1;
  wrong += median({-kMost, -kMost, -kMost, -kMost}) == -kMost ? 0 : 1;
  wrong += median({-kMost, kMost}) == 0.0 ? 0 : 1;
  wrong += median({kLeast, kLeast}) == kLeast ? 0 : 1;
  wrong += median({-stress::kInfinity, 1.0, stress::kInfinity}) == 1.0 ? 0 : 1;
  wrong += median({1e9, 3.0, -1e300}) == 3.0 ? 0 : 1;
  wrong += std::isnan(median({})) ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

/// The order of a list that holds what is not a number is none: whatever place that has, the answer must say so.
StressFigure medians_of_no_numbers() {
  int wrong = 0;
  for (std::size_t place = 0; place < 101; ++place) {
    std::vector<double> values;
    for (int i = 0; i < 101; ++i) values.push_back((i * 37) % 101);
    values[place] = std::nan("");
    wrong += std::isnan(median(values)) ? 0 : 1;
  }
  return {1.0 * wrong, 0.0};
}

/// Two directions of which the second is weaker by `ratio`, mixed by turns: the values come out to 20 epsilons of the
/// largest (Jacobi's sweeps), and a solution that leaves the weak one alone stays as small as the strong one makes it.
StressFigure weak_direction(double ratio) {
  const double c = std::cos(0.7), s = std::sin(0.7);
  Eigen::MatrixXd U(4, 2);
  U << c, 0.0, s, 0.0, 0.0, s, 0.0, -c;
  const Eigen::Matrix2d V = (Eigen::Matrix2d() << s, -c, c, s).finished();
  const Eigen::MatrixXd A = U * Eigen::Vector2d(1.0, ratio).asDiagonal() * V.transpose();
  const SingularValues found(A);
  const Eigen::VectorXd x = found.solve(U * Eigen::Vector2d(2.0, 1.0), 1e-9);
  stress::Worst worst;
  worst.look(found.values[0] - 1.0, 20.0 * stress::kEpsilon);
  worst.look(found.values[1] - ratio, 20.0 * stress::kEpsilon);
  // The right-hand side's weak part is as large as the strong one; divided by `ratio` it would be all there is. The
  // direction itself is known to an epsilon.
  const Eigen::Vector2d exact = ratio > 1e-9 ? Eigen::Vector2d(V * Eigen::Vector2d(2.0, 1.0 / ratio))
                                             : Eigen::Vector2d(V * Eigen::Vector2d(2.0, 0.0));
  worst.look((x - exact).norm(), 20.0 * stress::kEpsilon * (2.0 + (ratio > 1e-9 ? 1.0 / (ratio * ratio) : 0.0)));
  return worst.figure();
}

/// What cases are written with: a figure is the largest part of any bound, and holds up to 1 and no further; without a
/// bound, without a number, or merely wrong it is as bad as can be. A figure counts what differs.
StressFigure figures_themselves() {
  int wrong = 0;
  const auto worst_of = [](std::initializer_list<std::pair<double, double>> looks) {
    stress::Worst worst;
    for (const auto& [error, bound] : looks) worst.look(error, bound);
    return worst.figure();
  };
  const auto is = [&](const StressFigure& found, double figure) {
    wrong += found.figure == figure && found.bound == 1.0 ? 0 : 1;
  };
  is(worst_of({}), 0.0), is(worst_of({{-3.0, 2.0}, {1.0, 4.0}}), 1.5), is(worst_of({{0.0, 1.0}, {-0.5, 0.5}}), 1.0);
  for (const double none : {0.0, -1.0, std::nan(""), stress::kInfinity})
    is(worst_of({{0.1, none}, {0.0, 1.0}}), stress::kInfinity);
  is(worst_of({{std::nan(""), 1.0}, {0.0, 1.0}}), stress::kInfinity);
  wrong += beyond(3.0, 1.0) == 2.0 && beyond(-3.0, 1.0) == 0.0 && beyond(1.0, 1.0) == 0.0 ? 0 : 1;
  wrong +=
      std::isnan(beyond(std::nan(""), 1.0)) && std::isnan(worse(1.0, std::nan(""))) && worse(2.0, 3.0) == 3.0 ? 0 : 1;
  wrong += std::isnan(worse(std::nan(""), 1.0)) && worse(3.0, 2.0) == 3.0 ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> summary_cases() {
  const StressMechanism overflow{StressGroup::kData, "overflow of a mean",
                                 "the sum of the two in the middle is infinite (found by this case, 2026-11-22)",
                                 "the largest, the smallest and infinite values have their median: exact", "medians"};
  const StressMechanism order{
      StressGroup::kData, "an order that is none",
      "sorting what is not a number leaves any order, and reads past the ends (found by this case, 2026-11-22)",
      "no number, wherever in the list it stands", "medians"};
  const StressMechanism weak{
      StressGroup::kData, "rank deficiency of a least-squares problem",
      "normal equations square the ratio of the directions, and the weak one's noise becomes the answer",
      "values to 20 epsilons of the largest; below the threshold the weak direction is left alone", "of the bound"};
  StressRows rows;
  rows.of(overflow).add("median/of_largest_values", medians);
  rows.of(order).add("median/of_no_numbers", medians_of_no_numbers);
  rows.of({StressGroup::kData, "figures that cases are told by",
           "a bound that lets more through than it says, a number that is none",
           "up to the bound and no further: exact", "differences"});
  rows.add("figures/themselves", figures_themselves);
  for (const double ratio : {1.0, 1e-6, 1e-12, 0.0})
    rows.of(weak).add("singular_values/second_direction_weaker_by_" + stress::text(ratio),
                      [ratio] { return weak_direction(ratio); });
  return rows.take();
}

}  // namespace canyon
