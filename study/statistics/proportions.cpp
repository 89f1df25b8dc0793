#include "canyon/study/statistics/proportions.h"

#include <algorithm>

#include "canyon/core/check.h"

namespace canyon::study {

Interval wilson_interval(int successes, int n) {
  CANYON_CHECK(successes >= 0 && successes <= n, "successes = ", successes, ", n = ", n);
  if (n == 0) return {};
  const double z2 = kNormal975 * kNormal975, x = successes, m = n;
  const double centre = (2 * x + z2) / (2 * (m + z2));
  const double half = kNormal975 * std::sqrt(z2 + 4 * x * (1 - x / m)) / (2 * (m + z2));
  // At the ends the formula gives 0 and 1 but for rounding.
  return {successes == 0 ? 0.0 : centre - half, successes == n ? 1.0 : centre + half};
}

double PairedCounts::difference() const {
  return n() > 0 ? static_cast<double>(only_b - only_a) / n() : kNaN;
}

Interval paired_difference_interval(const PairedCounts& counts) {
  const double n = counts.n();
  if (counts.n() == 0) return {};
  const int a = counts.both + counts.only_a, b = counts.both + counts.only_b;
  const double share_a = a / n, share_b = b / n;
  const Interval of_a = wilson_interval(a, counts.n()), of_b = wilson_interval(b, counts.n());

  const double margins = static_cast<double>(a) * (n - a) * b * (n - b);
  double phi = 0.0;
  if (margins > 0.0) {
    const double product = static_cast<double>(counts.both) * counts.neither -
                           static_cast<double>(counts.only_a) * static_cast<double>(counts.only_b);
    phi = (product > 0.0 ? std::max(0.0, product - n / 2) : product) / std::sqrt(margins);
  }
  const auto reach = [phi](double first, double second) {
    return std::sqrt(std::max(0.0, first * first - 2 * phi * first * second + second * second));
  };
  const double difference = counts.difference();
  return {difference - reach(share_b - of_b.low, of_a.high - share_a),
          difference + reach(of_b.high - share_b, share_a - of_a.low)};
}

double fair_coin_tail(int k, int n) {
  if (k < 0) return 0.0;
  if (k >= n) return 1.0;
  // C(n, i) as multiples of the middle one, from the middle down; the upper half is its mirror image.
  const int middle = n / 2;
  double term = 1.0, total = 0.0, lower = 0.0;
  for (int i = middle; i >= 0; --i) {
    const bool mirrored = n - i != i;
    total += mirrored ? 2 * term : term;
    if (i <= k) lower += term;                  // i itself
    if (mirrored && n - i <= k) lower += term;  // its mirror image n - i
    term *= static_cast<double>(i) / (n - i + 1);
  }
  return lower / total;
}

double mcnemar_exact_p(int only_a, int only_b) {
  return std::min(1.0, 2 * fair_coin_tail(std::min(only_a, only_b), only_a + only_b));
}

}  // namespace canyon::study
