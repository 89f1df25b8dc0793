#include "canyon/core/math/chi_square.h"

#include <vector>

#include "canyon/core/stress/subjects.h"
#include "canyon/core/stress_rows.h"

namespace canyon {
namespace {

/// Q(n, h) = sum over j < n of e^-h h^j / j!, for 2 n degrees of freedom, in 64 bits of mantissa: its logarithms of up
/// to 10^7, of which it is the difference, leave three roundings of them.
double even_tail(int n, double h) {
  const long double x = h;
  // From the largest of the terms on both sides, until they no longer count.
  const int top = std::min(n - 1, static_cast<int>(h));
  const long double largest = std::exp(static_cast<long double>(top) * std::log(x) - x - std::lgamma(top + 1.0L));
  long double sum = 0.0L, term = largest;
  for (int j = top; j >= 0 && term > 1e-22L * sum; --j) {
    sum += term;
    term *= j / x;
  }
  term = largest;
  for (int j = top + 1; j < n; ++j) {
    term *= x / j;
    if (term < 1e-22L * sum) break;
    sum += term;
  }
  return static_cast<double>(sum);
}

double deviations_off(double dof, double sigmas) {
  return std::max(1e-3, dof + sigmas * std::sqrt(2.0 * dof));
}

StressFigure tail(double dof) {
  double worst = 0.0;
  for (const double sigmas : {-4.0, -1.0, 0.0, 1.0, 5.0, 8.0, 20.0}) {
    const double x = deviations_off(dof, sigmas), exact = even_tail(static_cast<int>(dof / 2), 0.5 * x);
    worst = worse(worst, std::abs(chi_square_tail(x, dof) / exact - 1.0));
  }
  const double reference = 3.0 * 0.5 * dof * std::log(0.5 * dof + 2.0) * 0x1p-64;
  return {worst, 1e-12 + reference};
}

/// The tail at a threshold is the probability again: to the tail's own error on both ways, and what an ulp of the
/// threshold makes of it, |d ln Q / dx| x eps below 1e-12 here.
StressFigure thresholds() {
  double worst = 0.0;
  for (const double dof : {0.5, 1.0, 3.0, 100.0, 1e4})
    for (const double p : {1e-300, 1e-100, 1e-15, 1e-6, 0.5, 0.999})
      worst = worse(worst, std::abs(chi_square_tail(chi_square_threshold(p, dof), dof) / p - 1.0));
  return {worst, 3e-12};
}

StressFigure ends() {
  int wrong = 0;
  for (const double dof : {0.5, 3.0, 1e6}) {
    wrong += chi_square_tail(0.0, dof) == 1.0 && chi_square_tail(-1e300, dof) == 1.0 ? 0 : 1;
    wrong += chi_square_tail(1e300, dof) == 0.0 ? 0 : 1;
    wrong += chi_square_tail(stress::kInfinity, dof) == 0.0 ? 0 : 1;
    wrong += chi_square_tail(1e-300, dof) <= 1.0 ? 0 : 1;
    wrong += stress::not_refused([&] { return chi_square_tail(std::nan(""), dof); });
  }
  wrong += stress::not_refused([] { return chi_square_tail(1.0, 0.0); });
  wrong += stress::not_refused([] { return chi_square_threshold(0.0, 3.0); });
  wrong += stress::not_refused([] { return chi_square_threshold(1.0, 3.0); });
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> chi_square_cases() {
  const auto group = StressGroup::kData;
  StressMechanism logarithms{
      group, "cancellation of large logarithms",
      "a ln x - x - ln Gamma(a) is a small difference of numbers of 10^7 (found by this case, 2026-11-22: 2e-9)",
      "relative error below 1e-12, as chi_square.h says, by the finite sum in 64 bits of mantissa and what that leaves",
      ""};
  const StressMechanism far{group, "tails of 1e-300",
                            "1 - P is 0 from 1e-16 on, so a threshold of a rare event is infinite",
                            "the tail at its threshold is the probability again to 3e-12: twice the "
                            "tail's error, and an ulp of the threshold",
                            ""};
  const StressMechanism edge{group, "a function's argument at its ends",
                             "0 ln 0, infinity minus infinity, or a loop that counts to no number",
                             "0, infinity and no number give 1, 0 and a refusal: exact", "answers"};
  logarithms.loose = "the bound is what the header promises at any degrees of freedom";
  StressRows rows;
  for (const double dof : {2.0, 20.0, 2e3, 2e5, 2e6})
    rows.of(logarithms).add("chi_square/tail_of_" + stress::text(dof) + "_degrees", [dof] { return tail(dof); });
  rows.of(far).add("chi_square/thresholds_to_1e-300", thresholds);
  rows.of(edge).add("chi_square/ends", ends);
  return rows.take();
}

}  // namespace canyon
