#include "canyon/fusion/consistency.h"

#include <vector>

#include "canyon/core/math/chi_square.h"
#include "canyon/core/stress_rows.h"
#include "canyon/fusion/stress/subjects.h"

namespace canyon::fusion {
namespace {

using stress::kEpsilon;

/// The finite sums against the incomplete gamma function of core, good to 1e-12, over all degrees of freedom. A sum of
/// dof / 2 positive terms, each by one product more, rounds by an epsilon each; e^-h knows its h to an epsilon of it.
StressFigure tails() {
  stress::Worst worst;
  for (int dof = 1; dof <= 100; ++dof)
    for (const double x : {1e-9, 0.1, 1.0, 10.0, 100.0, 400.0, 1000.0}) {
      const double exact = canyon::chi_square_tail(x, dof);
      worst.look(chi_square_tail(x, dof) / exact - 1.0, 1e-12 + kEpsilon * (dof + x));
    }
  return worst.figure();
}

StressFigure ends() {
  int wrong = 0;
  for (const int dof : {1, 2, 3, 8, 99, 100}) {
    wrong += chi_square_tail(0.0, dof) == 1.0 ? 0 : 1;
    for (const double x : {1e5, 1e9, 1e300, stress::kInfinity}) wrong += chi_square_tail(x, dof) == 0.0 ? 0 : 1;
    wrong += stress::not_refused([&] { return chi_square_tail(std::nan(""), dof); });
    wrong += stress::not_refused([&] { return chi_square_tail(-1.0, dof); });
  }
  wrong += stress::not_refused([] { return chi_square_tail(1.0, 0); });
  wrong += stress::not_refused([] { return chi_square_tail(1.0, 101); });
  wrong += normal_two_sided_tail(0.0) == 1.0 && normal_two_sided_tail(stress::kInfinity) == 0.0 ? 0 : 1;
  wrong += normal_two_sided_tail(20.0) > 0.0 ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

/// The band of a mean of `count` values against the exact quantiles of their sum: Wilson and Hilferty's form is good to
/// 1 % from 30 degrees of freedom n on. What it leaves is the fourth cumulant of the cube root, 4 / (9 n), of a spread
/// of sqrt(2 / n): with n^(-3/2).
StressFigure band(std::int64_t count) {
  const Band b = mean_chi_square_band(3, count, 1e-3);
  const double n = 3.0 * static_cast<double>(count);
  const double low = chi_square_threshold(1.0 - 0.5e-3, n) / static_cast<double>(count),
               high = chi_square_threshold(0.5e-3, n) / static_cast<double>(count);
  return {worse(std::abs(b.low / low - 1.0), std::abs(b.high / high - 1.0)), 0.01 * std::pow(30.0 / n, 1.5)};
}

/// A covariance that is none has no normalised square.
StressFigure indefinite() {
  int wrong = 0;
  const Eigen::Vector3d e(1.0, -2.0, 3.0);
  for (const double last : {0.0, -1e-30, -1.0, std::nan("")}) {
    const Eigen::Matrix3d P = Eigen::Vector3d(1.0, 1.0, last).asDiagonal();
    wrong += std::isnan(normalized_squared(e, P)) ? 0 : 1;
  }
  for (const double scale : {1e-200, 1.0, 1e200}) {
    const Eigen::Matrix3d P = scale * Eigen::Matrix3d::Identity();
    wrong += std::abs(normalized_squared((std::sqrt(scale) * e).eval(), P) - 14.0) < 14.0 * 8.0 * kEpsilon ? 0 : 1;
  }
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> consistency_cases() {
  const auto group = StressGroup::kData;
  const StressMechanism sum{group, "a finite sum of a tail", "terms of alternating parity, or one too few",
                            "the incomplete gamma function's, to an epsilon a term and of x", "of the bound"};
  const StressMechanism edge{group, "a test's statistic at its ends",
                             "infinity times zero is no number, and passes every gate",
                             "0 and infinity give 1 and 0, what is no number is refused: exact", "answers"};
  const StressMechanism many{StressGroup::kLong, "a mean of very many squares",
                             "quantiles of 10^6 degrees of freedom lose their digits, and the band "
                             "the mean",
                             "the exact quantiles, to 1 % at 30 degrees and less with their number to the power 3/2",
                             ""};
  const StressMechanism none{group, "a covariance that is none", "a negative square that lowers the mean",
                             "is told as no number; and 10^-200 to 10^200 do not matter", "answers"};
  StressRows rows;
  rows.of(sum).add("consistency/tails_of_1_to_100_degrees", tails);
  rows.of(edge).add("consistency/ends_of_the_tail", ends);
  rows.of(none).add("consistency/indefinite_covariances", indefinite);
  for (const std::int64_t count : {10, 1000, 100'000})
    rows.of(many).add("consistency/band_of_" + stress::text(static_cast<double>(count)) + "_values",
                      [=] { return band(count); });
  return rows.take();
}

}  // namespace canyon::fusion
